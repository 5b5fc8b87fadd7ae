// SPDX-License-Identifier: MIT
// Rays through the hierarchy over voxel objects, and through the grid of each object whose tight bounds they meet:
// VoxelObjects::closest_hit() and occluded() in a shader. GLSL with float64.
//
// Boxes are met in single precision, as BoxTree has it: padded by more than what is rounded on the way. Objects are
// answered in double and integers as on the CPU, so the order in which they are met does not matter: of hits at the same
// t that of the first object counts.
#ifndef SCARP_MARCH_VOXEL_OBJECTS_GLSL_H
#define SCARP_MARCH_VOXEL_OBJECTS_GLSL_H

#include "scarp/march/voxel/voxel_batch.glsl.h"
#include "scarp/march/voxel/voxel_marches.glsl.h"
#include "scarp/march/voxel/voxel_quantise.glsl.h"

// Steeper than any direction that can be told from one along a side, and the factor of BoxTree, doubled: quotients of
// devices are off by 2.5 units instead of one half.
const float kSteepest = 1152921504606846976.0;
const float kRounding = 1.0 + 1.0 / 524288.0;

dvec3 scarp_turned(ScarpVoxelTurn turn, dvec3 v) {
  precise dvec3 x = turn.x * v.x;
  precise dvec3 y = turn.y * v.y;
  precise dvec3 z = turn.z * v.z;
  precise dvec3 xy = x + y;
  precise dvec3 turned = xy + z;
  return turned;
}

// A ray relative to the middle of the hierarchy, in units of its longest component.
struct BoxRay {
  vec3 origin;
  vec3 inwards;
  double t_in;
  float longest;
};

float box_end(BoxRay ray, double t) { return float((t - ray.t_in) * double(ray.longest)) * kRounding; }

// Returns false for a ray that passes the box around everything.
bool enter_boxes(ScarpVoxelRay ray, VoxelObjects scene, out BoxRay boxes, out float end) {
  double t_in = ray.t_min, t_out = ray.t_max;
  for (int axis = 0; axis < 3; ++axis) {
    double d = ray.direction[axis], low = scene.is.low[axis], high = scene.is.high[axis];
    if (d == 0.0lf) {
      if (ray.origin[axis] < low || ray.origin[axis] > high) return false;
      continue;
    }
    double inverse = 1.0lf / d, a = (low - ray.origin[axis]) * inverse, b = (high - ray.origin[axis]) * inverse;
    t_in = max(t_in, min(a, b));
    t_out = min(t_out, max(a, b));
  }
  if (!(t_in <= t_out)) return false;
  double longest = max(max(abs(ray.direction.x), abs(ray.direction.y)), abs(ray.direction.z));
  double per_longest = 1.0lf / longest;
  for (int axis = 0; axis < 3; ++axis) {
    boxes.origin[axis] = float(ray.origin[axis] + t_in * ray.direction[axis] - scene.is.middle[axis]);
    float slope = float(ray.direction[axis] * per_longest);
    boxes.inwards[axis] = abs(slope) * kSteepest < 1.0 ? (slope < 0.0 ? -kSteepest : kSteepest) : 1.0 / slope;
  }
  boxes.t_in = t_in;
  boxes.longest = float(longest);
  end = box_end(boxes, t_out);
  return true;
}

void sort_pair(inout float a, inout uint child_a, inout float b, inout uint child_b) {
  bool swap = b > a;
  float far = swap ? b : a;
  uint child_far = swap ? child_b : child_a;
  b = swap ? a : b;
  child_b = swap ? child_a : child_b;
  a = far;
  child_a = child_far;
}

ScarpVoxelHit scarp_voxel_miss() {
  return ScarpVoxelHit(0.0lf, ivec3(-1), 0u, 0u, kScarpVoxelMiss, 0u, 0u, 0u, 0u);
}

