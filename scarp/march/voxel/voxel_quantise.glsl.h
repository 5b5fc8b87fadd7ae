// SPDX-License-Identifier: MIT
// Quantises a ray where it enters a box of voxels: voxel_ray.cpp in shaders, with the same operations in the same
// order, one axis at a time. Text of C++ and of GLSL. `scarp_real` is double, as on the CPU (voxel_double.glsl.h), or
// float where a shader has no float64 (voxel_float_ray.glsl.h); these include this text.
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

SCARP_FN scarp_real scarp_magnitude(scarp_real x) { return x < scarp_real(0.0f) ? -x : x; }

/// A component of the direction in 2^-28 of the longest one, given the least magnitude of inverse components.
SCARP_FN uint scarp_voxel_speed(scarp_real given, scarp_real per_longest) {
  SCARP_PRECISE scarp_real share = scarp_magnitude(given) * per_longest;
  SCARP_PRECISE scarp_real units = share * scarp_real(268435456.0f) + scarp_real(0.5f);
  return share <= scarp_real(1.0f) ? uint(units) : 0u;
}
/// t per unit of distance / speed.
SCARP_FN scarp_real scarp_voxel_t_per_s(scarp_real per_longest) { return scarp_real(256.0f) * per_longest; }

/// A ray that is clipped to a box, from t to t_out; begin with its range and entered = -1.
struct ScarpVoxelClip {
  scarp_real t;
  scarp_real t_out;
  int entered;  ///< the axis along which it comes in; -1: it starts inside
};

/// Returns false if the ray misses the box. `start` is the place of the voxel where it starts, if `has_start`.
SCARP_FN bool scarp_voxel_clip(int axis, scarp_real origin, scarp_real given, scarp_real inverse, int low, int high,
                               bool has_start, int start, SCARP_INOUT(ScarpVoxelClip) clip) {
  bool up = !(given < scarp_real(0.0f));
  scarp_real from = scarp_real(up ? low : high), to = scarp_real(up ? high : low);
  bool met = true;
  if (given == scarp_real(0.0f)) {
    met = origin >= from && origin < to;
  } else {
    SCARP_PRECISE scarp_real before = from - origin;
    SCARP_PRECISE scarp_real t_near = before * inverse;
    SCARP_PRECISE scarp_real behind = to - origin;
    SCARP_PRECISE scarp_real t_far = behind * inverse;
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
SCARP_FN bool scarp_voxel_place(int axis, scarp_real origin, scarp_real given, uint speed, int low, int high,
                                bool has_start, int start, ScarpVoxelClip clip, SCARP_OUT(ScarpVoxelPlace) at) {
  bool up = !(given < scarp_real(0.0f));
  scarp_real bottom = scarp_real(low), top = scarp_real(high);
  SCARP_PRECISE scarp_real way = clip.t * given;
  SCARP_PRECISE scarp_real place = origin + way;
  place = place > bottom ? place : bottom;
  place = place < top ? place : top;
  if (axis == clip.entered) {
    place = up ? bottom : top;
    at.voxel = up ? low : high - 1;
  } else if (has_start && clip.entered < 0) {
    at.voxel = start;
  } else {
    at.voxel = int(place);
    if (!up && scarp_real(at.voxel) == place) at.voxel -= 1;
  }
  SCARP_PRECISE scarp_real distance =
      up ? (scarp_real(at.voxel) + scarp_real(1.0f)) - place : place - scarp_real(at.voxel);
  SCARP_PRECISE scarp_real units = distance * scarp_real(1048576.0f) + scarp_real(0.5f);
  // A start voxel may be far from the place.
  units = units > scarp_real(0.0f) ? units : scarp_real(0.0f);
  units = units < scarp_real(1048576.0f) ? units : scarp_real(1048576.0f);
  at.next = speed == 0u ? kScarpNoPlane : uint(units);
  at.left = up ? high - at.voxel : at.voxel - low + 1;
  return at.voxel >= low && at.voxel < high;
}

SCARP_GLSL_END

#endif
