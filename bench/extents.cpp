// SPDX-License-Identifier: MIT
// `scarp-bench extents`: fields up to 65,536 samples wide. Rays aimed at nodes, from above and within a window, are
// also traced in a small field cut out of the large one: the results must be equal. Also measures how the cost of a ray
// in batches, on one thread, grows with the field, by class.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/fields.h"
#include "bench/protocol.h"
#include "bench/random.h"
#include "bench/rays.h"
#include "bench/report.h"
#include "bench/scarp_engine.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/march/height/max_mip.h"
#include "scarp/march/height/rounding.h"

namespace scarp::bench {
namespace {

// `extents`: the largest fields, int16, compared with windows cut out of them.
struct ExtentsOptions {
  std::vector<std::pair<int, int>> sizes{{65536, 512}, {65536, 65536}};  // columns and rows
  std::int64_t windows = 256;                                            // each with 256 rays
};

using Json = nlohmann::ordered_json;

constexpr int kWindow = 512;    // samples per side of the field cut out
constexpr double kAbove = 600;  // height above the target node at which rays start
constexpr int kAside = 40;      // maximum distance from the node along each axis
// The ground rises by less than 4 per cell along each axis. Along a ray, the clearance therefore falls by kAbove per t,
// less the largest fall of the ground along its plan track of at most sqrt(2) kAside cells.
constexpr double kFall = kAbove - 4 * 1.4142136 * 1.4142136 * kAside;

const std::vector<RayClass> kGrowthClasses{RayClass::primary, RayClass::shadow, RayClass::grazing, RayClass::ao};
constexpr RayCounts kGrowthRays{960, 544, 1 << 18, 1 << 18};

// Hills of several lengths, in integers, plus a hash: computes the height of each sample without a table.
std::int16_t height(int col, int row) {
  const auto wave = [](int x, int length) { return std::abs(x % (2 * length) - length); };
  auto hash = static_cast<std::uint32_t>(col) * 0x9e3779b1u ^ static_cast<std::uint32_t>(row) * 0x85ebca77u;
  hash = (hash ^ (hash >> 15)) * 0x2c1b3c6du;
  const int hills = wave(col + row / 3, 1021) / 4 + wave(row - col / 5 + 100'000, 331) / 3 + wave(col, 67) / 4;
  return static_cast<std::int16_t>(hills + static_cast<int>(hash >> 30));
}

HeightField make_field(int col, int row, int cols, int rows) {
  std::vector<std::int16_t> samples(static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows));
  parallel_for(rows, 16, [&](std::int64_t begin, std::int64_t end) {
    for (int r = static_cast<int>(begin); r < end; ++r) {
      for (int c = 0; c < cols; ++c) samples[static_cast<std::size_t>(r) * cols + c] = height(col + c, row + r);
    }
  });
  return HeightField::own(std::move(samples), cols, rows);
}

struct Aimed {
  Ray ray;
  int col, row;  // of the window
};

// Rays from above at nodes inside a window; the segments end below the lowest ground.
std::vector<Aimed> aimed_rays(int cols, int rows, std::int64_t windows, int per_window) {
  std::vector<Aimed> rays;
  for (std::int64_t w = 0; w < windows; ++w) {
    Random random(1, static_cast<std::uint64_t>(w));
    const int col = random.below(cols - kWindow + 1), row = random.below(rows - kWindow + 1);
    for (int i = 0; i < per_window; ++i) {
      const auto inside = [&](int first) { return first + 1 + random.below(kWindow - 2); };
      const int c = inside(col), r = inside(row);
      const dvec3 node{c, rows - 1 - r, static_cast<double>(height(c, r))};
      const auto beside = [&](int at, int first) {
        return std::clamp(at - kAside + random.below(2 * kAside + 1), first, first + kWindow - 1);
      };
      const dvec3 from{beside(c, col), rows - 1 - beside(r, row), node.z + kAbove};
      Aimed aimed{{}, col, row};
      aimed.ray.origin = from;
      aimed.ray.direction = node - from;
      aimed.ray.t_max = 1 + 1 / kAbove;
      rays.push_back(aimed);
    }
  }
  return rays;
}

// Processor time per ray in batches, in ns: the best of three passes.
double ns_in_batches(const HeightTarget& target, const RaySet& set) {
  constexpr std::int64_t kBatch = 4096;
  constexpr int kPasses = 3;
  std::vector<Hit> hits(kBatch);
  std::vector<std::uint8_t> blocked(kBatch);
  double best_s = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < kPasses; ++pass) {
    const Stopwatch watch;
    for (std::int64_t begin = 0; begin < set.size(); begin += kBatch) {
      const auto count = static_cast<std::size_t>(std::min(kBatch, set.size() - begin));
      const std::span<const Ray> part(set.library_rays.data() + begin, count);
      if (set.any_hit) {
        occluded_max_mip_simd(target, part, {blocked.data(), count});
      } else {
        closest_hits_max_mip_simd(target, part, {hits.data(), count});
      }
    }
    best_s = std::min(best_s, watch.cpu_s());
  }
  return 1e9 * best_s / static_cast<double>(set.size());
}

Json measure(int cols, int rows, const ExtentsOptions& options) {
  Stopwatch watch;
  const HeightField field = make_field(0, 0, cols, rows);
  const double fill_s = watch.wall_s();
  watch = {};
  const MaxPyramid pyramid(field);
  const double build_s = watch.wall_s();
  const HeightTarget target{&field, &pyramid};

  constexpr int kPerWindow = 256;
  const auto rays = aimed_rays(cols, rows, options.windows, kPerWindow);
  std::vector<Hit> hits;
  watch = {};
  for (const Aimed& aimed : rays) hits.push_back(march_max_mip(target, aimed.ray));
  const double cast_s = watch.wall_s();

  std::int64_t lost = 0, different = 0;
  for (std::size_t i = 0; i < rays.size(); i += kPerWindow) {
    const HeightField window = make_field(rays[i].col, rays[i].row, kWindow, kWindow);
    const MaxPyramid window_pyramid(window);
    for (std::size_t k = i; k < i + kPerWindow; ++k) {
      Ray ray = rays[k].ray;
      ray.origin.x -= rays[k].col;
      ray.origin.y -= rows - kWindow - rays[k].row;
      const Hit &whole = hits[k], part = march_max_mip({&window, &window_pyramid}, ray);
      lost += !whole || !part;
      if (!whole || !part) continue;
      // Positions in the large field are larger numbers, so their rounding bounds both clearances.
      const double bound = rounding_of_clearance(field, field.grid_from_world(rays[k].ray), whole.t);
      different += std::abs(whole.t - part.t) * kFall > 2 * bound;
    }
  }
  Json row;
  row["cols"] = cols;
  row["rows"] = rows;
  row["sample_type"] = name_of(field.sample_type());
  row["bytes_per_sample"] = 2 + static_cast<double>(pyramid.bytes()) / (static_cast<double>(cols) * rows);
  row["fill_s"] = fill_s;
  row["build_s"] = build_s;
  row["gsamples_per_s"] = static_cast<double>(cols) * rows / build_s * 1e-9;
  row["rays"] = rays.size();
  row["ns_per_ray"] = 1e9 * cast_s / static_cast<double>(rays.size());
  const BenchField ground{field, "hills", field.max_height() - field.min_height(), 0};
  for (const RaySet& set : make_rays(ground, kGrowthClasses, kGrowthRays, 1))
    row[std::string(name_of(set.ray_class)) + "_ns"] = ns_in_batches(target, set);
  row["lost"] = lost;
  row["different"] = different;
  return row;
}

void run_extents(const ExtentsOptions& options, const ReportOptions& report) {
  Json rows = Json::array();
  std::vector<std::vector<std::string>> lines{{"samples", "type", "B/sample", "build s", "Gsamples/s", "rays", "ns/ray",
                                               "primary", "shadow", "grazing", "ao", "lost", "different"}};
  for (const auto& [cols, count] : options.sizes) {
    if (std::min(cols, count) < kWindow) {
      throw Error(
          fmt::format("extents: {} x {} samples: at least {} are needed along each side", cols, count, kWindow));
    }
    const Json row = rows.emplace_back(measure(cols, count, options));
    lines.push_back({fmt::format("{} x {}", cols, count), row["sample_type"], short_number(row["bytes_per_sample"]),
                     short_number(row["build_s"]), short_number(row["gsamples_per_s"]), short_number(row["rays"]),
                     short_number(row["ns_per_ray"]), short_number(row["primary_ns"]), short_number(row["shadow_ns"]),
                     short_number(row["grazing_ns"]), short_number(row["ao_ns"]), short_number(row["lost"]),
                     short_number(row["different"])});
  }
  print_table(lines, 2);
  write_json(report, rows);
}

// "65536x512,65536x65536".
std::vector<std::pair<int, int>> sizes_from(const std::string& text) {
  constexpr int kMost = 65537;
  std::vector<std::pair<int, int>> sizes;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string size = text.substr(begin, end - begin);
    int cols = 0, rows = 0, read = 0;
    if (std::sscanf(size.c_str(), "%dx%d%n", &cols, &rows, &read) != 2 || size.c_str()[read] != '\0' ||
        std::max(cols, rows) > kMost || std::min(cols, rows) < 1) {
      throw cli::WrongUsage(
          fmt::format("--sizes '{}': expected COLSxROWS, each at most {}, for example 65536x512", size, kMost));
    }
    sizes.emplace_back(cols, rows);
    begin = end + 1;
  }
  return sizes;
}

}  // namespace

void add_extents(cli::Program& program) {
  auto [command, o] = add_command<ExtentsOptions>(program, "extents",
                                                  "The largest fields, beside windows cut out of them", run_extents);
  command.add([&sizes = o.sizes](const std::string& text) { sizes = sizes_from(text); },
              {.names = "--sizes",
               .value = "COLSxROWS,...",
               .help = "samples of the fields",
               .note = "65536x65536 takes 15 GB",
               .fallback = "65536x512,65536x65536"});
  command.add(&o.windows, {.names = "--windows", .help = "windows, of 256 rays each", .range = {1, 1e6}});
}

}  // namespace scarp::bench
