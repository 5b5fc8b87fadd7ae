// SPDX-License-Identifier: MIT
// `scarp-bench leaks`: a large number of rays of the kinds that engines lose, each judged in O(1), some also by the
// exhaustive march.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <map>
#include <mutex>
#include <vector>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/leak_judge.h"
#include "bench/leak_rays.h"
#include "bench/leaks_options.h"
#include "bench/protocol.h"
#include "bench/rays.h"
#include "bench/report.h"
#include "bench/trace_options.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/march/height/exhaustive.h"
#include "scarp/march/height/max_mip.h"
#include "scarp/march/height/queries.h"
#include "scarp/scene/file/ray_dump.h"

namespace scarp::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::int64_t kPiece = 1024;  // rays over one field and of one class; their answers stay in a core's cache
constexpr std::size_t kDumped = 10;
constexpr std::uint64_t kAskedMore =
    4;  // one ray in this many is also traced for all hits, and cut behind and in front of its hit

struct Count {
  std::int64_t rays = 0, hits = 0, must_hit = 0, lost = 0, wrong = 0, contradictions = 0, judged = 0, ties = 0;
  std::int64_t embree = 0, embree_lost = 0;

  void add(const Count& c) {
    rays += c.rays, hits += c.hits, must_hit += c.must_hit, lost += c.lost, wrong += c.wrong;
    contradictions += c.contradictions, judged += c.judged, ties += c.ties;
    embree += c.embree, embree_lost += c.embree_lost;
  }
  bool clean() const { return lost == 0 && wrong == 0 && contradictions == 0; }
};

bool identical(const Hit& a, const Hit& b) {
  return a.status == b.status && a.t == b.t && a.cell == b.cell && a.u == b.u && a.v == b.v && a.height == b.height &&
         a.wall == b.wall;
}

std::string text(const Hit& hit) {
  static constexpr const char* kNames[] = {"miss", "hit", "below", "exhausted"};
  if (!hit) return kNames[static_cast<int>(hit.status)];
  return fmt::format("{} at t {:a} in cell {} {} at {} {}", hit.wall ? "wall" : "hit", hit.t, hit.cell.col,
                     hit.cell.row, hit.u, hit.v);
}

struct Job {
  LeakClass leak_class;
  const LeakField* ground;
};

class Leaks {
 public:
  Leaks(const LeaksOptions& options, const std::vector<LeakField>& fields) : options_(options) {
    double for_embree_share = 0;  // fraction of all rays
    for (const LeakClass leak_class : kLeakClasses) {
      auto& suited = grounds_[static_cast<std::size_t>(leak_class)];
      std::ptrdiff_t have_embree = 0;
      for (const LeakField& ground : fields) {
        if (!suits(leak_class, ground)) continue;
        suited.push_back(&ground);
        have_embree += for_embree({leak_class, &ground});
      }
      for_embree_share +=
          0.5 * static_cast<double>(have_embree) / static_cast<double>(suited.size()) / std::size(kLeakClasses);
    }
    pieces_ = (options.rays + kPiece - 1) / kPiece;
    const double all = for_embree_share * static_cast<double>(options.rays);
    embree_share_ = all > 0 ? std::min(1.0, static_cast<double>(options.embree_rays) / all) : 0;
  }

