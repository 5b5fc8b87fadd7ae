// SPDX-License-Identifier: MIT
// `scarp-bench calls`: the commonest queries of games and robots, each beside the code it competes with.
//
//   heights, normals   the library's calls beside a loop as one would write it: cell, four samples, bilinear
//   feet, probe, sun   cast() beside occluded() for the same rays, single and in batches of several sizes
//
// Points are random, or along a walk of small steps. A small field fits into the cache, a large one does not.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "bench/call_ways.h"
#include "bench/command.h"
#include "bench/commands.h"
#include "bench/fields.h"
#include "bench/random.h"
#include "bench/report.h"
#include "bench/trace_options.h"
#include "scarp/base/parallel.h"
#include "scarp/field/ground_points.h"
#include "scarp/scene/cast.h"
#include "scarp/scene/terrain.h"

namespace scarp::bench {
namespace {

struct CallsOptions {
  FieldOptions field;
  std::vector<int> sizes{257, 4097};
  std::vector<std::string> of{"heights", "normals", "feet", "stilt", "probe", "sun"};
  int points = 1 << 17;
  int repeats = 5;
};

using Json = nlohmann::ordered_json;

struct Points {
  std::vector<double> x, y;
};

// Positions over the inner part of a field with cells of 1 x 1.
Points random_points(const HeightField& field, int count) {
  Points points;
  for (int i = 0; i < count; ++i) {
    Random random(1, static_cast<std::uint64_t>(i));
    points.x.push_back(random.uniform(2, field.width() - 2));
    points.y.push_back(random.uniform(2, field.depth() - 2));
  }
  return points;
}

// Steps of 0.3 cells whose direction turns slowly; turns back at the border.
Points walk_points(const HeightField& field, int count) {
  Points points;
  Random random(2, 0);
  double x = field.width() / 2, y = field.depth() / 2, angle = 0;
  for (int i = 0; i < count; ++i) {
    angle += random.uniform(-0.1, 0.1);
    x = std::clamp(x + 0.3 * std::cos(angle), 2.0, field.width() - 2);
    y = std::clamp(y + 0.3 * std::sin(angle), 2.0, field.depth() - 2);
    if (x == 2 || y == 2 || x == field.width() - 2 || y == field.depth() - 2) angle += 2;
    points.x.push_back(x), points.y.push_back(y);
  }
  return points;
}

// The samples of a field, as a program keeps them that has its own lookup.
struct OwnGround {
  std::vector<float> samples;
  int cols, rows;
  double per_cell_x, per_cell_y, scale, offset;
};
OwnGround own_ground(const HeightField& field) {
  const HeightFieldSettings& s = field.settings();
  OwnGround own{{}, field.cols(), field.rows(), 1 / s.cell_x, 1 / s.cell_y, s.scale, s.offset};
  field.visit([&](const auto& grid) {
    for (int row = 0; row < grid.rows; ++row) {
      for (int col = 0; col < grid.cols; ++col) own.samples.push_back(static_cast<float>(grid.at(col, row)));
    }
  });
  return own;
}

// The obvious loop: bounds, cell, four samples, bilinear, in double. The normal, if asked for, from the two slopes.
template <bool with_normals>
void look_up(const OwnGround& g, const Points& points, std::vector<double>& heights, std::vector<dvec3>& normals) {
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    const double col = points.x[i] * g.per_cell_x, row = (g.rows - 1) - points.y[i] * g.per_cell_y;
    if (!(col >= 0 && row >= 0 && col <= g.cols - 1 && row <= g.rows - 1)) {
      heights[i] = std::numeric_limits<double>::quiet_NaN();
      continue;
    }
    const int c = std::min(static_cast<int>(col), g.cols - 2), r = std::min(static_cast<int>(row), g.rows - 2);
    const double u = col - c, v = row - r;
    const float* at = g.samples.data() + static_cast<std::size_t>(r) * static_cast<std::size_t>(g.cols) + c;
    const double nw = at[0], ne = at[1], sw = at[g.cols], se = at[g.cols + 1];
    const double north = nw + u * (ne - nw), south = sw + u * (se - sw);
    heights[i] = (north + v * (south - north)) * g.scale + g.offset;
    if constexpr (with_normals) {
      const double east = (ne - nw) + v * ((se - sw) - (ne - nw)), down = south - north;
      normals[i] = normalize(dvec3(-east * g.scale * g.per_cell_x, down * g.scale * g.per_cell_y, 1.0));
    }
  }
}

class Calls {
 public:
  explicit Calls(const CallsOptions& options) : options_(options) {}

  void run(int size) {
    FieldOptions of_size = options_.field;
    of_size.size = size;
    const BenchField ground = load_field(of_size);
    const Terrain terrain(ground.field);
    for (const bool walk : {false, true}) {
      points_ = walk ? walk_points(ground.field, options_.points) : random_points(ground.field, options_.points);
      order_ = walk ? "walk" : "random";
      size_ = size;
      for (const std::string& task : options_.of) {
        if (task == "heights" || task == "normals") {
          look_at_points(terrain, task);
        } else {
          trace(terrain, task);
        }
      }
    }
  }

  void report(const ReportOptions& report) const {
    print_table(lines_, 4);
    write_json(report, rows_);
  }

