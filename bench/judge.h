// SPDX-License-Identifier: MIT
// How right an engine is: its answers to a random sample of a set's rays beside those of `exhaustive`.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "bench/engine.h"
#include "scarp/march/height/height_target.h"

namespace scarp::bench {

/// Along the ray, in cells: how far off a hit may be reported and still be that hit.
constexpr double kNear = 1.0;

struct Judgement {
  std::int64_t judged = 0;  ///< rays in the sample
  double miss_rate = 0;     ///< share of the judge's hits that the engine does not report
  double false_rate = 0;    ///< share of the judge's misses that the engine reports as hits
  std::optional<double>
      error_p99;          ///< 99th percentile of |t - t of the judge| in cells where both hit; null: neither does
  double wrong_rate = 0;  ///< share of all rays where one reports a hit and the other does not
  double late_rate =
      0;  ///< share of the judge's hits that are reported, but more than kNear behind: the first hit was lost
  double early_rate = 0;  ///< the same before it
  double off_rate = 0;    ///< share of all rays that are wrong, late or early
  double exhausted = 0;   ///< share of rays that the engine gave up; they count as not reported
  double steps = 0;       ///< mean positions looked at per ray, MarchStats::steps
  double cell_tests = 0;  ///< mean cells intersected per ray
};

class Judge {
 public:
  /// Asks the judge, on all threads.
  Judge(const HeightTarget& target, const RaySet& set, std::int64_t sample_size, std::uint64_t seed);

  /// For engines that have `closest` and `blocked`. Where the set only asks whether rays are blocked, the answer comes
  /// from `blocked`, t and the cost from `closest`.
  Judgement judge(const Engine& engine) const;
  /// For engines that take fans, over a set that is one.
  Judgement judge_fan(const Engine& engine) const;

  /// Indices of the sample's rays in the set, rising.
  const std::vector<std::size_t>& sample() const { return sample_; }
  /// What an engine said of a ray. A t that is not finite is not compared.
  struct Answer {
    bool hit, exhausted;
    double t;
    MarchStats stats;
  };
  /// The same for engines that have answered the sample, in its order.
  Judgement score(const std::vector<Answer>& answers) const;

 private:
  const RaySet& set_;
  std::vector<std::size_t> sample_;
  std::vector<Hit> truth_;
};

}  // namespace scarp::bench
