// SPDX-License-Identifier: MIT
#include "bench/voxel_sets.h"

#include <cmath>
#include <glm/vec3.hpp>
#include <numbers>

namespace scarp::bench {
namespace {

constexpr double kVoxel = 0.25, kSpacing = kObjectSide * kVoxel;
constexpr int kAcross = 32;
constexpr int kWidth = 1920, kHeight = 1080, kTile = 8;

// The pixels of a tile, row by row.
template <class Body>
void for_each_pixel(int left, int top, const Body& body) {
  for (int row = top; row < top + kTile; ++row) {
    for (int col = left; col < left + kTile; ++col) body(col, row);
  }
}

bool solid(std::string_view set, const ivec3& v) {
  if (set == "degenerate") return v == ivec3(kObjectSide - 1);
  if (set == "far-wall") return v.z == kObjectSide - 1;
  const dvec3 from_middle = dvec3(v) + 0.5 - 0.5 * kObjectSide;
  return set == "standard" && dot(from_middle, from_middle) - 0.1 <= 15.5 * 15.5;
}

}  // namespace

VoxelGrid voxel_object(std::string_view set) {
  VoxelGrid grid(ivec3(kObjectSide), 24);
  grid.edit(grid.box(), [&](const ivec3& v, const VoxelGrid::Voxel&) {
    if (!solid(set, v)) return VoxelGrid::Voxel();
    const auto channel = [](int i) { return static_cast<std::uint32_t>(255 * i / (kObjectSide - 1)); };
    return VoxelGrid::Voxel(channel(v.x) | channel(v.y) << 8 | channel(v.z) << 16);
  });
  return grid;
}

std::vector<VoxelPlace> object_places(int n) {
  std::vector<VoxelPlace> places;
  for (int z = 0; z < kAcross; ++z) {
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < kAcross; ++x)
        places.push_back({0, glm::dmat3(kVoxel), kSpacing * dvec3(x, y, z) - dvec3(0, n * kSpacing / 2, 0)});
    }
  }
  return places;
}

std::vector<Ray> camera_rays(int stride) {
  const dvec3 forward = normalize(dvec3(1, 0, 1)), up(0, 1, 0), right = cross(forward, up);
  const double half_height = std::tan(std::numbers::pi / 8), half_width = half_height * kWidth / kHeight;
  std::vector<Ray> rays;
  for (int top = kTile * (stride / 2); top < kHeight; top += kTile * stride) {
    for (int left = kTile * (stride / 2); left < kWidth; left += kTile * stride) {
      for_each_pixel(left, top, [&](int col, int row) {
        Ray ray;
        ray.origin = {-16, 0, -16};
        const double x = (2 * (col + 0.5) / kWidth - 1) * half_width, y = (1 - 2 * (row + 0.5) / kHeight) * half_height;
        ray.direction = normalize(forward + x * right + y * up);
        rays.push_back(ray);
      });
    }
  }
  return rays;
}

std::vector<Ray> octant_rays(const dvec3& size, int width) {
  std::vector<Ray> rays;
  for (int octant = 0; octant < 8; ++octant) {
    // Not along the diagonals, where planes are crossed simultaneously.
    const dvec3 forward = normalize(dvec3(octant & 1 ? -1 : 1, octant & 2 ? -0.7 : 0.7, octant & 4 ? -0.45 : 0.45));
    const dvec3 right = normalize(cross(forward, dvec3(0, 0, 1))), up = cross(right, forward);
    const double half = 0.25;
    for (int top = 0; top < width; top += kTile) {
      for (int left = 0; left < width; left += kTile) {
        for_each_pixel(left, top, [&](int col, int row) {
          Ray ray;
          ray.origin = dvec3(glm::vec3(0.5 * size - 2 * length(size) * forward));
          const double x = (2 * (col + 0.5) / width - 1) * half, y = (1 - 2 * (row + 0.5) / width) * half;
          ray.direction = dvec3(glm::vec3(normalize(forward + x * right + y * up)));
          rays.push_back(ray);
        });
      }
    }
  }
  return rays;
}

}  // namespace scarp::bench
