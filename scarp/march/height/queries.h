// SPDX-License-Identifier: MIT
// Rays by the batch, and the check of rays that come from outside.
//
//   rays in   [ r0 r1 r2 r3 ... ]        the answers stand where their rays stand, whatever the order
//   hits out  [ h0 h1 h2 h3 ... ]        in which they were found
//
// One call answers all rays, on all threads. Large batches of rays without order over large fields are answered in the
// order of the ground that they begin over, so that neighbours in time are neighbours in memory; ground_order.h says
// when. Marches that have vectors (max_mip_simd.h) answer batches by them, with the same bits.
#pragma once

#include <cstdint>
#include <span>

#include "scarp/march/height/height_table.h"

namespace scarp {

/// hits[i] is march.cpu(target, rays[i], settings), bit for bit. Throws Error when the spans differ in length.
void closest_hits(const HeightTarget& target, std::span<const Ray> rays, std::span<Hit> hits,
                  const HeightMarchEntry& march = find_height_march("max-mip"), const MarchSettings& settings = {});

/// blocked[i] is 1 where closest_hits would tell a hit, else 0. Throws Error when the spans differ in length.
void occluded(const HeightTarget& target, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
              const HeightMarchEntry& march = find_height_march("max-mip"), const MarchSettings& settings = {});

/// Throws Error, in one line, when a ray cannot be followed over any field: an origin or direction that is not finite,
/// a direction of zero, a range that is not one.
void validate(const Ray& ray);
/// Likewise over this field: also for an infinite t_max in a field that wraps round, a start cell that does not exist
/// or is a hole.
void validate(const Ray& ray, const HeightField& field);

}  // namespace scarp
