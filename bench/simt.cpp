// SPDX-License-Identifier: MIT
// `scarp-bench simt`: the shaders of max-mip and naive without a card. The CPU runs their source for each ray
// (simt_trace.h), replays neighbouring rays in lockstep (simt_bundle.h), and adds up the instructions of the compiled
// shaders in the blocks that a bundle enters (simt_blocks.h).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/judge.h"
#include "bench/naive_search.h"
#include "bench/random.h"
#include "bench/simt_options.h"
#include "bench/trace_options.h"
#ifdef SCARP_BENCH_VULKAN
#include "bench/simt_recount.h"
#endif
#include "bench/fields.h"
#include "bench/rays.h"
#include "bench/report.h"
#include "bench/simt_trace.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"

namespace scarp::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::int64_t kGroup = 64;
constexpr std::array<std::size_t, 2> kBundles = {32, kGroup};
constexpr std::int64_t kRaysPerPiece = 256;
// The search for naive's settings first tries one ray in kRoughShare. It rejects settings for which these rays are
// wrong kBeyondDoubt times as often as allowed.
constexpr std::int64_t kRoughShare = 8;
constexpr double kBeyondDoubt = 3;
// Steps per ray beyond which the search ends.
constexpr double kMostSteps = 1024;

// Whole groups of rays: a random one from each of several equally long pieces of a class.
RaySet groups_of(const RaySet& all, std::int64_t groups, std::uint64_t seed) {
  const std::int64_t blocks = (all.size() + kGroup - 1) / kGroup, kept = std::min(groups, blocks);
  RaySet part{all.ray_class, all.any_hit, all.must_hit, {}};
  for (std::int64_t i = 0; i < kept; ++i) {
    const std::int64_t first = i * blocks / kept, last = (i + 1) * blocks / kept;
    Random random(seed, static_cast<std::uint64_t>(i));
    const auto begin = static_cast<std::size_t>((first + random.below(static_cast<int>(last - first))) * kGroup);
    const std::size_t end = std::min(begin + kGroup, all.rays.size());
    for (std::size_t k = begin; k < end; ++k) {
      part.rays.push_back(all.rays[k]);
      part.library_rays.push_back(all.library_rays[k]);
    }
  }
  return part;
}

// Marches one ray; the trace may be null.
using March = std::function<SimtAnswer(const Ray&, SimtTrace*)>;

struct Contender {
  std::string mode;
  std::string shader;
  std::optional<SimtNaive> naive;  // nullopt: max-mip
  Judgement judged{};
  std::array<SimtBundle, kBundles.size()> bundles{};  // sums over all bundles of a size
  double second_pass = 0;                             // fraction of rays
};

std::vector<Judge::Answer> answers_of(const March& march, const RaySet& set, const Judge& judge) {
  std::vector<Judge::Answer> answers(judge.sample().size());
  parallel_for(static_cast<std::int64_t>(answers.size()), kRaysPerPiece, [&](std::int64_t begin, std::int64_t end) {
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
      answers[i] = march(set.library_rays[judge.sample()[i]], nullptr).answer;
  });
  return answers;
}

// Judges all rays, and counts the costs of their bundles.
void count(const March& march, const RaySet& set, const Judge& judge, Contender& contender) {
  std::vector<Judge::Answer> answers(set.library_rays.size());
  std::int64_t second = 0;
  std::mutex sums;
  parallel_for((set.size() + kGroup - 1) / kGroup, 1, [&](std::int64_t first, std::int64_t last) {
    std::array<SimtBundle, kBundles.size()> paid;
    std::vector<SimtTrace> traces(kGroup);
    std::int64_t left = 0;
    for (std::int64_t group = first; group < last; ++group) {
      const auto begin = static_cast<std::size_t>(group * kGroup);
      const std::size_t size = std::min(traces.size(), answers.size() - begin);
      for (std::size_t k = 0; k < size; ++k) {
        traces[k].clear();
        const SimtAnswer answer = march(set.library_rays[begin + k], &traces[k]);
        answers[begin + k] = answer.answer;
        left += answer.second_pass;
      }
      for (std::size_t b = 0; b < kBundles.size(); ++b) {
        for (std::size_t k = 0; k < size; k += kBundles[b])
          paid[b] += replay(std::span(traces).subspan(k, std::min(kBundles[b], size - k)));
      }
    }
    const std::scoped_lock lock(sums);
    for (std::size_t b = 0; b < kBundles.size(); ++b) contender.bundles[b] += paid[b];
    second += left;
  });
  contender.judged = judge.score(answers);
  contender.second_pass = static_cast<double>(second) / static_cast<double>(set.size());
}

