// SPDX-License-Identifier: MIT
#include "scarp/scene/voxel_model.h"

#include <utility>

namespace scarp {
namespace {

// What an optional holds beyond itself.
template <class Built>
std::size_t heap_bytes(const std::optional<Built>& built) {
  return built ? built->bytes() - sizeof(Built) : 0;
}

}  // namespace

VoxelModel::VoxelModel(VoxelGrid grid, const MarchEntry& march, std::vector<VoxelColour> palette, Extent extent)
    : grid_(std::move(grid)), march_(&march), palette_(std::move(palette)), extent_(extent) {
  switch (march.voxel_accelerator) {
    case VoxelAccelerator::spheres:
      spheres_.emplace(grid_);
      break;
    case VoxelAccelerator::cubes:
      cubes_.emplace(grid_);
      break;
    case VoxelAccelerator::octants:
      octants_.emplace(grid_);
      break;
    case VoxelAccelerator::bricks:
      bricks_.emplace(grid_);
      break;
    case VoxelAccelerator::none:
      break;
  }
  box_ = extent_ == Extent::grid ? grid_.box() : grid_.bounds();
}

VoxelTarget VoxelModel::target() const {
  VoxelTarget target{&grid_, box_};
  if (spheres_) target.spheres = &*spheres_;
  if (cubes_) target.cubes = &*cubes_;
  if (octants_) target.octants = &*octants_;
  if (bricks_) target.bricks = &*bricks_;
  return target;
}

VoxelColour VoxelModel::colour(std::uint32_t entry) const {
  if (palette_.empty()) {
    return {static_cast<std::uint8_t>(entry & 255), static_cast<std::uint8_t>(entry >> 8 & 255),
            static_cast<std::uint8_t>(entry >> 16 & 255)};
  }
  return entry < palette_.size() ? palette_[entry] : VoxelColour{};
}

void VoxelModel::update(const VoxelBox& changed) {
  if (spheres_) spheres_->update(grid_, changed);
  if (cubes_) cubes_->update(grid_, changed);
  if (octants_) octants_->update(grid_, changed);
  if (bricks_) bricks_->update(grid_, changed);
  if (extent_ == Extent::bounds) box_ = grid_.bounds();
}

std::size_t VoxelModel::bytes() const {
  return sizeof(*this) - sizeof(grid_) + grid_.bytes() + palette_.size() * sizeof(VoxelColour) + heap_bytes(spheres_) +
         heap_bytes(cubes_) + heap_bytes(octants_) + heap_bytes(bricks_);
}

}  // namespace scarp
