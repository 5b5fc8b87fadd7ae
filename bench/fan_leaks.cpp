// SPDX-License-Identifier: MIT
// `scarp-bench leaks --fans`: a large number of fans compared with the scalar march, which `leaks` judges.
//
// Eyes are at any height over nodes, edges and cells, beside the field, far from it and below it. Columns go through
// nodes and points of edges, or are those of cameras and scanners; some have unordered rays. Over fields that wrap,
// rays end, most of them some copies on.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <mutex>
#include <numbers>
#include <string>
#include <vector>

#include "bench/leak_fields.h"
#include "bench/leaks_options.h"
#include "bench/protocol.h"
#include "bench/random.h"
#include "bench/report.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/march/height/max_mip.h"
#include "scarp/march/height/max_mip_fan.h"
#include "scarp/march/height/rounding.h"
#include "scarp/march/usual_ray.h"
#include "scarp/scene/file/ray_dump.h"

namespace scarp::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kPi = std::numbers::pi;
constexpr int kColumns = 32, kRows = 32;
constexpr std::int64_t kPiece = kColumns * kRows;
constexpr std::size_t kDumped = 10;

enum class Kind { camera, scanner, aimed, unordered };
constexpr Kind kKinds[] = {Kind::camera, Kind::scanner, Kind::aimed, Kind::unordered};
constexpr const char* kNames[] = {"camera", "scanner", "aimed", "unordered"};

struct Count {
  std::int64_t rays = 0, hits = 0, lost = 0, wrong = 0, moved = 0, cells = 0, unlike = 0;
  FanStats stats;

  void add(const Count& c) {
    rays += c.rays, hits += c.hits, lost += c.lost, wrong += c.wrong, moved += c.moved, cells += c.cells;
    unlike += c.unlike;
    stats.rays += c.stats.rays, stats.resumed += c.stats.resumed, stats.from_start += c.stats.from_start;
  }
  bool clean() const { return lost == 0 && wrong == 0 && moved == 0 && unlike == 0; }
};

double tall(const HeightField& f) { return std::max(f.max_height() - f.min_height(), 0.01 * f.settings().cell_x); }

dvec3 make_eye(const HeightField& f, Random& random) {
  const auto along = [&](int cells) {
    switch (random.below(12)) {
      case 0:
        return random.uniform(-2, 3) * cells;
      case 1:
        return static_cast<double>(random.below(cells + 1));
      case 2:
        // Rays along lines visit each cell of the copies between.
        return random.uniform() * cells * (f.wraps() ? 10 : 1000);
      default:
        return random.uniform() * cells;
    }
  };
  const dvec3 at = f.world_from_grid(along(f.cell_cols()), along(f.cell_rows()), 0);
  const double ground = f.height(at.x, at.y).value_or(f.min_height() + random.uniform() * tall(f));
  const int kind = random.below(12);
  const double above = kind == 0   ? -random.uniform()
                       : kind == 1 ? random.uniform(1, 50)
                                   : std::exp2(random.uniform(-20, 1));
  return {at.x, at.y, ground + above * tall(f)};
}

dvec3 direction_to(double azimuth, double altitude) {
  return {std::sin(azimuth) * std::cos(altitude), std::cos(azimuth) * std::cos(altitude), std::sin(altitude)};
}

// The arrays of a fan, in rows.
struct FanRays {
  dvec3 eye;
  double t_max = std::numeric_limits<double>::infinity();
  std::vector<float> dx = std::vector<float>(kPiece), dy = dx, dz = dx;

  void put(int column, int row, dvec3 d) {
    const auto i = static_cast<std::size_t>(row * kColumns + column);
    dx[i] = static_cast<float>(d.x), dy[i] = static_cast<float>(d.y), dz[i] = static_cast<float>(d.z);
  }
  Ray ray(std::size_t i) const {
    Ray ray;
    ray.origin = eye;
    ray.direction = {static_cast<double>(dx[i]), static_cast<double>(dy[i]), static_cast<double>(dz[i])};
    ray.t_max = t_max;
    return ray;
  }
};

