// SPDX-License-Identifier: MIT
#include "scarp/scene/voxel/voxel_model.h"

#include <algorithm>
#include <type_traits>
#include <utility>
#include <variant>

#include "scarp/accel/brick_masks.h"
#include "scarp/accel/empty_cubes.h"
#include "scarp/accel/empty_spheres.h"
#include "scarp/accel/octant_cubes.h"
#include "scarp/scene/voxel/lattice_place.h"

namespace scarp {

std::int64_t accelerator_bytes(VoxelAccelerator accelerator, const ivec3& size) {
  const std::int64_t voxels = std::int64_t{size.x} * size.y * size.z;
  const ivec3 sectors = (size + 15) / 16;
  switch (accelerator) {
    case VoxelAccelerator::spheres:
    case VoxelAccelerator::cubes:
      return voxels;
    case VoxelAccelerator::octants:
      return 8 * voxels;
    case VoxelAccelerator::bricks:
      return std::int64_t{8} * sectors.x * sectors.y * sectors.z;
    case VoxelAccelerator::none:
      return 0;
  }
  return 0;
}

void require_marchable(const VoxelMarchEntry& march, const ivec3& size) {
  if (march.accelerator != VoxelAccelerator::none && march.accelerator != VoxelAccelerator::bricks)
    require_accelerable(size, march.name, march.accelerator == VoxelAccelerator::octants ? 8 : 1);
}

struct VoxelModel::Accelerator {
  std::variant<std::monostate, EmptySpheres, EmptyCubes, OctantCubes, BrickMasks> of;
};

VoxelModel::VoxelModel(VoxelGrid grid, const VoxelMarchEntry& march, std::vector<VoxelColour> palette, Extent extent,
                       std::vector<VoxelMaterial> materials)
    : grid_(std::move(grid)),
      march_(&march),
      palette_(std::move(palette)),
      materials_(std::move(materials)),
      extent_(extent),
      file_place_(std::make_shared<LatticePlace>(LatticeRotation{}, ivec3(0))),
      accelerator_(std::make_unique<Accelerator>()) {
  auto& built = accelerator_->of;
  switch (march.accelerator) {
    case VoxelAccelerator::spheres:
      built.emplace<EmptySpheres>(grid_);
      break;
    case VoxelAccelerator::cubes:
      built.emplace<EmptyCubes>(grid_);
      break;
    case VoxelAccelerator::octants:
      built.emplace<OctantCubes>(grid_);
      break;
    case VoxelAccelerator::bricks:
      built.emplace<BrickMasks>(grid_);
      break;
    case VoxelAccelerator::none:
      break;
  }
  box_ = extent_ == Extent::grid ? grid_.box() : grid_.bounds();
}

VoxelModel::VoxelModel(VoxelModel&&) noexcept = default;
VoxelModel& VoxelModel::operator=(VoxelModel&&) noexcept = default;
VoxelModel::~VoxelModel() = default;

void VoxelModel::set_file_place(const LatticePlace& place) { file_place_ = std::make_shared<LatticePlace>(place); }

VoxelTarget VoxelModel::target() const {
  VoxelTarget target{&grid_, box_};
  target.spheres = std::get_if<EmptySpheres>(&accelerator_->of);
  target.cubes = std::get_if<EmptyCubes>(&accelerator_->of);
  target.octants = std::get_if<OctantCubes>(&accelerator_->of);
  target.bricks = std::get_if<BrickMasks>(&accelerator_->of);
  return target;
}

VoxelColour VoxelModel::colour(std::uint32_t entry) const {
  if (palette_.empty()) {
    return {static_cast<std::uint8_t>(entry & 255), static_cast<std::uint8_t>(entry >> 8 & 255),
            static_cast<std::uint8_t>(entry >> 16 & 255)};
  }
  return entry < palette_.size() ? palette_[entry] : VoxelColour{};
}

bool VoxelModel::mirrors() const {
  return std::any_of(materials_.begin(), materials_.end(), [](const VoxelMaterial& of) { return of.mirror > 0; });
}

void VoxelModel::update(const VoxelBox& changed) {
  edits_.add();
  std::visit(
      [&](auto& built) {
        if constexpr (!std::is_same_v<decltype(built), std::monostate&>) built.update(grid_, changed);
      },
      accelerator_->of);
  if (extent_ == Extent::bounds) box_ = grid_.bounds();
}

std::size_t VoxelModel::bytes() const {
  const std::size_t heap = std::visit(
      [](const auto& built) {
        std::size_t bytes = 0;
        if constexpr (!std::is_same_v<decltype(built), const std::monostate&>) bytes = built.bytes() - sizeof(built);
        return bytes;
      },
      accelerator_->of);
  return sizeof(*this) + sizeof(Accelerator) - sizeof(grid_) + grid_.bytes() + palette_.size() * sizeof(VoxelColour) +
         materials_.size() * sizeof(VoxelMaterial) + heap;
}

}  // namespace scarp
