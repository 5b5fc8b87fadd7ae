// SPDX-License-Identifier: MIT
#include "scarp/scene/voxel/voxel_shading.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "scarp/base/error.h"

namespace scarp {
namespace {

bool solid(const VoxelGrid& grid, const ivec3& voxel) { return grid.box().contains(voxel) && grid.solid(voxel); }

}  // namespace

void validate(const VoxelShading& shading) {
  if (!(shading.normal_radius >= 1 && shading.normal_radius <= 8)) {
    throw Error(fmt::format("normals of voxels: their radius is {} (must be 1 to 8 voxels)", shading.normal_radius));
  }
}

dvec3 smooth_normal(const VoxelGrid& grid, const dvec3& point, double radius, const dvec3& face) {
  const dvec3 low = ceil(point - radius - 0.5), high = floor(point + radius - 0.5) + 1.0;
  const VoxelBox near = intersection({ivec3(low), ivec3(high)}, grid.bounds());
  dvec3 away(0.0);
  for_each_voxel(near, [&](const ivec3& voxel) {
    if (!grid.solid(voxel)) return;
    const dvec3 from = point - (dvec3(voxel) + 0.5);
    const double weight = 1 - dot(from, from) / (radius * radius);
    if (weight > 0) away += weight * from;
  });
  // The same sum as an integral over the half of the ball below a plane.
  away /= std::numbers::pi * std::pow(radius, 4) / 12;
  away += std::max(0.0, 1 - 2 * length(away)) * face;
  const double size = length(away);
  // Bound of the rounding error of the sum.
  return size > 1e-12 ? away / size : dvec3(0.0);
}

double corner_openness(const VoxelGrid& grid, const ivec3& voxel, VoxelFace face, const dvec3& point) {
  if (face == VoxelFace::inside) return 1;
  const int axis = static_cast<int>(face) / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
  const ivec3 before = voxel + normal_of(face);
  const auto at = [&](int du, int dv) {
    ivec3 neighbour = before;
    neighbour[u] += du, neighbour[v] += dv;
    return solid(grid, neighbour);
  };
  const auto corner = [&](int du, int dv) {
    const bool side_u = at(du, 0), side_v = at(0, dv);
    if (side_u && side_v) return 0.25;
    return 1 - 0.25 * (side_u + side_v + at(du, dv));
  };
  const double s = std::clamp(point[u] - voxel[u], 0.0, 1.0), t = std::clamp(point[v] - voxel[v], 0.0, 1.0);
  return glm::mix(glm::mix(corner(-1, -1), corner(1, -1), s), glm::mix(corner(-1, 1), corner(1, 1), s), t);
}

}  // namespace scarp