FanRays make_fan(Kind kind, const HeightField& f, Random& random) {
  FanRays rays{make_eye(f, random)};
  const bool aimed = kind == Kind::aimed || kind == Kind::unordered;
  if (f.wraps()) rays.t_max = random.uniform(0, 8) * (aimed ? 1 : f.width() + f.depth());
  // Slopes that suit the field: rays hit the ground near and far away.
  const double lift = random.below(2) ? tall(f) / (f.width() + f.depth()) : 1;
  const double yaw = random.uniform(0, 2 * kPi), pitch = random.uniform(-1.2, 0.4);
  const double roll = random.below(3) ? 0 : random.uniform(-0.3, 0.3), half = std::exp2(random.uniform(-8, 0));
  const dvec3 forward = direction_to(yaw, pitch), flat = normalize(cross(forward, dvec3(0, 0, 1)));
  const dvec3 right = std::cos(roll) * flat + std::sin(roll) * cross(flat, forward), up = cross(right, forward);
  std::vector<dvec3> column(kRows);
  for (int c = 0; c < kColumns; ++c) {
    dvec3 node{};
    for (int r = 0; r < kRows; ++r) {
      dvec3& d = column[static_cast<std::size_t>(r)];
      if (kind == Kind::camera) {
        d = forward + half * ((c + 0.5) / kColumns * 2 - 1) * right + half * (1 - (r + 0.5) / kRows * 2) * up;
        d.z *= lift;
      } else if (kind == Kind::scanner) {
        d = direction_to(yaw + 2 * kPi * c / kColumns, 0.5 - 1.5 * (r + 0.5) / kRows);
        d.z *= lift;
      } else {
        if (r == 0 || kind == Kind::unordered) {
          node = {static_cast<double>(random.below(f.cols())), static_cast<double>(random.below(f.rows())), 0};
          if (random.below(4) == 0) node.x += random.uniform() < 0.5 ? 0.5 : random.uniform();
        }
        // Towards the node or slightly beside it, on the surface or slightly above or below it.
        const double beside = random.below(3) ? 0 : std::exp2(random.uniform(-30, 0));
        dvec3 to = f.world_from_grid(std::min(node.x + beside, static_cast<double>(f.cell_cols())), node.y, 0);
        to.z = f.height(to.x, to.y).value_or(f.min_height()) +
               (random.below(2) ? 0 : random.uniform(-1, 1) * std::exp2(random.uniform(-20, 0)) * tall(f));
        d = to - rays.eye;
        if (d == dvec3(0.0)) d.z = -1;
      }
    }
    if (kind == Kind::aimed) {
      const auto slope = [](const dvec3& d) { return d.z / std::hypot(d.x, d.y); };
      std::sort(column.begin(), column.end(), [&](const dvec3& a, const dvec3& b) { return slope(a) < slope(b); });
    }
    for (int r = 0; r < kRows; ++r) rays.put(c, r, column[static_cast<std::size_t>(r)]);
  }
  return rays;
}

// The tolerance of fans in numerics.md: the maximum distance of a hit from the surface, in sample units.
double tolerance(const LeakField& ground, const GridRay& g, double t) {
  const double relief = std::min(ground.field.max_sample() - ground.field.min_sample(),
                                 ground.pyramid.cell_relief() * ground.pyramid.code().step);
  const double cells = std::max(std::abs(g.direction.x), std::abs(g.direction.y)) * t;
  return 0x1p-18 * (std::abs(g.direction.z) * t + (cells + 12) * relief) +
         8 * rounding_of_clearance(ground.field, g, t);
}

// Whether two times belong to the same hit: between them the ray runs along the surface.
bool same_hit(const LeakField& ground, const Ray& ray, double t, double truth) {
  const HeightField& f = ground.field;
  const GridRay g = f.grid_from_world(ray);
  const double most = 2 * tolerance(ground, g, std::max(t, truth));
  for (int i = 0; i <= 8; ++i) {
    const dvec3 p = ray.at(t + (truth - t) * i / 8);
    const auto z = f.height(p.x, p.y);
    if (z && std::abs(p.z - *z) * f.grid_scales().per_scale > most) return false;
  }
  return true;
}

