// SPDX-License-Identifier: MIT
// `scarp-bench gpu`: the marches on a Vulkan device, by its own timestamps, and the comparison of the max-mip article
// there: naive is made fine enough that its hits are those of max-mip; then the times and height reads of both are
// compared.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/device_seconds.h"
#include "bench/fields.h"
#include "bench/gpu_options.h"
#include "bench/judge.h"
#include "bench/naive_search.h"
#include "bench/protocol.h"
#include "bench/rays.h"
#include "bench/report.h"
#include "bench/scarp_engine.h"
#include "bench/trace_options.h"
#include "scarp/base/error.h"
#include "scarp/march/height/queries_vk.h"

namespace scarp::bench {
namespace {

using Json = nlohmann::ordered_json;

// 480 x 270, rounded down to whole tiles of 8 pixels.
constexpr RayCounts kCpuDeviceRays{480, 264, 1 << 16, 1 << 16, 256};
constexpr std::int64_t kJudged = 20000, kCpuDeviceJudged = 4096;
// Factor by which more rays are judged in the classes for which naive is tuned: a few correct rays do not show that all
// are.
constexpr std::int64_t kMoreJudged = 16;
constexpr std::uint32_t kMostRaysAtOnce = 4'000'000, kMostCountedAtOnce = 1 << 16;
constexpr std::size_t kBlock = 4096;
// For cards: runs per group, number of consecutive groups without improvement after which the best group counts, and
// the time limit.
constexpr int kRunsInARow = 9, kGroups = 20;
constexpr double kFaster = 0.99;
constexpr std::chrono::seconds kMostInARow{3};
// Fraction of wrong rays of naive-wrong, and of hits of naive-position that are lost or off.
constexpr double kNearlyRight = 0.001;
// Steps per ray beyond which the search for naive's settings ends.
constexpr double kMostSteps = 65536, kCpuDeviceMostSteps = 4096;

// The classes of the article's comparison: the map, one any-hit ray per point, and the picture.
bool is_compared(RayClass ray_class) { return ray_class == RayClass::chunk || ray_class == RayClass::primary; }

bool is_cpu(const Device& device) { return device.description().kind == DeviceKind::cpu; }

// The number of blocks of rays, spread evenly, that fits the time limit.
std::vector<Ray> affordable(const std::vector<Ray>& rays, double seconds_per_ray, double limit_s) {
  const double most = limit_s / std::max(seconds_per_ray, 1e-15);
  if (static_cast<double>(rays.size()) <= most) return rays;
  const std::size_t blocks = (rays.size() + kBlock - 1) / kBlock,
                    kept = std::max<std::size_t>(1, static_cast<std::size_t>(most) / kBlock);
  std::vector<Ray> part;
  for (std::size_t i = 0; i < std::min(kept, blocks); ++i) {
    const std::size_t begin = i * blocks / kept * kBlock, end = std::min(begin + kBlock, rays.size());
    part.insert(part.end(), rays.begin() + static_cast<std::ptrdiff_t>(begin),
                rays.begin() + static_cast<std::ptrdiff_t>(end));
  }
  return part;
}

// A field in the memory of the CPU and the device.
struct Ground {
  Ground(const Device& device, const BenchField& ground, double factor)
      : exaggeration(factor),
        bench(exaggerated(ground, factor)),
        cpu(bench.field),
        gpu(device, bench.field),
        target{&bench.field, &gpu, cpu.target().slope} {}

  double exaggeration;
  BenchField bench;
  ScarpGround cpu;
  DeviceGround gpu;
  DeviceTarget target;
};

// A march on the device: one pass for timing, on all rays of a class at once if possible, and one for counting.
struct DeviceMarch {
  DeviceMarch(const Device& device, const char* name, const RayCounts& rays, bool clip_at_top = false)
      : march(find_height_march(name)),
        timed(device, march, {}, {.rays_at_once = all_of(rays), .clip_at_top = clip_at_top}),
        counting(device, march, {},
                 {.statistics = true, .rays_at_once = kMostCountedAtOnce, .clip_at_top = clip_at_top}) {}

