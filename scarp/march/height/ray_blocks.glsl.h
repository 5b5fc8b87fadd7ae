// SPDX-License-Identifier: MIT
// Rays and their results in device memory: in blocks of 64, and component by component within a block.
//
//   block 0                                        block 1
//   | cell_x of 64 rays | cell_y of 64 | ...       | cell_x of the next 64 | ...
//
// The invocations of a subgroup read the same component of successive rays at once: in this order these are adjacent
// words, a single memory transaction. Stored ray by ray, 92 bytes apart, they would be one transaction each.
//
// Compiles as C++ and GLSL.
#ifndef SCARP_MARCH_RAY_BLOCKS_GLSL_H
#define SCARP_MARCH_RAY_BLOCKS_GLSL_H

#include "scarp/march/height/ray_frame.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// Rays of a block, a whole number of subgroups on all devices.
const uint kRayBlock = 64u;

/// The rays of a block: members of ScarpRay.
struct RayBlock {
  int cell_x[kRayBlock];
  int cell_y[kRayBlock];
  float place_x[kRayBlock];
  float place_y[kRayBlock];
  float place_low_x[kRayBlock];
  float place_low_y[kRayBlock];
  float direction_x[kRayBlock];
  float direction_y[kRayBlock];
  float direction_z[kRayBlock];
  float direction_low_x[kRayBlock];
  float direction_low_y[kRayBlock];
  float direction_low_z[kRayBlock];
  float per_direction_x[kRayBlock];
  float per_direction_y[kRayBlock];
  float z[kRayBlock];
  float z_low[kRayBlock];
  float end[kRayBlock];
  float end_low[kRayBlock];
  uint flags[kRayBlock];
  float travelled[kRayBlock];
  float exit[kRayBlock];
  float per_height[kRayBlock];
  float cell_time[kRayBlock];
};

/// Their results: members of ScarpHit.
struct HitBlock {
  int status[kRayBlock];
  int cell_x[kRayBlock];
  int cell_y[kRayBlock];
  float place_x[kRayBlock];
  float place_y[kRayBlock];
  float time[kRayBlock];
  float time_low[kRayBlock];
  uint steps[kRayBlock];
  uint fetches[kRayBlock];
};

const uint kRayBlockBytes = 5888u;
const uint kHitBlockBytes = 2304u;

#ifdef __cplusplus

static_assert(sizeof(RayBlock) == kRayBlockBytes && sizeof(RayBlock) == kRayBlock * sizeof(ScarpRay));
static_assert(sizeof(HitBlock) == kHitBlockBytes && sizeof(HitBlock) == kRayBlock * sizeof(ScarpHit));

/// Number of blocks for this many rays.
constexpr std::uint64_t ray_blocks(std::uint64_t rays) { return (rays + kRayBlock - 1) / kRayBlock; }

// Counterpart of a buffer reference in GLSL.
struct RayBlockAt {
  const RayBlock& is;
};
struct RayBlockTo {
  RayBlock& is;
};
struct HitBlockAt {
  HitBlock& is;
};

#else

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer RayBlockAt { RayBlock is; };
layout(buffer_reference, scalar, buffer_reference_align = 16) writeonly buffer RayBlockTo { RayBlock is; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer HitBlockAt { HitBlock is; };

// The block of ray i, with 32-bit offsets: batches have less than 2^32 bytes.
Address ray_block_address(Address begin, uint i, uint block_bytes) {
  uint low = begin.x + (i / kRayBlock) * block_bytes;
  return Address(low, begin.y + (low < begin.x ? 1u : 0u));
}

#endif

/// Ray i of a block.
SCARP_FN ScarpRay ray_of_block(RayBlockAt block, uint i) {
  ScarpRay ray;
  ray.cell = ivec2(block.is.cell_x[i], block.is.cell_y[i]);
  ray.place = vec2(block.is.place_x[i], block.is.place_y[i]);
  ray.place_low = vec2(block.is.place_low_x[i], block.is.place_low_y[i]);
  ray.direction = vec3(block.is.direction_x[i], block.is.direction_y[i], block.is.direction_z[i]);
  ray.direction_low = vec3(block.is.direction_low_x[i], block.is.direction_low_y[i], block.is.direction_low_z[i]);
  ray.per_direction = vec2(block.is.per_direction_x[i], block.is.per_direction_y[i]);
  ray.z = block.is.z[i];
  ray.z_low = block.is.z_low[i];
  ray.end = block.is.end[i];
  ray.end_low = block.is.end_low[i];
  ray.flags = block.is.flags[i];
  ray.travelled = block.is.travelled[i];
  ray.exit = block.is.exit[i];
  ray.per_height = block.is.per_height[i];
  ray.cell_time = block.is.cell_time[i];
  return ray;
}

/// Writes ray i of a block.
SCARP_FN void put_ray(RayBlockTo block, uint i, ScarpRay ray) {
  block.is.cell_x[i] = ray.cell.x;
  block.is.cell_y[i] = ray.cell.y;
  block.is.place_x[i] = ray.place.x;
  block.is.place_y[i] = ray.place.y;
  block.is.place_low_x[i] = ray.place_low.x;
  block.is.place_low_y[i] = ray.place_low.y;
  block.is.direction_x[i] = ray.direction.x;
  block.is.direction_y[i] = ray.direction.y;
  block.is.direction_z[i] = ray.direction.z;
  block.is.direction_low_x[i] = ray.direction_low.x;
  block.is.direction_low_y[i] = ray.direction_low.y;
  block.is.direction_low_z[i] = ray.direction_low.z;
  block.is.per_direction_x[i] = ray.per_direction.x;
  block.is.per_direction_y[i] = ray.per_direction.y;
  block.is.z[i] = ray.z;
  block.is.z_low[i] = ray.z_low;
  block.is.end[i] = ray.end;
  block.is.end_low[i] = ray.end_low;
  block.is.flags[i] = ray.flags;
  block.is.travelled[i] = ray.travelled;
  block.is.exit[i] = ray.exit;
  block.is.per_height[i] = ray.per_height;
  block.is.cell_time[i] = ray.cell_time;
}

/// Result i of a block.
SCARP_FN ScarpHit hit_of_block(HitBlockAt block, uint i) {
  ScarpHit hit;
  hit.status = block.is.status[i];
  hit.cell = ivec2(block.is.cell_x[i], block.is.cell_y[i]);
  hit.place = vec2(block.is.place_x[i], block.is.place_y[i]);
  hit.time = block.is.time[i];
  hit.time_low = block.is.time_low[i];
  hit.steps = block.is.steps[i];
  hit.fetches = block.is.fetches[i];
  return hit;
}

/// Writes result i of a block.
SCARP_FN void put_hit(HitBlockAt block, uint i, ScarpHit hit) {
  block.is.status[i] = hit.status;
  block.is.cell_x[i] = hit.cell.x;
  block.is.cell_y[i] = hit.cell.y;
  block.is.place_x[i] = hit.place.x;
  block.is.place_y[i] = hit.place.y;
  block.is.time[i] = hit.time;
  block.is.time_low[i] = hit.time_low;
  block.is.steps[i] = hit.steps;
  block.is.fetches[i] = hit.fetches;
}

SCARP_GLSL_END

#endif
