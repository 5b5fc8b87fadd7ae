// SPDX-License-Identifier: MIT
#include "scarp/scene/voxels.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/scene/scene_field.h"
#include "scarp/scene/voxel/placed_voxels.h"

namespace scarp {
namespace {

constexpr std::string_view kMarch = "voxel-bricks";

Scene scene_of(const std::shared_ptr<VoxelModel>& model, double side) {
  return scene_voxels({{model}, {VoxelPlace{.world_from_grid = glm::dmat3(side)}}});
}

}  // namespace

struct Voxels::State {
  double side;
  std::shared_ptr<VoxelModel> model;
  Scene scene{scene_of(model, side)};
};

Voxels::Voxels(VoxelGrid grid, VoxelSettings settings) {
  if (!(std::isfinite(settings.side) && settings.side > 0))
    throw Error(fmt::format("voxels: side is {} (must be finite and above 0)", settings.side));
  auto model = std::make_shared<VoxelModel>(std::move(grid), find_voxel_march(kMarch), std::move(settings.palette));
  state_ = std::make_shared<State>(State{settings.side, std::move(model)});
}

Voxels Voxels::copy(const std::uint8_t* indices, const ivec3& size, VoxelSettings settings) {
  if (!indices) throw Error("voxels: the pointer to the indices is null");
  if (settings.palette.empty()) settings.palette.assign(256, kPlainVoxels);
  VoxelGrid grid(size, 8);
  const auto at = [&](const ivec3& v) {
    return indices[static_cast<std::size_t>(v.x) +
                   static_cast<std::size_t>(size.x) *
                       (static_cast<std::size_t>(v.y) +
                        static_cast<std::size_t>(size.y) * static_cast<std::size_t>(v.z))];
  };
  grid.edit(grid.box(), [&](const ivec3& v, const VoxelGrid::Voxel&) {
    const std::uint8_t index = at(v);
    if (index >= settings.palette.size()) {
      throw Error(fmt::format("voxels: the index at ({}, {}, {}) is {}, but the palette has {} colours", v.x, v.y, v.z,
                              index, settings.palette.size()));
    }
    return index ? VoxelGrid::Voxel(index) : VoxelGrid::Voxel();
  });
  return Voxels(std::move(grid), std::move(settings));
}

void Voxels::edit(const std::function<VoxelBox(VoxelGrid&)>& change) {
  state_->model->edit(change);
  // The scene's box still reflects the old voxels.
  state_->scene = scene_of(state_->model, state_->side);
}

const VoxelGrid& Voxels::grid() const { return state_->model->grid(); }
VoxelColour Voxels::colour(const Hit& hit) const { return state_->model->colour(grid().entry(hit.voxel)); }
const Scene& Voxels::scene() const { return state_->scene; }

}  // namespace scarp
