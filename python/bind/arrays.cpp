// SPDX-License-Identifier: MIT
#include "python/bind/arrays.h"

#include <fmt/format.h>

#include <limits>
#include <optional>

#include "scarp/base/error.h"

namespace scarp::python {
namespace {

std::optional<SampleType> sample_type(const py::array& array) {
  // Types in the other byte order are not equivalent.
  if (py::isinstance<py::array_t<float>>(array)) return SampleType::float32;
  if (py::isinstance<py::array_t<std::int16_t>>(array)) return SampleType::int16;
  if (py::isinstance<py::array_t<std::uint16_t>>(array)) return SampleType::uint16;
  return std::nullopt;
}

std::string type_name(const py::array& array) { return py::str(array.dtype()); }

std::string shape_text(const py::array& array) { return py::str(array.attr("shape")); }

}  // namespace

Samples samples_of(const py::array& array, bool south_up) {
  if (array.ndim() != 2)
    throw Error(fmt::format("heights: the array has the shape {} (expected two dimensions, rows and columns)",
                            shape_text(array)));
  const auto type = sample_type(array);
  if (!type)
    throw py::type_error(
        fmt::format("heights: {} is not float32, int16 or uint16 in native byte order (pass copy=True, "
                    "or convert the array: heights.astype(numpy.float32))",
                    type_name(array)));
  constexpr py::ssize_t kMost = std::numeric_limits<int>::max();
  if (array.shape(0) < 1 || array.shape(1) < 1 || array.shape(0) > kMost || array.shape(1) > kMost)
    throw Error(
        fmt::format("heights: the array has the shape {} (expected at least one row and column)", shape_text(array)));
  const py::ssize_t item = array.itemsize();
  const bool one_column = array.shape(1) == 1, one_row = array.shape(0) == 1;
  if ((!one_column && array.strides(1) != item) || (!one_row && array.strides(0) % item != 0) ||
      reinterpret_cast<std::uintptr_t>(array.data()) % static_cast<std::uintptr_t>(item) != 0)
    throw Error(
        "heights: the samples of a row are not next to one another in memory (pass copy=True, or convert the array: "
        "numpy.ascontiguousarray(heights))");
  if (!one_row && array.strides(0) == 0)
    throw Error("heights: all rows are the same memory (pass copy=True, or convert the array: numpy.array(heights))");
  Samples samples{*type, array.data(), static_cast<int>(array.shape(1)), static_cast<int>(array.shape(0)), 0};
  samples.row_stride = one_row ? samples.cols : array.strides(0) / item;
  if (south_up && !one_row) {
    samples.northernmost = static_cast<const char*>(array.data()) + (array.shape(0) - 1) * array.strides(0);
    samples.row_stride = -samples.row_stride;
  }
  return samples;
}

ArrayMemory::ArrayMemory(py::array array) : array_(std::move(array)) {
  py::object part = array_;
  while (py::isinstance<py::array>(part)) {
    const auto view = py::reinterpret_borrow<py::array>(part);
    parts_.push_back({view.ptr(), view.data(), view.nbytes()});
    const py::object base = view.base();
    if (!base) break;
    part = base;
  }
}

void ArrayMemory::require_unchanged() const {
  for (const Part& part : parts_) {
    const auto view = py::reinterpret_borrow<py::array>(part.array);
    if (view.data() != part.data || view.nbytes() != part.bytes)
      throw Error("heights: the array was resized after the terrain was built over it (build another Terrain)");
  }
}

bool Vectors::readable(const py::array& array) {
  return array.ndim() == 2 && array.shape(1) == 3 &&
         (py::isinstance<py::array_t<double>>(array) || py::isinstance<py::array_t<float>>(array));
}

Vectors::Vectors(const py::array& array, const char* name) {
  if (array.ndim() != 2 || array.shape(1) != 3)
    throw Error(fmt::format("{}: the array has the shape {} (expected (..., 3): x, y and z)", name, shape_text(array)));
  is_double_ = py::isinstance<py::array_t<double>>(array);
  if (!is_double_ && !py::isinstance<py::array_t<float>>(array))
    throw py::type_error(fmt::format("{}: {} is not float64 or float32 (convert the array: {}.astype(float))", name,
                                     type_name(array), name));
  data_ = static_cast<const char*>(array.data());
  row_ = array.strides(0);
  item_ = array.strides(1);
  count_ = static_cast<std::size_t>(array.shape(0));
}

void* require_room(py::array& array, std::size_t items, std::size_t item_bytes, const char* name) {
  if (!(array.flags() & py::array::c_style) || !array.writeable() ||
      static_cast<std::size_t>(array.nbytes()) != items * item_bytes)
    throw Error(fmt::format("{}: expected a writable, contiguous array of {} bytes, found {} (room for each answer)",
                            name, items * item_bytes, array.nbytes()));
  return array.mutable_data();
}

}  // namespace scarp::python
