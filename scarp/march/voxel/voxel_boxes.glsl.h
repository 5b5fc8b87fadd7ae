// SPDX-License-Identifier: MIT
// Rays through the hierarchy over voxel objects, which is that of BoxTree, in single precision: boxes are padded by more
// than what is rounded on the way. GLSL with float64, in which the ray is brought to the box around everything.
//
// Instead of all children that are still to be visited, the stack holds one word per level: a node, and which of its
// children are left. The nearest of them is found again on the way back.
#ifndef SCARP_MARCH_VOXEL_BOXES_GLSL_H
#define SCARP_MARCH_VOXEL_BOXES_GLSL_H

#include "scarp/march/voxel/voxel_batch.glsl.h"

// Steeper than any direction that can be told from one along a side, and the factor of BoxTree, doubled: quotients of
// devices are off by 2.5 units instead of one half.
const float kSteepest = 1152921504606846976.0;
const float kRounding = 1.0 + 1.0 / 524288.0;

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

// Nodes with children yet to visit, 4 bits each, one per level.
shared uint waiting[batch_levels * gl_WorkGroupSize.x];

// No child is as large.
const uint kScarpNoChild = 0xffffffffu;

// Returns the child of a node to visit next: the nearest of those in `rest` that the ray meets before `end`, or
// kScarpNoChild. Leaves the others in `rest`.
uint nearest_child(ScarpBoxNode node, BoxRay boxes, float end, inout uint rest) {
  vec4 near = vec4(0.0), far = vec4(end);
  bvec3 down = lessThan(boxes.inwards, vec3(0.0));
  vec3 outwards = boxes.inwards * kRounding;
  near = max(near, ((down.x ? node.high_x : node.low_x) - boxes.origin.x) * boxes.inwards.x);
  near = max(near, ((down.y ? node.high_y : node.low_y) - boxes.origin.y) * boxes.inwards.y);
  near = max(near, ((down.z ? node.high_z : node.low_z) - boxes.origin.z) * boxes.inwards.z);
  far = min(far, ((down.x ? node.low_x : node.high_x) - boxes.origin.x) * outwards.x);
  far = min(far, ((down.y ? node.low_y : node.high_y) - boxes.origin.y) * outwards.y);
  far = min(far, ((down.z ? node.low_z : node.high_z) - boxes.origin.z) * outwards.z);
  bvec4 met = lessThanEqual(near, far);
  uint found = kScarpNoChild, left = 0u, own = 0u;
  float nearest = 0.0;
  for (uint k = 0u; k < 4u; ++k) {
    if ((rest >> k & 1u) == 0u || !met[k]) continue;
    left |= 1u << k;
    if (found != kScarpNoChild && near[k] > nearest) continue;  // of those as near the last, as BoxTree has it
    found = node.child[k];
    own = 1u << k;
    nearest = near[k];
  }
  rest = left & ~own;
  return found;
}

#endif