 private:
  void look_at_points(const Terrain& terrain, const std::string& task) {
    const HeightField& field = terrain.field();
    const OwnGround own = own_ground(field);
    const bool with_normals = task == "normals";
    std::vector<double> heights(points_.x.size());
    std::vector<dvec3> normals(points_.x.size());
    const Points& p = points_;
    std::vector<CallWay> ways;
    ways.push_back({"obvious loop", [&] {
                      with_normals ? look_up<true>(own, p, heights, normals) : look_up<false>(own, p, heights, normals);
                    }});
    ways.push_back({"batch", [&] {
                      heights_at(field, p.x, p.y, heights, with_normals ? std::span(normals) : std::span<dvec3>());
                    }});
    if (!with_normals) ways.push_back({"batch of a scene", [&] { heights_at(terrain.scene(), p.x, p.y, heights); }});
    ways.push_back({"single", [&] {
                      for (std::size_t i = 0; i < p.x.size(); ++i) {
                        if (!with_normals) {
                          heights[i] = field.height(p.x[i], p.y[i]).value_or(0);
                          continue;
                        }
                        const auto at = ground_point(field, p.x[i], p.y[i]).value();
                        heights[i] = at.height, normals[i] = at.normal;
                      }
                    }});
    add_rows(task, ways, 0);
  }

  std::vector<Ray> rays_of(const Terrain& terrain, const std::string& task) const {
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < points_.x.size(); ++i) {
      Random random(3, i);
      const double x = points_.x[i], y = points_.y[i], z = terrain.height(x, y).value();
      const double angle = random.uniform(0, 6.2831853);
      Ray ray;
      if (task == "feet") {  // down from the knee
        ray = {.origin = {x, y, z + 0.5}, .direction = {0, 0, -1}, .t_max = 2};
      } else if (task == "stilt") {  // the same, slanted
        ray = {.origin = {x, y, z + 0.5}, .direction = {0.1, 0.05, -1}, .t_max = 2};
      } else if (task == "probe") {  // 2 cells in any direction, slightly down
        ray = {.origin = {x, y, z + 0.5}, .direction = {std::cos(angle), std::sin(angle), -0.4}, .t_max = 2};
      } else {  // to the sun, 20 degrees high
        ray = {.origin = {x, y, z + 0.01}, .direction = {0.66, 0.66, 0.34}};
      }
      rays.push_back(ray);
    }
    return rays;
  }

  void trace(const Terrain& terrain, const std::string& task) {
    const std::vector<Ray> rays = rays_of(terrain, task);
    std::vector<Hit> hits(rays.size());
    std::vector<std::uint8_t> blocked(rays.size());
    const Scene& scene = terrain.scene();
    std::vector<CallWay> ways;
    ways.push_back({"cast, single", [&] {
                      for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = cast(scene, rays[i]);
                    }});
    ways.push_back({"occluded, single", [&] {
                      for (std::size_t i = 0; i < rays.size(); ++i) blocked[i] = occluded(scene, rays[i]);
                    }});
    for (const std::size_t batch : {std::size_t{1}, std::size_t{4}, std::size_t{16}, std::size_t{64}, rays.size()}) {
      const std::string name = batch == rays.size() ? "all" : std::to_string(batch);
      const auto in_batches = [&rays, batch](const auto& call) {
        for (std::size_t i = 0; i < rays.size(); i += batch) call(i, std::min(batch, rays.size() - i));
      };
      ways.push_back({"cast, batches of " + name, [&, in_batches] {
                        in_batches([&](std::size_t first, std::size_t count) {
                          cast(scene, std::span(rays).subspan(first, count), std::span(hits).subspan(first, count));
                        });
                      }});
      ways.push_back({"occluded, batches of " + name, [&, in_batches] {
                        in_batches([&](std::size_t first, std::size_t count) {
                          occluded(scene, std::span(rays).subspan(first, count),
                                   std::span(blocked).subspan(first, count));
                        });
                      }});
    }
    add_rows(task, ways, 0);
  }

  // Ratios are to the way with this index.
  void add_rows(const std::string& task, const std::vector<CallWay>& ways, std::size_t reference) {
    const std::vector<double> ns = measure_ways(ways, points_.x.size(), options_.repeats);
    for (std::size_t w = 0; w < ways.size(); ++w) {
      Json row;
      row["size"] = size_;
      row["order"] = order_;
      row["task"] = task;
      row["way"] = ways[w].name;
      row["ns"] = ns[w];
      row["ratio"] = ns[w] / ns[reference];
      lines_.push_back(
          {std::to_string(size_), order_, task, ways[w].name, short_number(row["ns"]), short_number(row["ratio"])});
      rows_.push_back(std::move(row));
    }
  }

  const CallsOptions& options_;
  Points points_;
  std::string order_;
  int size_ = 0;
  Json rows_ = Json::array();
  std::vector<std::vector<std::string>> lines_{{"size", "order", "task", "way", "ns", "ratio"}};
};

void run_calls(const CallsOptions& options, const ReportOptions& report) {
  const ThreadLimit one(1);
  Calls calls(options);
  for (const int size : options.sizes) calls.run(size);
  calls.report(report);
}

}  // namespace

void add_calls(cli::Program& program) {
  auto [command, o] = add_command<CallsOptions>(
      program, "calls", "Heights, normals and short rays, single and in batches, on one thread", run_calls);
  add_sizes_option(command, o.sizes);
  command.add(cli::List<std::string>{&o.of}, {.names = "--of",
                                              .help = "queries to measure",
                                              .choices = {"heights", "normals", "feet", "stilt", "probe", "sun"},
                                              .closed = true});
  command.add(&o.points, {.names = "--points", .help = "points or rays per pass", .range = {64, 1 << 26}});
  add_ground_options(command, o.field);
  add_repeats_option(command, o.repeats);
}

}  // namespace scarp::bench
