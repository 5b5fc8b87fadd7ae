// SPDX-License-Identifier: MIT
#include "bench/protocol.h"
#include "bench/rays.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numeric>

#include "scarp/base/parallel.h"

namespace scarp::bench {
namespace {

constexpr std::int64_t kBlock = 4096;  // rays per task
// The same for fans, which are cut into strips of 16 columns only.
std::int64_t rays_per_block(const Engine& engine, const RaySet& set) {
  if (!engine.in_fans) return kBlock;
  const std::int64_t strip = 16 * std::int64_t{set.fan.rows};
  return std::max<std::int64_t>(1, kBlock / strip) * strip;
}
constexpr std::int64_t kProbedBlocks = 16;

std::int64_t nanoseconds(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

// Rays in blocks: all blocks, or some that are spread evenly.
struct Selection {
  std::int64_t ray_count, size, blocks, all_blocks;  // size: rays per block

  Selection(const Engine& engine, const RaySet& set)
      : ray_count(set.size()),
        size(rays_per_block(engine, set)),
        blocks((ray_count + size - 1) / size),
        all_blocks(blocks) {}

  std::int64_t begin(std::int64_t block) const { return block * all_blocks / blocks * size; }
  std::int64_t end(std::int64_t block) const { return std::min(begin(block) + size, ray_count); }
  std::int64_t rays() const {
    std::int64_t sum = 0;
    for (std::int64_t block = 0; block < blocks; ++block) sum += end(block) - begin(block);
    return sum;
  }
};

void trace(const Engine& engine, const RaySet& set, const Selection& selection, float* answers) {
  parallel_for(selection.blocks, 1, [&](std::int64_t first, std::int64_t last) {
    for (std::int64_t block = first; block < last; ++block) {
      engine.trace(set, selection.begin(block), selection.end(block), answers + block * selection.size);
    }
  });
}

std::int64_t count_hits(const Selection& selection, const std::vector<float>& answers) {
  std::int64_t hits = 0;
  for (std::int64_t block = 0; block < selection.blocks; ++block) {
    const float* from = answers.data() + block * selection.size;
    hits +=
        std::count_if(from, from + (selection.end(block) - selection.begin(block)), [](float t) { return t != kMiss; });
  }
  return hits;
}

}  // namespace

Stopwatch::Stopwatch() : wall_ns_(nanoseconds(CLOCK_MONOTONIC)), cpu_ns_(nanoseconds(CLOCK_PROCESS_CPUTIME_ID)) {}
double Stopwatch::wall_s() const { return static_cast<double>(nanoseconds(CLOCK_MONOTONIC) - wall_ns_) * 1e-9; }
double Stopwatch::cpu_s() const { return static_cast<double>(nanoseconds(CLOCK_PROCESS_CPUTIME_ID) - cpu_ns_) * 1e-9; }

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<Timing> measure(const std::vector<Engine>& engines, const RaySet& set, const ProtocolOptions& options) {
  const ThreadLimit limit(options.threads);
  std::vector<float> answers;
  std::vector<Timing> timings(engines.size());
  std::vector<Selection> selections;
  for (const Engine& engine : engines) {
    const Selection& whole = selections.emplace_back(engine, set);
    answers.resize(std::max(answers.size(), static_cast<std::size_t>(whole.blocks * whole.size)));
  }

  // A few blocks show how long a pass would take. The warm-up follows, whose answers are counted.
  for (std::size_t e = 0; e < engines.size(); ++e) {
    const Selection whole = selections[e];
    Selection probe = whole;
    probe.blocks = std::min(whole.blocks, kProbedBlocks);
    const Stopwatch watch;
    trace(engines[e], set, probe, answers.data());
    const double pass_s = watch.wall_s() * static_cast<double>(whole.blocks) / static_cast<double>(probe.blocks);
    if (pass_s > options.pass_limit_s) {
      const double affordable = static_cast<double>(whole.blocks) * options.pass_limit_s / pass_s;
      selections[e].blocks = std::clamp(static_cast<std::int64_t>(affordable), probe.blocks, whole.blocks);
    }
    trace(engines[e], set, selections[e], answers.data());
    timings[e].rays = selections[e].rays();
    timings[e].hits = count_hits(selections[e], answers);
  }

  std::vector<std::vector<double>> wall(engines.size()), cpu(engines.size());
  for (int repeat = 0; repeat < options.repeats; ++repeat) {
    for (std::size_t e = 0; e < engines.size(); ++e) {
      const Stopwatch watch;
      trace(engines[e], set, selections[e], answers.data());
      cpu[e].push_back(watch.cpu_s());
      wall[e].push_back(watch.wall_s());
    }
  }
  for (std::size_t e = 0; e < engines.size(); ++e) {
    const double mrays = static_cast<double>(timings[e].rays) * 1e-6;
    const auto [fastest, slowest] = std::minmax_element(wall[e].begin(), wall[e].end());
    timings[e].mrays_per_s = mrays / median(wall[e]);
    timings[e].mrays_per_cpu_s = mrays / median(cpu[e]);
    timings[e].spread = (*slowest - *fastest) / median(wall[e]);
    timings[e].busy = std::accumulate(cpu[e].begin(), cpu[e].end(), 0.0) /
                      (std::accumulate(wall[e].begin(), wall[e].end(), 0.0) * options.threads);
  }
  return timings;
}

std::vector<Timing> measure_fastest(const std::vector<Engine>& engines, const RaySet& set,
                                    const ProtocolOptions& options) {
  std::vector<std::size_t> on_trial, finalists;
  for (std::size_t e = 0; e < engines.size(); ++e) (engines[e].on_trial ? on_trial : finalists).push_back(e);
  const auto measured = [&](const std::vector<std::size_t>& which, const ProtocolOptions& how) {
    std::vector<Engine> some;
    for (const std::size_t e : which) some.push_back(engines[e]);
    return measure(some, set, how);
  };
  std::vector<Timing> timings(engines.size());
  const std::vector<Timing> trial =
      measured(on_trial, {options.threads, 1, std::min(kTrialPass_s, options.pass_limit_s)});
  for (std::size_t i = 0; i < on_trial.size(); ++i) {
    timings[on_trial[i]] = trial[i];
    timings[on_trial[i]].in_full = false;
  }
  std::stable_sort(on_trial.begin(), on_trial.end(), [&](std::size_t a, std::size_t b) {
    return timings[a].mrays_per_cpu_s > timings[b].mrays_per_cpu_s;
  });
  on_trial.resize(std::min(on_trial.size(), kFinalists));
  finalists.insert(finalists.end(), on_trial.begin(), on_trial.end());
  const std::vector<Timing> final = measured(finalists, options);
  for (std::size_t i = 0; i < finalists.size(); ++i) timings[finalists[i]] = final[i];
  return timings;
}

}  // namespace scarp::bench
