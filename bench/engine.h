// SPDX-License-Identifier: MIT
// The subject of the protocol: an engine that traces batches of rays.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "bench/rays.h"
#include "scarp/base/ray.h"

namespace scarp::bench {

/// The answer to a ray: t of the hit, kMiss, or kBlocked if the query was any-hit.
constexpr float kMiss = std::numeric_limits<float>::infinity();
constexpr float kBlocked = -std::numeric_limits<float>::infinity();

struct Engine {
  std::string name;       ///< "scarp", "embree-tri", "embree-grid"
  std::string mode;       ///< the march, or one of Embree's (bench/embree_modes.h)
  double bytes = 0;       ///< memory that tracing needs: samples or vertices, and the acceleration structure
  double peak_bytes = 0;  ///< peak memory during the build
  double build_s = 0;     ///< time from samples to readiness for tracing
  /// Whether it is one of many variants, which are timed in full only if they are among the fastest in a short trial.
  bool on_trial = false;
  /// Whether it takes RaySet::fan: rays are numbered as in the fan, and `begin` and `end` are bounds of strips of 16
  /// columns.
  bool in_fans = false;
  /// Answers rays [begin, end) of a set, begin a multiple of 16, into answers[0 ...]. Called from several threads.
  std::function<void(const RaySet& set, std::int64_t begin, std::int64_t end, float* answers)> trace;

  // For the judge; null for peers, whose surface differs.
  std::function<Hit(const Ray& ray, MarchStats& stats)> closest;  ///< result of the closest-hit function
  std::function<bool(const Ray& ray)> blocked;  ///< result of the function that `trace` uses for any_hit
};

}  // namespace scarp::bench