  void run() {
    std::atomic<std::int64_t> done{0};
    parallel_for(pieces_, 1, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t piece = begin; piece < end; ++piece) {
        run_piece(piece);
        const std::int64_t now = ++done;
        if (isatty(2) && now * 100 / pieces_ != (now - 1) * 100 / pieces_)
          std::fprintf(stderr, "\r%d %%", static_cast<int>(now * 100 / pieces_));
      }
    });
    if (isatty(2)) std::fprintf(stderr, "\r");
  }

  const std::array<Count, std::size(kLeakClasses)>& counts() const { return counts_; }
  std::vector<RayDump> failures() const {
    std::vector<RayDump> dumps;
    for (const auto& [index, dump] : failures_) dumps.push_back(dump);
    return dumps;
  }

 private:
  static bool for_embree(const Job& job) { return job.ground->embree && job.leak_class <= LeakClass::diagonals; }

  // Pieces take all classes in turn, and each class all of its fields: any part of the run is a fair sample of it.
  Job job_of(std::int64_t piece) const {
    constexpr auto kClasses = static_cast<std::int64_t>(std::size(kLeakClasses));
    const auto leak_class = static_cast<std::size_t>(piece % kClasses);
    const auto& suited = grounds_[leak_class];
    return {kLeakClasses[leak_class], suited[static_cast<std::size_t>(piece / kClasses) % suited.size()]};
  }

  void run_piece(std::int64_t piece) {
    const Job job = job_of(piece);
    const std::int64_t begin = piece * kPiece, count = std::min(kPiece, options_.rays - begin);
    const HeightTarget target = job.ground->target();
    std::vector<Ray> rays;
    std::vector<Hit> batch(static_cast<std::size_t>(count)), all;
    std::vector<std::uint8_t> blocked(batch.size());
    rays.reserve(batch.size());
    for (std::int64_t i = 0; i < count; ++i) {
      Random random(options_.seed, static_cast<std::uint64_t>(begin + i));
      rays.push_back(make_leak_ray(job.leak_class, *job.ground, random, i % 2 == 1));
    }
    closest_hits(target, rays, batch);
    occluded(target, rays, blocked);

    Count sum;
    RaySet floats{RayClass::nodes, false, true, {}};
    const bool ask_embree =
        for_embree(job) && Random(options_.seed + 1, static_cast<std::uint64_t>(piece)).uniform() < embree_share_;
    for (std::int64_t i = 0; i < count; ++i) {
      const std::int64_t index = begin + i;
      const Ray& ray = rays[static_cast<std::size_t>(i)];
      const LeakJudge judge(*job.ground, ray);
      Random random(options_.seed + 2, static_cast<std::uint64_t>(index));
      const Hit hit = march_max_mip(target, ray);
      ++sum.rays;
      sum.hits += hit.status == HitStatus::hit;
      sum.must_hit += judge.must_hit();
      const auto fails = [&](std::int64_t& counter, const char* why) {
        if (!why) return;
        ++counter;
        keep(index, job, ray, why, text(hit));
      };
      fails(sum.lost, judge.lost(hit, random.uniform()));
      fails(sum.wrong, judge.false_hit(hit));
      fails(sum.wrong, judge.false_status(hit));
      if (!identical(hit, batch[static_cast<std::size_t>(i)])) fails(sum.contradictions, "the batch answers otherwise");
      if ((blocked[static_cast<std::size_t>(i)] != 0) != static_cast<bool>(hit))
        fails(sum.contradictions, "any-hit answers otherwise");
      all.clear();
      if (random.bits() % kAskedMore == 0) fails(sum.contradictions, contradiction(target, judge, ray, hit, all));
      for (std::size_t k = 1; k < all.size(); ++k) fails(sum.wrong, judge.false_hit(all[k]));
      if (is_small(*job.ground) && random.bits() % static_cast<std::uint64_t>(options_.judge_every) == 0) {
        ++sum.judged;
        const Hit truth = march_exhaustive(target, ray);
        if (!judge.same(truth, hit)) judge_difference(judge, truth, hit, sum, fails);
      }
      if (ask_embree && i % 2 == 1 && judge.must_hit()) {
        floats.rays.push_back({static_cast<float>(ray.origin.x), static_cast<float>(ray.origin.y),
                               static_cast<float>(ray.origin.z), static_cast<float>(ray.direction.x),
                               static_cast<float>(ray.direction.y), static_cast<float>(ray.direction.z),
                               static_cast<float>(ray.t_max)});
      }
    }
    if (!floats.rays.empty()) {
      floats.records = records_of(floats.rays);
      std::vector<float> answers(floats.rays.size());
      job.ground->embree->engines()[0].trace(floats, 0, floats.size(), answers.data());
      sum.embree = floats.size();
      sum.embree_lost = std::count(answers.begin(), answers.end(), kMiss);
    }
    const std::scoped_lock lock(mutex_);
    counts_[static_cast<std::size_t>(job.leak_class)].add(sum);
  }

  // Returns why the list of all hits, or the same ray cut behind or in front of its hit, contradicts the hit; null if
  // it does not. `all` receives all hits.
  static const char* contradiction(const HeightTarget& target, const LeakJudge& judge, const Ray& ray, const Hit& hit,
                                   std::vector<Hit>& all) {
    const HitStatus status = all_hits_max_mip(target, ray, all);
    if (status != hit.status || all.empty() != !hit) return "all hits answer otherwise";
    if (hit && !identical(all.front(), hit)) return "the first of all hits is another";
    if (!std::is_sorted(all.begin(), all.end(), [](const Hit& a, const Hit& b) { return a.t < b.t; }))
      return "all hits are not in order";
    if (!hit) return nullptr;
    Ray cut = ray;
    if (const auto t = judge.cut_behind(hit)) {
      cut.t_max = *t;
      const Hit again = march_max_mip(target, cut);
      if (!again || !judge.same(again, hit)) return "cut behind its hit, the ray hits otherwise";
      if (!occluded_max_mip(target, cut)) return "cut behind its hit, any-hit finds none";
    }
    if (const auto t = judge.cut_before(hit)) {
      cut.t_max = *t;
      if (occluded_max_mip(target, cut)) return "cut before its hit, the ray is blocked";
    }
    return nullptr;
  }

  // Handles two answers that cannot both be right. The march's own answer has passed all checks. Earlier hits of the
  // exhaustive march therefore count as lost if they pass the same checks and the ray is below the ground behind them.
  template <class Fails>
  void judge_difference(const LeakJudge& judge, const Hit& truth, const Hit& hit, Count& sum,
                        const Fails& fails) const {
    if (truth && (!hit || truth.t < hit.t) && !judge.false_hit(truth) && judge.cut_behind(truth) &&
        judge.cut_before(truth)) {
      fails(sum.lost, "a hit that the exhaustive march finds");
    } else if (hit && (!truth || hit.t < truth.t) && judge.cut_behind(hit) && judge.cut_before(hit)) {
      fails(sum.wrong, "a hit that the exhaustive march does not find");
    } else {
      ++sum.ties;
    }
  }

  static bool is_small(const LeakField& ground) { return !ground.generator; }

  void keep(std::int64_t index, const Job& job, const Ray& ray, const char* why, const std::string& answered) {
    const std::scoped_lock lock(mutex_);
    failures_.try_emplace(
        index, RayDump{job.ground->field, job.ground->generator, ray,
                       fmt::format("{} over '{}': {}", name_of(job.leak_class), job.ground->name, why), answered});
    if (failures_.size() > kDumped) failures_.erase(std::prev(failures_.end()));
  }

  const LeaksOptions& options_;
  std::array<std::vector<const LeakField*>, std::size(kLeakClasses)> grounds_;  // grounds that suit each class
  std::int64_t pieces_ = 0;
  double embree_share_ = 0;
  std::mutex mutex_;
  std::array<Count, std::size(kLeakClasses)> counts_{};
  std::map<std::int64_t, RayDump> failures_;  // the first by index, regardless of threads
};

