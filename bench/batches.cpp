// SPDX-License-Identifier: MIT
// `scarp-bench batches`: the library's batch calls, closest_hits() and occluded(), from ten rays to ten million. A
// script typically sends a thousand rays, a film frame ten million. Rays are traced in the order of their class and
// shuffled: the difference shows the gain of sorting them.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/fields.h"
#include "bench/protocol.h"
#include "bench/rays.h"
#include "bench/report.h"
#include "bench/scarp_engine.h"
#include "bench/trace_options.h"
#include "scarp/base/parallel.h"
#include "scarp/march/height/queries.h"

namespace scarp::bench {
namespace {

// `batches`: the library's batch calls with batches of several sizes.
struct BatchesOptions {
  TraceOptions trace;
  std::vector<std::string> classes{"primary", "ao"};
  std::vector<double> batches{10, 100, 1e3, 1e4, 1e6, 1e7};  // rays
};

using Json = nlohmann::ordered_json;

constexpr std::int64_t kRaysPerPass = 2'000'000;  // minimum: small batches are repeated

// Median wall-clock time, in seconds, of a pass over `rays` in batches.
double seconds(const HeightTarget& target, bool any_hit, const std::vector<Ray>& rays, std::size_t batch, int repeats) {
  std::vector<Hit> hits(batch);
  std::vector<std::uint8_t> blocked(batch);
  std::vector<double> passes;
  for (int pass = 0; pass <= repeats; ++pass) {
    const Stopwatch watch;
    for (std::size_t begin = 0; begin + batch <= rays.size(); begin += batch) {
      const std::span<const Ray> part(rays.data() + begin, batch);
      if (any_hit) {
        occluded(target, part, blocked);
      } else {
        closest_hits(target, part, hits);
      }
    }
    if (pass > 0) passes.push_back(watch.wall_s());  // the first one warms up
  }
  return median(passes);
}

// Repeats the rays up to `count`.
std::vector<Ray> repeated(const std::vector<Ray>& rays, std::size_t count) {
  std::vector<Ray> more;
  more.reserve(count);
  while (more.size() < count) {
    const std::size_t part = std::min(rays.size(), count - more.size());
    more.insert(more.end(), rays.begin(), rays.begin() + static_cast<std::ptrdiff_t>(part));
  }
  return more;
}

void run_batches(const BatchesOptions& options, const ReportOptions& report) {
  std::vector<RayClass> classes;
  for (const std::string& name : options.classes) classes.push_back(find_ray_class(name));
  const BenchField ground = load_field(options.trace.field);
  const ScarpGround scarp(ground.field);
  Json rows = Json::array();
  std::vector<std::vector<std::string>> lines{{"class", "order", "thr", "batch", "Mrays/s", "us per batch"}};
  for (const RaySet& set : make_rays(ground, classes, options.trace.rays, options.trace.ray_seed)) {
    for (const bool shuffled : {false, true}) {
      std::vector<Ray> rays = set.library_rays;
      std::mt19937_64 random(options.trace.ray_seed);
      if (shuffled) std::shuffle(rays.begin(), rays.end(), random);
      for (const int threads : options.trace.threads) {
        const ThreadLimit limit(threads);
        for (const double size : options.batches) {
          const auto batch = static_cast<std::size_t>(size);
          const std::size_t most = std::max<std::size_t>(batch, std::min<std::size_t>(kRaysPerPass, rays.size()));
          const std::vector<Ray> asked = repeated(rays, most / batch * batch);
          const double s = seconds(scarp.target(), set.any_hit, asked, batch, options.trace.repeats);
          Json row;
          row["class"] = name_of(set.ray_class);
          row["order"] = shuffled ? "shuffled" : "own";
          row["threads"] = threads;
          row["batch"] = batch;
          row["mrays_per_s"] = static_cast<double>(asked.size()) / s * 1e-6;
          row["us_per_batch"] = s * 1e6 / static_cast<double>(asked.size() / batch);
          row["field"] = ground.name;
          row["size"] = ground.field.cols();
          lines.push_back({row["class"], row["order"], short_number(threads), short_number(batch),
                           short_number(row["mrays_per_s"]), short_number(row["us_per_batch"])});
          rows.push_back(std::move(row));
        }
      }
    }
  }
  print_table(lines, 2);
  write_json(report, rows);
}

}  // namespace

void add_batches(cli::Program& program) {
  auto [command, o] = add_command<BatchesOptions>(
      program, "batches", "The library's batch calls, from ten rays to ten million", run_batches);
  add_size_option(command, o.trace.field.size);
  add_classes_option(command, o.classes, {"primary", "shadow", "grazing", "ao"});
  command.add(cli::List<double>{&o.batches}, {.names = "--batches", .help = "rays per batch", .range = {1, 1e8}});
  add_trace_options(command, o.trace);
}

}  // namespace scarp::bench
