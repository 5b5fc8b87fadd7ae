// SPDX-License-Identifier: MIT
// NumPy arrays: heights read where they are, vectors of rays, and results handed over without a copy.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "scarp/base/vec.h"
#include "scarp/field/height_field.h"

namespace scarp::python {

namespace py = pybind11;

/// Heights in the memory of an array, as HeightField::view() takes them.
struct Samples {
  SampleType type = SampleType::float32;
  const void* northernmost = nullptr;
  int cols = 0, rows = 0;
  std::ptrdiff_t row_stride = 0;  ///< samples; negative if the last row is the northernmost
};

/// Describes an array of two dimensions: float32, int16 or uint16, rows of contiguous samples. `south_up`: the first
/// row is the southernmost. Throws TypeError or Error with the remedy for all other arrays. Takes no reference.
Samples samples_of(const py::array& array, bool south_up);

/// The memory of an array and of the arrays that it is a view of. NumPy may move it: ndarray.resize(refcheck=False).
class ArrayMemory {
 public:
  explicit ArrayMemory(py::array array);
  /// Throws Error if the memory has moved or changed its size. Requires the interpreter's lock.
  void require_unchanged() const;
  const py::array& array() const { return array_; }

 private:
  struct Part {
    PyObject* array;
    const void* data;
    py::ssize_t bytes;
  };
  py::array array_;
  std::vector<Part> parts_;
};

/// Vectors of three floats or doubles in an array of shape (n, 3) with any strides.
class Vectors {
 public:
  /// Whether the array is one: of floats or doubles, (n, 3).
  static bool readable(const py::array& array);
  /// Throws TypeError for another type, Error for another shape; `name` is the argument's, for messages.
  Vectors(const py::array& array, const char* name);

  std::size_t count() const { return count_; }
  dvec3 operator[](std::size_t i) const {
    const char* at = data_ + static_cast<std::ptrdiff_t>(i) * row_;
    if (is_double_) return {number<double>(at), number<double>(at + item_), number<double>(at + 2 * item_)};
    return {number<float>(at), number<float>(at + item_), number<float>(at + 2 * item_)};
  }

 private:
  template <class T>
  static double number(const char* at) {
    T value;
    std::memcpy(&value, at, sizeof value);  // arrays of records are not aligned
    return static_cast<double>(value);
  }

  const char* data_;
  std::ptrdiff_t row_, item_;
  std::size_t count_;
  bool is_double_;
};

/// Throws Error unless an array is C-contiguous and writable and has this many items of this size; returns its memory.
void* require_room(py::array& array, std::size_t items, std::size_t item_bytes, const char* name);

/// Hands a vector over to an array of this shape. `Item` has the size and meaning of T, such as an enum's integer.
template <class Item, class T>
py::array_t<Item> handed_over(std::vector<T>&& values, const std::vector<py::ssize_t>& shape) {
  static_assert(sizeof(Item) == sizeof(T));
  auto kept = std::make_unique<std::vector<T>>(std::move(values));
  const auto* data = reinterpret_cast<const Item*>(kept->data());
  py::capsule owner(kept.get(), [](void* vector) { delete static_cast<std::vector<T>*>(vector); });
  kept.release();
  return py::array_t<Item>(shape, data, owner);
}

}  // namespace scarp::python
