// SPDX-License-Identifier: MIT
// A batch of rays on a device: the interface between the compute shaders of the marches and the C++ that calls them
// (queries_vk.h), and the functions that the marches require (cell_surface.glsl.h, max_mip.glsl.h), from
// accel/ground_buffers.glsl.h.
//
//   RayBatch ──rays──▶ RayBlock RayBlock ...     one invocation for each ray (ray_blocks.glsl.h)
//       │  ├──hits───▶ HitBlock HitBlock ...     the answers, in the same order
//       │  ├──states─▶ batch_states.glsl.h       positions of unfinished marches
//       │  └──under_way─▶ a word                 1 if there are any; cleared before each run
//       └────ground──▶ GroundBuffers
//
// A march is interrupted after some turns of its loop (vk/loop_turns.glsl.h) and continues in the next run, which has
// `resume` set. `max-mip` has two shaders: max_mip.comp traces nearly all rays, and max_mip_exact.comp those that it
// leaves under way.
#ifndef SCARP_MARCH_RAY_BATCH_GLSL_H
#define SCARP_MARCH_RAY_BATCH_GLSL_H

#include "scarp/accel/ground_buffers.glsl.h"
#include "scarp/march/height/ray_blocks.glsl.h"
#include "scarp/march/sampling/sampling.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

// Specialisation constants of all marches.
const uint kBatchThreads = 0u;     // of a workgroup
const uint kBatchAny = 1u;         // whether anything is hit, instead of the closest hit: max-mip only
const uint kBatchStatistics = 2u;  // whether steps and fetches are counted; otherwise zeros
const uint kBatchMarch = 3u;       // ScarpSampling::march
const uint kBatchGround = 4u;      // batch_ground_kind(), or kBatchAnyGround: read from the ground
const uint kBatchRefinement = 5u;  // ScarpSampling::refinement, for the first pass

const uint kBatchAnyGround = 0xffffffffu;
const uint kBatchSamplesShift = 16u;
/// The ground that a shader is specialised for: ScarpField::flags and GroundBuffers::sample_type.
SCARP_FN uint batch_ground_kind(uint flags, uint sample_type) { return flags | (sample_type << kBatchSamplesShift); }

// Values of RayBatch::resume.
const uint kBatchBegin = 0u;   // march all rays
const uint kBatchResume = 1u;  // continue those that were interrupted
const uint kBatchSecond = 2u;  // march those that the first pass left

/// The push constants of all marches.
struct RayBatch {
  Address ground;
  Address rays;
  Address hits;
  uint count;
  ScarpSampling settings;  ///< for all marches except max-mip
  int turns;               ///< of a march's loop in one run
  uint resume;             ///< kBatchBegin and so on
  Address states;
  Address under_way;
};

/// The status of a march that continues in the next run.
const int kBatchUnderWay = kScarpDoubtful;

#ifndef __cplusplus

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const bool batch_any = false;
layout(constant_id = 2) const bool batch_statistics = false;
layout(constant_id = 3) const uint batch_march = kScarpNaive;
layout(constant_id = 4) const uint batch_ground = kBatchAnyGround;
layout(constant_id = 5) const uint batch_refinement = kScarpRefineNone;

layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer BatchWord { uint word; };
layout(push_constant, scalar) uniform Push { RayBatch batch; };

#define SCARP_GROUND_TYPE (batch_ground == kBatchAnyGround ? opened_type : batch_ground >> kBatchSamplesShift)
#include "scarp/march/height/ground_host.glsl.h"

// The ray of an invocation, and the block of its result.
ScarpRay batch_ray(uint i) {
  return ray_of_block(RayBlockAt(ray_block_address(batch.rays, i, kRayBlockBytes)), i % kRayBlock);
}
HitBlockAt batch_hits(uint i) { return HitBlockAt(ray_block_address(batch.hits, i, kHitBlockBytes)); }

// Whether this run marches ray i.
bool batch_asks(uint i) {
  if (i >= batch.count) return false;
  return batch.resume == kBatchBegin || batch_hits(i).is.status[i % kRayBlock] == kBatchUnderWay;
}

// The ground for a ray.
ScarpField batch_field(ScarpRay ray) {
  ScarpField field = open_ground(batch.ground);
  field.flags = batch_ground == kBatchAnyGround ? field.flags | kScarpStarts : batch_ground & 0xffffu;
  if ((ray.flags & kScarpThroughWalls) != 0u) field.flags &= ~kScarpSolid;
  return field;
}

// Marks that at least one march has not finished.
void batch_mark() { BatchWord(batch.under_way).word = 1u; }
// Marks that the march of ray i has not finished.
void batch_interrupt(uint i) {
  batch_hits(i).is.status[i % kRayBlock] = kBatchUnderWay;
  batch_mark();
}

// Writes the result of ray i.
void batch_answer(uint i, ScarpHit hit) {
  if (!batch_statistics) {
    hit.steps = 0u;
    hit.fetches = 0u;
  }
  if (batch_any) {
    uint j = i % kRayBlock;
    batch_hits(i).is.status[j] = hit.status;
    if (!batch_statistics) return;
    batch_hits(i).is.steps[j] = hit.steps;
    batch_hits(i).is.fetches[j] = hit.fetches;
    return;
  }
  put_hit(batch_hits(i), i % kRayBlock, hit);
}

#endif

SCARP_GLSL_END

#endif
