// SPDX-License-Identifier: MIT
#include <cmath>

#include "scarp/c/scene_handle.h"
#include "scarp/c/settings.h"
#include "scarp/c/structures.h"
#include "scarp/c/threads.h"

namespace scarp::c {
namespace {

std::uint32_t entry_from(std::int32_t index) {
  if (index < 0 || index > 255) throw Error(fmt::format("voxels: index is {} (must be 0..255)", index));
  return static_cast<std::uint32_t>(index);
}

ivec3 voxel_from(const std::int32_t v[3], const char* name) {
  required(v, name);
  return {v[0], v[1], v[2]};
}

}  // namespace
}  // namespace scarp::c

using namespace scarp::c;

scarp_status scarp_voxels_copy(const scarp_voxels* voxels, scarp_scene** scene) {
  return guarded_on_threads([&] {
    required(scene, "scene");
    const scarp_voxels given = read(voxels, "voxels");
    if (given.palette_count < 0 || given.palette_count > 256)
      throw scarp::Error(fmt::format("voxels: palette_count is {} (must be 0..256)", given.palette_count));
    const auto colours = static_cast<std::size_t>(given.palette_count);
    required(given.palette, colours, "voxels: palette");
    scarp::VoxelSettings settings{.side = or_one(given.side, "voxels: side")};
    for (std::size_t i = 0; i < colours; ++i)
      settings.palette.push_back({given.palette[3 * i], given.palette[3 * i + 1], given.palette[3 * i + 2]});
    *scene = opened(scarp::Voxels::copy(given.indices, voxel_from(given.size, "size"), std::move(settings))).release();
  });
}

scarp_status scarp_voxels_set_box(scarp_scene* scene, const int32_t low[3], const int32_t high[3], int32_t index) {
  return guarded_on_threads([&] {
    const scarp::VoxelBox box{voxel_from(low, "low"), voxel_from(high, "high")};
    const std::uint32_t entry = entry_from(index);
    only<scarp::Voxels>(scene, "voxels").edit([&](scarp::VoxelGrid& grid) {
      return entry == 0 ? grid.clear(box) : grid.fill(box, entry);
    });
  });
}

scarp_status scarp_voxels_set_sphere(scarp_scene* scene, const double centre[3], double radius, int32_t index) {
  return guarded_on_threads([&] {
    const scarp::dvec3 middle = vector_from(centre, "centre");
    if (!std::isfinite(middle.x + middle.y + middle.z + radius) || radius < 0)
      throw scarp::Error("voxels: the sphere is not finite, or its radius is negative");
    const std::uint32_t entry = entry_from(index);
    only<scarp::Voxels>(scene, "voxels").edit([&](scarp::VoxelGrid& grid) {
      return entry == 0 ? grid.clear_sphere(middle, radius) : grid.fill_sphere(middle, radius, entry);
    });
  });
}
