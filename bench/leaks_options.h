// SPDX-License-Identifier: MIT
// Options of `scarp-bench leaks`, with and without --fans.
#pragma once

#include <cstdint>
#include <string>

#include "bench/report.h"

namespace scarp::bench {

/// `leaks`: rays of the kinds that engines lose, each judged.
struct LeaksOptions {
  std::int64_t rays = 10'000'000;
  std::uint64_t seed = 1;
  int large = 2049;                       ///< side of the large field, in samples
  std::int64_t judge_every = 4096;        ///< one in this many rays over a small field is also traced by exhaustive
  std::int64_t embree_rays = 10'000'000;  ///< approximate maximum of rays also traced by Embree; 0: none
  std::string dump;                       ///< file for the first failing rays; empty: leaks-SEED.txt
  bool fans = false;                      ///< instead: fans compared with the scalar march
  double fan_margin = 1;                  ///< factor of their margin; below 1, hits may be lost
};
/// Throws Error, after the report, when a ray was lost, false or contradictory.
void run_fan_leaks(const LeaksOptions& options, const ReportOptions& report);

}  // namespace scarp::bench
