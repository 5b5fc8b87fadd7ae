// SPDX-License-Identifier: MIT
// `scarp-bench pitches`: cameras that look down by 0 to 90 degrees, their rays by fans, by batches, and by the choice
// between both, as pictures ask them (render/film/camera_fan.h); and in one call that finds the fan by itself
// (march/height/fan_batch.h).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/fields.h"
#include "bench/protocol.h"
#include "bench/report.h"
#include "bench/trace_options.h"
#include "scarp/base/error.h"
#include "scarp/march/height/max_mip_fan.h"
#include "scarp/march/height/max_mip_simd.h"
#include "scarp/march/height/queries.h"

namespace scarp::bench {
namespace {

// `pitches`: cameras that look down by 0 to 90 degrees, by fans, batches and the choice between both.
struct PitchesOptions {
  FieldOptions field;
  int width = 640, height = 480;  // pixels; the width is rounded down to a multiple of 32
  int step = 10;                  // degrees
  int repeats = 3;                // timed passes of each; the median counts
  double exaggeration = 1;
  double wrapped = 0;  // range of the rays in widths of the field, which wraps; 0: no wrap, no limit
};

using Json = nlohmann::ordered_json;

constexpr double kPi = std::numbers::pi;
constexpr int kSide = 32;  // pixels of a tile; a fan takes a column of tiles

struct View {
  const char* name;
  double over;  // eye over the highest ground, in widths of the field; negative: over the ground below it, metres
  double roll;
};
constexpr View kViews[] = {
    {"high", 0.3, 0}, {"above", 0.05, 0}, {"above, roll", 0.05, 0.3}, {"near", -100, 0}, {"ground", -2, 0}};

// A camera, with directions of pixels as pictures make them.
struct PixelCamera {
  dvec3 eye, corner, right, down;  // direction of the first pixel's centre, and steps to its neighbours

  dvec3 direction(int x, int y) const {
    return corner + static_cast<double>(x) * right + static_cast<double>(y) * down;
  }
};

PixelCamera camera_of(const HeightField& field, const View& view, double pitch, int width, int height) {
  PixelCamera camera;
  dvec3& eye = camera.eye;
  eye = {0.4 * field.width(), 0.35 * field.depth(), 0};
  eye.z = view.over > 0 ? field.max_height() + view.over * field.width()
                        : field.height(eye.x, eye.y).value_or(field.max_height()) - view.over;
  const double yaw = 0.7;
  const dvec3 ahead(std::sin(yaw), std::cos(yaw), 0), level(std::cos(yaw), -std::sin(yaw), 0);
  const dvec3 forward = std::cos(pitch) * ahead - dvec3(0, 0, std::sin(pitch)), over = cross(level, forward);
  const dvec3 right = std::cos(view.roll) * level + std::sin(view.roll) * over, up = cross(right, forward);
  const double half = std::tan(45.0 / 2 * kPi / 180), pixel = 2 * half / height;
  camera.right = pixel * right, camera.down = -pixel * up;
  camera.corner = forward + (0.5 - 0.5 * width) * camera.right + (0.5 - 0.5 * height) * camera.down;
  return camera;
}

// The rays of a picture: columns of tiles, in each all rows, in each 32 pixels.
std::vector<Ray> camera_rays(const PixelCamera& camera, int width, int height, double t_max) {
  std::vector<Ray> rays;
  for (int x0 = 0; x0 < width; x0 += kSide) {
    for (int y = 0; y < height; ++y) {
      for (int x = x0; x < x0 + kSide; ++x) {
        Ray ray;
        ray.origin = camera.eye;
        ray.t_max = t_max;
        ray.direction = camera.direction(x, y);
        rays.push_back(ray);
      }
    }
  }
  return rays;
}

// Calls body(i, place) for the rays of a picture in the order of its rows.
template <class Body>
void for_each_in_rows(int width, int height, const Body& body) {
  std::size_t place = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x, ++place)
      body(static_cast<std::size_t>((x / kSide * height + y) * kSide + x % kSide), place);
  }
}

void by_batch(const HeightTarget& target, std::span<const Ray> rays, std::span<Hit> hits) {
  for (std::size_t first = 0; first < rays.size(); first += kSide * kSide) {
    const std::size_t count = std::min<std::size_t>(kSide * kSide, rays.size() - first);
    closest_hits_max_mip_simd(target, rays.subspan(first, count), hits.subspan(first, count));
  }
}

void by_fan(const HeightTarget& target, const PixelCamera& camera, std::span<const Ray> rays, int height, bool always,
            std::span<Hit> hits) {
  const auto rows = static_cast<std::size_t>(height), area = rows * kSide;
  std::vector<float> dx(area), dy(area), dz(area);
  std::vector<FanSight> sights(area);
  FanOptions options;
  options.always = always;
  for (std::size_t first = 0; first < rays.size(); first += area) {
    const int x0 = static_cast<int>(first / rows);
    for (std::size_t i = 0; i < area; ++i) {
      const int x = static_cast<int>(i % kSide), y = static_cast<int>(i / kSide);
      const dvec3 d = camera.direction(x0 + x, y);
      dx[i] = static_cast<float>(d.x), dy[i] = static_cast<float>(d.y), dz[i] = static_cast<float>(d.z);
    }
    Fan fan;
    fan.origin = rays[first].origin, fan.t_max = rays[first].t_max;
    fan.dx = dx.data(), fan.dy = dy.data(), fan.dz = dz.data();
    fan.columns = kSide, fan.rows = height, fan.row_stride = kSide;
    look_max_mip_fan(target, fan, sights.data(), 0, kSide, options);
    for (std::size_t i = 0; i < area; i += kSide * kSide) {
      const std::size_t count = std::min<std::size_t>(kSide * kSide, area - i);
      closest_hits_max_mip_seen(target, rays.subspan(first + i, count), std::span(sights).subspan(i, count),
                                hits.subspan(first + i, count));
    }
  }
}

