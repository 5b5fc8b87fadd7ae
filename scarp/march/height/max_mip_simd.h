// SPDX-License-Identifier: MIT
// `max-mip` for many rays at once, in single precision, one ray per lane of a vector.
//
//   lanes    r0 r1 r2 ... r15     each at a block, a level, a time of its own; a step: where does the ray leave the
//            |  |  |       |      block, is it above all of it? On to the next block, or one level down
//   cells    . r1 .  ... r14      lanes that have come down to a cell wait for company, then four samples are fetched
//   done     r0 .  r2 ... .       lanes that are done wait for company, too, then get the next rays
//
// Rays of a camera start together, deep in the field: max_mip_simd_beam.h.
//
// What the vectors say is proven, for single precision with a margin, in first cells for double (doc/dev/numerics.md):
// that a ray is above the ground up to a time, or that it is above at one time and below at a later one. Any-hit needs
// no more. The closest hit is computed as march_max_mip() computes it, in double; what no margin decides goes to
// march_max_mip() and occluded_max_mip(), from the time on up to which the ray is above. So the answers are theirs, bit
// for bit.
//
// Source: T. Aila, S. Laine, "Understanding the efficiency of ray traversal on GPUs", HPG 2009 (lanes that are
// refilled, leaves put off); the walk is that of max_mip.h. Cost: none per field but the pyramid; pays from some 32
// rays on.
#pragma once

#include <cstdint>
#include <span>

#include "scarp/march/height/height_target.h"

namespace scarp {

/// The ideas that make it fast, each of which can be left out to see what it gains (`scarp-bench simd`). The answers
/// are the same.
struct VectorIdeas {
  bool refill = true;     ///< lanes get new rays when some are done, not when all are
  bool wait = true;       ///< lanes at cells wait for company
  bool doubles = true;    ///< rays that begin over the field: their first cells in double
  bool put_off = true;    ///< any-hit: a doubtful cell is decided only if nothing stops the ray behind it
  bool find_hits = true;  ///< closest hit: computed for many rays at once
  bool beam = true;       ///< closest hit: rays that come from above together start together
};

/// hits[i] is march_max_mip() of rays[i], bit for bit. On the calling thread; the spans have the same length, below
/// 2^31.
void closest_hits_max_mip_simd(const HeightTarget& target, std::span<const Ray> rays, std::span<Hit> hits);
void closest_hits_max_mip_simd(const HeightTarget& target, std::span<const Ray> rays, std::span<Hit> hits,
                               const VectorIdeas& ideas);

/// blocked[i] is 1 where occluded_max_mip() of rays[i] is true, else 0.
void occluded_max_mip_simd(const HeightTarget& target, std::span<const Ray> rays, std::span<std::uint8_t> blocked);
void occluded_max_mip_simd(const HeightTarget& target, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                           const VectorIdeas& ideas);

/// What the vectors did on this thread since it was last asked.
struct VectorStats {
  std::uint64_t block_lanes = 0, block_steps = 0;  ///< steps of rays, and of vectors times their lanes
  std::uint64_t cell_lanes = 0, cell_steps = 0;    ///< the same for tests of cells
  std::uint64_t handed_over = 0;                   ///< rays that the scalar walk went on with
  std::uint64_t beam_rays = 0;                     ///< rays that a beam took on
};
VectorStats take_vector_stats();

}  // namespace scarp
