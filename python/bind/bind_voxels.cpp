// SPDX-License-Identifier: MIT
// The class Voxels of the module.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "python/bind/bind.h"
#include "python/bind/tasks.h"
#include "scarp/base/error.h"
#include "scarp/scene/voxels.h"

namespace scarp::python {
namespace {

namespace py = pybind11;

using Indices = py::array_t<std::uint8_t, py::array::c_style>;
using Positions = py::array_t<std::int32_t, py::array::c_style | py::array::forcecast>;
using Three = std::array<double, 3>;
using Whole = std::array<int, 3>;

dvec3 vector_of(const Three& numbers) { return {numbers[0], numbers[1], numbers[2]}; }
ivec3 whole_of(const Whole& numbers) { return {numbers[0], numbers[1], numbers[2]}; }

Voxels copied(const Indices& indices, double side, const std::vector<VoxelColour>& palette) {
  if (indices.ndim() != 3)
    throw Error(fmt::format("voxels: the array has {} dimensions (expected three: z, y and x)", indices.ndim()));
  for (py::ssize_t i = 0; i < 3; ++i)
    if (indices.shape(i) < 1 || indices.shape(i) > VoxelGrid::kMaxSide)
      throw Error(fmt::format("voxels: the array has the shape ({}, {}, {}) (expected sides from 1 to {})",
                              indices.shape(0), indices.shape(1), indices.shape(2), VoxelGrid::kMaxSide));
  const ivec3 size{indices.shape(2), indices.shape(1), indices.shape(0)};
  const std::uint8_t* data = indices.data();
  const py::gil_scoped_release release;
  return Voxels::copy(data, size, {side, palette});
}

class VoxelsObject : public SceneObject {
 public:
  VoxelsObject(const Indices& indices, double side, const std::vector<VoxelColour>& palette)
      : SceneObject({std::make_shared<FieldGuard>()}), voxels_(copied(indices, side, palette)) {}

  const Scene& scene() const override { return voxels_.scene(); }
  const VoxelGrid& grid() const { return voxels_.grid(); }

  // Applies `change` to the grid when no query runs.
  template <class Change>
  void edit(const Change& change) {
    require_no_callback();
    FieldGuard& guard = *guards().front();
    const py::gil_scoped_release release;
    const auto lock = guard.turnstile.edit();
    ++guard.edits;
    voxels_.edit([&](VoxelGrid& grid) { return change(grid); });
  }

 private:
  Voxels voxels_;
};

void set_voxels(VoxelsObject& self, const Positions& positions, const Positions& entries) {
  if (positions.ndim() != 2 || positions.shape(1) != 3)
    throw Error("edit: expected positions of the shape (n, 3): x, y and z");
  if (entries.size() != 1 && entries.size() != positions.shape(0))
    throw Error(fmt::format("edit: {} entries for {} voxels (expected one, or one per voxel)", entries.size(),
                            positions.shape(0)));
  std::vector<VoxelGrid::Placed> placed;
  for (py::ssize_t i = 0; i < positions.shape(0); ++i) {
    const std::int32_t entry = entries.data()[entries.size() == 1 ? 0 : i];
    if (entry < 0) throw Error(fmt::format("edit: the entry {} is below 0 (0 is empty)", entry));
    const ivec3 voxel{positions.at(i, 0), positions.at(i, 1), positions.at(i, 2)};
    placed.push_back({voxel, entry == 0 ? VoxelGrid::Voxel() : VoxelGrid::Voxel(static_cast<std::uint32_t>(entry))});
  }
  self.edit([&](VoxelGrid& grid) { return grid.set(placed); });
}

// The entries, (z, y, x); 0 is empty.
py::array_t<std::uint8_t> indices_of(const VoxelsObject& self) {
  const ivec3 size = self.grid().size();
  std::vector<std::uint8_t> entries(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
                                    static_cast<std::size_t>(size.z));
  {
    const Query query(self);
    std::size_t i = 0;
    for (int z = 0; z < size.z; ++z)
      for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x, ++i)
          if (self.grid().solid({x, y, z})) entries[i] = static_cast<std::uint8_t>(self.grid().entry({x, y, z}));
  }
  return handed_over<std::uint8_t>(std::move(entries), {size.z, size.y, size.x});
}

VoxelBox box_of(const Whole& low, const Whole& high) { return {whole_of(low), whole_of(high)}; }

}  // namespace

void bind_voxels(py::module_& module) {
  py::class_<VoxelsObject, SceneObject>(module, "Voxels")
      .def(py::init<const Indices&, double, const std::vector<VoxelColour>&>(), py::arg("indices"), py::arg("side"),
           py::arg("palette"))
      .def_property_readonly("_size",
                             [](const VoxelsObject& self) {
                               const ivec3 size = self.grid().size();
                               return py::make_tuple(size.x, size.y, size.z);
                             })
      .def_property_readonly("_solid_count",
                             [](const VoxelsObject& self) {
                               const Query query(self);
                               return self.grid().solid_count();
                             })
      .def("_indices", &indices_of)
      .def("_fill_box",
           [](VoxelsObject& self, const Whole& low, const Whole& high, std::uint32_t entry) {
             self.edit([&](VoxelGrid& grid) {
               return entry == 0 ? grid.clear(box_of(low, high)) : grid.fill(box_of(low, high), entry);
             });
           })
      .def("_fill_sphere",
           [](VoxelsObject& self, const Three& centre, double radius, std::uint32_t entry) {
             self.edit([&](VoxelGrid& grid) {
               return entry == 0 ? grid.clear_sphere(vector_of(centre), radius)
                                 : grid.fill_sphere(vector_of(centre), radius, entry);
             });
           })
      .def("_set", &set_voxels);
}

}  // namespace scarp::python
