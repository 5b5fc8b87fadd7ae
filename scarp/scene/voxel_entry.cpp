// SPDX-License-Identifier: MIT
#include "scarp/scene/voxel_entry.h"

#include <variant>

#include "scarp/scene/voxel/voxel_objects.h"

namespace scarp {
namespace {

constexpr int kColourBits = 24;  // bits of entries that are colours: 8 each of red, green and blue

// Null for hits of other fields.
const VoxelObjects* objects_of(const Scene& scene, const Hit& hit) {
  if (!hit || hit.voxel.x < 0) return nullptr;
  const SceneFieldParts parts = scene.field_of(hit.object).parts();
  const auto* voxels = std::get_if<SceneFieldParts::Voxels>(&parts.of);
  return voxels ? voxels->objects : nullptr;
}

}  // namespace

std::optional<std::uint32_t> palette_entry(const Scene& scene, const Hit& hit) {
  const VoxelObjects* objects = objects_of(scene, hit);
  if (!objects) return {};
  const VoxelGrid& grid = objects->grid(hit);
  if (grid.entry_bits() >= kColourBits) return {};
  return grid.entry(hit.voxel);
}

std::optional<ivec3> file_voxel(const Scene& scene, const Hit& hit) {
  const VoxelObjects* objects = objects_of(scene, hit);
  return objects ? std::optional(objects->file_voxel(hit)) : std::nullopt;
}

}  // namespace scarp
