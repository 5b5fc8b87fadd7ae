// SPDX-License-Identifier: MIT
// `scarp-bench function-leaks`: traces a large number of rays over terrain functions and judges each by interval
// bisection: the conservative marches must not lose any.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <string>
#include <vector>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/random.h"
#include "bench/report.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/march/function/function_exhaustive.h"
#include "scarp/march/function/function_table.h"
#include "scarp/scene/file/example_functions.h"

namespace scarp::bench {
namespace {

// `function-leaks`: the conservative marches over the example functions, every ray judged.
struct FunctionLeaksOptions {
  std::int64_t rays = 1'000'000;  // total
  std::uint64_t seed = 1;
  bool all = false;  // the approximate marches as well
};

using Json = nlohmann::ordered_json;

constexpr std::int64_t kRaysPerPiece = 256;

// Eyes close to the ground and high above it; rays along the ground, up and down, of any length.
Ray random_ray(const HeightFunction& function, Random& random) {
  const double x = random.uniform(-20000, 20000), y = random.uniform(-20000, 20000);
  const double azimuth = random.uniform(0, 6.283185307179586);
  const bool near = random.below(4) == 0, level = random.below(2) == 0;
  const double above = near ? random.uniform(0.001, 2) : random.uniform(2, 400);
  const double rise = level ? random.uniform(-0.05, 0.05) : random.uniform(-1, 0.2);
  const double scale = std::exp2(random.uniform(-4, 4));
  Ray ray;
  ray.origin = {x, y, function.value(x, y) + above};
  ray.direction = dvec3(std::cos(azimuth), std::sin(azimuth), rise) * scale;
  ray.t_max = 10000 / scale;
  return ray;
}

struct Counts {
  std::int64_t hits = 0, lost = 0, false_hits = 0, exhausted = 0, below = 0;
  Counts& operator+=(const Counts& c) {
    hits += c.hits, lost += c.lost, false_hits += c.false_hits, exhausted += c.exhausted, below += c.below;
    return *this;
  }
};

// `tolerance`: the fraction of the distance within which crossings count as one, and a hit as a touch.
void count(const FunctionJudgement& judge, const Ray& ray, const Hit& hit, double tolerance, Counts& counts) {
  counts.hits += bool(hit);
  counts.exhausted += hit.status == HitStatus::exhausted;
  counts.below += hit.status == HitStatus::below;  // no ray starts below ground
  if (judge.verdict == FunctionVerdict::crossing) {
    const bool passed = hit && hit.t > judge.crossed_by + tolerance * (hit.t - ray.t_min);
    counts.lost += hit.status == HitStatus::miss || passed;
  }
  // A hit in front of the ground does not lose the ground, but is false if the ground is beyond the tolerance.
  const double early = 2 * tolerance * (hit.t - ray.t_min);
  counts.false_hits += hit && hit.t < judge.clear_until - early;
}

struct Row {
  std::int64_t crossings = 0, clear = 0, undecided = 0;
  std::vector<Counts> marches;
};

// Throws Error, after the report, if a conservative march was wrong.
void run_function_leaks(const FunctionLeaksOptions& options, const ReportOptions& report) {
  std::vector<const FunctionMarchEntry*> marches;
  for (const FunctionMarchEntry& march : function_marches()) {
    if (options.all || march.guarantee == Guarantee::conservative) marches.push_back(&march);
  }
  MarchSettings settings;
  settings.lipschitz.max_steps = settings.lipschitz_local.max_steps = 1 << 20;
  Json rows = Json::array();
  std::vector<std::vector<std::string>> lines{
      {"function", "march", "rays", "crossings", "clear", "undecided", "hits", "lost", "false", "below", "exhausted"}};
  std::int64_t wrong = 0;
  const auto functions = example_functions();
  const std::int64_t each = std::max<std::int64_t>(1, options.rays / static_cast<std::int64_t>(functions.size()));
  for (std::size_t f = 0; f < functions.size(); ++f) {
    const HeightFunction function(example_function(functions[f].name));
    Row row{.marches = std::vector<Counts>(marches.size())};
    std::mutex mutex;
    parallel_for(each, kRaysPerPiece, [&](std::int64_t begin, std::int64_t end) {
      Row mine{.marches = std::vector<Counts>(marches.size())};
      for (std::int64_t i = begin; i < end; ++i) {
        Random random(options.seed + f, static_cast<std::uint64_t>(i));
        const Ray ray = random_ray(function, random);
        const FunctionJudgement judge = judge_function(function.function(), ray);
        mine.crossings += judge.verdict == FunctionVerdict::crossing;
        mine.clear += judge.verdict == FunctionVerdict::clear;
        mine.undecided += judge.verdict == FunctionVerdict::undecided;
        for (std::size_t m = 0; m < marches.size(); ++m) {
          const Hit hit = marches[m]->cpu(function, ray, settings, nullptr, FunctionUse::march);
          const bool local = marches[m]->name == "lipschitz-local";
          // All other marches have their own tolerance above the ground: only passing through the ground is wrong.
          count(judge, ray, hit, local ? settings.lipschitz_local.tolerance : 0, mine.marches[m]);
          if (!local) mine.marches[m].false_hits = 0;
        }
      }
      const std::lock_guard lock(mutex);
      row.crossings += mine.crossings, row.clear += mine.clear, row.undecided += mine.undecided;
      for (std::size_t m = 0; m < marches.size(); ++m) row.marches[m] += mine.marches[m];
    });
    for (std::size_t m = 0; m < marches.size(); ++m) {
      const Counts& c = row.marches[m];
      if (marches[m]->guarantee == Guarantee::conservative) wrong += c.lost + c.false_hits + c.below;
      rows.push_back({{"function", functions[f].name},
                      {"march", marches[m]->name},
                      {"rays", each},
                      {"crossings", row.crossings},
                      {"clear", row.clear},
                      {"undecided", row.undecided},
                      {"hits", c.hits},
                      {"lost", c.lost},
                      {"false", c.false_hits},
                      {"below", c.below},
                      {"exhausted", c.exhausted},
                      {"seed", options.seed}});
      std::vector<std::string> line{std::string(functions[f].name), std::string(marches[m]->name)};
      for (const std::int64_t n :
           {each, row.crossings, row.clear, row.undecided, c.hits, c.lost, c.false_hits, c.below, c.exhausted}) {
        line.push_back(fmt::format("{}", n));
      }
      lines.push_back(std::move(line));
    }
  }
  print_table(lines, 2);
  write_json(report, rows);
  if (wrong > 0) throw Error("function-leaks: a conservative march was wrong; see lost, false and below in the table");
}

}  // namespace

void add_function_leaks(cli::Program& program) {
  auto [command, o] = add_command<FunctionLeaksOptions>(
      program, "function-leaks", "Very many rays at terrain functions; fails if Scarp loses one", run_function_leaks);
  command.add(&o.rays, {.names = "--rays", .help = "rays in all", .range = {1, 1e15}});
  command.add(&o.seed, {.names = "--seed", .help = "seed of the rays"});
  command.add(&o.all, {.names = "--all", .help = "the approximate marches as well"});
}

}  // namespace scarp::bench
