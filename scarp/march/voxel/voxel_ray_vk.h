// SPDX-License-Identifier: MIT
// Private to the station: rays and hits in the form that devices use.
#pragma once

#include <array>
#include <cmath>
#include <string_view>

#include "scarp/base/ray.h"
#include "scarp/march/usual_ray.h"
#include "scarp/march/voxel/voxel_rays.glsl.h"

namespace scarp {

/// Returns the name of a march by its number in shaders.
constexpr std::string_view voxel_march_name(std::uint32_t march) {
  constexpr std::array<std::string_view, glsl::kScarpVoxelMarches> kNames = {
      "voxel-planes", "voxel-spheres", "voxel-cubes", "voxel-octants", "voxel-bricks"};
  return kNames[march];
}

// Drivers may flush subnormal doubles to zero. The numbers of quantised rays are products of a few of these, and of
// differences that may be 2^-53 as large.
inline bool is_number_of_devices(double x) { return x == 0 || (std::abs(x) > 0x1p-200 && std::abs(x) < 0x1p200); }
// The end of a range is only compared.
inline bool is_end_of_devices(double t) { return t >= 0x1p200 || is_number_of_devices(t); }
// Directions whose lengths also fit in floats, for the hierarchy.
inline bool is_length_of_devices(double longest) { return longest > 0x1p-60 && longest < 0x1p60; }
inline bool are_numbers_of_devices(const dvec3& v) {
  return is_number_of_devices(v.x) && is_number_of_devices(v.y) && is_number_of_devices(v.z);
}

struct PreparedVoxelRay {
  glsl::ScarpVoxelRay ray{};
  int exponent = 0;  ///< its t are 2^exponent times those of the caller
  bool marches = false, left = false;
};

/// `from`: the hit beside whose voxel it starts, or null.
inline PreparedVoxelRay prepared_voxel_ray(const Ray& given, const Hit* from) {
  PreparedVoxelRay prepared;
  Ray ray = given;
  const double longest = longest_of(ray.direction);
  if (!is_direction(longest)) return prepared;
  // By a power of two, which is exact.
  if (!is_length_of_devices(longest)) {
    prepared.exponent = std::ilogb(longest);
    ray = scaled_down(ray, prepared.exponent);
  }
  prepared.marches = are_numbers_of_devices(ray.origin) && are_numbers_of_devices(ray.direction) &&
                     is_number_of_devices(ray.t_min) && is_end_of_devices(ray.t_max);
  prepared.left = !prepared.marches;
  prepared.ray = {
      ray.origin, ray.direction, ray.t_min, ray.t_max, glsl::kScarpNoPart, {}, ray.frame % (1u << VoxelTies::kBits),
      ray.room};
  if (from) {
    prepared.ray.part = from->part;
    prepared.ray.start = from->voxel + normal_of(from->face);
  }
  return prepared;
}

/// `t`: that of the caller.
inline Hit hit_of(const glsl::ScarpVoxelHit& found, double t) {
  Hit hit;
  if (found.status == glsl::kScarpVoxelHit) {
    hit.status = HitStatus::hit;
    hit.face = static_cast<VoxelFace>(found.face);
    hit.t = t;
    hit.voxel = found.voxel;
    hit.part = found.part;
  }
  return hit;
}

}  // namespace scarp
