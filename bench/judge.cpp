// SPDX-License-Identifier: MIT
#include "bench/judge.h"

#include <algorithm>
#include <cmath>

#include "bench/random.h"
#include "bench/rays.h"
#include "scarp/base/parallel.h"
#include "scarp/march/height/exhaustive.h"

namespace scarp::bench {
namespace {

constexpr std::int64_t kRaysPerPiece = 64;

double share(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
}

}  // namespace

bool has_positions(const Judgement& judged, double limit) {
  return judged.miss_rate + judged.late_rate + judged.early_rate <= limit && judged.false_rate <= limit;
}

Judge::Judge(const HeightTarget& target, const RaySet& set, std::int64_t sample_size, std::uint64_t seed) : set_(set) {
  // Takes one ray from each of `count` equally long pieces of the set.
  const std::int64_t count = std::min(sample_size, set.size());
  for (std::int64_t i = 0; i < count; ++i) {
    const std::int64_t begin = i * set.size() / count, end = (i + 1) * set.size() / count;
    Random random(seed, static_cast<std::uint64_t>(i));
    sample_.push_back(static_cast<std::size_t>(begin + random.below(static_cast<int>(end - begin))));
  }
  truth_.resize(sample_.size());
  parallel_for(count, kRaysPerPiece, [&](std::int64_t first, std::int64_t last) {
    for (std::int64_t i = first; i < last; ++i) {
      const std::size_t k = static_cast<std::size_t>(i);
      truth_[k] = march_exhaustive(target, set.library_rays[sample_[k]]);
    }
  });
}

Judgement Judge::judge(const Engine& engine) const {
  std::vector<Answer> answers(sample_.size());
  parallel_for(static_cast<std::int64_t>(sample_.size()), kRaysPerPiece, [&](std::int64_t first, std::int64_t last) {
    for (std::int64_t i = first; i < last; ++i) {
      const std::size_t k = static_cast<std::size_t>(i);
      const Ray ray = set_.library_rays[sample_[k]];
      Answer& answer = answers[k];
      const Hit hit = engine.closest(ray, answer.stats);
      answer.hit = set_.any_hit ? engine.blocked(ray) : static_cast<bool>(hit);
      answer.exhausted = hit.status == HitStatus::exhausted;
      answer.t = hit.t;
    }
  });
  return score(answers);
}

Judgement Judge::judge_fan(const Engine& engine) const {
  std::vector<float> times(set_.rays.size());
  engine.trace(set_, 0, set_.size(), times.data());
  std::vector<Answer> answers(sample_.size());
  for (std::size_t k = 0; k < sample_.size(); ++k) {
    const float t = times[set_.fan.place[sample_[k]]];
    answers[k] = {t != kMiss, false, static_cast<double>(t), {}};
  }
  return score(answers);
}

Judgement Judge::score(const std::vector<Answer>& answers) const {
  Judgement result;
  result.judged = static_cast<std::int64_t>(sample_.size());
  std::int64_t hits = 0, missed = 0, invented = 0, late = 0, early = 0, exhausted = 0;
  double steps = 0, cell_tests = 0;
  std::vector<double> errors;
  for (std::size_t k = 0; k < sample_.size(); ++k) {
    const Answer& answer = answers[k];
    const bool hit = static_cast<bool>(truth_[k]);
    hits += hit;
    missed += hit && !answer.hit;
    invented += !hit && answer.hit;
    exhausted += answer.exhausted;
    steps += answer.stats.steps;
    cell_tests += answer.stats.cell_tests;
    if (hit && std::isfinite(answer.t) && !answer.exhausted) {
      const double behind = (answer.t - truth_[k].t) * length(set_.library_rays[sample_[k]].direction);
      late += behind > kNear;
      early += behind < -kNear;
      errors.push_back(std::abs(behind));
    }
  }
  result.miss_rate = share(missed, hits);
  result.false_rate = share(invented, result.judged - hits);
  result.wrong_rate = share(missed + invented, result.judged);
  result.late_rate = share(late, hits);
  result.early_rate = share(early, hits);
  result.off_rate = share(missed + invented + late + early, result.judged);
  result.exhausted = share(exhausted, result.judged);
  result.steps = steps / static_cast<double>(result.judged);
  result.cell_tests = cell_tests / static_cast<double>(result.judged);
  if (!errors.empty()) {
    const auto at = errors.begin() + static_cast<std::ptrdiff_t>((errors.size() - 1) * 99 / 100);
    std::nth_element(errors.begin(), at, errors.end());
    result.error_p99 = *at;
  }
  return result;
}

}  // namespace scarp::bench
