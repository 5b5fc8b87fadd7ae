// SPDX-License-Identifier: MIT
// Rays through voxel objects: VoxelObjects::closest_hit() and occluded() in a shader. GLSL with float64.
//
// Objects are answered in double and integers as on the CPU, so the order in which they are met does not matter: of hits
// at the same t that of the first object counts.
//
// A march has few registers if little else is alive meanwhile. What a ray needs between objects alone, its numbers and
// its best hit, is therefore kept in memory and read again.
#ifndef SCARP_MARCH_VOXEL_OBJECTS_GLSL_H
#define SCARP_MARCH_VOXEL_OBJECTS_GLSL_H

#include "scarp/march/voxel/voxel_batch.glsl.h"
#include "scarp/march/voxel/voxel_boxes.glsl.h"
#include "scarp/march/voxel/voxel_marches.glsl.h"
#include "scarp/march/voxel/voxel_quantise.glsl.h"

// The direction in the grid of the object at hand.
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer VoxelDirections { ScarpVoxelDirection of[]; };

dvec3 scarp_turned(ScarpVoxelTurn turn, dvec3 v) {
  precise dvec3 x = turn.x * v.x;
  precise dvec3 y = turn.y * v.y;
  precise dvec3 z = turn.z * v.z;
  precise dvec3 xy = x + y;
  precise dvec3 turned = xy + z;
  return turned;
}

// A ray on its way.
struct VoxelQuery {
  uint ray;
  uint turn;  // of its direction in memory
  uint part;  // that was hit; kScarpNoPart: none
  double t_max;
  uint boxes;
  int turns;  // left
};

// Looks for a hit in an object that is better than the one so far. Returns whether there is one, which is written.
bool scarp_ask_object(VoxelObjects scene, uint index, inout VoxelQuery query) {
  ScarpVoxelObject object = VoxelObjectList(scene.is.objects).of[index];
  ScarpVoxelTurn to = VoxelTurns(scene.is.turns).of[object.turn];
  VoxelRaysAgain rays = VoxelRaysAgain(batch.rays);
  VoxelDirections directions = VoxelDirections(batch.directions);
  if (object.turn != query.turn) {
    query.turn = object.turn;
    directions.of[query.ray] = scarp_voxel_direction(scarp_turned(to, rays.rays[query.ray].direction));
  }
  voxel_grid = VoxelGrids(scene.is.grids).grids[object.grid];
  ++query.boxes;
  ScarpVoxelWalk walk;
  {
    ScarpVoxelRay ray = rays.rays[query.ray];
    precise dvec3 away = ray.origin - object.origin;
    if (!scarp_voxel_quantise(scarp_turned(to, away), ray.t_min, query.t_max, directions.of[query.ray], voxel_grid.low,
                              voxel_grid.high, ray.part == object.part, ray.start, walk))
      return false;
  }
  directions.of[query.ray].t = walk.t;
  uint march = batch_march == kScarpVoxelMarches ? voxel_grid.march : batch_march;
  if (!scarp_first_voxel(march, walk, query.turns)) return false;
  walk.t = directions.of[query.ray].t;
  walk.t_per_s = directions.of[query.ray].t_per_s;
  double t = scarp_voxel_time(walk);
  uint part = VoxelObjectList(scene.is.objects).of[index].part;
  if (t > query.t_max || (t == query.t_max && part > query.part)) return false;
  query.t_max = t;
  query.part = part;
  VoxelHits hits = VoxelHits(batch.hits);
  hits.hits[query.ray].t = t;
  hits.hits[query.ray].voxel = walk.voxel;
  hits.hits[query.ray].face = scarp_voxel_face(walk);
  if (batch_entries != 0u) hits.hits[query.ray].entry = voxel_entry(voxel_grid, walk.voxel);
  return true;
}

// Answers a ray; writes the answer to the hits.
void scarp_ask_voxels(uint i) {
  VoxelObjects scene = VoxelObjects(batch.objects);
  VoxelHits(batch.hits).hits[i] = ScarpVoxelHit(0.0lf, ivec3(-1), 0u, 0u, kScarpVoxelMiss, 0u, 0u, 0u, 0u);
  BoxRay boxes;
  float end;
  if (!enter_boxes(VoxelRays(batch.rays).rays[i], scene, boxes, end)) return;
  VoxelQuery query = VoxelQuery(i, 0xffffffffu, kScarpNoPart, VoxelRays(batch.rays).rays[i].t_max, 0u, batch.turns);
  uint size = 0u, node = 0u, rest = 15u, nodes = 0u;
  bool over = false;
  while (!over && query.turns > 0) {
    --query.turns;
    ++nodes;
    uint child = nearest_child(VoxelNodes(scene.is.nodes).of[node], boxes, end, rest);
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
    end = min(end, box_end(boxes, query.t_max));
    over = over || batch_any != 0u;
  }
  VoxelHits hits = VoxelHits(batch.hits);
  bool hit = query.part != kScarpNoPart;
  hits.hits[i].part = query.part;
  hits.hits[i].status = !over ? kScarpVoxelUnfinished : hit ? kScarpVoxelHit : kScarpVoxelMiss;
  hits.hits[i].steps = uint(batch.turns - query.turns) - nodes;
  hits.hits[i].boxes = query.boxes;
}

#endif