  static std::uint32_t all_of(const RayCounts& rays) {
    const std::int64_t most =
        std::max({std::int64_t{rays.width} * rays.height, std::int64_t{rays.chunk} * rays.chunk, rays.grazing});
    return static_cast<std::uint32_t>(std::min<std::int64_t>(most, kMostRaysAtOnce));
  }

  const HeightMarchEntry& march;
  DeviceQueries timed, counting;
};

// One contender for the rays of a set, and its results.
struct Contender {
  std::string mode;
  DeviceMarch* march;
  MarchSettings settings;
  Judgement judged{};
  double fetches = 0;          // per ray
  double seconds_per_ray = 0;  // in the judged pass, which has the counters
};

class Comparison {
 public:
  Comparison(const Device& device, const GpuOptions& options)
      : device_(device),
        options_(options),
        rays_(options.rays.value_or(is_cpu(device) ? kCpuDeviceRays : RayCounts{})),
        judged_(options.judged > 0 ? options.judged
                : is_cpu(device)   ? kCpuDeviceJudged
                                   : kJudged),
        max_mip_(device, "max-mip", rays_),
        naive_(device, "naive", rays_),
        clipped_naive_(device, "naive", rays_, true),
        relaxed_(device, "relaxed", rays_),
        lipschitz_(device, "lipschitz", rays_) {}

  void run(const BenchField& field) {
    for (const double exaggeration : options_.exaggerations) {
      const Ground ground(device_, field, exaggeration);
      measure_build(ground);
      for (const std::string& name : options_.classes) measure_class(ground, find_ray_class(name));
    }
  }

  const Json& rows() const { return rows_; }

  void print() const {
    std::vector<std::vector<std::string>> lines{{"samples", "exagg.", "class", "mode", "Mrays/s", "max-mip is",
                                                 "fetches", "x max-mip", "steps", "wrong %", "missed %", "late %",
                                                 "error p99", "factor", "least step", "tolerance"}};
    const auto percent = [](const Json& share) {
      return share.is_null() ? "-" : short_number(100 * share.get<double>());
    };
    const auto fraction = [](const Json& value) {
      return value.is_null() ? "-" : fmt::format("1/{:.0f}", 1 / value.get<double>());
    };
    for (const Json& row : rows_) {
      if (row["class"] == "build") {
        fmt::print("{0} x {0} samples: pyramid in {1} ms, {2} Gsamples/s\n", row["size"].get<int>(),
                   short_number(row["build_ms"]), short_number(row["gsamples_per_s"]));
        continue;
      }
      lines.push_back({short_number(row["size"]), short_number(row["exaggeration"]), row["class"], row["mode"],
                       short_number(row["mrays_per_s"]), fmt::format("{} x", short_number(row["max_mip_ratio"])),
                       short_number(row["fetches_per_ray"]), short_number(row["fetch_ratio"]),
                       short_number(row["steps_per_ray"]), percent(row["wrong_rate"]), percent(row["miss_rate"]),
                       percent(row["late_rate"]), short_number(row["error_p99"], 2), short_number(row["step_factor"]),
                       fraction(row["min_step"]), fraction(row["tolerance"])});
    }
    print_table(lines, 4);
    print_comparison();
  }

 private:
  void measure_class(const Ground& ground, RayClass ray_class) {
    const RaySet set = std::move(make_rays(ground.bench, {ray_class}, rays_, options_.ray_seed).front());
    const Judge judge(ground.cpu.target(), set, is_compared(ray_class) ? kMoreJudged * judged_ : judged_,
                      options_.ray_seed);
    std::vector<Contender> contenders{{"max-mip", &max_mip_, {}},
                                      {"naive-default", &naive_, {}},
                                      {"relaxed", &relaxed_, {}},
                                      {"lipschitz", &lipschitz_, {}}};
    for (Contender& contender : contenders) judge_it(ground, set, judge, contender);
    if (is_compared(ray_class)) add_fair_ones(ground, set, judge, contenders);
    measure_all(ground, set, set.library_rays, contenders);
    std::fflush(stdout);
  }

