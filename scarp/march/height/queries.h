// SPDX-License-Identifier: MIT
// Batch queries over a height field, and validation of rays.
//
//   rays in   [ r0 r1 r2 r3 ... ]        hits[i] belongs to rays[i]; the rays are
//   hits out  [ h0 h1 h2 h3 ... ]        traced in any order
//
// One call traces all rays, on all threads. Large batches of unordered rays over large fields are traced in the order
// of the ground below their origins, so that consecutive rays use nearby memory; ground_order.h defines when. Marches
// with SIMD code (max_mip_simd.h) use it for batches, with bit-identical results. max-mip traces rays from one origin
// together if they are arranged in rows or columns, as those of a camera or a scanner are (fan_batch.h).
#pragma once

#include <cstdint>
#include <span>

#include "scarp/march/height/height_table.h"

namespace scarp {

/// Sets hits[i] to march.cpu(target, rays[i], settings), bit for bit. Throws Error if the spans differ in length.
void closest_hits(const HeightTarget& target, std::span<const Ray> rays, std::span<Hit> hits,
                  const HeightMarchEntry& march = find_height_march("max-mip"), const MarchSettings& settings = {});

/// Sets blocked[i] to 1 if closest_hits() would return a hit, else to 0. Throws Error if the spans differ in length.
void occluded(const HeightTarget& target, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
              const HeightMarchEntry& march = find_height_march("max-mip"), const MarchSettings& settings = {});

/// Throws Error if a ray is not valid: an origin or direction that is not finite, a direction of zero, a t_min that is
/// not finite, a t_max that is NaN or less than t_min.
void validate(const Ray& ray);
/// As above. Also throws Error for an infinite t_max in a field that wraps, and for a start cell that does not exist or
/// is a hole.
void validate(const Ray& ray, const HeightField& field);

}  // namespace scarp
