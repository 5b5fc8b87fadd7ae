// SPDX-License-Identifier: MIT
// `scarp-bench render`: what a frame of the look `comanche` costs, stepped as the founding text has it and exactly, and
// what share of its pixels is wrong.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "bench/commands.h"
#include "bench/protocol.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/render/picture.h"
#include "scarp/scene/from_raster.h"
#include "scarp/source/procedural_dem.h"

namespace scarp::bench {
namespace {

using Json = nlohmann::ordered_json;

struct Way {
  const char* name;
  const char* march;
  bool interpolate, step_by_view;
  int steps;  // times those of the options
};
constexpr Way kWays[] = {{"fixed-step plain", "fixed-step", false, false, 1},
                         {"fixed-step", "fixed-step", true, false, 1},
                         {"fixed-step by view", "fixed-step", true, true, 1},
                         {"fixed-step, 4 x the steps", "fixed-step", true, false, 4},
                         {"max-mip", "max-mip", true, false, 1}};
struct Air {
  const char* name;
  bool water, fog;
};
constexpr Air kAirs[] = {{"dry", false, false}, {"water", true, false}, {"fog", false, true}, {"both", true, true}};

// Cells along the ray by which ground may be off.
constexpr double kTolerance = 1;

HeightField endless(const FramesOptions& options) {
  ProceduralDem dem;
  dem.cols = dem.rows = options.period / 2 + 1;
  dem.seed = options.seed;
  dem.cell_m = 1;
  dem.kind = TerrainKind::ridged;
  Raster raster;
  raster.samples = generate_dem(dem);
  raster.cols = raster.rows = dem.cols;
  return height_field_from(std::move(raster), {.mirror = true});
}

// Low over the ground, a little down, on a straight line through several repetitions.
std::vector<Camera> flight(const HeightField& field, const FramesOptions& options) {
  const double low = field.min_height(), relief = field.max_height() - low;
  std::vector<Camera> cameras;
  for (int i = 0; i < options.cameras; ++i) {
    const dvec3 eye(113.7 + 211.3 * i, 57.1 + 317.9 * i, low + relief);
    const double heading = 0.7 * i;
    const dvec3 ahead(std::sin(heading), std::cos(heading), -0.2);
    cameras.push_back(Camera::look_at(eye, eye + ahead, 60, options.width, options.height));
    cameras.back().set_reach(default_reach(field));
  }
  return cameras;
}

struct Sighting {
  int kind;  // 0 nothing, 1 ground, 2 water
  double t;
};

Sighting exact(const TerrainScene& scene, const Water* water, Ray ray) {
  std::optional<Water::Meeting> meeting;
  if (water) meeting = water->meets(ray);
  if (meeting) ray.t_max = meeting->t;
  const Hit hit = scene.closest_hit(ray);
  if (hit) return {1, hit.t};
  return meeting ? Sighting{2, meeting->t} : Sighting{0, 0};
}

Sighting stepped(const StepMarch& march, const Water* water, const Ray& ray) {
  const StepMarch::Answer answer = march.march(ray, water);
  if (answer.hit) return {1, answer.hit.t};
  return answer.water ? Sighting{2, answer.t} : Sighting{0, 0};
}

bool wrong(const Sighting& answer, const Sighting& truth) {
  return answer.kind != truth.kind || std::abs(answer.t - truth.t) > kTolerance;
}

PictureSettings settings_of(const HeightField& field, const FramesOptions& options, const Way& way, const Air& air,
                            double level) {
  PictureSettings settings;
  settings.look = Look::comanche;
  settings.width = options.width;
  settings.height = options.height;
  settings.aa = 1;
  settings.shadows = settings.plinth = false;
  settings.comanche.scale = 1;
  settings.comanche.steps = options.steps * way.steps;
  settings.comanche.interpolate = way.interpolate;
  settings.comanche.step_by_view = way.step_by_view;
  if (air.water) settings.water = WaterSettings{.level = level};
  if (air.fog) {
    settings.fog.kind = FogKind::height;
    settings.fog.visibility = default_reach(field);
    settings.fog.base = level;
    settings.fog.falloff = (field.max_height() - field.min_height()) / 4;
  }
  return settings;
}

}  // namespace

void run_frames(const FramesOptions& options, const ReportOptions& report) {
  if (options.period % 2 != 0) throw Error(fmt::format("--period {}: expected an even number", options.period));
  const ThreadLimit limit(options.threads);
  const HeightField field = endless(options);
  const double level = field.min_height() + 0.25 * (field.max_height() - field.min_height());
  const std::vector<Camera> cameras = flight(field, options);
  const TerrainScene max_mip(field, find_march("max-mip")), fixed(field, find_march("fixed-step"));
  const TerrainScene oracle(field, find_march("exhaustive"));
  constexpr std::size_t kAirCount = std::size(kAirs);

  std::vector<std::vector<double>> wall_ms(std::size(kWays) * kAirCount), cpu_ms(wall_ms.size());
  for (int pass = 0; pass <= options.repeats; ++pass) {  // the first one warms up
    for (std::size_t way = 0; way < std::size(kWays); ++way) {
      for (std::size_t air = 0; air < kAirCount; ++air) {
        const PictureSettings settings = settings_of(field, options, kWays[way], kAirs[air], level);
        const TerrainScene& scene = kWays[way].march == std::string("max-mip") ? max_mip : fixed;
        const Stopwatch watch;
        for (const Camera& camera : cameras) render_picture(scene, camera, 0, settings);
        const double frames = static_cast<double>(cameras.size());
        if (pass == 0) continue;
        wall_ms[way * kAirCount + air].push_back(1000 * watch.wall_s() / frames);
        cpu_ms[way * kAirCount + air].push_back(1000 * watch.cpu_s() / frames);
      }
    }
  }

  Json rows = Json::array();
  std::vector<std::vector<std::string>> lines{
      {"way", "air", "ms", "cpu ms", "frames/s", "x dry", "x fixed-step", "wrong %", "water %"}};
  double worst_exact = 0;
  const auto wall = [&](std::size_t way, std::size_t air) { return median(wall_ms[way * kAirCount + air]); };
  for (std::size_t way = 0; way < std::size(kWays); ++way) {
    for (std::size_t air = 0; air < kAirCount; ++air) {
      const PictureSettings settings = settings_of(field, options, kWays[way], kAirs[air], level);
      std::optional<Water> water;
      if (settings.water) water.emplace(*settings.water, field);
      const Water* sea = water ? &*water : nullptr;
      const bool steps = kWays[way].march == std::string("fixed-step");
      std::int64_t judged = 0, mistakes = 0, seas = 0;
      for (const Camera& camera : cameras) {
        const StepMarch march(field, settings.comanche, camera.reach(), camera.forward());
        std::vector<std::uint8_t> is_wrong(static_cast<std::size_t>(options.width * options.height)), is_sea(is_wrong);
        parallel_for(options.width * options.height, 256, [&](std::int64_t begin, std::int64_t end) {
          for (std::int64_t i = begin; i < end; ++i) {
            if (i % options.judge_every != 0) continue;
            const auto x = static_cast<double>(i % options.width), y = static_cast<double>(i / options.width);
            const Ray ray = camera.ray(x + 0.5, y + 0.5);
            const Sighting truth = exact(oracle, sea, ray);
            const Sighting answer = steps ? stepped(march, sea, ray) : exact(max_mip, sea, ray);
            is_wrong[static_cast<std::size_t>(i)] = wrong(answer, truth);
            is_sea[static_cast<std::size_t>(i)] = truth.kind == 2;
          }
        });
        for (std::size_t i = 0; i < is_wrong.size(); i += static_cast<std::size_t>(options.judge_every)) {
          ++judged;
          mistakes += is_wrong[i];
          seas += is_sea[i];
        }
      }
      const double share = static_cast<double>(mistakes) / static_cast<double>(judged);
      if (!steps) worst_exact = std::max(worst_exact, share);
      Json row;
      row["way"] = kWays[way].name;
      row["air"] = kAirs[air].name;
      row["threads"] = options.threads;
      row["ms_per_frame"] = wall(way, air);
      row["cpu_ms_per_frame"] = median(cpu_ms[way * kAirCount + air]);
      row["frames_per_s"] = 1000 / wall(way, air);
      row["dry_ratio"] = wall(way, air) / wall(way, 0);
      row["fixed_step_ratio"] = wall(way, air) / wall(1, air);
      row["judged_pixels"] = judged;
      row["wrong_percent"] = 100 * share;
      row["water_percent"] = 100 * static_cast<double>(seas) / static_cast<double>(judged);
      std::vector<std::string> line{row["way"], row["air"]};
      for (const char* key : {"ms_per_frame", "cpu_ms_per_frame", "frames_per_s", "dry_ratio", "fixed_step_ratio",
                              "wrong_percent", "water_percent"}) {
        line.push_back(short_number(row[key]));
      }
      lines.push_back(std::move(line));
      rows.push_back(std::move(row));
    }
  }
  fmt::print("comanche, {} x {} pixels, {} steps over {} cells; ridged ground of period {}, {} cameras, {} threads\n",
             options.width, options.height, options.steps, default_reach(field), options.period, options.cameras,
             options.threads);
  print_table(lines, 2);
  write_json(report, rows);
  if (worst_exact > 0)
    throw Error(fmt::format("render: {:.3g} % of the pixels of max-mip are wrong", 100 * worst_exact));
}

}  // namespace scarp::bench
