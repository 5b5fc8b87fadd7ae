// SPDX-License-Identifier: MIT
// The path of a quantised ray from voxel to voxel in shaders: voxel_walk.h with the same integers, which gives the same
// voxels. Compiles as C++ and GLSL, including GLSL ES 3.0.
//
// Instead of comparing voxels with the box, it counts how many planes of each axis are left until the ray leaves it.
//
// Distances fit in 32 bits for rays of any length: they restart after every 256 voxels (scarp_voxel_rebase()).
#ifndef SCARP_MARCH_VOXEL_WALK_GLSL_H
#define SCARP_MARCH_VOXEL_WALK_GLSL_H

#include "scarp/march/voxel/voxel_wide.glsl.h"

SCARP_GLSL_BEGIN

/// A quantised ray in a box.
struct ScarpVoxelWalk {
  ivec3 voxel;
  ivec3 left;  ///< planes to cross until it leaves the box, the last one included; 0 or less outside
  uvec3 next;  ///< distance to the next plane in 2^-20 voxel, from the last rebase; arbitrary if speed is 0
  uvec3 speed;
  /// Bits 0 to 2: axes along which it steps in the negative direction; 3 to 5: those of VoxelTies (voxel_ray.h), 0 for
  /// the order x, y, z; 6: its path is inexact; higher bits: number of rebases.
  uint back;
  int axis;  ///< crossed last; -1: none
};

const uint kScarpBackBits = 7u;
const uint kScarpInexact = 64u;
const uint kScarpTieBits = 56u;  ///< those of `back` that are bits of VoxelTies

/// Returns 1 or -1: the ray's step along an axis.
SCARP_FN int scarp_voxel_step(uint back, int axis) { return (back >> uint(axis) & 1u) != 0u ? -1 : 1; }

/// Returns whether planes across axis a are crossed before those across b at the same t; a and b differ.
SCARP_FN bool scarp_axis_before(uint back, int a, int b) { return ((back >> uint(a + b + 2) & 1u) != 0u) == (a > b); }

/// Returns the axis of the first of three planes.
SCARP_FN int scarp_first_plane(uvec3 distance, uvec3 speed, uint back) {
  bool y_first = scarp_plane_before(distance.y, speed.y, distance.x, speed.x, back >> 3 & 1u);
  uint d = y_first ? distance.y : distance.x, v = y_first ? speed.y : speed.x;
  return scarp_plane_before(distance.z, speed.z, d, v, back >> (y_first ? 5u : 4u) & 1u) ? 2 : y_first ? 1 : 0;
}

/// Crosses planes of one axis.
SCARP_FN void scarp_voxel_advance(SCARP_INOUT(ScarpVoxelWalk) walk, int axis, uint planes) {
  walk.next[axis] += planes << 20;
  walk.voxel[axis] += scarp_voxel_step(walk.back, axis) * int(planes);
  walk.left[axis] -= int(planes);
}

/// Rebases distances, if possible, to the point 2^28 units further along the longest axis, exactly speed[i] units along
/// each axis: the order of planes is unchanged. One step moves the next plane at most that far.
SCARP_FN void scarp_voxel_rebase(SCARP_INOUT(ScarpVoxelWalk) walk) {
  if (walk.next.x >= walk.speed.x && walk.next.y >= walk.speed.y && walk.next.z >= walk.speed.z) {
    walk.next -= walk.speed;
    walk.back += 1u << kScarpBackBits;
  }
}

/// Crosses the next plane. Returns false if that leaves the box.
SCARP_FN bool scarp_voxel_cross(SCARP_INOUT(ScarpVoxelWalk) walk) {
  SCARP_COUNT(cross);
  walk.axis = scarp_first_plane(walk.next, walk.speed, walk.back);
  scarp_voxel_advance(walk, walk.axis, 1u);
  scarp_voxel_rebase(walk);
  return walk.left[walk.axis] > 0;
}

/// Crosses planes until part[axis] of them have been crossed along one axis, which leaves a box around the voxel.
/// Returns false if that leaves the box of the walk; `part` may extend beyond it.
SCARP_FN bool scarp_voxel_leave(SCARP_INOUT(ScarpVoxelWalk) walk, ivec3 part) {
  SCARP_COUNT(skip);
  uvec3 out_at;
  out_at.x = walk.next.x + (uint(min(part.x, walk.left.x) - 1) << 20);
  out_at.y = walk.next.y + (uint(min(part.y, walk.left.y) - 1) << 20);
  out_at.z = walk.next.z + (uint(min(part.z, walk.left.z) - 1) << 20);
  int axis = scarp_first_plane(out_at, walk.speed, walk.back);
  uint distance = out_at[axis], speed = walk.speed[axis];
  float slowness = 1.0f / float(speed);
  for (int i = 0; i < 3; ++i) {
    uint after = i != axis && scarp_axis_before(walk.back, axis, i) ? 1u : 0u;
    uint planes = scarp_planes_until(distance, speed, slowness, walk.next[i], walk.speed[i], after);
    scarp_voxel_advance(walk, i, planes);
  }
  walk.axis = axis;
  scarp_voxel_rebase(walk);
  return walk.left[axis] > 0;
}

/// Travel along the ray's longest axis, in 2^-20 voxel, per voxel of distance: reduced by 16 units of single precision,
/// more than twice its rounding error.
SCARP_FN uint scarp_travel_per_voxel(uvec3 speed) {
  float x = float(speed.x) * 3.7252902984619140625e-9f, y = float(speed.y) * 3.7252902984619140625e-9f,
        z = float(speed.z) * 3.7252902984619140625e-9f;
  return uint((1048576.0f - 1.0f) / sqrt(x * x + y * y + z * z));
}

/// Crosses the next plane, then all planes within `voxels` further travel. Returns false if that leaves the box.
SCARP_FN bool scarp_voxel_travel(SCARP_INOUT(ScarpVoxelWalk) walk, uint voxels, uint travel_per_voxel) {
  SCARP_COUNT(cross);
  int axis = scarp_first_plane(walk.next, walk.speed, walk.back);
  uint distance = walk.next[axis], speed = walk.speed[axis];
  walk.axis = axis;
  scarp_voxel_advance(walk, axis, 1u);
  bool inside = walk.left[axis] > 0;
  if (inside && voxels > 0u) {
    SCARP_COUNT(skip);
    uint until = scarp_travelled(distance, speed, 1.0f / float(speed)) + voxels * travel_per_voxel;
    for (int i = 0; i < 3; ++i) {
      // None at speed 0.
      scarp_voxel_advance(walk, i, scarp_planes_before(until, walk.next[i], walk.speed[i]));
      inside = inside && walk.left[i] > 0;
    }
  }
  scarp_voxel_rebase(walk);
  return inside;
}

/// Distance of the last plane crossed along walk.axis, which must not be -1, from the entry into the box: two words.
SCARP_FN uvec2 scarp_voxel_distance(ScarpVoxelWalk walk) {
  uvec2 rebased = scarp_words_product(walk.back >> kScarpBackBits, walk.speed[walk.axis]);
  return scarp_words_minus(scarp_words_plus(rebased, walk.next[walk.axis]), uvec2(kScarpVoxelPlaces, 0u));
}

/// The face by which the current voxel was entered, given the face by which the box was entered.
SCARP_FN uint scarp_voxel_face(ScarpVoxelWalk walk, uint entered) {
  return walk.axis < 0 ? entered : 2u * uint(walk.axis) + (walk.back >> uint(walk.axis) & 1u);
}

SCARP_GLSL_END

#endif
