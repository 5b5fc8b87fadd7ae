// SPDX-License-Identifier: MIT
// How time is taken: every engine warmed up by a whole pass, then passes of all engines in turn (A, B, C, A, B, C,
// ...), so that what disturbs the machine disturbs all of them; the median counts.
#pragma once

#include <cstdint>
#include <vector>

#include "bench/engine.h"

namespace scarp::bench {

/// Seconds since it was made: on the wall, and of processor time of all threads of this process.
class Stopwatch {
 public:
  Stopwatch();
  double wall_s() const;
  double cpu_s() const;

 private:
  std::int64_t wall_ns_, cpu_ns_;
};

/// The middle one; of two middle ones the lower. Not empty.
double median(std::vector<double> values);

struct ProtocolOptions {
  int threads = 1;
  int repeats = 3;
  double pass_limit_s = 10;  ///< a slower engine traces a subset: blocks of rays spread evenly over the set
};

/// What one engine did with one set of rays.
struct Timing {
  double mrays_per_s = 0;  ///< median pass, by the wall clock
  double mrays_per_cpu_s =
      0;              ///< median pass, by the processor time of all threads: what others on the machine disturb least
  double spread = 0;  ///< (slowest - fastest pass) / median pass, by the wall clock
  double busy = 0;    ///< processor time / (wall time * threads) of all counted passes; well below 1: not alone
  std::int64_t rays = 0;  ///< traced per pass
  std::int64_t hits = 0;
  bool in_full = true;  ///< false: the pass of a trial, of an engine that is not among the fastest
};

/// One Timing per engine. All engines get the same threads, blocks and repeats.
std::vector<Timing> measure(const std::vector<Engine>& engines, const RaySet& set, const ProtocolOptions& options);

/// The same, but of the engines on trial only the kFinalists fastest by processor time are measured by `options`. The
/// trial is one pass of at most kTrialPass_s (at least 16 blocks) after as long a warm-up.
constexpr std::size_t kFinalists = 3;
constexpr double kTrialPass_s = 0.05;
std::vector<Timing> measure_fastest(const std::vector<Engine>& engines, const RaySet& set,
                                    const ProtocolOptions& options);

}  // namespace scarp::bench
