// SPDX-License-Identifier: MIT
#include "scarp/march/voxel/voxel_ray.h"

#include <algorithm>
#include <cmath>

namespace scarp {
namespace {

VoxelFace face_of(int axis, int step) { return static_cast<VoxelFace>(2 * axis + (step < 0 ? 1 : 0)); }

// The voxel of a position along one axis. Positions are not negative, so conversion rounds down.
int voxel_at(double place, int step) {
  const int voxel = static_cast<int>(place);
  return step < 0 && voxel == place ? voxel - 1 : voxel;
}

}  // namespace

ivec3 normal_of(VoxelFace face) {
  ivec3 normal(0);
  if (face == VoxelFace::inside) return normal;
  const int index = static_cast<int>(face);
  normal[index / 2] = index % 2 == 0 ? -1 : 1;
  return normal;
}

VoxelDirection::VoxelDirection(const dvec3& direction) : given(direction), inverse(1.0 / direction) {
  // Divisions dominate the cost here: that by the longest component has been done.
  const double per_longest = std::min({std::abs(inverse.x), std::abs(inverse.y), std::abs(inverse.z)});
  auto& [speed, slowness, step, t_per_s] = quantised;
  for (int axis = 0; axis < 3; ++axis) {
    // For a direction that is too short it is not finite.
    const double share = std::abs(direction[axis]) * per_longest;
    speed[axis] = share <= 1 ? static_cast<std::int64_t>(share * (1 << kDirectionBits) + 0.5) : 0;
    slowness[axis] = 1 / static_cast<double>(speed[axis]);
    step[axis] = direction[axis] < 0 ? -1 : 1;
  }
  t_per_s = static_cast<double>(1 << (kDirectionBits - kPlaceBits)) * per_longest;
}

std::optional<QuantisedRay> quantise(const VoxelRay& ray, const VoxelDirection& ray_direction, const VoxelBox& box) {
  const QuantisedDirection& direction = ray_direction.quantised;
  if (!std::isfinite(direction.t_per_s)) return {};
  // Clip to the box. Among planes crossed at the same s the last one, z, is the entry face.
  double t = ray.t_min, t_out = ray.t_max;
  int entered = -1;
  for (int axis = 0; axis < 3; ++axis) {
    const double origin = ray.origin[axis];
    const int low = box.low[axis], high = box.high[axis], step = direction.step[axis];
    if (ray_direction.given[axis] == 0) {
      if (!(origin >= low && origin < high)) return {};
      continue;
    }
    const double t_near = ((step > 0 ? low : high) - origin) * ray_direction.inverse[axis];
    const double t_far = ((step > 0 ? high : low) - origin) * ray_direction.inverse[axis];
    bool outside = false;
    if (ray.start_voxel) {
      const int start = (*ray.start_voxel)[axis];
      if (step > 0 ? start >= high : start < low) return {};
      outside = step > 0 ? start < low : start >= high;
    }
    if (outside || t_near >= t) {
      t = std::max(t, t_near);
      entered = axis;
    }
    t_out = std::min(t_out, t_far);
  }
  if (!(t <= t_out)) return {};

  std::optional<QuantisedRay> result(QuantisedRay{direction, {}, {}, VoxelFace::inside, t, ray.t_max});
  const bool starts_inside = ray.start_voxel && entered < 0;
  if (starts_inside && !box.contains(*ray.start_voxel)) return {};
  if (entered >= 0) result->face = face_of(entered, direction.step[entered]);
  for (int axis = 0; axis < 3; ++axis) {
    const int low = box.low[axis], high = box.high[axis], step = direction.step[axis];
    // Not beyond the box, where only rounding can take it.
    double place = ray.origin[axis] + t * ray_direction.given[axis];
    place = place > low ? place : low;
    place = place < high ? place : high;
    int& voxel = result->voxel[axis];
    if (axis == entered) {
      place = step > 0 ? low : high;
      voxel = step > 0 ? low : high - 1;
    } else if (starts_inside) {
      voxel = (*ray.start_voxel)[axis];
    } else {
      voxel = voxel_at(place, step);
      // On the border and leaving.
      if (voxel < low || voxel >= high) return {};
    }
    const double distance = step > 0 ? voxel + 1 - place : place - voxel;
    result->to_plane[axis] =
        direction.speed[axis] == 0
            ? QuantisedRay::kNever
            : std::clamp<std::int64_t>(static_cast<std::int64_t>(distance * kVoxelPlaces + 0.5), 0, kVoxelPlaces);
  }
  return result;
}

std::optional<QuantisedRay> quantise(const VoxelRay& ray, const VoxelBox& box) {
  if (box.empty()) return {};
  return quantise(ray, VoxelDirection(ray.direction), box);
}

}  // namespace scarp
