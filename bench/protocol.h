// SPDX-License-Identifier: MIT
// Time measurement: each engine is warmed up by a whole pass, then passes of all engines take turns (A, B, C, A, B, C,
// ...), so that disturbances of the machine affect all of them; the median counts.
#pragma once

#include <cstdint>
#include <vector>

#include "bench/engine.h"

namespace scarp::bench {

/// Seconds since construction: wall-clock time, and processor time of all threads of this process.
class Stopwatch {
 public:
  Stopwatch();
  double wall_s() const;
  double cpu_s() const;

 private:
  std::int64_t wall_ns_, cpu_ns_;
};

/// The median, or the lower of two middle values. `values` must not be empty.
double median(std::vector<double> values);

struct ProtocolOptions {
  int threads = 1;
  int repeats = 3;
  double pass_limit_s = 10;  ///< a slower engine traces a subset: blocks of rays spread evenly over the set
};

/// Measurements of one engine with one set of rays.
struct Timing {
  double mrays_per_s = 0;      ///< median pass, by the wall clock
  double mrays_per_cpu_s = 0;  ///< median pass, by the processor time of all threads: least affected by other processes
  double spread = 0;           ///< (slowest - fastest pass) / median pass, by the wall clock
  double busy =
      0;  ///< processor time / (wall time * threads) of all counted passes; well below 1: other processes were running
  std::int64_t rays = 0;  ///< traced per pass
  std::int64_t hits = 0;
  bool in_full = true;  ///< false: only a trial pass, because the engine is not among the fastest
};

/// One Timing per engine. All engines get the same threads, blocks and repeats.
std::vector<Timing> measure(const std::vector<Engine>& engines, const RaySet& set, const ProtocolOptions& options);

/// As above, but only the kFinalists fastest of the trial engines, by processor time, are measured by `options`. The
/// trial is one pass of at most kTrialPass_s (at least 16 blocks) after as long a warm-up.
constexpr std::size_t kFinalists = 3;
constexpr double kTrialPass_s = 0.05;
std::vector<Timing> measure_fastest(const std::vector<Engine>& engines, const RaySet& set,
                                    const ProtocolOptions& options);

}  // namespace scarp::bench