class Comparison {
 public:
  Comparison(const SimtOptions& options, SimtShaders shaders) : options_(options), shaders_(std::move(shaders)) {}

  void run(const BenchField& field) {
    const MaxPyramid pyramid(field.field);
    const SimtGround ground(field.field, pyramid);
    for (const std::string& name : options_.classes) {
      const RaySet set = groups_of(make_rays(field, {find_ray_class(name)}, options_.rays, options_.ray_seed).front(),
                                   options_.groups, options_.ray_seed);
      const HeightTarget target{&field.field, &pyramid};
      const Judge judge(target, set, set.size(), options_.ray_seed);
      const Judge rough(target, set, std::max<std::int64_t>(1, set.size() / kRoughShare), options_.ray_seed);
      std::vector<Contender> contenders{{"max-mip", set.any_hit ? "max-mip any" : "max-mip", std::nullopt}};
      count(march_of(ground, set, contenders[0]), set, judge, contenders[0]);
      for (const bool clipped : {false, true}) add_naive(ground, set, judge, rough, clipped, contenders);
      for (const Contender& contender : contenders) report(field, set, contender, contenders[0]);
      std::fflush(stdout);
    }
  }

  const Json& rows() const { return rows_; }

  void print() const {
    std::vector<std::vector<std::string>> lines{{"samples", "class", "mode", "bundle", "turns", "instr.", "memory",
                                                 "lines", "max-mip: instr.", "memory", "lines", "wrong %", "factor",
                                                 "least step"}};
    std::vector<std::vector<std::string>> shares{{"samples", "class", "mode", "bundle"}};
    for (const std::string_view block : kSimtBlockNames) shares.front().push_back(fmt::format("{} %", block));
    const auto times = [](const Json& ratio) { return fmt::format("{} x", short_number(ratio)); };
    for (const Json& row : rows_) {
      const std::vector<std::string> head{short_number(row["size"]), row["class"], row["mode"],
                                          short_number(row["bundle"])};
      lines.push_back(head);
      for (const char* number : {"turns", "instructions", "memory_instructions", "lines_128"})
        lines.back().push_back(short_number(row[number]));
      for (const char* ratio : {"max_mip_instructions", "max_mip_memory", "max_mip_lines_128"})
        lines.back().push_back(times(row[ratio]));
      lines.back().push_back(short_number(100 * row["wrong_rate"].get<double>()));
      lines.back().push_back(short_number(row["step_factor"]));
      lines.back().push_back(row["min_step"].is_null() ? "-"
                                                       : fmt::format("1/{:.0f}", 1 / row["min_step"].get<double>()));
      if (!row["min_step"].is_null()) continue;
      shares.push_back(head);
      for (const std::string_view block : kSimtBlockNames) {
        const Json& part = row[fmt::format("{}_instructions", block)];
        const double whole = row["instructions"];
        shares.back().push_back(part.is_null() ? "-" : fmt::format("{:.0f}", 100 * part.get<double>() / whole));
      }
    }
    print_table(lines, 3);
    fmt::print("\nmax-mip's instructions by block:\n");
    print_table(shares, 3);
    fmt::print("\nmax-mip relative to naive, least to most of all classes and sizes:\n");
    print_table(ranges(), 1);
  }

 private:
  static March march_of(const SimtGround& ground, const RaySet& set, const Contender& contender) {
    const bool any = set.any_hit;
    if (!contender.naive)
      return [&ground, any](const Ray& ray, SimtTrace* trace) { return trace_max_mip(ground, ray, any, trace); };
    return [&ground, any, naive = *contender.naive](const Ray& ray, SimtTrace* trace) {
      return trace_naive(ground, ray, any, naive, trace);
    };
  }