class FanLeaks {
 public:
  FanLeaks(const LeaksOptions& options, const std::vector<LeakField>& fields) : options_(options) {
    for (const LeakField& field : fields) {
      if (field.field.has_cells() && !field.field.all_nodata()) grounds_.push_back(&field);
    }
  }

  void run() {
    const std::int64_t pieces = (options_.rays + kPiece - 1) / kPiece;
    parallel_for(pieces, 1, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t piece = begin; piece < end; ++piece) run_piece(piece);
    });
  }

  std::size_t grounds() const { return grounds_.size(); }
  const Count* counts() const { return counts_; }
  std::vector<RayDump> failures() const {
    std::vector<RayDump> dumps;
    for (const auto& [index, dump] : failures_) dumps.push_back(dump);
    return dumps;
  }

 private:
  void run_piece(std::int64_t piece) {
    const auto k = static_cast<std::size_t>(piece % static_cast<std::int64_t>(std::size(kKinds)));
    const LeakField& ground =
        *grounds_[static_cast<std::size_t>(piece / static_cast<std::int64_t>(std::size(kKinds))) % grounds_.size()];
    Random random(options_.seed, static_cast<std::uint64_t>(piece));
    const FanRays rays = make_fan(kKinds[k], ground.field, random);
    Fan fan;
    fan.origin = rays.eye;
    fan.dx = rays.dx.data(), fan.dy = rays.dy.data(), fan.dz = rays.dz.data();
    fan.columns = kColumns, fan.rows = kRows, fan.row_stride = kColumns;
    fan.t_max = rays.t_max;
    std::vector<float> t(kPiece), u(kPiece), v(kPiece);
    std::vector<std::int32_t> col(kPiece), row(kPiece);
    std::vector<HitStatus> status(kPiece);
    FanOptions walk;
    walk.always = true, walk.margin = static_cast<float>(options_.fan_margin);
    take_fan_stats();
    closest_hits_max_mip_fan(ground.target(), fan,
                             {t.data(), col.data(), row.data(), u.data(), v.data(), status.data()}, 0, kColumns, walk);
    Count sum;
    sum.stats = take_fan_stats();
    for (std::size_t i = 0; i < static_cast<std::size_t>(kPiece); ++i) {
      const Ray ray = rays.ray(i);
      if (!is_followable(ray)) continue;
      const Hit truth = march_max_mip(ground.target(), ray);
      ++sum.rays;
      sum.hits += static_cast<bool>(truth);
      const auto fails = [&](std::int64_t& counter, const char* why) {
        ++counter;
        keep(piece * kPiece + static_cast<std::int64_t>(i), ground, ray,
             fmt::format("{} over '{}': {}", kNames[k], ground.name, why), truth, static_cast<double>(t[i]));
      };
      if (status[i] != truth.status) {
        if (truth) {
          fails(sum.lost, "lost");
        } else {
          fails(sum.wrong, "false");
        }
      } else if (truth && !truth.wall) {
        sum.cells += Cell{col[i], row[i]} != truth.cell;
        if (!same_hit(ground, ray, static_cast<double>(t[i]), truth.t)) fails(sum.moved, "another hit");
      }
    }
    look(piece, ground, rays, fan, walk, random, sum);
    const std::scoped_lock lock(mutex_);
    counts_[k].add(sum);
  }

  // Hits of double-precision rays that the fan has searched for must equal those of the march, bit for bit.
  void look(std::int64_t piece, const LeakField& ground, const FanRays& rays, const Fan& fan, const FanOptions& options,
            Random& random, Count& sum) {
    std::vector<FanSight> sights(kPiece);
    look_max_mip_fan(ground.target(), fan, sights.data(), 0, kColumns, options);
    std::vector<Ray> precise;
    for (std::size_t i = 0; i < sights.size(); ++i) {
      Ray ray = rays.ray(i);
      if (!is_followable(ray)) ray.direction = {0, 0, -1}, sights[i] = {-std::numeric_limits<float>::infinity(), 0};
      // Changed by less than half a unit of the last digit.
      for (int axis = 0; axis < 3; ++axis) ray.direction[axis] *= 1 + random.uniform(-0.99, 0.99) * 0x1p-25;
      // Distances, as aimed rays are as long as the way to their node.
      if (random.below(4) == 0)
        ray.t_max = 2 * random.uniform() * std::max(ground.field.width(), 1.0) / length(ray.direction);
      precise.push_back(ray);
    }
    std::vector<Hit> hits(kPiece);
    closest_hits_max_mip_seen(ground.target(), precise, sights, hits);
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const Hit truth = march_max_mip(ground.target(), precise[i]);
      if (hits[i] == truth) continue;
      ++sum.unlike;
      keep(piece * kPiece + static_cast<std::int64_t>(i), ground, precise[i], "a sight leads to another hit", truth,
           hits[i].t);
    }
  }

  void keep(std::int64_t index, const LeakField& ground, const Ray& ray, const std::string& why, const Hit& truth,
            double t) {
    const std::scoped_lock lock(mutex_);
    failures_.try_emplace(
        index, RayDump{ground.field, ground.generator, ray, why, fmt::format("t {:a}, march t {:a}", t, truth.t)});
    if (failures_.size() > kDumped) failures_.erase(std::prev(failures_.end()));
  }

  const LeaksOptions& options_;
  std::vector<const LeakField*> grounds_;
  std::mutex mutex_;
  Count counts_[std::size(kKinds)];
  std::map<std::int64_t, RayDump> failures_;
};

}  // namespace

