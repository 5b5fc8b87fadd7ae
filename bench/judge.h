// SPDX-License-Identifier: MIT
// Accuracy of an engine: its answers to a random sample of a set's rays, compared with those of `exhaustive`.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "bench/engine.h"
#include "scarp/march/height/height_target.h"

namespace scarp::bench {

/// Tolerance of the position of a hit along the ray, in cells.
constexpr double kNear = 1.0;

struct Judgement {
  std::int64_t judged = 0;  ///< rays in the sample
  double miss_rate = 0;     ///< fraction of the judge's hits that the engine does not report
  double false_rate = 0;    ///< fraction of the judge's misses that the engine reports as hits
  std::optional<double>
      error_p99;          ///< 99th percentile of |t - t of the judge| in cells where both hit; null: neither does
  double wrong_rate = 0;  ///< fraction of all rays where one reports a hit and the other does not
  double late_rate =
      0;  ///< fraction of the judge's hits that are reported more than kNear behind: the first hit was lost
  double early_rate = 0;  ///< the same, in front of it
  double off_rate = 0;    ///< fraction of all rays that are wrong, late or early
  double exhausted = 0;   ///< fraction of rays on which the engine gave up; they count as not reported
  double steps = 0;       ///< mean positions evaluated per ray, MarchStats::steps
  double cell_tests = 0;  ///< mean cells intersected per ray
};

/// Whether an engine has the positions of the hits: at most `limit` of the judge's hits are lost or off by more than
/// kNear, and at most as many of its misses are hits.
bool has_positions(const Judgement& judged, double limit);

class Judge {
 public:
  /// Runs the judge, on all threads.
  Judge(const HeightTarget& target, const RaySet& set, std::int64_t sample_size, std::uint64_t seed);

  /// For engines that have `closest` and `blocked`. For any-hit sets, the answer comes from `blocked`, t and the cost
  /// from `closest`.
  Judgement judge(const Engine& engine) const;
  /// For engines that take fans, over a set that is a fan.
  Judgement judge_fan(const Engine& engine) const;

  /// Indices of the sample's rays in the set, ascending.
  const std::vector<std::size_t>& sample() const { return sample_; }
  /// An engine's answer to a ray. A t that is not finite is not compared.
  struct Answer {
    bool hit, exhausted;
    double t;
    MarchStats stats;
  };
  /// The same for engines that have already answered the sample, in its order.
  Judgement score(const std::vector<Answer>& answers) const;

 private:
  const RaySet& set_;
  std::vector<std::size_t> sample_;
  std::vector<Hit> truth_;
};

}  // namespace scarp::bench