// The same samples, repeated.
HeightField periodic(const HeightField& field) {
  HeightFieldSettings settings = field.settings();
  settings.wrap = Wrap::periodic;
  return field.visit(
      [&](const auto& grid) { return HeightField::view(grid.data, grid.cols, grid.rows, settings, grid.row_stride); });
}

void run_pitches(const PitchesOptions& options, const ReportOptions& report) {
  const BenchField samples = load_field(options.field), ground = exaggerated(samples, options.exaggeration);
  const HeightField field = options.wrapped > 0 ? periodic(ground.field) : HeightField(ground.field);
  const double t_max = options.wrapped > 0 ? options.wrapped * field.width() : std::numeric_limits<double>::infinity();
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid};
  const int width = options.width / kSide * kSide, height = options.height;
  Json rows = Json::array();
  std::vector<std::vector<std::string>> lines{{"view", "down", "batch Mrays/s", "fan", "choice", "choice / better",
                                               "batch of rows", "one call", "fan's unknown %", "choice's %"}};
  for (const View& view : kViews) {
    for (int down = 0; down <= 90; down += options.step) {
      const PixelCamera camera = camera_of(field, view, down * kPi / 180, width, height);
      const std::vector<Ray> rays = camera_rays(camera, width, height, t_max);
      std::vector<Hit> truth(rays.size()), hits(rays.size());
      std::vector<Ray> in_rows(rays.size());
      for_each_in_rows(width, height, [&](std::size_t i, std::size_t place) { in_rows[place] = rays[i]; });
      constexpr int kWays = 5;
      std::vector<double> seconds[kWays];
      double unknown[kWays] = {};
      for (int pass = 0; pass < kWays * options.repeats; ++pass) {
        const int way = pass % kWays;
        take_vector_stats();
        const Stopwatch watch;
        if (way == 0) by_batch(target, rays, truth);
        if (way == 1 || way == 2) by_fan(target, camera, rays, height, way == 1, hits);
        if (way == 3) by_batch(target, in_rows, hits);
        if (way == 4) closest_hits(target, in_rows, hits);
        seconds[way].push_back(watch.cpu_s());
        bool same = (way != 1 && way != 2) || hits == truth;
        if (way > 2)
          for_each_in_rows(width, height,
                           [&](std::size_t i, std::size_t place) { same = same && hits[place] == truth[i]; });
        if (!same) throw Error(fmt::format("pitches: {} at {} degrees: hits differ", view.name, down));
        const FanStats stats = take_fan_stats();
        unknown[way] = 100 * static_cast<double>(stats.from_start) / static_cast<double>(rays.size());
      }
      const auto rate = [&](int way) { return 1e-6 * static_cast<double>(rays.size()) / median(seconds[way]); };
      Json row;
      row["view"] = view.name, row["down"] = down;
      row["batch_mrays"] = rate(0), row["fan_mrays"] = rate(1), row["choice_mrays"] = rate(2);
      row["choice_of_better"] = rate(2) / std::max(rate(0), rate(1));
      row["rows_mrays"] = rate(3), row["call_mrays"] = rate(4);
      row["fan_unknown"] = unknown[1], row["choice_unknown"] = unknown[2];
      lines.push_back(
          {view.name, short_number(row["down"]), short_number(row["batch_mrays"]), short_number(row["fan_mrays"]),
           short_number(row["choice_mrays"]), short_number(row["choice_of_better"]), short_number(row["rows_mrays"]),
           short_number(row["call_mrays"]), short_number(row["fan_unknown"]), short_number(row["choice_unknown"])});
      rows.push_back(std::move(row));
    }
  }
  print_table(lines, 1);
  write_json(report, rows);
}

}  // namespace

void add_pitches(cli::Program& program) {
  auto [command, o] = add_command<PitchesOptions>(
      program, "pitches", "Cameras that look down by 0 to 90 degrees: rays by fans, by batches, and by the choice",
      run_pitches);
  command.add(&o.field.size,
              {.names = "--size", .help = "samples per side of the procedural DEM", .range = {64, 1 << 14}});
  command.add(
      &o.width,
      {.names = "--width", .help = "columns, down to a multiple of 32", .unit = "pixels", .range = {32, 1 << 13}});
  command.add(&o.height, {.names = "--height", .help = "rows", .unit = "pixels", .range = {1, 1 << 13}});
  add_repeats_option(command, o.repeats, "timed passes of each");
  command.add(&o.exaggeration, {.names = "--exaggeration", .help = "factor of the heights", .range = {0.01, 1000}});
  command.add(&o.wrapped, {.names = "--wrapped",
                           .help = "range of the rays in widths of the field, which repeats",
                           .range = {0, 1000},
                           .note = "0: no wrap"});
  command.add(&o.step, {.names = "--step", .help = "step of the pitch", .unit = "degrees", .range = {1, 90}});
}

}  // namespace scarp::bench