// Answers a ray; writes the answer to hits[i].
void scarp_ask_voxels(uint i) {
  VoxelObjects scene = VoxelObjects(batch.objects);
  ScarpVoxelRay ray = VoxelRays(batch.rays).rays[i];
  ScarpVoxelHit best = scarp_voxel_miss();
  BoxRay boxes;
  float end;
  if (!enter_boxes(ray, scene, boxes, end)) {
    VoxelHits(batch.hits).hits[i] = best;
    return;
  }
  uint stack_child[batch_stack];
  float stack_near[batch_stack];
  stack_child[0] = 0u;
  stack_near[0] = 0.0;
  uint size = 1u;
  int turns = batch.turns, nodes = 0;
  uint turn = 0xffffffffu;
  ScarpVoxelDirection direction;
  double t_max = ray.t_max;
  while (size > 0u && turns > 0) {
    --size;
    if (stack_near[size] > end) continue;
    uint child = stack_child[size];
    if ((child & kScarpBoxLeaf) == 0u) {
      --turns;
      ++nodes;
      ScarpBoxNode node = VoxelNodes(scene.is.nodes).of[child];
      vec4 near = vec4(0.0), far = vec4(end);
      bvec3 down = lessThan(boxes.inwards, vec3(0.0));
      vec3 outwards = boxes.inwards * kRounding;
      near = max(near, ((down.x ? node.high_x : node.low_x) - boxes.origin.x) * boxes.inwards.x);
      near = max(near, ((down.y ? node.high_y : node.low_y) - boxes.origin.y) * boxes.inwards.y);
      near = max(near, ((down.z ? node.high_z : node.low_z) - boxes.origin.z) * boxes.inwards.z);
      far = min(far, ((down.x ? node.low_x : node.high_x) - boxes.origin.x) * outwards.x);
      far = min(far, ((down.y ? node.low_y : node.high_y) - boxes.origin.y) * outwards.y);
      far = min(far, ((down.z ? node.low_z : node.high_z) - boxes.origin.z) * outwards.z);
      // Those that are not met come first, and are not pushed.
      near = mix(vec4(1.0 / 0.0), near, lessThanEqual(near, far));
      sort_pair(near.x, node.child.x, near.y, node.child.y);
      sort_pair(near.z, node.child.z, near.w, node.child.w);
      sort_pair(near.x, node.child.x, near.z, node.child.z);
      sort_pair(near.y, node.child.y, near.w, node.child.w);
      sort_pair(near.y, node.child.y, near.z, node.child.z);
      for (int k = 0; k < 4; ++k) {
        if (isinf(near[k])) continue;
        stack_child[size] = node.child[k];
        stack_near[size] = near[k];
        ++size;
      }
      continue;
    }
    ScarpVoxelObject object = VoxelObjectList(scene.is.objects).of[child & ~kScarpBoxLeaf];
    ScarpVoxelTurn to = VoxelTurns(scene.is.turns).of[object.turn];
    if (object.turn != turn) {
      turn = object.turn;
      direction = scarp_voxel_direction(scarp_turned(to, ray.direction));
    }
    voxel_grid = VoxelGrids(scene.is.grids).grids[object.grid];
    precise dvec3 away = ray.origin - object.origin;
    ScarpVoxelWalk walk;
    ++best.boxes;
    if (!scarp_voxel_quantise(scarp_turned(to, away), ray.t_min, t_max, direction, voxel_grid.low, voxel_grid.high,
                              ray.part == object.part, ray.start, walk))
      continue;
    uint march = batch_march == kScarpVoxelMarches ? voxel_grid.march : batch_march;
    if (!scarp_first_voxel(march, walk, turns)) continue;
    double t = scarp_voxel_time(walk);
    if (t > t_max || (best.status == kScarpVoxelHit && t == best.t && object.part > best.part)) continue;
    best.status = kScarpVoxelHit;
    best.t = t;
    best.voxel = walk.voxel;
    best.face = scarp_voxel_face(walk);
    best.part = object.part;
    if (batch_entries != 0u) best.entry = voxel_entry(voxel_grid, walk.voxel);
    if (batch_any != 0u) break;
    t_max = t;
    end = min(end, box_end(boxes, t));
  }
  if (turns <= 0 && !(batch_any != 0u && best.status == kScarpVoxelHit)) best.status = kScarpVoxelUnfinished;
  best.steps = uint(batch.turns - turns - nodes);
  VoxelHits(batch.hits).hits[i] = best;
}

#endif
