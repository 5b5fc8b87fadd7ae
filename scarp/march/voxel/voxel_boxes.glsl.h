// SPDX-License-Identifier: MIT
// Rays through the hierarchy over voxel objects, that of BoxTree, in single precision: boxes are padded by more than
// the rounding errors. GLSL with float64, which is used to clip the ray to the outer box.
//
// The stack holds one word per level, a node and a mask of its remaining children, instead of all children yet to
// visit. The nearest of them is found again on the way back.
#ifndef SCARP_MARCH_VOXEL_BOXES_GLSL_H
#define SCARP_MARCH_VOXEL_BOXES_GLSL_H

#include "scarp/march/voxel/voxel_batch.glsl.h"

// The largest inverse of a direction, and the factor of BoxTree, doubled: device quotients have errors of 2.5 units
// instead of one half.
const float kSteepest = 1152921504606846976.0;
const float kRounding = 1.0 + 1.0 / 524288.0;

// Numbers of rays in memory, which are read again instead of kept in registers.
layout(buffer_reference, scalar, buffer_reference_align = 8) volatile buffer VoxelScratch { ScarpVoxelScratch of[]; };

// In shared memory per invocation, which leaves the registers to the marches: nodes with children yet to visit, 4 bits
// each, one per level; and the ray relative to the middle of the hierarchy, in units of its longest component.
shared uint waiting[batch_levels * gl_WorkGroupSize.x];
shared vec3 box_origin[gl_WorkGroupSize.x];
shared vec3 box_inwards[gl_WorkGroupSize.x];

// The end of a ray in that unit.
float box_end(uint i, double t) {
  VoxelScratch scratch = VoxelScratch(batch.scratch);
  return float((t - scratch.of[i].t_in) * double(scratch.of[i].longest)) * kRounding;
}

// Returns false for a ray that misses the outer box.
bool enter_boxes(uint i, VoxelObjects scene, out float end) {
  VoxelRays rays = VoxelRays(batch.rays);
  double t_in = rays.rays[i].t_min, t_out = rays.rays[i].t_max, longest = 0.0lf;
  [[dont_unroll]] for (int axis = 0; axis < 3; ++axis) {
    double d = rays.rays[i].direction[axis], origin = rays.rays[i].origin[axis];
    double low = scene.is.low[axis], high = scene.is.high[axis];
    longest = max(longest, abs(d));
    if (d == 0.0lf) {
      if (origin < low || origin > high) return false;
      continue;
    }
    double inverse = 1.0lf / d, a = (low - origin) * inverse, b = (high - origin) * inverse;
    t_in = max(t_in, min(a, b));
    t_out = min(t_out, max(a, b));
  }
  if (!(t_in <= t_out)) return false;
  double per_longest = 1.0lf / longest;
  [[dont_unroll]] for (int axis = 0; axis < 3; ++axis) {
    double d = rays.rays[i].direction[axis];
    float slope = float(d * per_longest);
    box_origin[gl_LocalInvocationIndex][axis] = float(rays.rays[i].origin[axis] + t_in * d - scene.is.middle[axis]);
    box_inwards[gl_LocalInvocationIndex][axis] =
        abs(slope) * kSteepest < 1.0 ? (slope < 0.0 ? -kSteepest : kSteepest) : 1.0 / slope;
  }
  VoxelScratch scratch = VoxelScratch(batch.scratch);
  scratch.of[i].t_in = t_in;
  scratch.of[i].longest = float(longest);
  end = box_end(i, t_out);
  return true;
}

// Larger than any child.
const uint kScarpNoChild = 0xffffffffu;

// Returns the child of a node to visit next: the nearest of those in `rest` that the ray hits before `end`, or
// kScarpNoChild. Leaves the others in `rest`.
uint nearest_child(VoxelNodes nodes, uint node, float end, inout uint rest) {
  vec3 origin = box_origin[gl_LocalInvocationIndex], inwards = box_inwards[gl_LocalInvocationIndex];
  // All four at once, a vector per side.
  bvec3 down = lessThan(inwards, vec3(0.0));
  vec4 near = vec4(0.0), far = vec4(end);
  vec4 low = nodes.of[node].low_x, high = nodes.of[node].high_x;
  near = max(near, ((down.x ? high : low) - origin.x) * inwards.x);
  far = min(far, ((down.x ? low : high) - origin.x) * (inwards.x * kRounding));
  low = nodes.of[node].low_y, high = nodes.of[node].high_y;
  near = max(near, ((down.y ? high : low) - origin.y) * inwards.y);
  far = min(far, ((down.y ? low : high) - origin.y) * (inwards.y * kRounding));
  low = nodes.of[node].low_z, high = nodes.of[node].high_z;
  near = max(near, ((down.z ? high : low) - origin.z) * inwards.z);
  far = min(far, ((down.z ? low : high) - origin.z) * (inwards.z * kRounding));
  uint found = kScarpNoChild, left = 0u, own = 0u;
  float nearest = 0.0;
  for (uint k = 0u; k < 4u; ++k) {
    bool met = near[k] <= far[k] && (rest >> k & 1u) != 0u;
    left |= met ? 1u << k : 0u;
    // The last one of equally near children, like BoxTree: steps then equal the CPU's.
    if (!met || (own != 0u && near[k] > nearest)) continue;
    own = 1u << k;
    nearest = near[k];
  }
  if (own != 0u) found = nodes.of[node].child[findLSB(own)];
  rest = left & ~own;
  return found;
}

#endif
