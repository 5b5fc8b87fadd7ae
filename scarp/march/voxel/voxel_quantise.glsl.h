// SPDX-License-Identifier: MIT
// Quantises a ray where it enters a box of voxels: voxel_ray.cpp in shaders, in double, with the same operations in the
// same order, one axis at a time. Text of C++ and of GLSL with float64.
//
// Hosts keep what a ray has for each axis in memory and call these functions for the axes x, y, z in turn: doubles take
// two registers each, and a shader has few.
//
//   direction of the grid   scarp_exact_inverse(), the least magnitude of all three, scarp_voxel_speed()
//   each object's box       scarp_voxel_clip(), then scarp_voxel_place()
//
// Numbers whose products would be too small for normal doubles do not come here: drivers may take them for zero.
#ifndef SCARP_MARCH_VOXEL_QUANTISE_GLSL_H
#define SCARP_MARCH_VOXEL_QUANTISE_GLSL_H

#include "scarp/march/voxel/voxel_walk.glsl.h"

SCARP_GLSL_BEGIN

SCARP_FN double scarp_magnitude(double x) { return x < double(0.0f) ? -x : x; }

/// A component of grid_from_world * v, given its row.
SCARP_FN double scarp_turned(dvec3 row, dvec3 v) {
  SCARP_PRECISE double x = row.x * v.x;
  SCARP_PRECISE double y = row.y * v.y;
  SCARP_PRECISE double xy = x + y;
  SCARP_PRECISE double z = row.z * v.z;
  SCARP_PRECISE double sum = xy + z;
  return sum;
}

/// A component of the direction in 2^-28 of the longest one, given the least magnitude of inverse components.
SCARP_FN uint scarp_voxel_speed(double given, double per_longest) {
  SCARP_PRECISE double share = scarp_magnitude(given) * per_longest;
  SCARP_PRECISE double units = share * double(268435456.0f) + double(0.5f);
  return share <= double(1.0f) ? uint(units) : 0u;
}
/// t per unit of distance / speed.
SCARP_FN double scarp_voxel_t_per_s(double per_longest) { return double(256.0f) * per_longest; }

/// A ray that is clipped to a box, from t to t_out; begin with its range and entered = -1.
struct ScarpVoxelClip {
  double t;
  double t_out;
  int entered;  ///< the axis along which it comes in; -1: it starts inside
};

/// Returns false if the ray misses the box. `start` is the place of the voxel where it starts, if `has_start`.
SCARP_FN bool scarp_voxel_clip(int axis, double origin, double given, double inverse, int low, int high, bool has_start,
                               int start, SCARP_INOUT(ScarpVoxelClip) clip) {
  bool up = !(given < double(0.0f));
  double from = double(up ? low : high), to = double(up ? high : low);
  bool met = true;
  if (given == double(0.0f)) {
    met = origin >= from && origin < to;
  } else {
    SCARP_PRECISE double before = from - origin;
    SCARP_PRECISE double t_near = before * inverse;
    SCARP_PRECISE double behind = to - origin;
    SCARP_PRECISE double t_far = behind * inverse;
    bool outside = has_start && (up ? start < low : start >= high);
    met = !has_start || (up ? start < high : start >= low);
    if (outside || t_near >= clip.t) {
      clip.t = clip.t < t_near ? t_near : clip.t;
      clip.entered = axis;
    }
    clip.t_out = t_far < clip.t_out ? t_far : clip.t_out;
  }
  return met;
}

/// The face by which it comes in.
SCARP_FN uint scarp_voxel_entered(ScarpVoxelClip clip, uint back) {
  return clip.entered < 0 ? 6u : 2u * uint(clip.entered) + (back >> uint(clip.entered) & 1u);
}

/// Where a walk begins, along one axis.
struct ScarpVoxelPlace {
  int voxel;
  int left;
  uint next;
};

/// Returns false if the ray only touches the box from outside.
SCARP_FN bool scarp_voxel_place(int axis, double origin, double given, uint speed, int low, int high, bool has_start,
                                int start, ScarpVoxelClip clip, SCARP_OUT(ScarpVoxelPlace) at) {
  bool up = !(given < double(0.0f));
  double bottom = double(low), top = double(high);
  SCARP_PRECISE double way = clip.t * given;
  SCARP_PRECISE double place = origin + way;
  place = place > bottom ? place : bottom;
  place = place < top ? place : top;
  if (axis == clip.entered) {
    place = up ? bottom : top;
    at.voxel = up ? low : high - 1;
  } else if (has_start && clip.entered < 0) {
    at.voxel = start;
  } else {
    at.voxel = int(place);
    if (!up && double(at.voxel) == place) at.voxel -= 1;
  }
  SCARP_PRECISE double distance = up ? (double(at.voxel) + double(1.0f)) - place : place - double(at.voxel);
  SCARP_PRECISE double units = distance * double(1048576.0f) + double(0.5f);
  // A start voxel may be far from the place.
  units = units > double(0.0f) ? units : double(0.0f);
  units = units < double(1048576.0f) ? units : double(1048576.0f);
  at.next = speed == 0u ? kScarpNever : uint(units);
  at.left = up ? high - at.voxel : at.voxel - low + 1;
  return at.voxel >= low && at.voxel < high;
}

SCARP_GLSL_END

#endif
