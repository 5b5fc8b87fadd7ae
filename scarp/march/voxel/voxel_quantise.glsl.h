// SPDX-License-Identifier: MIT
// Quantises a ray where it enters a box of voxels: voxel_ray.cpp in shaders, with the same operations in the same
// order, one axis at a time. Compiles as C++ and GLSL. `scarp_real` is double, as on the CPU (voxel_double.glsl.h), or
// float where a shader has no float64 (voxel_float_ray.glsl.h); these files include this one.
//
// Hosts keep a ray's numbers of each axis in memory and call these functions for x, y and z in turn: doubles take two
// registers each, and a shader has few.
//
//   direction of the grid   scarp_exact_inverse(), the least magnitude of all three, scarp_voxel_speed()
//   each object's box       scarp_voxel_rounded() of exact directions and scarp_voxel_clip(), then scarp_voxel_place()
//
// Numbers whose products would be subnormal are excluded: drivers may flush them to zero.
#ifndef SCARP_MARCH_VOXEL_QUANTISE_GLSL_H
#define SCARP_MARCH_VOXEL_QUANTISE_GLSL_H

#include "scarp/march/voxel/voxel_walk.glsl.h"

SCARP_GLSL_BEGIN

SCARP_FN scarp_real scarp_magnitude(scarp_real x) { return x < scarp_real(0.0f) ? -x : x; }

const uint kScarpVoxelSlow = 16384u;  ///< kSlow of voxel_ray.h
const uint kScarpVoxelTouch = 10u;    ///< kTouch

/// A component of the direction in 2^-28 of the longest one, given the least magnitude of inverse components.
SCARP_FN uint scarp_voxel_speed(scarp_real given, scarp_real per_longest) {
  SCARP_PRECISE scarp_real share = scarp_magnitude(given) * per_longest;
  SCARP_PRECISE scarp_real units = share * scarp_real(268435456.0f);
  SCARP_PRECISE scarp_real nearest = units + scarp_real(0.5f);
  return share <= scarp_real(1.0f) ? uint(units < scarp_real(16384.0f) ? units : nearest) : 0u;
}
/// kScarpInexact if no path in this direction is exact (kExactStart of voxel_ray.h), given one component, else 0.
SCARP_FN uint scarp_voxel_inexact(scarp_real given, scarp_real per_longest, uint speed) {
  SCARP_PRECISE scarp_real share = scarp_magnitude(given) * per_longest;
  SCARP_PRECISE scarp_real units = share * scarp_real(268435456.0f);
  bool power = units == scarp_real(speed) && (speed & (speed - 1u)) == 0u && speed >= kScarpVoxelSlow;
  return power || given == scarp_real(0.0f) ? 0u : kScarpInexact;
}
/// kScarpInexact if the path is not exact from this coordinate of the ray's origin, else 0.
SCARP_FN uint scarp_voxel_rounded(scarp_real origin, scarp_real given, scarp_real t_min) {
  SCARP_PRECISE scarp_real way = t_min * given;
  SCARP_PRECISE scarp_real place = origin + way;
  SCARP_PRECISE scarp_real parts = place * scarp_real(4.0f);
  bool whole = floor(parts) == parts && scarp_magnitude(parts) < scarp_real(4503599627370496.0f);
  return whole || given == scarp_real(0.0f) ? 0u : kScarpInexact;
}
/// Bits of ScarpVoxelWalk::back for an axis: how the ray steps along it, given the bits of VoxelTies.
SCARP_FN uint scarp_voxel_back(int axis, scarp_real given, uint ties) {
  uint bit = 1u << uint(axis);
  return given == scarp_real(0.0f) ? ties & bit : given < scarp_real(0.0f) ? bit : 0u;
}
/// t per unit of distance / speed.
SCARP_FN scarp_real scarp_voxel_t_per_s(scarp_real per_longest) { return scarp_real(256.0f) * per_longest; }

/// A ray that is clipped to a box, from t to t_out; initialise with its range, entered = -1 and comes_in = false.
struct ScarpVoxelClip {
  scarp_real t;
  scarp_real t_out;
  int entered;    ///< the axis along which it enters; -1: it starts inside
  bool comes_in;  ///< whether it enters after its start
};

/// The origin of a level ray: on the adjacent plane; `room` as VoxelRay::room, twice as far at the side of the box that
/// takes rays along it.
SCARP_FN scarp_real scarp_voxel_level(int axis, scarp_real origin, scarp_real room, uint back, int low, int high) {
  SCARP_PRECISE scarp_real moved = origin + scarp_real(0.5f);
  scarp_real plane = floor(moved);
  SCARP_PRECISE scarp_real away = origin - plane;
  scarp_real border = scarp_real((back >> uint(axis) & 1u) == 0u ? low : high);
  SCARP_PRECISE scarp_real near = plane == border ? room + room : room;
  return scarp_magnitude(away) <= near ? plane : origin;
}