  // Adds naive at the cheapest settings that are accurate enough: within the limit, and as accurate as max-mip.
  void add_naive(const SimtGround& ground, const RaySet& set, const Judge& judge, const Judge& rough, bool clipped,
                 std::vector<Contender>& contenders) const {
    std::map<std::pair<double, double>, Judgement> tried;
    const auto judged_with = [&](const NaiveSettings& settings, double limit) {
      const std::pair key(settings.step_factor, settings.min_step);
      const auto known = tried.find(key);
      if (known != tried.end() && (known->second.judged == set.size() || known->second.off_rate > kBeyondDoubt * limit))
        return known->second;
      const March march = march_of(ground, set, {"", "", SimtNaive{settings, clipped}});
      const Judgement first = rough.score(answers_of(march, set, rough));
      if (first.off_rate > kBeyondDoubt * limit) return tried[key] = first;
      return tried[key] = judge.score(answers_of(march, set, judge));
    };
    const auto add = [&](const std::string& mode, double limit) {
      const auto settings = cheapest_naive(
          [&](const NaiveSettings& attempt) {
            const Judgement judged = judged_with(attempt, limit);
            return NaiveTrial{judged.off_rate <= limit, judged.steps};
          },
          kMostSteps);
      if (!settings) {
        fmt::print("{}, {} rays: no settings make {}\n", name_of(set.ray_class), set.size(), mode);
        return;
      }
      Contender contender{mode, set.any_hit ? "naive any" : "naive", SimtNaive{*settings, clipped}};
      count(march_of(ground, set, contender), set, judge, contender);
      contenders.push_back(std::move(contender));
    };
    const std::string name = clipped ? "naive-clipped" : "naive";
    add(name, options_.wrong_limit);
    add(name + "-equal", contenders[0].judged.off_rate);
  }

  void report(const BenchField& field, const RaySet& set, const Contender& contender, const Contender& max_mip) {
    for (std::size_t b = 0; b < kBundles.size(); ++b) {
      const SimtBundle& bundle = contender.bundles[b];
      const SimtShader& shader = shaders_.find(contender.shader);
      const SimtSum sum = cost_of(bundle, shader), best = cost_of(max_mip.bundles[b], shaders_.find(max_mip.shader));
      const auto bundles = static_cast<double>(bundle.of(SimtBlock::begin));
      const auto per_bundle = [&](std::uint64_t total) { return static_cast<double>(total) / bundles; };
      const auto ratio = [](std::uint64_t a, std::uint64_t of) {
        return static_cast<double>(a) / static_cast<double>(of);
      };
      const auto turn = static_cast<std::size_t>(contender.naive ? SimtBlock::probe : SimtBlock::walk);
      Json row;
      row["size"] = field.field.cols();
      row["class"] = name_of(set.ray_class);
      row["mode"] = contender.mode;
      row["bundle"] = kBundles[b];
      row["turns"] = per_bundle(bundle.runs[turn]);
      row["turns_per_ray"] = static_cast<double>(bundle.lanes[turn]) / static_cast<double>(set.size());
      for (std::size_t block = 0; block < kSimtBlocks; ++block) {
        const auto& name = kSimtBlockNames[block];
        const bool has = bundle.runs[block] > 0;
        const double runs = per_bundle(bundle.runs[block]);
        row[fmt::format("{}_runs", name)] = has ? Json(runs) : Json();
        row[fmt::format("{}_instructions", name)] = has ? Json(runs * shader.costs[block].instructions) : Json();
      }
      row["instructions"] = per_bundle(sum.instructions);
      row["vector_instructions"] = per_bundle(sum.vector);
      row["memory_instructions"] = per_bundle(sum.memory);
      row["fetches"] = per_bundle(bundle.fetches);
      for (std::size_t k = 0; k < kCacheLines.size(); ++k)
        row[fmt::format("lines_{}", kCacheLines[k])] = per_bundle(bundle.lines[k]);
      row["max_mip_instructions"] = ratio(best.instructions, sum.instructions);
      row["max_mip_memory"] = ratio(best.memory, sum.memory);
      for (std::size_t k = 0; k < kCacheLines.size(); ++k)
        row[fmt::format("max_mip_lines_{}", kCacheLines[k])] = ratio(max_mip.bundles[b].lines[k], bundle.lines[k]);
      row["wrong_rate"] = contender.judged.off_rate;
      row["judged"] = contender.judged.judged;
      row["second_pass_rate"] = contender.second_pass;
      row["step_factor"] = contender.naive ? Json(contender.naive->settings.step_factor) : Json();
      row["min_step"] = contender.naive ? Json(contender.naive->settings.min_step) : Json();
      row["field"] = field.name;
      row["relief"] = field.relief;
      row["mean_slope_deg"] = field.mean_slope_deg;
      row["compilers"] = shaders_.compilers;
      rows_.push_back(std::move(row));
    }
  }