void run_fan_leaks(const LeaksOptions& options, const ReportOptions& report) {
  const Stopwatch watch;
  const std::vector<LeakField> fields = make_leak_fields(options.seed, options.large, false);
  FanLeaks leaks(options, fields);
  leaks.run();
  Json rows = Json::array();
  std::vector<std::vector<std::string>> lines{{"fan", "rays", "hits %", "lost", "false", "another hit",
                                               "another by sight", "another cell", "resumed %", "to the batch %"}};
  Count total;
  const auto add_row = [&](const char* name, const Count& c) {
    const auto share = [&](std::uint64_t part) {
      return static_cast<double>(part) / static_cast<double>(std::max<std::int64_t>(c.rays, 1));
    };
    Json row;
    row["fan"] = name, row["rays"] = c.rays, row["hit_share"] = share(static_cast<std::uint64_t>(c.hits));
    row["lost"] = c.lost, row["false"] = c.wrong, row["moved"] = c.moved, row["unlike"] = c.unlike,
    row["other_cell"] = c.cells;
    row["resumed"] = share(c.stats.resumed), row["from_start"] = share(c.stats.from_start);
    row["walked"] = c.stats.rays, row["seed"] = options.seed;
    lines.push_back({name, short_number(row["rays"]), short_number(100 * row["hit_share"].get<double>()),
                     short_number(row["lost"]), short_number(row["false"]), short_number(row["moved"]),
                     short_number(row["unlike"]), short_number(row["other_cell"]),
                     short_number(100 * row["resumed"].get<double>()),
                     short_number(100 * row["from_start"].get<double>())});
    rows.push_back(std::move(row));
  };
  for (std::size_t k = 0; k < std::size(kKinds); ++k) {
    add_row(kNames[k], leaks.counts()[k]);
    total.add(leaks.counts()[k]);
  }
  add_row("all", total);
  fmt::print("{} rays, seed {}, {} fields\n", total.rays, options.seed, leaks.grounds());
  print_table(lines, 1);
  fmt::print("{:.0f} s, {:.3g} us of processor time per ray\n", watch.wall_s(),
             1e6 * watch.cpu_s() / static_cast<double>(std::max<std::int64_t>(total.rays, 1)));
  write_json(report, rows);
  if (total.clean()) return;
  const std::string dump = options.dump.empty() ? fmt::format("fan-leaks-{}.txt", options.seed) : options.dump;
  const std::vector<RayDump> failures = leaks.failures();
  write_ray_dumps(dump, failures);
  throw Error(fmt::format(
      "leaks --fans: {} lost, {} false, {} other hits, {} by sight; the first {} are in '{}', for scarp replay",
      total.lost, total.wrong, total.moved, total.unlike, failures.size(), dump));
}

}  // namespace scarp::bench
