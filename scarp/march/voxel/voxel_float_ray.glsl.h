// SPDX-License-Identifier: MIT
// Voxel marches for hosts without doubles: shaders that generate their own rays, such as in WebGL 2.
//
//   ScarpVoxelAnswer hit = scarp_march_voxels(kScarpVoxelOctants, ivec3(0), size, eye, direction, 0.0, 1.0e30, 4096);
//   if (hit.face != kScarpNoFace) ... hit.voxel, hit.t
//
// Coordinates are those of the grid: voxel (x, y, z) is the cube from there to (x + 1, y + 1, z + 1). The ray is
// quantised in single precision, which displaces it by at most 2^-20 (1 + |origin| + |path|) voxel along each axis; the
// march of the quantised ray is exact (voxel_walk.glsl.h).
//
// GLSL, including GLSL ES 3.0.
#ifndef SCARP_MARCH_VOXEL_FLOAT_RAY_GLSL_H
#define SCARP_MARCH_VOXEL_FLOAT_RAY_GLSL_H

#define scarp_real float
#include "scarp/march/voxel/voxel_marches.glsl.h"
#include "scarp/march/voxel/voxel_quantise.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

const uint kScarpNoFace = 7u;
const uint kScarpInside = 6u;  ///< the ray starts in the voxel

/// The answer of a march.
struct ScarpVoxelAnswer {
  uint
      face;  ///< by which the ray enters the voxel: 0 to 5 for -x, +x, -y, +y, -z, +z; kScarpInside; kScarpNoFace: miss
  ivec3 voxel;  ///< that was hit
  float t;      ///< in lengths of the direction
  int steps;    ///< of the march
};

/// Entry of a ray into a box.
struct ScarpVoxelEntry {
  float t;        ///< in lengths of the direction
  float t_per_s;  ///< t per unit of distance / speed
  uint face;      ///< of the box; kScarpInside: it starts there
};

/// Quantises a ray of finite numbers in the box [low, high). With `has_start`, `start` is the voxel in which it starts,
/// which may be outside. Returns false if the ray misses the box between t_min and t_max.
SCARP_FN bool scarp_voxel_ray(ivec3 low, ivec3 high, vec3 origin, vec3 direction, float t_min, float t_max,
                              bool has_start, ivec3 start, SCARP_OUT(ScarpVoxelWalk) walk,
                              SCARP_OUT(ScarpVoxelEntry) entry) {
  float longest = max(max(abs(direction.x), abs(direction.y)), abs(direction.z));
  // Device quotients have errors of 2.5 units; no component may appear longer than the longest one. No
  // path is exact here.
  float per_longest = (1.0f - 1.0f / 2097152.0f) / longest;
  ScarpVoxelClip clip = ScarpVoxelClip(t_min, t_max, -1, false);
  walk.back = 0u;
  bool met = longest > 0.0f;
  for (int i = 0; i < 3; ++i) {
    walk.speed[i] = scarp_voxel_speed(direction[i], per_longest);
    walk.back |= scarp_voxel_back(i, direction[i], 0u) | scarp_voxel_inexact(direction[i], per_longest, walk.speed[i]);
  }
  for (int i = 0; i < 3; ++i) {
    met = scarp_voxel_clip(i, origin[i], direction[i], 1.0f / direction[i], 0.0f, walk.speed[i], walk.back, low[i],
                           high[i], has_start, start[i], clip) &&
          met;
  }
  met = met && clip.t <= clip.t_out;
  if (met) {
    for (int i = 0; i < 3; ++i) {
      ScarpVoxelPlace at;
      met = scarp_voxel_place(i, origin[i], direction[i], walk.speed[i], walk.back, low[i], high[i], has_start,
                              start[i], clip, at) &&
            met;
      walk.speed[i] = at.speed;
      walk.voxel[i] = at.voxel;
      walk.left[i] = at.left;
      walk.next[i] = at.next;
    }
  }
  walk.axis = -1;
  entry.t = clip.t;
  entry.t_per_s = scarp_voxel_t_per_s(per_longest);
  entry.face = scarp_voxel_entered(clip, walk.back);
  return met;
}

/// Follows a quantised ray for at most `turns` steps.
SCARP_FN ScarpVoxelAnswer scarp_march_walk(uint march, ScarpVoxelWalk walk, ScarpVoxelEntry entry, int turns) {
  ScarpVoxelAnswer hit;
  hit.face = kScarpNoFace;
  hit.t = entry.t;
  int left = turns;
  bool solid = scarp_first_voxel(march, walk, left);
  hit.voxel = walk.voxel;
  hit.steps = turns - left;
  if (solid) {
    hit.face = scarp_voxel_face(walk, entry.face);
    if (walk.axis >= 0) {
      uvec2 distance = scarp_voxel_distance(walk);
      float s = (float(distance.y) * 4294967296.0f + float(distance.x)) / float(walk.speed[walk.axis]);
      hit.t = entry.t + s * entry.t_per_s;
    }
  }
  return hit;
}

/// Returns the first solid voxel on a ray through the box [low, high), between t_min and t_max. It may be a little
/// beyond t_max. `march` is kScarpVoxelPlanes and so on.
SCARP_FN ScarpVoxelAnswer scarp_march_voxels(uint march, ivec3 low, ivec3 high, vec3 origin, vec3 direction,
                                             float t_min, float t_max, int turns) {
  ScarpVoxelWalk walk;
  ScarpVoxelEntry entry;
  ScarpVoxelAnswer hit;
  hit.face = kScarpNoFace;
  hit.voxel = ivec3(-1, -1, -1);
  hit.t = t_max;
  hit.steps = 0;
  if (scarp_voxel_ray(low, high, origin, direction, t_min, t_max, false, ivec3(0, 0, 0), walk, entry)) {
    hit = scarp_march_walk(march, walk, entry, turns);
    if (hit.t > t_max) hit.face = kScarpNoFace;
  }
  return hit;
}

/// Returns whether a ray from the face of a voxel that was hit, for example to the sun, hits another one before t_max.
/// It starts in the voxel on the other side of the face, so it needs no offset.
SCARP_FN bool scarp_voxels_block(uint march, ivec3 low, ivec3 high, ScarpVoxelAnswer from, vec3 origin, vec3 direction,
                                 float t_max, int turns) {
  ivec3 start = from.voxel;
  if (from.face < kScarpInside) start[int(from.face) >> 1] += (from.face & 1u) == 0u ? -1 : 1;
  ScarpVoxelWalk walk;
  ScarpVoxelEntry entry;
  bool blocked = false;
  if (scarp_voxel_ray(low, high, origin, direction, 0.0f, t_max, true, start, walk, entry)) {
    ScarpVoxelAnswer hit = scarp_march_walk(march, walk, entry, turns);
    blocked = hit.face != kScarpNoFace && hit.t <= t_max;
  }
  return blocked;
}

SCARP_GLSL_END

#endif