Json row_of(std::string_view name, const Count& count) {
  Json row;
  row["class"] = name;
  row["rays"] = count.rays;
  row["hit_share"] = count.rays > 0 ? Json(static_cast<double>(count.hits) / static_cast<double>(count.rays)) : Json();
  row["must_hit"] = count.must_hit;
  row["lost"] = count.lost;
  row["false"] = count.wrong;
  row["contradictions"] = count.contradictions;
  row["judged"] = count.judged;
  row["ties"] = count.ties;
  row["embree_rays"] = count.embree > 0 ? Json(count.embree) : Json();
  row["embree_lost"] = count.embree > 0 ? Json(count.embree_lost) : Json();
  row["embree_lost_share"] =
      count.embree > 0 ? Json(static_cast<double>(count.embree_lost) / static_cast<double>(count.embree)) : Json();
  return row;
}

// Throws Error, after the report, when a ray was lost, false or contradictory.
void run_leaks(const LeaksOptions& options, const ReportOptions& report) {
  const Stopwatch watch;
  const std::vector<LeakField> fields = make_leak_fields(options.seed, options.large, options.embree_rays > 0);
  Leaks leaks(options, fields);
  leaks.run();

  Json rows = Json::array();
  Count total;
  for (const LeakClass leak_class : kLeakClasses) {
    const Count& count = leaks.counts()[static_cast<std::size_t>(leak_class)];
    total.add(count);
    rows.push_back(row_of(name_of(leak_class), count));
  }
  rows.push_back(row_of("all", total));
  std::vector<std::vector<std::string>> lines{{"class", "rays", "hits %", "must hit", "lost", "false", "contrad.",
                                               "judged", "ties", "embree rays", "embree lost", "%"}};
  for (const Json& row : rows) {
    const auto percent = [](const Json& share) {
      return share.is_null() ? std::string("-") : short_number(100 * share.get<double>());
    };
    lines.push_back({row["class"], short_number(row["rays"]), percent(row["hit_share"]), short_number(row["must_hit"]),
                     short_number(row["lost"]), short_number(row["false"]), short_number(row["contradictions"]),
                     short_number(row["judged"]), short_number(row["ties"]), short_number(row["embree_rays"]),
                     short_number(row["embree_lost"]), percent(row["embree_lost_share"])});
  }
  fmt::print("{} rays, seed {}, {} fields\n", total.rays, options.seed, fields.size());
  print_table(lines, 1);
  fmt::print("{:.0f} s, {:.3g} us of processor time per ray\n", watch.wall_s(),
             1e6 * watch.cpu_s() / static_cast<double>(total.rays));
  for (Json& row : rows) row["seed"] = options.seed;
  write_json(report, rows);
  if (total.clean()) return;
  const std::string dump = options.dump.empty() ? fmt::format("leaks-{}.txt", options.seed) : options.dump;
  const std::vector<RayDump> failures = leaks.failures();
  write_ray_dumps(dump, failures);
  throw Error(fmt::format("leaks: {} lost, {} false, {} contradictions; the first {} are in '{}', for scarp replay",
                          total.lost, total.wrong, total.contradictions, failures.size(), dump));
}

}  // namespace

