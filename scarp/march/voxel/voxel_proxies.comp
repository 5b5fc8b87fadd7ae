// SPDX-License-Identifier: MIT
// Converts the pixels of a picture of boxes to hits, one invocation per pixel, and detects whether another object may
// be as near as the visible one: searches for other boxes along the part of the ray at the visible depth, within 2^-23
// of t.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_control_flow_attributes : require

#include "scarp/march/voxel/voxel_proxies.glsl.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint tie_levels = 32;

// Nodes with children yet to visit, as in voxel_boxes.glsl.h.
shared uint waiting[tie_levels * gl_WorkGroupSize.x];

// The children of a node whose boxes a box touches.
uint touched(VoxelNodes nodes, uint node, vec3 low, vec3 high) {
  bvec4 x = bvec4(uvec4(lessThanEqual(nodes.of[node].low_x, vec4(high.x))) &
                  uvec4(greaterThanEqual(nodes.of[node].high_x, vec4(low.x))));
  bvec4 y = bvec4(uvec4(lessThanEqual(nodes.of[node].low_y, vec4(high.y))) &
                  uvec4(greaterThanEqual(nodes.of[node].high_y, vec4(low.y))));
  bvec4 z = bvec4(uvec4(lessThanEqual(nodes.of[node].low_z, vec4(high.z))) &
                  uvec4(greaterThanEqual(nodes.of[node].high_z, vec4(low.z))));
  uint children = 0u;
  for (int k = 0; k < 4; ++k) children |= x[k] && y[k] && z[k] ? 1u << uint(k) : 0u;
  return children;
}

bool tied(VoxelObjects scene, uint pixel, uint object, double t) {
  if (scarp_depth_is_coarse(t)) return true;
  dvec3 origin = VoxelRays(push.rays).rays[pixel].origin, direction = VoxelRays(push.rays).rays[pixel].direction;
  vec3 near = vec3(origin + scarp_least_of_depth(t) * direction - scene.is.middle);
  vec3 far = vec3(origin + scarp_largest_of_depth(t) * direction - scene.is.middle);
  // Both are rounded to float, with a relative error of at most 2^-24.
  vec3 away = max(abs(near), abs(far));
  float room = push.room + max(away.x, max(away.y, away.z)) / 1048576.0;
  vec3 low = min(near, far) - room, high = max(near, far) + room;
  VoxelNodes nodes = VoxelNodes(scene.is.nodes);
  uint size = 0u, node = 0u, rest = touched(nodes, 0u, low, high);
  bool other = false;
  while (!other && (rest != 0u || size > 0u)) {
    if (rest == 0u) {
      uint next = waiting[--size * gl_WorkGroupSize.x + gl_LocalInvocationIndex];
      node = next >> 4;
      rest = next & 15u;
    }
    uint child = nodes.of[node].child[findLSB(rest)];
    rest &= rest - 1u;
    if ((child & kScarpBoxLeaf) != 0u) {
      other = (child & ~kScarpBoxLeaf) != object;
    } else {
      if (rest != 0u) waiting[size++ * gl_WorkGroupSize.x + gl_LocalInvocationIndex] = node << 4 | rest;
      node = child;
      rest = touched(nodes, node, low, high);
    }
  }
  return other;
}

void main() {
  uint group = gl_WorkGroupID.x + gl_NumWorkGroups.x * gl_WorkGroupID.y;
  uint pixel = group * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
  if (pixel >= push.count) return;
  VoxelHits hits = VoxelHits(push.hits);
  uvec4 first = VoxelPixels(push.first).of[pixel];
  uint status = first.w & 7u;
  if (status == kScarpVoxelMiss) {
    hits.hits[pixel] = ScarpVoxelHit(0.0lf, ivec3(-1), 0u, 0u, status, 0u, 0u);
    return;
  }
  uvec4 second = VoxelPixels(push.second).of[pixel];
  VoxelObjects scene = VoxelObjects(push.objects);
  double t = packDouble2x32(first.yz);
  if (status == kScarpVoxelHit && tied(scene, pixel, first.x, t)) status = kScarpVoxelTied;
  hits.hits[pixel] = ScarpVoxelHit(t, ivec3(second.xyz), VoxelObjectList(scene.is.objects).of[first.x].part,
                                   first.w >> 3 & 7u, status, first.w >> 6, second.w);
}
