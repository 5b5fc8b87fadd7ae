// SPDX-License-Identifier: MIT
// Rays through voxel objects: VoxelObjects::closest_hit() and occluded() in a shader. GLSL with float64.
//
// Objects are traced in double and integers as on the CPU, so the order in which they are visited does not matter: of
// hits at the same t, the one on the first object counts.
//
// Registers are reserved for the march. Numbers used only between objects, and the best hit, stay in memory and are
// read again. Functions have one return, at their end: otherwise compilers keep their variables from one object to the
// next.
#ifndef SCARP_MARCH_VOXEL_OBJECTS_GLSL_H
#define SCARP_MARCH_VOXEL_OBJECTS_GLSL_H

#include "scarp/march/voxel/voxel_batch.glsl.h"
#include "scarp/march/voxel/voxel_boxes.glsl.h"
#include "scarp/march/voxel/voxel_double.glsl.h"
#include "scarp/march/voxel/voxel_marches.glsl.h"

// A ray during its traversal.
struct VoxelQuery {
  uint ray;
  uint turn;  // of its direction in memory
  uint part;  // that was hit; kScarpNoPart: none
  double t_max;
  int turns;  // left
};

// Writes the VoxelDirection of a ray to memory.
void scarp_turn_ray(uint ray, uint turn, VoxelTurns turns) {
  VoxelScratch scratch = VoxelScratch(batch.scratch);
  double per_longest = 0.0lf;
  uint frame = VoxelRaysAgain(batch.rays).rays[ray].frame;
  uint ties = turns.of[turn].ties[frame >> 2] >> (8u * (frame & 3u)), back = ties & kScarpTieBits;
  [[dont_unroll]] for (int axis = 0; axis < 3; ++axis) {
    double given = scarp_turned(turns.of[turn].rows[axis], VoxelRaysAgain(batch.rays).rays[ray].direction);
    back |= scarp_voxel_back(axis, given, ties);
    double inverse = scarp_exact_inverse(given), size = scarp_magnitude(inverse);
    if (axis == 0 || size < per_longest) per_longest = size;
    scratch.of[ray].given[axis] = given;
    scratch.of[ray].inverse[axis] = inverse;
  }
  [[dont_unroll]] for (int axis = 0; axis < 3; ++axis) {
    double given = scratch.of[ray].given[axis];
    uint speed = scarp_voxel_speed(given, per_longest);
    back |= scarp_voxel_inexact(given, per_longest, speed);
    scratch.of[ray].speed[axis] = speed;
  }
  scratch.of[ray].back = back;
  scratch.of[ray].t_per_s = scarp_voxel_t_per_s(per_longest);
}

// Returns false if the ray misses the object's box.
bool scarp_quantise(VoxelQuery query, VoxelObjectList objects, uint index, VoxelTurns turns, VoxelGrids grids,
                    inout ScarpVoxelWalk walk) {
  VoxelScratch scratch = VoxelScratch(batch.scratch);
  VoxelRaysAgain rays = VoxelRaysAgain(batch.rays);
  uint ray = query.ray, grid = objects.of[index].grid;
  bool has_start = rays.rays[ray].part == objects.of[index].part;
  ScarpVoxelClip clip = ScarpVoxelClip(rays.rays[ray].t_min, query.t_max, -1, false);
  uint back = scratch.of[ray].back;
  bool met = true;
  [[dont_unroll]] for (int axis = 0; axis < 3; ++axis) {
    precise dvec3 away = rays.rays[ray].origin - objects.of[index].origin;
    double origin = scarp_turned(turns.of[query.turn].rows[axis], away);
    double room = scarp_voxel_room(turns.of[query.turn].room, turns.of[query.turn].per_metre, rays.rays[ray].room);
    if (scratch.of[ray].given[axis] == 0.0lf)
      origin = scarp_voxel_level(axis, origin, room, back, grids.grids[grid].low[axis], grids.grids[grid].high[axis]);
    scratch.of[ray].origin[axis] = origin;
    if ((back & kScarpInexact) == 0u)
      back |= scarp_voxel_rounded(origin, scratch.of[ray].given[axis], rays.rays[ray].t_min);
    met = scarp_voxel_clip(axis, origin, scratch.of[ray].given[axis], scratch.of[ray].inverse[axis], room,
                           scratch.of[ray].speed[axis], back, grids.grids[grid].low[axis], grids.grids[grid].high[axis],
                           has_start, rays.rays[ray].start[axis], clip) &&
          met;
  }
  met = met && clip.t <= clip.t_out;
  if (met) {
    walk.speed = scratch.of[ray].speed;
    walk.back = back;
    [[dont_unroll]] for (int axis = 0; axis < 3; ++axis) {
      ScarpVoxelPlace at;
      met = scarp_voxel_place(axis, scratch.of[ray].origin[axis], scratch.of[ray].given[axis],
                              scratch.of[ray].speed[axis], walk.back, grids.grids[grid].low[axis],
                              grids.grids[grid].high[axis], has_start, rays.rays[ray].start[axis], clip, at) &&
            met;
      walk.speed[axis] = at.speed;
      walk.voxel[axis] = at.voxel;
      walk.left[axis] = at.left;
      walk.next[axis] = at.next;
    }
    walk.axis = -1;
    scratch.of[ray].t = clip.t;
    scratch.of[ray].entered = scarp_voxel_entered(clip, walk.back);
  }
  return met;
}

