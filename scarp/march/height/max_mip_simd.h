// SPDX-License-Identifier: MIT
// `max-mip` for many rays at once, in single precision, one ray per vector lane.
//
//   lanes    r0 r1 r2 ... r15     each with its own block, level and time; a step: where does the ray leave the
//            |  |  |       |      block, is it above its tilted plane? On to the next block, or one level down
//   cells    . r1 .  ... r14      lanes at a cell wait until enough of them do, then four samples are loaded
//   done     r0 .  r2 ... .       finished lanes also wait until enough of them are, then get the next rays
//
// Camera rays from above start together, deep in the field: max_mip_simd_beam.h. Rays from one point over the field
// share their blocks: max_mip_simd_together.h.
//
// Vector results are proven, with a margin for single precision (for double in first cells; doc/dev/numerics.md): that
// a ray is above the ground up to a time, or that it is above at one time and below at a later one. Any hit needs no
// more. The closest hit is computed in double exactly as by march_max_mip(). Rays that no margin decides continue in
// march_max_mip() and occluded_max_mip(), from the time up to which they are above. Answers therefore equal theirs bit
// for bit.
//
// Source: T. Aila, S. Laine, "Understanding the efficiency of ray traversal on GPUs", HPG 2009 (refilled lanes,
// postponed leaves); the traversal is that of max_mip.h. Cost: no memory besides the pyramid; pays off from about 32
// rays on. Rays over less than a cell are traced by march_max_mip() and occluded_max_mip() (short_rays.h).
#pragma once

#include <cstdint>
#include <span>

#include "scarp/march/height/height_target.h"

namespace scarp {

/// Optimisations that can be disabled to measure their gain (`scarp-bench simd`). They do not change answers.
struct VectorOptions {
  bool refill = true;     ///< refill lanes when some rays are finished, not when all are
  bool wait = true;       ///< lanes at cells wait until enough of them do
  bool doubles = true;    ///< rays that start over the field: first cells in double
  bool put_off = true;    ///< any hit: decides a doubtful cell only if nothing behind it stops the ray
  bool find_hits = true;  ///< closest hit: computed for many rays at once
  bool beam = true;       ///< closest hit: 64 consecutive rays from above start together
  bool together = true;   ///< closest hit, with `beam`: rays from one point traverse the same blocks together
};

/// Sets hits[i] to march_max_mip() of rays[i], bit for bit. Runs on the calling thread; the spans have equal lengths
/// below 2^31.
void closest_hits_max_mip_simd(const HeightTarget& target, std::span<const Ray> rays, std::span<Hit> hits);
void closest_hits_max_mip_simd(const HeightTarget& target, std::span<const Ray> rays, std::span<Hit> hits,
                               const VectorOptions& options);

/// Sets blocked[i] to 1 if occluded_max_mip() of rays[i] is true, else to 0.
void occluded_max_mip_simd(const HeightTarget& target, std::span<const Ray> rays, std::span<std::uint8_t> blocked);
void occluded_max_mip_simd(const HeightTarget& target, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                           const VectorOptions& options);

/// Counters of the vector code on this thread since the last query.
struct VectorStats {
  std::uint64_t block_lanes = 0, block_steps = 0;  ///< steps of rays, and of vectors times their lanes
  std::uint64_t cell_lanes = 0, cell_steps = 0;    ///< the same for cell tests
  std::uint64_t handed_over = 0;                   ///< rays that the scalar traversal continued
  std::uint64_t beam_rays = 0;                     ///< rays that a beam advanced
  std::uint64_t together_rays = 0;                 ///< rays that shared their blocks
};
VectorStats take_vector_stats();

}  // namespace scarp