  // Prints naive with hits at the right position, compared with max-mip, one class per row.
  void print_comparison() const {
    std::vector<std::vector<std::string>> lines{
        {"samples", "exagg.", "class", "max-mip", "naive Mrays/s", "max-mip is", "clipped Mrays/s", "max-mip is"}};
    for (const Json& row : rows_) {
      if (row["class"] != "chunk" && row["class"] != "primary") continue;
      if (row["mode"] == "max-mip") {
        lines.push_back({short_number(row["size"]), short_number(row["exaggeration"]), row["class"],
                         short_number(row["mrays_per_s"]), "-", "-", "-", "-"});
      }
      const std::size_t at = row["mode"] == "naive-position" ? 4 : row["mode"] == "naive-position-clipped" ? 6 : 0;
      if (at == 0) continue;
      lines.back()[at] = short_number(row["mrays_per_s"]);
      lines.back()[at + 1] = fmt::format("{} x", short_number(row["max_mip_ratio"]));
    }
    if (lines.size() == 1) return;
    fmt::print("naive with at most {} % of its hits lost or more than a cell off:\n", 100 * kNearlyRight);
    print_table(lines, 3);
  }

  // Traces `rays` and returns the answers for the judge.
  static std::vector<Judge::Answer> ask(DeviceQueries& queries, const DeviceTarget& target, bool any_hit,
                                        const std::vector<Ray>& rays, std::vector<DeviceRayCost>& costs) {
    constexpr double kNoTime = std::numeric_limits<double>::quiet_NaN();
    std::vector<Judge::Answer> answers(rays.size());
    if (any_hit) {
      std::vector<std::uint8_t> blocked(rays.size());
      queries.occluded(target, rays, blocked, costs);
      for (std::size_t i = 0; i < rays.size(); ++i) answers[i] = {blocked[i] != 0, false, kNoTime, {}};
    } else {
      std::vector<Hit> hits(rays.size());
      queries.closest_hits(target, rays, hits, costs);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        answers[i] = {
            static_cast<bool>(hits[i]), hits[i].status == HitStatus::exhausted, hits[i] ? hits[i].t : kNoTime, {}};
      }
    }
    for (std::size_t i = 0; i < costs.size(); ++i) answers[i].stats.steps = static_cast<int>(costs[i].steps);
    return answers;
  }

  void judge_it(const Ground& ground, const RaySet& set, const Judge& judge, Contender& contender) const {
    std::vector<Ray> sample;
    for (const std::size_t i : judge.sample()) sample.push_back(set.library_rays[i]);
    std::vector<DeviceRayCost> costs(sample.size()), no_costs;
    DeviceQueries& queries = contender.march->counting;
    queries.set_march_settings(contender.settings);
    std::vector<Judge::Answer> answers = ask(queries, ground.target, set.any_hit, sample, costs);
    const double count = static_cast<double>(sample.size());
    contender.fetches = std::accumulate(costs.begin(), costs.end(), 0.0,
                                        [](double sum, const DeviceRayCost& cost) { return sum + cost.fetches; }) /
                        count;
    contender.seconds_per_ray = device_seconds(device_, queries.passes()) / count;
    if (set.any_hit && is_compared(set.ray_class)) {
      // The position at which an any-hit ray is blocked is that of its closest hit.
      contender.march->timed.set_march_settings(contender.settings);
      const auto closest = ask(contender.march->timed, ground.target, false, sample, no_costs);
      for (std::size_t i = 0; i < answers.size(); ++i) answers[i].t = closest[i].t;
    }
    contender.judged = judge.score(answers);
  }

