// SPDX-License-Identifier: MIT
// Quantises a ray where it enters a box of voxels: voxel_ray.cpp in shaders, in double, with the same operations in the
// same order. Text of C++ and of GLSL with float64.
//
// Numbers whose products would be too small for normal doubles do not come here: drivers may take them for zero.
#ifndef SCARP_MARCH_VOXEL_QUANTISE_GLSL_H
#define SCARP_MARCH_VOXEL_QUANTISE_GLSL_H

#include "scarp/march/voxel/voxel_walk.glsl.h"

#ifdef __cplusplus
#include "scarp/base/vec.h"
#endif

SCARP_GLSL_BEGIN

/// VoxelDirection.
struct ScarpVoxelDirection {
  dvec3 given;
  dvec3 inverse;
  uvec3 speed;
  uint back;
  double t_per_s;
  double t;  ///< room for the time where the ray comes into a box
};

SCARP_FN double scarp_magnitude(double x) { return x < double(0.0f) ? -x : x; }

SCARP_FN ScarpVoxelDirection scarp_voxel_direction(dvec3 given) {
  ScarpVoxelDirection d;
  d.given = given;
  d.back = 0u;
  for (int axis = 0; axis < 3; ++axis) {
    d.inverse[axis] = scarp_exact_inverse(given[axis]);
    if (given[axis] < double(0.0f)) d.back |= 1u << uint(axis);
  }
  double x = scarp_magnitude(d.inverse.x), y = scarp_magnitude(d.inverse.y), z = scarp_magnitude(d.inverse.z);
  double per_longest = y < x ? y : x;
  per_longest = z < per_longest ? z : per_longest;
  for (int axis = 0; axis < 3; ++axis) {
    SCARP_PRECISE double share = scarp_magnitude(given[axis]) * per_longest;
    SCARP_PRECISE double units = share * double(268435456.0f) + double(0.5f);
    d.speed[axis] = share <= double(1.0f) ? uint(units) : 0u;
  }
  d.t_per_s = double(256.0f) * per_longest;
  d.t = double(0.0f);
  return d;
}

/// Returns false if the ray misses the box within its range. `start` is the voxel where it starts, if `has_start`.
SCARP_FN bool scarp_voxel_quantise(dvec3 origin, double t_min, double t_max, ScarpVoxelDirection d, ivec3 low,
                                   ivec3 high, bool has_start, ivec3 start, SCARP_OUT(ScarpVoxelWalk) walk) {
  double t = t_min, t_out = t_max;
  int entered = -1;
  walk.axis = -1;
  for (int axis = 0; axis < 3; ++axis) {
    bool up = (d.back >> uint(axis) & 1u) == 0u;
    double from = double(up ? low[axis] : high[axis]), to = double(up ? high[axis] : low[axis]);
    if (d.given[axis] == double(0.0f)) {
      if (!(origin[axis] >= from && origin[axis] < to)) return false;
      continue;
    }
    SCARP_PRECISE double before = from - origin[axis];
    SCARP_PRECISE double t_near = before * d.inverse[axis];
    SCARP_PRECISE double behind = to - origin[axis];
    SCARP_PRECISE double t_far = behind * d.inverse[axis];
    bool outside = false;
    if (has_start) {
      if (up ? start[axis] >= high[axis] : start[axis] < low[axis]) return false;
      outside = up ? start[axis] < low[axis] : start[axis] >= high[axis];
    }
    if (outside || t_near >= t) {
      t = t < t_near ? t_near : t;
      entered = axis;
    }
    t_out = t_far < t_out ? t_far : t_out;
  }
  if (!(t <= t_out)) return false;

  bool starts_inside = has_start && entered < 0;
  walk.entered = entered < 0 ? 6u : 2u * uint(entered) + (d.back >> uint(entered) & 1u);
  for (int axis = 0; axis < 3; ++axis) {
    bool up = (d.back >> uint(axis) & 1u) == 0u;
    double bottom = double(low[axis]), top = double(high[axis]);
    SCARP_PRECISE double way = t * d.given[axis];
    SCARP_PRECISE double place = origin[axis] + way;
    place = place > bottom ? place : bottom;
    place = place < top ? place : top;
    int voxel;
    if (axis == entered) {
      place = up ? bottom : top;
      voxel = up ? low[axis] : high[axis] - 1;
    } else if (starts_inside) {
      voxel = start[axis];
    } else {
      voxel = int(place);
      if (!up && double(voxel) == place) voxel -= 1;
    }
    if (voxel < low[axis] || voxel >= high[axis]) return false;
    SCARP_PRECISE double distance = up ? double(voxel + 1) - place : place - double(voxel);
    SCARP_PRECISE double units = distance * double(1048576.0f) + double(0.5f);
    // A start voxel may be far from the place.
    units = units > double(0.0f) ? units : double(0.0f);
    units = units < double(1048576.0f) ? units : double(1048576.0f);
    walk.next[axis] = d.speed[axis] == 0u ? kScarpNever : uint(units);
    walk.voxel[axis] = voxel;
    walk.left[axis] = up ? high[axis] - voxel : voxel - low[axis] + 1;
  }
  walk.speed = d.speed;
  walk.back = d.back;
  walk.t = t;
  walk.t_per_s = d.t_per_s;
  return true;
}

SCARP_GLSL_END

#endif