void add_leaks(cli::Program& program) {
  auto [command, o] =
      add_command<LeaksOptions>(program, "leaks", "Very many rays at what engines lose; fails if Scarp loses one",
                                [](const LeaksOptions& options, const ReportOptions& report) {
                                  (options.fans ? run_fan_leaks : run_leaks)(options, report);
                                });
  command.add(&o.rays, {.names = "--rays", .help = "rays in all", .range = {1, 1e15}});
  command.add(&o.seed, {.names = "--seed", .help = "seed of fields and rays"});
  command.add(&o.large,
              {.names = "--large", .help = "samples per side of the large field", .range = {kLeastSize, kMostSize}});
  command.add(&o.judge_every,
              {.names = "--judge-every", .help = "one in so many is also traced by exhaustive", .range = {1, 0x1p40}});
  command.add(
      &o.embree_rays,
      {.names = "--embree-rays", .help = "largest number of rays that Embree also traces, about", .range = {0, 1e15}});
  command.add(&o.dump, {.names = "--dump",
                        .value = "FILE",
                        .help = "file for the first failing rays",
                        .files = "txt",
                        .fallback = "leaks-SEED.txt"});
  command.add(&o.fans, {.names = "--fans", .help = "instead: fans beside the scalar march"});
  command.add(&o.fan_margin, {.names = "--fan-margin",
                              .help = "factor of the fans' margin",
                              .range = {0, 1e6},
                              .note = "below 1, hits may be lost",
                              .rules = {cli::needs("--fans", [&o = o] { return o.fans; })}});
}

}  // namespace scarp::bench