  // Adds naive at the cheapest acceptable settings, for each criterion that has such settings.
  void add_fair_ones(const Ground& ground, const RaySet& set, const Judge& judge, std::vector<Contender>& contenders) {
    const double limit = options_.miss_limit, max_mip_wrong = contenders[0].judged.wrong_rate;
    std::map<std::tuple<DeviceMarch*, double, double, double>, Contender> tried;
    const auto contender_with = [&](DeviceMarch& march, const NaiveSettings& settings) -> const Contender& {
      const auto [at, is_new] =
          tried.try_emplace({&march, settings.step_factor, settings.min_step, settings.tolerance});
      if (is_new) {
        at->second.march = &march;
        at->second.settings.naive = settings;
        judge_it(ground, set, judge, at->second);
      }
      return at->second;
    };
    const auto add = [&](const char* mode, DeviceMarch& march, const std::function<bool(const Judgement&)>& good,
                         EarlyHits early = EarlyHits::limited) {
      const auto attempt = [&](const NaiveSettings& settings) {
        const Judgement& judged = contender_with(march, settings).judged;
        return NaiveTrial{good(judged), judged.steps};
      };
      const auto settings = cheapest_naive(attempt, is_cpu(device_) ? kCpuDeviceMostSteps : kMostSteps);
      if (!settings) {
        fmt::print("{0} x {0} samples, exaggeration {1}, {2}: no settings make {3}\n", ground.bench.field.cols(),
                   ground.exaggeration, name_of(set.ray_class), mode);
        return;
      }
      contenders.push_back(contender_with(march, coarsened_naive(*settings, attempt, early)));
      contenders.back().mode = mode;
    };
    const auto in_position = [](const Judgement& judged) { return has_positions(judged, kNearlyRight); };
    add("naive-position", naive_, in_position);
    add("naive-position-clipped", clipped_naive_, in_position);
    if (!set.any_hit) return;
    const auto nearly_right = [](const Judgement& judged) { return judged.wrong_rate <= kNearlyRight; };
    add(
        "naive-missed", naive_, [&](const Judgement& judged) { return judged.miss_rate < limit; }, EarlyHits::ignored);
    add("naive-missed-false", naive_,
        [&](const Judgement& judged) { return judged.miss_rate + judged.false_rate < limit; });
    add("naive-wrong", naive_, nearly_right);
    add("naive-wrong-clipped", clipped_naive_, nearly_right);
    add("naive-wrong-equal", naive_, [&](const Judgement& judged) { return judged.wrong_rate <= max_mip_wrong; });
  }

  // Time of the last rays that a device traced; for cards the median of the fastest group of consecutive runs. While
  // the host prepares rays, the card lowers its clock, and a run takes up to six times as long until the clock is up
  // again.
  double seconds_of_last(DeviceQueries& queries) const {
    if (is_cpu(device_)) return device_seconds(device_, queries.passes());
    const auto again = [&] {
      queries.march_again();
      return device_seconds(device_, queries.passes());
    };
    const auto end = std::chrono::steady_clock::now() + kMostInARow;
    double best = std::numeric_limits<double>::infinity();
    for (int slower = 0; slower < kGroups && std::chrono::steady_clock::now() < end;) {
      std::vector<double> times(kRunsInARow);
      for (double& time : times) time = again();
      const double group = median(times);
      slower = group < kFaster * best ? 0 : slower + 1;
      best = std::min(best, group);
    }
    return best;
  }

