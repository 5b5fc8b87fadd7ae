// SPDX-License-Identifier: MIT
// The fragments of voxel_proxies.frag: the ray of a pixel through one object, as in voxel_objects.glsl.h. GLSL with
// float64.
//
// The ray is read by pixel, as compute does: nothing is interpolated, so it is bit-identical and finds the same voxel.
#ifndef SCARP_MARCH_VOXEL_PROXIES_MARCH_GLSL_H
#define SCARP_MARCH_VOXEL_PROXIES_MARCH_GLSL_H

// The marches call these.
bool scarp_voxel_words();
uvec2 scarp_voxel_mask(ivec3 brick);
uvec2 scarp_voxel_sector(ivec3 sector);
uint scarp_voxel_byte(ivec3 voxel, uint octant);

#include "scarp/march/voxel/voxel_double.glsl.h"
#include "scarp/march/voxel/voxel_marches.glsl.h"
#include "scarp/march/voxel/voxel_proxies.glsl.h"

// Specialisation constants of all shaders of proxies.
layout(constant_id = 0) const uint proxy_march = kScarpVoxelMarches;
layout(constant_id = 1) const uint proxy_words = 0;
layout(constant_id = 2) const uint proxy_entries = 0;

// The grid that is marched.
ScarpVoxelGrid voxel_grid;

bool scarp_voxel_words() { return proxy_words != 0u; }
uvec2 scarp_voxel_mask(ivec3 brick) { return voxel_mask(voxel_grid, brick); }
uvec2 scarp_voxel_sector(ivec3 sector) { return voxel_sector(voxel_grid, sector); }
uint scarp_voxel_byte(ivec3 voxel, uint octant) { return voxel_byte(voxel_grid, voxel, octant); }

layout(depth_less) out float gl_FragDepth;
layout(location = 0) flat in uint proxy_object;
layout(location = 0) out uvec4 first_words;
layout(location = 1) out uvec4 second_words;

// A ray at its entry into the box of an object.
struct ProxyEntry {
  double t;
  double t_per_s;
  uint face;
};

// VoxelRay::room of the ray in the grid of the object.
double scarp_proxy_room(uint pixel, VoxelObjects scene, uint object) {
  VoxelTurns turns = VoxelTurns(scene.is.turns);
  uint turn = VoxelObjectList(scene.is.objects).of[object].turn;
  return scarp_voxel_room(turns.of[turn].room, turns.of[turn].per_metre, VoxelRaysAgain(push.rays).rays[pixel].room);
}

// One axis of the ray in the grid of the object.
void scarp_proxy_axis(uint pixel, VoxelObjects scene, uint object, int axis, double room, uint ties, out double origin,
                      out double given) {
  // Read again rather than kept, so that only one axis at a time is in registers.
  VoxelRaysAgain rays = VoxelRaysAgain(push.rays);
  VoxelObjectList objects = VoxelObjectList(scene.is.objects);
  dvec3 row = VoxelTurns(scene.is.turns).of[objects.of[object].turn].rows[axis];
  given = scarp_turned(row, rays.rays[pixel].direction);
  precise dvec3 away = rays.rays[pixel].origin - objects.of[object].origin;
  origin = scarp_turned(row, away);
  if (given == 0.0lf) origin = scarp_voxel_level(axis, origin, room, ties, voxel_grid.low[axis], voxel_grid.high[axis]);
}

