// SPDX-License-Identifier: MIT
// `scarp-bench shapes`: sphere-trace over distance fields, on the pixels of one picture and the shadow rays from it,
// compared with plain sphere tracing and checked by the judge's proofs.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/random.h"
#include "bench/report.h"
#include "bench/trace_options.h"
#include "scarp/accel/slope_bound.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/field/distance_field.h"
#include "scarp/march/shape/shape_exhaustive.h"
#include "scarp/march/shape/shape_table.h"
#include "scarp/march/shape/sphere_trace.h"

namespace scarp::bench {
namespace {

// `shapes`: sphere-trace over distance fields, compared with plain sphere tracing and checked by proofs.
struct ShapesOptions {
  int width = 480, height = 270;  // pixels
  int repeats = 3;
  std::int64_t judged = 1000;  // about this many rays per shape are judged
};

using Json = nlohmann::ordered_json;
using namespace shape;

constexpr double kFarthest = 400;  // maximum length of a ray in metres

struct Scene {
  std::string name;
  Shape shape;
};

Shape moved(Shape shape, const dvec3& by) { return make_shape(Moved{std::move(shape), by}); }

std::vector<Scene> scenes() {
  const Fractal hills{.wavelength = 60, .height = 8, .octaves = {6, 6, 6}};
  const auto function = std::make_shared<HeightFunction>(make_function(hills));
  const Shape ground = make_shape(FunctionGround{function});
  const Shape block = make_shape(Turned{make_shape(Box{{6, 6, 6}, 0.5}), {0.2, 0.3, 1}, 0.6});
  const Shape ring = make_shape(Torus{9, 2});
  std::vector<Shape> founding{ground, moved(make_shape(Sphere{8}), {-20, 10, 4}), moved(block, {12, 0, 4}),
                              moved(ring, {0, 35, 6})};
  std::vector<Shape> many;
  Random random(7, 0);
  const auto between = [&](double low, double high) { return random.uniform(low, high); };
  for (int i = 0; i < 300; ++i) {
    const Shape solid = i % 3 == 0   ? make_shape(Sphere{between(0.5, 3)})
                        : i % 3 == 1 ? make_shape(Torus{between(1, 3), 0.5})
                                     : make_shape(Cone{between(0.5, 2), between(1, 5)});
    many.push_back(moved(solid, {between(-60, 60), between(-60, 60), between(-15, 15)}));
  }
  std::vector<Shape> blobs;
  for (int i = 0; i < 12; ++i) {
    blobs.push_back(moved(make_shape(Sphere{between(3, 7)}), {between(-18, 18), between(-18, 18), between(-10, 10)}));
  }
  std::vector<float> samples;
  for (int row = 0; row < 257; ++row) {
    for (int col = 0; col < 257; ++col)
      samples.push_back(static_cast<float>(function->value(col * 0.5 - 64, row * 0.5 - 64)));
  }
  const auto field =
      std::make_shared<HeightField>(HeightField::own(std::move(samples), 257, 257, {.cell_x = 0.5, .cell_y = 0.5}));
  const Shape rock = moved(make_shape(FieldGround{field, slope_bound(*field)}), {-64, -64, 0});
  return {
      {"ground, sphere, cube, ring", make_shape(Union{founding})},
      {"300 solids", make_shape(Union{many})},
      {"12 balls flowing together", make_shape(Union{blobs, 4})},
      {"pillars without end",
       make_shape(Union{{make_shape(HalfSpace{{0, 0, 1}, -10}),
                         make_shape(Repeated{moved(make_shape(Cylinder{1.5, 12}), {0, 0, -4}), {12, 12, 0}})}})},
      {"field without a ball", make_shape(Subtraction{rock, moved(make_shape(Sphere{25}), {0, 0, 12})})},
  };
}

// From a point outside the solid, 40 m high, down to its middle.
std::vector<Ray> picture(const DistanceField& field, const ShapesOptions& options) {
  dvec3 eye(5, -75, 40);
  while (field.value(eye) < 5) eye.z += 5;
  const dvec3 ahead = normalize(-eye), right = normalize(cross(ahead, dvec3(0, 0, 1))), up = cross(right, ahead);
  const double half = std::tan(30 * 3.141592653589793 / 180);
  std::vector<Ray> rays;
  for (int row = 0; row < options.height; ++row) {
    for (int col = 0; col < options.width; ++col) {
      const double x = (2 * (col + 0.5) / options.width - 1) * half;
      const double y = (1 - 2 * (row + 0.5) / options.height) * half * options.height / options.width;
      Ray ray;
      ray.origin = eye;
      ray.direction = normalize(ahead + x * right + y * up);
      ray.t_max = kFarthest;
      rays.push_back(ray);
    }
  }
  return rays;
}

std::vector<Ray> shadows(const DistanceField& field, const std::vector<Ray>& rays) {
  std::vector<Ray> out;
  for (const Ray& ray : rays) {
    const Hit hit = march_sphere_trace(field, ray);
    if (!hit) continue;
    Ray on;
    on.origin = ray.at(hit.t);
    on.direction = normalize(dvec3(-0.6, -0.3, 0.35));
    if (dot(field.normal(on.origin), on.direction) <= 0) continue;
    on.start = RayStart::on_surface;
    on.t_max = kFarthest;
    out.push_back(on);
  }
  return out;
}

// Hart's original march: steps by spheres until a radius is within the tolerance, which counts as a hit.
Hit by_balls(const DistanceField& field, const Ray& ray, const MarchSettings& settings, MarchStats* stats) {
  Hit hit;
  const SphereTraceSettings& s = settings.sphere_trace;
  const double speed = length(ray.direction);
  *stats = {};
  // A ray from the surface is offset from it, as usual.
  double t = ray.t_min + (ray.start == RayStart::on_surface ? 1e-3 : 0);
  while (t <= ray.t_max) {
    if (stats->steps == static_cast<std::uint32_t>(s.max_steps)) {
      hit.status = HitStatus::exhausted;
      return hit;
    }
    ++stats->steps;
    const double free = field.value(ray.at(t)) / speed;
    if (free <= s.tolerance * (t - ray.t_min)) {
      hit.status = HitStatus::hit;
      hit.t = t;
      return hit;
    }
    t += free;
  }
  return hit;
}

struct Row {
  double values = 0, bounds = 0, ms = std::numeric_limits<double>::infinity();
  std::vector<Hit> hits;
};

Row timed(const DistanceField& field, const std::vector<Ray>& rays, ShapeMarch march, int repeats) {
  Row row;
  row.hits.resize(rays.size());
  for (int pass = 0; pass < repeats; ++pass) {
    row.values = row.bounds = 0;
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < rays.size(); ++i) {
      MarchStats stats;
      row.hits[i] = march(field, rays[i], {}, &stats);
      row.values += stats.steps, row.bounds += stats.cell_tests;
    }
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    row.ms = std::min(row.ms, took.count());
  }
  return row;
}

// Throws Error, after the report, if sphere-trace lost a crossing.
void run_shapes(const ShapesOptions& options, const ReportOptions& report) {
  Json rows = Json::array();
  std::vector<std::vector<std::string>> lines{{"shape", "rays", "march", "values/ray", "bounds/ray", "ms/megapixel",
                                               "judged", "misses", "false hits", "given up", "error p99 m"}};
  bool lost = false;
  for (const Scene& scene : scenes()) {
    const DistanceField field(scene.shape);
    const std::vector<Ray> eye_rays = picture(field, options);
    for (const bool shadow : {false, true}) {
      const std::vector<Ray> rays = shadow ? shadows(field, eye_rays) : eye_rays;
      if (rays.empty()) continue;
      const auto count = static_cast<std::int64_t>(rays.size());
      const std::int64_t every = std::max<std::int64_t>(1, count / options.judged);
      const std::int64_t judged = (count + every - 1) / every;
      std::vector<FunctionJudgement> judgements(static_cast<std::size_t>(judged));
      parallel_for(judged, 16, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) {
          Ray ray = rays[static_cast<std::size_t>(i * every)];
          // The judge takes only free rays, so rays from the surface are judged from a centimetre on.
          if (shadow) ray.start = RayStart::free, ray.t_min += 0.01;
          judgements[static_cast<std::size_t>(i)] = judge_shape(scene.shape, ray);
        }
      });
      for (const bool plain : {false, true}) {
        const ShapeMarch march = plain ? by_balls : march_sphere_trace;
        const char* const name = plain ? "balls alone" : "sphere-trace";
        const Row row = timed(field, rays, march, options.repeats);
        int crossings = 0, misses = 0, clear = 0, false_hits = 0, given_up = 0;
        std::vector<double> errors;
        for (std::int64_t i = 0; i < judged; ++i) {
          const FunctionJudgement& judge = judgements[static_cast<std::size_t>(i)];
          const Hit& hit = row.hits[static_cast<std::size_t>(i * every)];
          given_up += hit.status == HitStatus::exhausted;
          if (judge.verdict == FunctionVerdict::clear) {
            ++clear;
            // A shadow ray may have hit within the centimetre.
            false_hits += hit && !(shadow && hit.t < 0.01);
          } else if (judge.verdict == FunctionVerdict::crossing) {
            ++crossings;
            const bool passed = hit && hit.t > judge.crossed_by * (1 + 1e-5);
            misses += hit.status == HitStatus::miss || passed;
            if (hit && !passed && !shadow) errors.push_back(std::max(0.0, judge.clear_until - hit.t));
          }
        }
        std::sort(errors.begin(), errors.end());
        const double p99 = errors.empty() ? 0 : errors[(errors.size() - 1) * 99 / 100];
        const double n = static_cast<double>(count), ms = row.ms / n * 1e6;
        lost = lost || (misses > 0 && !plain);
        const char* const kind = shadow ? "shadow" : "primary";
        rows.push_back({{"shape", scene.name},
                        {"rays", kind},
                        {"march", name},
                        {"values_per_ray", row.values / n},
                        {"bounds_per_ray", row.bounds / n},
                        {"ms_per_megapixel", ms},
                        {"judged", judged},
                        {"crossings", crossings},
                        {"misses", misses},
                        {"false_hits", false_hits},
                        {"exhausted", given_up},
                        {"error_p99_m", p99}});
        lines.push_back({scene.name, kind, name, fmt::format("{:.1f}", row.values / n),
                         fmt::format("{:.1f}", row.bounds / n), fmt::format("{:.0f}", ms), fmt::format("{}", judged),
                         fmt::format("{}", misses), fmt::format("{}", false_hits), fmt::format("{}", given_up),
                         fmt::format("{:.2g}", p99)});
      }
    }
  }
  print_table(lines, 3);
  write_json(report, rows);
  if (lost) throw Error("shapes: sphere-trace lost a crossing that the judge proves; see the table");
}

}  // namespace

void add_shapes(cli::Program& program) {
  auto [command, o] = add_command<ShapesOptions>(
      program, "shapes", "Sphere-trace over distance fields, beside balls alone and proofs", run_shapes);
  command.add(&o.width, {.names = "--width", .help = "pixels", .range = {1, 16384}});
  command.add(&o.height, {.names = "--height", .help = "pixels", .range = {1, 16384}});
  add_repeats_option(command, o.repeats);
  command.add(&o.judged, {.names = "--judged", .help = "rays per shape that are judged, about", .range = {1, 0x1p40}});
}

}  // namespace scarp::bench