  // One warm-up pass of each, then passes of all in turn.
  void measure_all(const Ground& ground, const RaySet& set, const std::vector<Ray>& rays,
                   const std::vector<Contender>& contenders) {
    std::vector<std::vector<Ray>> parts;
    for (const Contender& contender : contenders)
      parts.push_back(affordable(rays, contender.seconds_per_ray, options_.pass_limit_s));
    std::vector<std::vector<double>> times(contenders.size());
    std::vector<double> hits(contenders.size());
    std::vector<DeviceRayCost> no_costs;
    for (int pass = 0; pass <= options_.repeats; ++pass) {
      for (std::size_t c = 0; c < contenders.size(); ++c) {
        DeviceQueries& queries = contenders[c].march->timed;
        queries.set_march_settings(contenders[c].settings);
        const auto answers = ask(queries, ground.target, set.any_hit, parts[c], no_costs);
        if (pass > 0) {
          times[c].push_back(seconds_of_last(queries));
        } else {
          hits[c] = static_cast<double>(
              std::count_if(answers.begin(), answers.end(), [](const Judge::Answer& answer) { return answer.hit; }));
        }
      }
    }
    const double max_mip_speed = static_cast<double>(parts[0].size()) / median(times[0]);
    for (std::size_t c = 0; c < contenders.size(); ++c) {
      const auto& [mode, march, settings, judged, fetches, per_ray] = contenders[c];
      const double count = static_cast<double>(parts[c].size()), speed = count / median(times[c]);
      const auto [fastest, slowest] = std::minmax_element(times[c].begin(), times[c].end());
      const bool is_naive = march == &naive_ || march == &clipped_naive_, has_times = judged.error_p99.has_value();
      Json row = head(ground, name_of(set.ray_class), mode);
      row["mrays_per_s"] = speed * 1e-6;
      row["max_mip_ratio"] = max_mip_speed / speed;
      row["fetches_per_ray"] = fetches;
      row["fetch_ratio"] = fetches / contenders[0].fetches;
      row["steps_per_ray"] = judged.steps;
      row["step_ratio"] = judged.steps / contenders[0].judged.steps;
      row["article_ratio"] = kArticleRatio;
      row["step_factor"] = is_naive ? Json(settings.naive.step_factor) : Json();
      row["min_step"] = is_naive ? Json(settings.naive.min_step) : Json();
      row["tolerance"] = is_naive ? Json(settings.naive.tolerance) : Json();
      row["wrong_rate"] = judged.wrong_rate;
      row["miss_rate"] = judged.miss_rate;
      row["false_rate"] = judged.false_rate;
      row["late_rate"] = has_times ? Json(judged.late_rate) : Json();
      row["early_rate"] = has_times ? Json(judged.early_rate) : Json();
      row["error_p99"] = has_times ? Json(*judged.error_p99) : Json();
      row["judged"] = judged.judged;
      row["rays"] = parts[c].size();
      row["hit_share"] = hits[c] / count;
      row["spread"] = (*slowest - *fastest) / median(times[c]);
      rows_.push_back(with_all_fields(std::move(row)));
    }
  }

  // Once per size: samples are the same under all exaggerations.
  void measure_build(const Ground& ground) {
    if (ground.exaggeration != options_.exaggerations.front()) return;
    std::vector<double> times;
    for (int repeat = 0; repeat < options_.repeats; ++repeat) {
      const DeviceGround again(device_, ground.bench.field);
      times.push_back(device_seconds(device_, again.passes()));
    }
    const double samples = static_cast<double>(ground.bench.field.cols()) * ground.bench.field.rows();
    const auto [fastest, slowest] = std::minmax_element(times.begin(), times.end());
    Json row = head(ground, "build", "pyramid");
    row["exaggeration"] = nullptr;
    row["build_ms"] = median(times) * 1e3;
    row["gsamples_per_s"] = samples / median(times) * 1e-9;
    row["bytes_per_sample"] = static_cast<double>(ground.gpu.bytes()) / samples;
    row["spread"] = (*slowest - *fastest) / median(times);
    rows_.push_back(with_all_fields(std::move(row)));
  }

  Json head(const Ground& ground, std::string_view ray_class, std::string_view mode) const {
    const DeviceDescription& device = device_.description();
    Json row;
    row["size"] = ground.bench.field.cols();
    row["exaggeration"] = ground.exaggeration;
    row["class"] = ray_class;
    row["mode"] = mode;
    row["device"] = device.name;
    row["driver"] = device.driver;
    row["field"] = ground.bench.name;
    row["relief"] = ground.bench.relief;
    row["mean_slope_deg"] = ground.bench.mean_slope_deg;
    return row;
  }