// Returns false if the ray misses the box.
bool scarp_enter_proxy(uint pixel, VoxelObjects scene, uint object, out ScarpVoxelWalk walk, out ProxyEntry entry) {
  VoxelRays rays = VoxelRays(push.rays);
  double per_longest = 0.0lf, origin, given;
  uint turn = VoxelObjectList(scene.is.objects).of[object].turn, frame = rays.rays[pixel].frame;
  uint ties = VoxelTurns(scene.is.turns).of[turn].ties[frame >> 2] >> (8u * (frame & 3u));
  double room = scarp_proxy_room(pixel, scene, object);
  uint back = ties & kScarpTieBits;
  dvec3 inverse;
  for (int axis = 0; axis < 3; ++axis) {
    scarp_proxy_axis(pixel, scene, object, axis, room, ties, origin, given);
    back |= scarp_voxel_back(axis, given, ties);
    inverse[axis] = scarp_exact_inverse(given);
    double size = scarp_magnitude(inverse[axis]);
    if (axis == 0 || size < per_longest) per_longest = size;
  }
  for (int axis = 0; axis < 3; ++axis) {
    scarp_proxy_axis(pixel, scene, object, axis, room, ties, origin, given);
    walk.speed[axis] = scarp_voxel_speed(given, per_longest);
    back |= scarp_voxel_inexact(given, per_longest, walk.speed[axis]);
  }
  ScarpVoxelClip clip = ScarpVoxelClip(rays.rays[pixel].t_min, rays.rays[pixel].t_max, -1, false);
  bool met = true;
  for (int axis = 0; axis < 3; ++axis) {
    scarp_proxy_axis(pixel, scene, object, axis, room, ties, origin, given);
    back |= scarp_voxel_rounded(origin, given, rays.rays[pixel].t_min);
    met = scarp_voxel_clip(axis, origin, given, inverse[axis], room, walk.speed[axis], back, voxel_grid.low[axis],
                           voxel_grid.high[axis], false, 0, clip) &&
          met;
  }
  met = met && clip.t <= clip.t_out;
  if (met) {
    for (int axis = 0; axis < 3; ++axis) {
      scarp_proxy_axis(pixel, scene, object, axis, room, ties, origin, given);
      ScarpVoxelPlace at;
      met = scarp_voxel_place(axis, origin, given, walk.speed[axis], back, voxel_grid.low[axis], voxel_grid.high[axis],
                              false, 0, clip, at) &&
            met;
      walk.speed[axis] = at.speed;
      walk.voxel[axis] = at.voxel;
      walk.left[axis] = at.left;
      walk.next[axis] = at.next;
    }
    walk.back = back;
    walk.axis = -1;
    entry = ProxyEntry(clip.t, scarp_voxel_t_per_s(per_longest), scarp_voxel_entered(clip, back));
  }
  return met;
}

void scarp_march_proxy() {
  VoxelObjects scene = VoxelObjects(push.objects);
  VoxelRays rays = VoxelRays(push.rays);
  uint pixel = uint(gl_FragCoord.y) * push.width + uint(gl_FragCoord.x);
  voxel_grid = VoxelGrids(scene.is.grids).grids[VoxelObjectList(scene.is.objects).of[proxy_object].grid];
  ScarpVoxelWalk walk;
  ProxyEntry entry;
  if (!scarp_enter_proxy(pixel, scene, proxy_object, walk, entry)) discard;
  int turns = push.turns;
  bool solid = scarp_first_voxel(proxy_march == kScarpVoxelMarches ? voxel_grid.march : proxy_march, walk, turns);
  // A march that takes too long counts as a hit at its start.
  bool over = solid || turns > 0;
  double t = solid ? scarp_voxel_time(walk, entry.t, entry.t_per_s) : entry.t;
  if ((over && !solid) || t > rays.rays[pixel].t_max) discard;
  uvec2 words = unpackDouble2x32(t);
  uint status = over ? kScarpVoxelHit : kScarpVoxelUnfinished, face = scarp_voxel_face(walk, entry.face);
  gl_FragDepth = uintBitsToFloat(scarp_depth_bits(t));
  first_words = uvec4(proxy_object, words, status | face << 3 | uint(push.turns - turns) << 6);
  second_words = uvec4(uvec3(walk.voxel), proxy_entries != 0u && solid ? voxel_entry(voxel_grid, walk.voxel) : 0u);
}

#endif