  // By mode and bundle, over the rows of naive.
  std::vector<std::vector<std::string>> ranges() const {
    std::vector<std::vector<std::string>> lines{{"mode", "bundle", "instructions", "memory", "lines"}};
    for (const char* mode : {"naive", "naive-clipped", "naive-equal", "naive-clipped-equal"}) {
      for (const std::size_t bundle : kBundles) {
        std::vector<std::string> line{mode, fmt::format("{}", bundle)};
        for (const char* ratio : {"max_mip_instructions", "max_mip_memory", "max_mip_lines_128"}) {
          std::vector<double> of;
          for (const Json& row : rows_) {
            if (row["mode"] == mode && row["bundle"] == bundle) of.push_back(row[ratio]);
          }
          if (of.empty()) break;
          const auto [least, most] = std::minmax_element(of.begin(), of.end());
          line.push_back(fmt::format("{} to {}", short_number(*least), short_number(*most)));
        }
        if (line.size() > 2) lines.push_back(line);
      }
    }
    return lines;
  }

  const SimtOptions& options_;
  SimtShaders shaders_;
  Json rows_ = Json::array();
};

void run_simt(const SimtOptions& options, const ReportOptions& report) {
  SimtShaders shaders =
      read_simt_shaders(options.blocks.empty() ? SCARP_SOURCE_DIR "/bench/simt_blocks.csv" : options.blocks);
#ifdef SCARP_BENCH_VULKAN
  if (options.recount) shaders = recount(shaders, options.disassembly);
  if (!options.update.empty()) {
    write_simt_shaders(options.update, shaders);
    return;
  }
#endif
  fmt::print("instructions by {}\n", shaders.compilers);
  if (options.voxels) return run_simt_voxels(options, std::move(shaders), report);
  Comparison comparison(options, std::move(shaders));
  for (const int size : options.sizes) {
    FieldOptions field = options.field;
    field.size = size;
    comparison.run(load_field(field));
  }
  comparison.print();
  write_json(report, comparison.rows());
}

}  // namespace

void add_simt(cli::Program& program) {
  auto [command, o] = add_command<SimtOptions>(
      program, "simt", "What bundles of rays in lockstep pay with max-mip and with naive, counted on the CPU",
      run_simt);
  add_sizes_option(command, o.sizes);
  add_ground_options(command, o.field);
  add_classes_option(command, o.classes);
  command.add(&o.groups, {.names = "--groups",
                          .help = "groups of 64 successive rays, spread evenly over each class",
                          .range = {1, 1 << 20}});
  command.add(&o.ray_seed, {.names = "--ray-seed", .help = "seed of the rays"});
  add_ray_size_option(
      command,
      [&rays = o.rays](const std::string& size) {
        if (size == "small") rays = {160, 88, 4096, 4096, 64};
      },
      "full: groups of 1920 x 1080 pixels and 2^20 rays for each other class; small: of 160 x 88 and 2^12, for tests");
  command.add(&o.voxels, {.names = "--voxels", .help = "instead: the voxel marches, in pictures of many objects"});
  command.add(&o.wrong_limit,
              {.names = "--wrong-limit", .help = "share of rays that naive may get wrong", .range = {0, 1}});
  command.add(&o.blocks, {.names = "--blocks",
                          .value = "FILE",
                          .help = "table of instructions by block",
                          .files = "csv",
                          .fallback = "bench/simt_blocks.csv of the sources"});
#ifdef SCARP_BENCH_VULKAN
  command.add(&o.recount, {.names = "--recount", .help = "count the instructions by RADV, as this build compiles"});
  const cli::Rule counts = cli::needs("--recount", [&o = o] { return o.recount; });
  command.add(
      &o.disassembly,
      {.names = "--disassembly", .value = "FOLDER", .help = "folder for the counted disassemblies", .rules = {counts}});
  command.add(&o.update, {.names = "--update",
                          .value = "FILE",
                          .help = "table to write instead of tracing rays",
                          .files = "csv",
                          .rules = {counts}});
#endif
}

}  // namespace scarp::bench