  // Rows of rays and of builds have the same fields, in the same order; fields that do not apply are null.
  static Json with_all_fields(const Json& row) {
    Json all;
    for (const char* field : {"size",           "class",
                              "mode",           "mrays_per_s",
                              "max_mip_ratio",  "fetches_per_ray",
                              "fetch_ratio",    "steps_per_ray",
                              "step_ratio",     "article_ratio",
                              "step_factor",    "min_step",
                              "tolerance",      "wrong_rate",
                              "miss_rate",      "false_rate",
                              "late_rate",      "early_rate",
                              "error_p99",      "judged",
                              "rays",           "hit_share",
                              "spread",         "build_ms",
                              "gsamples_per_s", "bytes_per_sample",
                              "device",         "driver",
                              "field",          "relief",
                              "mean_slope_deg", "exaggeration"}) {
      all[field] = row.value(field, Json());
    }
    return all;
  }

  Device device_;
  const GpuOptions& options_;
  RayCounts rays_;
  std::int64_t judged_;
  DeviceMarch max_mip_, naive_, clipped_naive_, relaxed_, lipschitz_;
  Json rows_ = Json::array();
};

void run_gpu(const GpuOptions& options, const ReportOptions& report) {
  const Device device({.choice = options.device});
  const DeviceDescription& description = device.description();
  fmt::print("{}, {}\n", description.name, description.driver);
  std::vector<int> sizes = options.sizes;
  if (sizes.empty()) sizes = is_cpu(device) ? std::vector<int>{1025, 4097} : std::vector<int>{1025, 4097, 16385};
  Comparison comparison(device, options);
  for (const int size : sizes) {
    FieldOptions field = options.field;
    field.size = size;
    const std::uint64_t bytes = std::uint64_t{4} * static_cast<std::uint64_t>(size) * static_cast<std::uint64_t>(size);
    if (bytes > description.max_allocation_bytes) {
      fmt::print("{0} x {0} samples: left out, one buffer of the device holds {1} bytes at most\n", size,
                 description.max_allocation_bytes);
      continue;
    }
    comparison.run(load_field(field));
  }
  comparison.print();
  fmt::print("the article: 55.066 ms without, 9.074 ms with the pyramid: {:.2f} x\n", kArticleRatio);
  write_json(report, comparison.rows());
}

}  // namespace

void add_gpu(cli::Program& program) {
  auto [command, o] =
      add_command<GpuOptions>(program, "gpu", "The marches on a Vulkan device, and the article's comparison there",
                              [](const GpuOptions& options, const ReportOptions& report) {
                                (options.raster ? run_gpu_raster : run_gpu)(options, report);
                              });
  command.add(&o.device, {.names = "--device", .value = "NAME", .help = "auto, gpu, cpu or part of a name"});
  command.add(cli::List<int>{&o.sizes}, {.names = "--sizes",
                                         .help = "samples per side of the procedural DEM",
                                         .range = {kLeastSize, kMostSize},
                                         .fallback = "1025,4097, and 16385 except on CPU devices"});
  add_ground_options(command, o.field);
  add_classes_option(command, o.classes);
  command.add(cli::List<double>{&o.exaggerations},
              {.names = "--exaggerations", .help = "vertical exaggerations", .range = cli::kAboveZero});
  command.add(&o.ray_seed, {.names = "--ray-seed", .help = "seed of the rays"});
  add_ray_size_option(
      command,
      [&rays = o.rays](const std::string& size) {
        rays = size == "small" ? RayCounts{160, 88, 4096, 4096, 64} : RayCounts{};
      },
      "full: 1920 x 1080 pixels and 2^20 rays for each other class, on CPU devices a sixteenth; small: 160 x 88 and "
      "2^12, for tests");
  command.add(&o.judged, {.names = "--judged",
                          .help = "rays per class that the judge also traces",
                          .range = {1, 1e8},
                          .fallback = "20000; on CPU devices 4096"});
  command.add(&o.miss_limit,
              {.names = "--miss-limit", .help = "share of the hits that naive-missed may miss", .range = {0, 1}});
  add_repeats_option(command, o.repeats, "counted passes per march");
  add_pass_limit_option(command, o.pass_limit_s, "a march");
  command.add(&o.raster, {.names = "--raster",
                          .help = "instead: primary rays beside the same grid drawn as two triangles per cell"});
}

}  // namespace scarp::bench