/// Returns false if the ray misses the box. `room`: VoxelRay::room. `back` is that of the walk; `start` is the position
/// of the start voxel, if `has_start`.
SCARP_FN bool scarp_voxel_clip(int axis, scarp_real origin, scarp_real given, scarp_real inverse, scarp_real room,
                               uint speed, uint back, int low, int high, bool has_start, int start,
                               SCARP_INOUT(ScarpVoxelClip) clip) {
  bool up = (back >> uint(axis) & 1u) == 0u;
  scarp_real from = scarp_real(up ? low : high), to = scarp_real(up ? high : low);
  bool met = true;
  if (given == scarp_real(0.0f)) {
    met = up ? origin >= from && origin < to : origin > to && origin <= from;
  } else {
    scarp_real early = speed < kScarpVoxelSlow ? room : scarp_real(0.0f);
    scarp_real late = room > scarp_real(9.5367431640625e-6f) ? room : scarp_real(9.5367431640625e-6f);
    SCARP_PRECISE scarp_real first = up ? from - early : from + early;
    SCARP_PRECISE scarp_real last = up ? to + late : to - late;
    SCARP_PRECISE scarp_real before = first - origin;
    SCARP_PRECISE scarp_real t_near = before * inverse;
    SCARP_PRECISE scarp_real behind = last - origin;
    SCARP_PRECISE scarp_real t_far = behind * inverse;
    bool outside = has_start && (up ? start < low : start >= high);
    met = !has_start || (up ? start < high : start >= low);
    if (outside || t_near >= clip.t) {
      bool later = clip.t < t_near;
      if (later || clip.entered < 0 || scarp_axis_before(back, clip.entered, axis)) clip.entered = axis;
      clip.t = later ? t_near : clip.t;
      clip.comes_in = clip.comes_in || later;
    }
    clip.t_out = t_far < clip.t_out ? t_far : clip.t_out;
  }
  return met;
}

/// The face through which the ray enters.
SCARP_FN uint scarp_voxel_entered(ScarpVoxelClip clip, uint back) {
  return clip.entered < 0 ? 6u : 2u * uint(clip.entered) + (back >> uint(clip.entered) & 1u);
}

/// Start of a walk along one axis.
struct ScarpVoxelPlace {
  int voxel;
  int left;
  uint next;
  uint speed;
};

/// Returns false if the ray only touches the box from outside. `back` has kScarpInexact unless the path is exact: from
/// scarp_voxel_inexact() and scarp_voxel_rounded() of all axes.
SCARP_FN bool scarp_voxel_place(int axis, scarp_real origin, scarp_real given, uint speed, uint back, int low, int high,
                                bool has_start, int start, ScarpVoxelClip clip, SCARP_OUT(ScarpVoxelPlace) at) {
  bool up = (back >> uint(axis) & 1u) == 0u;
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
  SCARP_PRECISE scarp_real units = distance * scarp_real(1048576.0f);
  SCARP_PRECISE scarp_real nearest = units + scarp_real(0.5f);
  units = speed < kScarpVoxelSlow ? ceil(units) : nearest;
  // A start voxel may be far from the position.
  units = units > scarp_real(0.0f) ? units : scarp_real(0.0f);
  units = units < scarp_real(1048576.0f) ? units : scarp_real(1048576.0f);
  at.next = uint(units);
  // Planes behind that are not crossed yet.
  bool on_plane = distance == scarp_real(1.0f) && (back & kScarpInexact) == 0u;
  at.speed = speed;
  if (clip.comes_in && at.next >= kScarpVoxelPlaces - kScarpVoxelTouch && given != scarp_real(0.0f) &&
      axis != clip.entered && (!on_plane || scarp_axis_before(back, clip.entered, axis)) &&
      at.voxel != (up ? low : high - 1)) {
    at.voxel -= up ? 1 : -1;
    at.next = 0u;
    // The ray crosses this plane at once, and never another one.
    at.speed = speed > 0u ? speed : 1u;
  }
  // A plane by which the ray leaves the box at once is crossed after others at the same position.
  if (at.next == 0u && clip.comes_in && speed >= kScarpVoxelSlow && at.voxel == (up ? high - 1 : low) &&
      (back & kScarpInexact) != 0u)
    at.next = 1u;
  if (at.speed == 0u) at.next = kScarpNoPlane;
  at.left = up ? high - at.voxel : at.voxel - low + 1;
  return at.voxel >= low && at.voxel < high;
}

SCARP_GLSL_END

#endif
