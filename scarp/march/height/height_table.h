// SPDX-License-Identifier: MIT
// The marches of height fields.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "scarp/march/height/height_target.h"
#include "scarp/march/hit_rules.h"
#include "scarp/march/march_entry.h"
#include "scarp/march/march_settings.h"

namespace scarp {

struct MarchTrace;  // base/march_trace.h

/// Returns the closest hit of a ray in world space. Overwrites `stats` unless null.
using HeightMarch = Hit (*)(const HeightTarget& target, const Ray& ray, const MarchSettings& settings,
                            MarchStats* stats);
/// Returns whether the status of the closest hit is `hit`.
using HeightOcclusion = bool (*)(const HeightTarget& target, const Ray& ray, const MarchSettings& settings);

/// The two above for many rays, on the calling thread; the answers are bit-identical to those for single rays. The
/// spans have the same length.
using HeightMarchBatch = void (*)(const HeightTarget& target, std::span<const Ray> rays, std::span<Hit> hits,
                                  const MarchSettings& settings);
using HeightOcclusionBatch = void (*)(const HeightTarget& target, std::span<const Ray> rays,
                                      std::span<std::uint8_t> blocked, const MarchSettings& settings);

/// Replaces `hits` by all hits in the ray's range, in order of t. Returns `hit`, or why there is none.
using HeightAllHits = HitStatus (*)(const HeightTarget& target, const Ray& ray, std::vector<Hit>& hits);

using HeightMarchByRules = Hit (*)(const HeightTarget& target, const Ray& ray, const HitRules& rules,
                                   MarchStats* stats);

/// The closest hit; `trace` receives the steps of the march. Overwrites `stats` unless null.
using HeightMarchTraced = Hit (*)(const HeightTarget& target, const Ray& ray, const MarchSettings& settings,
                                  MarchStats* stats, MarchTrace& trace);

/// A row of the table. Only `by_rules`, `all_hits` and `traced` may be null: a technique without its own any-hit or
/// batch query gets one based on `cpu`.
struct HeightMarchEntry : MarchEntry {
  bool needs_pyramid = false;               ///< HeightTarget::pyramid must be given
  bool needs_slope = false;                 ///< HeightTarget::slope must be given
  bool own_any_hit = false;                 ///< `occluded` is a separate query, not based on `cpu`
  HeightFields fields = HeightFields::all;  ///< require_field() rejects others
  /// Whether a ray that starts or enters below the ground is followed to later hits; otherwise it is `below` at once.
  bool follows_below = true;
  HeightMarch cpu = nullptr;  ///< scalar C++
  HeightOcclusion occluded = nullptr;
  HeightMarchBatch batch = nullptr;  ///< in vectors if `simd`
  HeightOcclusionBatch occluded_batch = nullptr;
  bool fans = false;  ///< batches of rays from one origin are answered by fan_batch.h where that is faster
  /// The closest of the hits that count; null: the march finds hits from above only, and takes no filter.
  HeightMarchByRules by_rules = nullptr;
  /// All hits in order of t; null: the march finds the closest one only.
  HeightAllHits all_hits = nullptr;
  HeightMarchTraced traced = nullptr;  ///< null if the march records nothing
};

/// The oracle, `exhaustive`, comes first.
std::span<const HeightMarchEntry> height_marches();
/// Throws Error listing the names if the march is unknown.
const HeightMarchEntry& find_height_march(std::string_view name);

}  // namespace scarp
