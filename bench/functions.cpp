// SPDX-License-Identifier: MIT
// `scarp-bench functions`: the marches over terrain functions, on the pixels of one picture, checked by the judge's
// proofs.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/report.h"
#include "bench/trace_options.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/field/height_function.h"
#include "scarp/march/function/function_exhaustive.h"
#include "scarp/march/function/function_table.h"
#include "scarp/march/function/presets.h"
#ifdef SCARP_BENCH_VULKAN
#include "scarp/march/function/function_queries_vk.h"
#endif

namespace scarp::bench {
namespace {

// `functions`: the marches over terrain functions, checked by proofs.
struct FunctionsOptions {
  int width = 480, height = 270;  // pixels
  int octaves = 9;                // number of octaves of the fractals
  std::uint64_t seed = 1;
  int repeats = 3;
  std::int64_t judged = 4000;  // about this many rays per function are judged
  bool presets = false;        // instead of the marches: the presets of known shaders and lipschitz-local
  std::string device;          // a Vulkan device, as in `scarp render --device`; empty: none
};

using Json = nlohmann::ordered_json;

constexpr double kFarthest = 20'000;  // maximum length of a ray in metres
constexpr double kEyeHeight = 300;    // metres above the function's ground
constexpr int kUnlimitedSteps = 1 << 20;

struct Ground {
  std::string name;
  Function function;
};

std::vector<Ground> grounds(const FunctionsOptions& options) {
  const int n = options.octaves;
  const Octaves octaves{n, n, n};
  Fractal fractal{.seed = options.seed, .octaves = octaves};
  std::vector<Ground> all{{"fbm", make_function(fractal)}};
  fractal.noise = NoiseKind::value;
  fractal.damping = 1;
  all.push_back({"fbm, damped", make_function(fractal)});
  fractal.damping = 0;
  fractal.noise = NoiseKind::simplex;
  fractal.form = FractalForm::ridged;
  all.push_back({"ridged", make_function(fractal)});
  const Function shift =
      make_function(Fractal{.seed = options.seed + 1, .wavelength = 3000, .height = 300, .octaves = {2, 2, 2}});
  all.push_back({"fbm, warped", make_function(Warp{all[0].function, shift, shift})});
  all.push_back({"sines", make_function(Sines{{{20, 700, 0.3, 0}, {8, 220, 1.3, 1}, {2, 60, 2, 2}}})});
  return all;
}

// A pinhole camera, 60 degrees wide, looking 12 degrees down.
std::vector<Ray> picture(const HeightFunction& function, const FunctionsOptions& options) {
  const double pitch = -12 * 3.141592653589793 / 180, half = std::tan(30 * 3.141592653589793 / 180);
  const dvec3 ahead(0, std::cos(pitch), std::sin(pitch)), right(1, 0, 0), up(0, -std::sin(pitch), std::cos(pitch));
  std::vector<Ray> rays;
  for (int row = 0; row < options.height; ++row) {
    for (int col = 0; col < options.width; ++col) {
      const double x = (2 * (col + 0.5) / options.width - 1) * half;
      const double y = (1 - 2 * (row + 0.5) / options.height) * half * options.height / options.width;
      Ray ray;
      ray.origin = {0, 0, function.value(0, 0) + kEyeHeight};
      ray.direction = normalize(ahead + x * right + y * up);
      ray.t_max = kFarthest;
      rays.push_back(ray);
    }
  }
  return rays;
}

// Traces all rays at once, counting steps, for one function; null: the march on the CPU.
using AnswerAll = std::function<void(std::span<const Ray> rays, std::span<Hit> hits, std::span<std::uint32_t> steps)>;

struct March {
  std::string name;
  const FunctionMarchEntry* entry;
  MarchSettings settings;
  bool vectors = false;
  std::function<AnswerAll(const HeightFunction&)> elsewhere{};  // null: on the CPU
};

#ifdef SCARP_BENCH_VULKAN
// Over functions in the memory of a device.
std::vector<March> marches_on(const Device& device, const MarchSettings& settings) {
  std::vector<March> all;
  for (const FunctionMarchEntry& march : function_marches()) {
    const auto queries = std::make_shared<DeviceFunctionQueries>(device, march, settings);
    all.push_back({fmt::format("{} on the device", march.name), &march, settings, false,
                   [device, queries](const HeightFunction& function) -> AnswerAll {
                     const auto there = std::make_shared<DeviceFunction>(device, function);
                     return [queries, there, &function](std::span<const Ray> rays, std::span<Hit> hits,
                                                        std::span<std::uint32_t> steps) {
                       queries->closest_hits({&function, there.get(), FunctionUse::march}, rays, hits, steps);
                     };
                   }});
  }
  return all;
}
#endif

std::vector<March> marches_over_functions(const FunctionsOptions& options) {
  MarchSettings settings;
  settings.lipschitz.max_steps = kUnlimitedSteps;
  std::vector<March> all;
  if (options.presets) {
    for (const MarchPreset& preset : march_presets()) {
      all.push_back({std::string(preset.name), &find_function_march(preset.march), preset.settings});
    }
    all.push_back({"lipschitz-local", &find_function_march("lipschitz-local"), settings});
    return all;
  }
  for (const FunctionMarchEntry& march : function_marches()) {
    all.push_back({std::string(march.name), &march, settings});
    if (march.simd) all.push_back({fmt::format("{}-simd", march.name), &march, settings, true});
  }
  if (options.device.empty()) return all;
#ifdef SCARP_BENCH_VULKAN
  const Device device({.choice = options.device});
  fmt::print("device: {}, {}\n", device.description().name, device.description().driver);
  for (March& march : marches_on(device, settings)) all.push_back(std::move(march));
#else
  throw Error("functions: --device: this scarp-bench was built without Vulkan; leave it out");
#endif
  return all;
}

// Throws Error, after the report, if a conservative march lost a crossing.
void run_functions(const FunctionsOptions& options, const ReportOptions& report) {
  Json rows = Json::array();
  std::vector<std::vector<std::string>> lines{{"function", "march", "heights/ray", "bounds/ray", "ms/megapixel",
                                               "judged", "misses", "false hits", "given up", "error p99 m"}};
  bool lost = false;
  const std::vector<March> marches = marches_over_functions(options);
  for (const Ground& ground : grounds(options)) {
    const HeightFunction function(ground.function);
    const std::vector<Ray> rays = picture(function, options);
    const auto count = static_cast<std::int64_t>(rays.size());
    const std::int64_t every = std::max<std::int64_t>(1, count / options.judged);
    const std::int64_t judged = (count + every - 1) / every;
    std::vector<FunctionJudgement> judgements(static_cast<std::size_t>(judged));
    parallel_for(judged, 16, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t i = begin; i < end; ++i) {
        judgements[static_cast<std::size_t>(i)] =
            judge_function(ground.function, rays[static_cast<std::size_t>(i * every)]);
      }
    });
    double counted_heights = 0, counted_bounds = 0;
    for (const March& march : marches) {
      std::vector<Hit> hits(rays.size());
      double heights = 0, bounds = 0, best_ms = std::numeric_limits<double>::infinity();
      const AnswerAll answer = march.elsewhere ? march.elsewhere(function) : AnswerAll{};
      std::vector<std::uint32_t> steps(answer ? rays.size() : 0);
      // Shaders are created on first use.
      if (answer) answer(std::span(rays).first(1), std::span(hits).first(1), std::span(steps).first(1));
      for (int pass = 0; pass < options.repeats; ++pass) {
        heights = bounds = 0;
        const auto start = std::chrono::steady_clock::now();
        if (march.vectors) march.entry->batch(function, rays, hits, march.settings, {}, FunctionUse::march);
        if (answer) answer(rays, hits, steps);
        for (std::size_t i = 0; i < rays.size() && !march.vectors && !answer; ++i) {
          MarchStats stats;
          hits[i] = march.entry->cpu(function, rays[i], march.settings, &stats, FunctionUse::march);
          heights += stats.cell_tests, bounds += stats.steps;
        }
        const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
        best_ms = std::min(best_ms, took.count());
      }
      for (const std::uint32_t of_ray : steps) bounds += of_ray;
      // The work is the same, bit for bit, as for single rays, which the previous row counts.
      if (march.vectors) heights = counted_heights, bounds = counted_bounds;
      counted_heights = heights, counted_bounds = bounds;
      // All other marches evaluate only heights, and count them as steps.
      if (march.entry->name != "lipschitz-local") std::swap(heights, bounds);
      int crossings = 0, misses = 0, clear = 0, false_hits = 0, given_up = 0;
      std::vector<double> errors;
      for (std::int64_t i = 0; i < judged; ++i) {
        const FunctionJudgement& judge = judgements[static_cast<std::size_t>(i)];
        const Hit& hit = hits[static_cast<std::size_t>(i * every)];
        given_up += hit.status == HitStatus::exhausted;
        if (judge.verdict == FunctionVerdict::clear) {
          ++clear;
          false_hits += bool(hit);
        } else if (judge.verdict == FunctionVerdict::crossing) {
          ++crossings;
          // The hit is behind the first crossing by more than the tolerance: the crossing was stepped over.
          const bool passed = hit && hit.t > judge.crossed_by * (1 + RelaxedSettings{}.tolerance);
          misses += hit.status == HitStatus::miss || passed;
          if (hit && !passed) {
            errors.push_back(std::max({0.0, judge.clear_until - hit.t, hit.t - judge.crossed_by}));
          }
        }
      }
      std::sort(errors.begin(), errors.end());
      const double p99 = errors.empty() ? 0 : errors[(errors.size() - 1) * 99 / 100];
      const double n = static_cast<double>(count), ms = best_ms / n * 1e6;
      const double miss_rate = crossings ? static_cast<double>(misses) / crossings : 0;
      lost = lost || (misses > 0 && march.entry->guarantee == Guarantee::conservative);
      rows.push_back({{"function", ground.name},
                      {"octaves", options.octaves},
                      {"march", march.name},
                      {"heights_per_ray", heights / n},
                      {"bounds_per_ray", bounds / n},
                      {"ms_per_megapixel", ms},
                      {"judged", judged},
                      {"crossings", crossings},
                      {"miss_rate", miss_rate},
                      {"false_hit_rate", clear ? static_cast<double>(false_hits) / clear : 0},
                      {"exhausted", given_up},
                      {"error_p99_m", p99}});
      lines.push_back({ground.name, march.name, fmt::format("{:.1f}", heights / n), fmt::format("{:.1f}", bounds / n),
                       fmt::format("{:.0f}", ms), fmt::format("{}", judged), fmt::format("{:.4f} %", miss_rate * 100),
                       fmt::format("{}", false_hits), fmt::format("{}", given_up), fmt::format("{:.2g}", p99)});
    }
  }
  print_table(lines, 2);
  write_json(report, rows);
  if (lost) throw Error("functions: a conservative march lost a crossing that the judge proves; see the table");
}

}  // namespace

void add_functions(cli::Program& program) {
  auto [command, o] = add_command<FunctionsOptions>(program, "functions",
                                                    "The marches over terrain functions, beside proofs", run_functions);
  command.add(&o.width, {.names = "--width", .help = "pixels", .range = {1, 16384}});
  command.add(&o.height, {.names = "--height", .help = "pixels", .range = {1, 16384}});
  command.add(&o.octaves, {.names = "--octaves", .help = "octaves of the fractals", .range = {1, 20}});
  command.add(&o.seed, {.names = "--seed", .help = "seed of the noise"});
  add_repeats_option(command, o.repeats);
  command.add(&o.judged,
              {.names = "--judged", .help = "rays per function that are judged, about", .range = {1, 0x1p40}});
  command.add(&o.presets, {.names = "--presets",
                           .help = "the presets of known shaders beside lipschitz-local, instead of the marches"});
  command.add(&o.device, {.names = "--device",
                          .value = "NAME",
                          .help = "the marches on a Vulkan device, too",
                          .note = "cpu, gpu, auto or part of a name"});
}

}  // namespace scarp::bench
