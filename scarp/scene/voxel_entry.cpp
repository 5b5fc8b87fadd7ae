// SPDX-License-Identifier: MIT
#include "scarp/scene/voxel_entry.h"

#include <variant>

#include "scarp/scene/voxel_objects.h"

namespace scarp {
namespace {

constexpr int kColourBits = 24;  // of entries that are colours: 8 of red, green and blue

}  // namespace

std::optional<std::uint32_t> palette_entry(const Scene& scene, const Hit& hit) {
  if (!hit || hit.voxel.x < 0) return {};
  const SceneFieldParts parts = scene.field_of(hit.object).parts();
  const auto* voxels = std::get_if<SceneFieldParts::Voxels>(&parts.of);
  if (!voxels) return {};
  const VoxelGrid& grid = voxels->objects->grid(hit);
  if (grid.entry_bits() >= kColourBits) return {};
  return grid.entry(hit.voxel);
}

}  // namespace scarp