// Searches an object for a hit better than the current one. If there is one, writes it and returns true.
bool scarp_ask_object(VoxelObjects scene, uint index, inout VoxelQuery query) {
  VoxelObjectList objects = VoxelObjectList(scene.is.objects);
  VoxelTurns turns = VoxelTurns(scene.is.turns);
  uint turn = objects.of[index].turn;
  if (turn != query.turn) {
    query.turn = turn;
    scarp_turn_ray(query.ray, turn, turns);
  }
  VoxelGrids grids = VoxelGrids(scene.is.grids);
  ScarpVoxelWalk walk = ScarpVoxelWalk(ivec3(0), ivec3(0), uvec3(0u), uvec3(0u), 0u, 0);
  bool better = false;
  if (scarp_quantise(query, objects, index, turns, grids, walk)) {
    voxel_grid = grids.grids[objects.of[index].grid];
    uint march = batch_march == kScarpVoxelMarches ? voxel_grid.march : batch_march;
    if (scarp_first_voxel(march, walk, query.turns)) {
      VoxelScratch scratch = VoxelScratch(batch.scratch);
      double t = scarp_voxel_time(walk, scratch.of[query.ray].t, scratch.of[query.ray].t_per_s);
      uint part = objects.of[index].part;
      better = t < query.t_max || (t == query.t_max && part <= query.part);
      if (better) {
        query.t_max = t;
        query.part = part;
        VoxelHits hits = VoxelHits(batch.hits);
        hits.hits[query.ray].t = t;
        hits.hits[query.ray].voxel = walk.voxel;
        hits.hits[query.ray].face = scarp_voxel_face(walk, scratch.of[query.ray].entered);
        if (batch_entries != 0u) hits.hits[query.ray].entry = voxel_entry(voxel_grid, walk.voxel);
      }
    }
  }
  return better;
}

// Traces a ray and writes its hit.
void scarp_ask_voxels(uint i) {
  VoxelObjects scene = VoxelObjects(batch.objects);
  VoxelHits hits = VoxelHits(batch.hits);
  hits.hits[i] = ScarpVoxelHit(0.0lf, ivec3(-1), 0u, 0u, kScarpVoxelMiss, 0u, 0u);
  float end;
  if (!enter_boxes(i, scene, end)) return;
  VoxelQuery query = VoxelQuery(i, 0xffffffffu, kScarpNoPart, VoxelRaysAgain(batch.rays).rays[i].t_max, batch.turns);
  uint size = 0u, node = 0u, rest = 15u, nodes = 0u;
  bool over = false;
  while (!over && query.turns > 0) {
    --query.turns;
    ++nodes;
    uint child = nearest_child(VoxelNodes(scene.is.nodes), node, end, rest);
    if (rest != 0u) waiting[size++ * gl_WorkGroupSize.x + gl_LocalInvocationIndex] = node << 4 | rest;
    node = child;
    rest = 15u;
    if ((child & kScarpBoxLeaf) == 0u) continue;
    over = size == 0u;
    if (!over) {
      uint next = waiting[--size * gl_WorkGroupSize.x + gl_LocalInvocationIndex];
      node = next >> 4;
      rest = next & 15u;
    }
    if (child == kScarpNoChild || !scarp_ask_object(scene, child & ~kScarpBoxLeaf, query)) continue;
    end = min(end, box_end(i, query.t_max));
    over = over || batch_any != 0u;
  }
  bool hit = query.part != kScarpNoPart;
  hits.hits[i].part = query.part;
  hits.hits[i].status = !over ? kScarpVoxelUnfinished : hit ? kScarpVoxelHit : kScarpVoxelMiss;
  hits.hits[i].steps = uint(batch.turns - query.turns) - nodes;
}

#endif
