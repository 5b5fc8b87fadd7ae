// SPDX-License-Identifier: MIT
// Batches whose rays share an origin and stand in rows or columns, as cameras and scanners give them. They are followed
// together as a fan (max_mip_fan.h), and each hit is then computed in double: answers are those of single rays.
//
//   a camera, row by row:        0 1 2 3 4 5    a scanner, firing by firing:    0 3 6 9
//                                6 7 8 9 ...                                    1 4 7 ...
//                                                                               2 5 8
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "scarp/base/ray.h"
#include "scarp/march/height/height_target.h"
#include "scarp/march/height/max_mip_fan.h"

namespace scarp {

struct FanBatch {
  std::size_t run = 0;   ///< number of consecutive rays that are a row, or a column
  bool columns = false;  ///< consecutive rays are a column
};

/// Looks at one run. Returns nullopt if it finds none, and if rays look straight down, which inherit nothing from one
/// another.
std::optional<FanBatch> find_fan(std::span<const Ray> rays);
/// Whether a ray is free, from this origin and from t = 0, and floats hold its direction.
bool is_of_fan(const Ray& ray, const dvec3& origin);
/// As find_fan(). Tries up to 1,536 other rays, and also returns nullopt if a fan over this ground is not likely to be
/// faster.
std::optional<FanBatch> fan_batch(const HeightTarget& target, std::span<const Ray> rays);
/// `always`: also where a batch is likely to be faster.
std::optional<FanBatch> fan_batch(const HeightTarget& target, std::span<const Ray> rays, const FanOptions& options);

/// hits[i] is march_max_mip() of rays[i], bit for bit, whatever the order of the rays: others than the batch seems to
/// have only take longer. Runs on all threads. The target is the one that fan_batch() accepted.
void closest_hits_in_fan(const HeightTarget& target, const FanBatch& batch, std::span<const Ray> rays,
                         std::span<Hit> hits);

}  // namespace scarp
