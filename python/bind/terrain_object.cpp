// SPDX-License-Identifier: MIT
#include "python/bind/terrain_object.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "python/bind/tasks.h"
#include "scarp/base/error.h"

namespace scarp::python {
namespace {

namespace py = pybind11;

HeightField field_over(const Samples& samples, const HeightFieldSettings& settings) {
  const auto view = [&]<class T>(const T* data) {
    return HeightField::view(data, samples.cols, samples.rows, settings, samples.row_stride);
  };
  switch (samples.type) {
    case SampleType::int16:
      return view(static_cast<const std::int16_t*>(samples.northernmost));
    case SampleType::uint16:
      return view(static_cast<const std::uint16_t*>(samples.northernmost));
    case SampleType::float32:
      break;
  }
  return view(static_cast<const float*>(samples.northernmost));
}

HeightField field_over(const py::array& heights, bool south_up, const HeightFieldSettings& settings) {
  const Samples samples = samples_of(heights, south_up);
  const py::gil_scoped_release release;
  return field_over(samples, settings);
}

// Copies rows of samples; a stride counts samples.
template <class T>
void copy_rows(const T* from, std::ptrdiff_t from_stride, T* to, std::ptrdiff_t to_stride, const SampleRect& rect) {
  for (std::ptrdiff_t row = 0; row < rect.rows; ++row)
    std::copy_n(from + row * from_stride, rect.cols, to + row * to_stride);
}

// Overwrites samples of the array that a ground reads, which the caller has found writable. If the ground rejects them,
// the array is as before.
template <class T, class Ground>
void overwrite(const SampleGrid<T>& grid, const SampleRect& rect, const T* samples, std::ptrdiff_t stride,
               Ground& ground) {
  T* first = const_cast<T*>(grid.row(rect.row)) + rect.col;
  std::vector<T> before(static_cast<std::size_t>(rect.cols) * static_cast<std::size_t>(rect.rows));
  copy_rows<T>(first, grid.row_stride, before.data(), rect.cols, rect);
  copy_rows<T>(samples, stride, first, grid.row_stride, rect);
  try {
    ground.samples_changed(rect);
  } catch (const Error&) {
    copy_rows<T>(before.data(), rect.cols, first, grid.row_stride, rect);
    ground.samples_changed(rect);
    throw;
  }
}

FieldGuards guard_of(const py::array& heights) {
  auto guard = std::make_shared<FieldGuard>();
  guard->memory = std::make_unique<ArrayMemory>(heights);
  return {guard};
}

}  // namespace

TerrainObject::TerrainObject(const py::array& heights, bool south_up, const HeightFieldSettings& settings,
                             Georeference georeference)
    : SceneObject(guard_of(heights)),
      field_(field_over(heights, south_up, settings)),
      georeference_(std::move(georeference)) {}

TerrainObject::TerrainObject(HeightField field, Georeference georeference)
    : SceneObject({std::make_shared<FieldGuard>()}), field_(std::move(field)), georeference_(std::move(georeference)) {}

const Terrain& TerrainObject::terrain() const {
  std::call_once(built_, [&] { terrain_.emplace(field_, georeference_); });
  return *terrain_;
}

HeightField TerrainObject::field_with_cells(double cell_x, double cell_y) const {
  HeightFieldSettings settings = field_.settings();
  settings.cell_x = cell_x;
  settings.cell_y = cell_y;
  return field_.visit([&]<class T>(const SampleGrid<T>& grid) {
    return HeightField::view(grid.data, field_.cols(), field_.rows(), settings, grid.row_stride);
  });
}

py::object TerrainObject::array() const {
  const auto& memory = guards().front()->memory;
  return memory ? py::object(memory->array()) : py::none();
}

template <class Change>
void TerrainObject::edit(const Change& change) {
  require_no_callback();
  require_memory(*this);
  const py::gil_scoped_release release;
  const auto lock = guards().front()->turnstile.edit();
  ++guards().front()->edits;
  if (terrain_) {
    change(*terrain_);
  } else {
    change(field_);
  }
}

void TerrainObject::samples_changed(const SampleRect& rect) {
  edit([&](auto& ground) { ground.samples_changed(rect); });
}

void TerrainObject::set_samples(const SampleRect& rect, const py::array& samples) {
  const Samples source = samples_of(samples, false);
  if (source.type != field_.sample_type() || source.cols != rect.cols || source.rows != rect.rows)
    throw Error(fmt::format("edit: {} x {} samples of type {} for {} x {} of type {} (expected the same)", source.cols,
                            source.rows, name_of(source.type), rect.cols, rect.rows, name_of(field_.sample_type())));
  const bool owned = !guards().front()->memory;
  field_.visit([&]<class T>(const SampleGrid<T>& grid) {
    const T* data = static_cast<const T*>(source.northernmost);
    edit([&](auto& ground) {
      if (owned) {
        ground.set_samples(rect, data, source.row_stride);
      } else {
        overwrite(grid, rect, data, source.row_stride, ground);
      }
    });
  });
}

}  // namespace scarp::python
