// SPDX-License-Identifier: MIT
#include "scarp/scene/voxelised.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/field/ground_voxels.h"

namespace scarp {
namespace {

constexpr double kFarthest = 1 << 24;  // voxels

}  // namespace

VoxelLattice lattice_around(const Scene& scene, double side, const std::optional<WorldBox>& within, int most) {
  if (!(side > 0 && std::isfinite(side)))
    throw Error(fmt::format("voxels: their side is {} m (must be above 0)", side));
  if (!within && scene.endless()) throw Error("voxels: the scene is endless (set a box to make voxels in)");
  WorldBox box = scene.box();
  if (within) {
    box = *within;
    if (!scene.endless()) {
      box.low = glm::max(box.low, scene.box().low);
      box.high = glm::min(box.high, scene.box().high);
    }
  }
  if (!(box.low.x < box.high.x && box.low.y < box.high.y && box.low.z <= box.high.z))
    throw Error("voxels: nothing in the box to make voxels of");
  VoxelLattice lattice{side, {}};
  for (int axis = 0; axis < 3; ++axis) {
    const double low = std::floor(box.low[axis] / side), high = std::max(low + 1, std::ceil(box.high[axis] / side));
    if (high - low > most) {
      throw Error(fmt::format("voxels of {} m: {} along {} (limited to {}; choose larger voxels)", side, high - low,
                              "xyz"[axis], most));
    }
    if (!(std::abs(low) <= kFarthest && std::abs(high) <= kFarthest))
      throw Error(fmt::format("voxels of {} m: {} of them from the origin (limited to 2^24)", side,
                              std::max(std::abs(low), std::abs(high))));
    lattice.box.low[axis] = static_cast<int>(low);
    lattice.box.high[axis] = static_cast<int>(high);
  }
  return lattice;
}

VoxelGrid voxelised(const Scene& scene, const VoxelLattice& lattice,
                    const std::function<std::uint32_t(const SceneSurface&)>& entry, const Progress& progress) {
  const ivec3 size = lattice.box.high - lattice.box.low;
  VoxelGrid grid(size, VoxelGrid::kMaxEntryBits);
  // One layer of bricks at a time: all threads test points, one thread fills the grid.
  const auto columns = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
  std::vector<std::optional<SceneSurface>> found(columns * VoxelGrid::kBrick);
  const auto place = [&](int x, int y, int z) {
    return static_cast<std::size_t>(x) +
           static_cast<std::size_t>(size.x) *
               (static_cast<std::size_t>(y) + static_cast<std::size_t>(size.y) * static_cast<std::size_t>(z));
  };
  for (int z0 = 0; z0 < size.z; z0 += VoxelGrid::kBrick) {
    if (progress && !progress(static_cast<double>(z0) / size.z)) throw Interrupted();
    const int layers = std::min(VoxelGrid::kBrick, size.z - z0);
    parallel_for(size.y, 4, [&](std::int64_t begin, std::int64_t end) {
      for (int z = 0; z < layers; ++z) {
        for (auto y = static_cast<int>(begin); y < end; ++y) {
          for (int x = 0; x < size.x; ++x) {
            const dvec3 middle = lattice.side * (dvec3(lattice.box.low + ivec3(x, y, z0 + z)) + 0.5);
            found[place(x, y, z)] = scene.within(middle);
          }
        }
      }
    });
    grid.edit({{0, 0, z0}, {size.x, size.y, z0 + layers}}, [&](const ivec3& v, const VoxelGrid::Voxel&) {
      const auto& surface = found[place(v.x, v.y, v.z - z0)];
      return surface ? VoxelGrid::Voxel(entry(*surface)) : VoxelGrid::Voxel();
    });
  }
  if (progress) progress(1);
  return grid;
}

VoxelGrid voxelised_ground(const HeightField& heights, const VoxelLattice& lattice, const Progress& progress) {
  constexpr int kRows = 256;
  const ivec3 size = lattice.box.high - lattice.box.low;
  std::vector<std::int32_t> tops(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
  const auto middle = [&](int x, int y, int z) {
    return lattice.side * (dvec3(lattice.box.low + ivec3(x, y, z)) + 0.5);
  };
  // Centres at or below the ground, by the same comparison as voxelised().
  const auto top = [&](int x, int y) {
    const dvec3 lowest = middle(x, y, 0);
    const auto height = heights.height(lowest.x, lowest.y);
    if (!height) return 0;
    int z = static_cast<int>(std::clamp((*height - lowest.z) / lattice.side, 0.0, static_cast<double>(size.z)));
    while (z < size.z && middle(x, y, z).z <= *height) ++z;
    while (z > 0 && middle(x, y, z - 1).z > *height) --z;
    return z;
  };
  for (int from = 0; from < size.y; from += kRows) {
    if (progress && !progress(static_cast<double>(from) / size.y)) throw Interrupted();
    parallel_for(std::min(kRows, size.y - from), 4, [&](std::int64_t begin, std::int64_t end) {
      for (int y = from + static_cast<int>(begin); y < from + end; ++y) {
        for (int x = 0; x < size.x; ++x)
          tops[static_cast<std::size_t>(x) + static_cast<std::size_t>(size.x) * static_cast<std::size_t>(y)] =
              top(x, y);
      }
    });
  }
  VoxelGrid grid = ground_voxels(size, tops, 1, [](const ivec3&) { return 0; });
  if (progress) progress(1);
  return grid;
}

}  // namespace scarp
