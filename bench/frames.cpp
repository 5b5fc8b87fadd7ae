// SPDX-License-Identifier: MIT
// `scarp-bench render`: the cost of a frame of the look `comanche`, stepped as in the founding text and exact, and the
// fraction of wrong pixels.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/protocol.h"
#include "bench/report.h"
#include "bench/trace_options.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/render/frame/picture.h"
#include "scarp/scene/file/from_raster.h"
#include "scarp/source/raster/procedural_dem.h"
#ifdef SCARP_BENCH_VULKAN
#include "scarp/render/frame/terrain_frame_vk.h"
#include "scarp/scene/scene_vk.h"
#endif

namespace scarp::bench {
namespace {

// `render`: frames of the look `comanche`.
struct FramesOptions {
  int period = 1024;  // period of the ground in samples, even, 64..8192
  int width = 320, height = 240, steps = 256;
  int threads = 2, cameras = 8, repeats = 9;
  std::uint64_t seed = 1;
  int judge_every = 16;  // one pixel in this many is also traced by exhaustive
  std::string device;    // a Vulkan device besides the CPU, as in `scarp render --device`; empty: none
};

using Json = nlohmann::ordered_json;

struct Way {
  const char* name;
  const char* march;
  bool interpolate, step_by_view;
  int steps;  // multiple of the steps in the options
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

// Tolerance of ground along the ray, in cells.
constexpr double kTolerance = 1;
// Fraction of the device's pixels by max-mip that may be wrong: floats move a ray by 1/768 pixel (numerics.md, "Whole
// frames"), so 2 in 768 of the pixels on an edge show its other side; less than a third of the pixels are on an edge.
constexpr double kBesideEdges = 2.0 / 768 / 3;

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

// Low over the ground, looking slightly down, on a straight line over several periods.
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

Sighting exact(const Scene& scene, const Water* water, Ray ray) {
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
  settings.shadows = false;
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

// The renderer: the CPU, or a device.
struct Maker {
  std::string name;
  Scene max_mip, fixed;
  bool on_device = false;

  const Scene& scene(const Way& way) const { return way.march == std::string("max-mip") ? max_mip : fixed; }
};

std::vector<Maker> makers(const HeightField& field, const FramesOptions& options) {
  const Scene max_mip(scene_heights(field)), fixed(scene_heights(field, find_height_march("fixed-step")));
  std::vector<Maker> all;
  all.push_back({"cpu", max_mip, fixed});
  if (options.device.empty()) return all;
#ifdef SCARP_BENCH_VULKAN
  const Device device({.choice = options.device});
  all.push_back({device.description().name, scene_on(device, max_mip), scene_on(device, fixed), true});
  return all;
#else
  throw Error("--device: this program was built without Vulkan");
#endif
}

// Time on the device's clock, in milliseconds.
std::optional<double> device_ms(const Maker& maker, [[maybe_unused]] const Way& way,
                                [[maybe_unused]] const Camera& camera,
                                [[maybe_unused]] const PictureSettings& settings) {
  if (!maker.on_device) return {};
#ifdef SCARP_BENCH_VULKAN
  FrameReport report;
  render_whole_frame(maker.scene(way), camera, settings, {}, &report);
  if (report.device_s) return 1000 * *report.device_s;
#endif
  return {};
}

// The hits of a frame's rays, for the judged pixels.
std::vector<Sighting> sightings_of(const Maker& maker, const Way& way, const Camera& camera,
                                   const PictureSettings& settings, const Water* water, int judge_every) {
  const std::int64_t pixels = std::int64_t{settings.width} * settings.height;
  std::vector<Sighting> found(static_cast<std::size_t>(pixels), Sighting{0, 0});
#ifdef SCARP_BENCH_VULKAN
  if (maker.on_device) {
    FrameReport report{.tells_sightings = true};
    render_whole_frame(maker.scene(way), camera, settings, {}, &report);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const FrameSighting& sighting = report.sightings[i];
      if (sighting.kind == FrameSighting::Kind::nothing) continue;
      found[i] = {sighting.kind == FrameSighting::Kind::water ? 2 : 1, sighting.t};
    }
    return found;
  }
#endif
  const StepMarch march(*maker.fixed.only_heights(), settings.comanche, camera.reach(), camera.forward());
  parallel_for(pixels, 256, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) {
      if (i % judge_every != 0) continue;
      const Ray ray =
          camera.ray(static_cast<double>(i % settings.width) + 0.5, static_cast<double>(i / settings.width) + 0.5);
      found[static_cast<std::size_t>(i)] =
          way.march == std::string("fixed-step") ? stepped(march, water, ray) : exact(maker.max_mip, water, ray);
    }
  });
  return found;
}

// Ground truth of the judged pixels.
std::vector<Sighting> truth_of(const Scene& oracle, const Camera& camera, const FramesOptions& options,
                               const Water* water) {
  const std::int64_t pixels = std::int64_t{options.width} * options.height;
  std::vector<Sighting> found(static_cast<std::size_t>(pixels));
  parallel_for(pixels, 256, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) {
      if (i % options.judge_every != 0) continue;
      const Ray ray =
          camera.ray(static_cast<double>(i % options.width) + 0.5, static_cast<double>(i / options.width) + 0.5);
      found[static_cast<std::size_t>(i)] = exact(oracle, water, ray);
    }
  });
  return found;
}

struct FrameTimes {
  std::vector<double> wall_ms, cpu_ms, device_ms;
};

// Throws Error, after the report, if the exact march has a wrong pixel; on a device, if more than one in a thousand is
// wrong: in single precision a ray may pass a crest on its other side.
void run_frames(const FramesOptions& options, const ReportOptions& report) {
  if (options.period % 2 != 0) throw Error(fmt::format("--period {}: expected an even number", options.period));
  const ThreadLimit limit(options.threads);
  const HeightField field = endless(options);
  const double level = field.min_height() + 0.25 * (field.max_height() - field.min_height());
  const std::vector<Camera> cameras = flight(field, options);
  const std::vector<Maker> all = makers(field, options);
  const Scene oracle(scene_heights(field, find_height_march("exhaustive")));
  constexpr std::size_t kAirCount = std::size(kAirs), kOfMaker = std::size(kWays) * kAirCount;

  std::vector<FrameTimes> timings(all.size() * kOfMaker);
  for (int pass = 0; pass <= options.repeats; ++pass) {  // the first one warms up
    for (std::size_t i = 0; i < timings.size(); ++i) {
      const Maker& maker = all[i / kOfMaker];
      const Way& way = kWays[i % kOfMaker / kAirCount];
      const PictureSettings settings = settings_of(field, options, way, kAirs[i % kAirCount], level);
      const Stopwatch watch;
      for (const Camera& camera : cameras) render_picture(maker.scene(way), camera, settings);
      const double frames = static_cast<double>(cameras.size());
      const double wall_ms = 1000 * watch.wall_s() / frames, cpu_ms = 1000 * watch.cpu_s() / frames;
      if (pass == 0) continue;
      timings[i].wall_ms.push_back(wall_ms);
      timings[i].cpu_ms.push_back(cpu_ms);
      for (const Camera& camera : cameras) {
        if (const auto ms = device_ms(maker, way, camera, settings)) timings[i].device_ms.push_back(*ms);
      }
    }
  }

  Json rows = Json::array();
  std::vector<std::vector<std::string>> lines{
      {"engine", "way", "air", "ms", "cpu ms", "device ms", "frames/s", "x dry", "x fixed-step", "wrong %", "water %"}};
  double worst_exact = 0, worst_on_device = 0;
  for (std::size_t i = 0; i < timings.size(); ++i) {
    const Maker& maker = all[i / kOfMaker];
    const std::size_t way_index = i % kOfMaker / kAirCount, air = i % kAirCount;
    const Way& way = kWays[way_index];
    const auto wall = [&](std::size_t of_way, std::size_t of_air) {
      return median(timings[i / kOfMaker * kOfMaker + of_way * kAirCount + of_air].wall_ms);
    };
    const PictureSettings settings = settings_of(field, options, way, kAirs[air], level);
    std::optional<Water> water;
    if (settings.water) water.emplace(*settings.water, oracle);
    const Water* sea = water ? &*water : nullptr;
    std::int64_t judged = 0, mistakes = 0, seas = 0;
    for (const Camera& camera : cameras) {
      const std::vector<Sighting> truth = truth_of(oracle, camera, options, sea);
      const std::vector<Sighting> found = sightings_of(maker, way, camera, settings, sea, options.judge_every);
      for (std::size_t pixel = 0; pixel < truth.size(); pixel += static_cast<std::size_t>(options.judge_every)) {
        ++judged;
        mistakes += wrong(found[pixel], truth[pixel]);
        seas += truth[pixel].kind == 2;
      }
    }
    const double share = static_cast<double>(mistakes) / static_cast<double>(judged);
    if (way.march == std::string("max-mip")) {
      double& worst = maker.on_device ? worst_on_device : worst_exact;
      worst = std::max(worst, share);
    }
    Json row;
    row["engine"] = maker.name;
    row["way"] = way.name;
    row["air"] = kAirs[air].name;
    row["threads"] = options.threads;
    row["ms_per_frame"] = wall(way_index, air);
    row["cpu_ms_per_frame"] = median(timings[i].cpu_ms);
    row["device_ms_per_frame"] = timings[i].device_ms.empty() ? Json() : Json(median(timings[i].device_ms));
    row["frames_per_s"] = 1000 / wall(way_index, air);
    row["dry_ratio"] = wall(way_index, air) / wall(way_index, 0);
    row["fixed_step_ratio"] = wall(way_index, air) / wall(1, air);
    row["judged_pixels"] = judged;
    row["wrong_percent"] = 100 * share;
    row["water_percent"] = 100 * static_cast<double>(seas) / static_cast<double>(judged);
    std::vector<std::string> line{row["engine"], row["way"], row["air"]};
    for (const char* key : {"ms_per_frame", "cpu_ms_per_frame", "device_ms_per_frame", "frames_per_s", "dry_ratio",
                            "fixed_step_ratio", "wrong_percent", "water_percent"}) {
      line.push_back(row[key].is_null() ? "-" : short_number(row[key]));
    }
    lines.push_back(std::move(line));
    rows.push_back(std::move(row));
  }
  fmt::print("comanche, {} x {} pixels, {} steps over {} cells; ridged ground of period {}, {} cameras, {} threads\n",
             options.width, options.height, options.steps, default_reach(field), options.period, options.cameras,
             options.threads);
  print_table(lines, 3);
  write_json(report, rows);
  if (worst_exact > 0)
    throw Error(fmt::format("render: {:.3g} % of the pixels of max-mip are wrong", 100 * worst_exact));
  if (worst_on_device > kBesideEdges)
    throw Error(fmt::format("render: {:.3g} % of max-mip's pixels on the device are wrong", 100 * worst_on_device));
}

}  // namespace

void add_frames(cli::Program& program) {
  auto [command, o] = add_command<FramesOptions>(
      program, "render", "Frames of the look comanche over endless ground: milliseconds and wrong pixels", run_frames);
  command.add(
      &o.period,
      {.names = "--period", .help = "samples from repetition to repetition, an even number", .range = {64, 8192}});
  command.add(&o.width, {.names = "--width", .help = "pixels", .range = {1, 16384}});
  command.add(&o.height, {.names = "--height", .help = "pixels", .range = {1, 16384}});
  command.add(&o.steps, {.names = "--steps", .help = "steps of fixed-step", .range = {1, 65536}});
  command.add(&o.threads, {.names = "--threads", .help = "threads", .range = {1, 1024}});
  command.add(&o.cameras, {.names = "--cameras", .help = "cameras along a flight", .range = {1, 1000}});
  add_repeats_option(command, o.repeats, "counted passes over the flight");
  command.add(&o.seed, {.names = "--seed", .help = "seed of the ground"});
  command.add(
      &o.judge_every,
      {.names = "--judge-every", .help = "one pixel in so many is also traced by exhaustive", .range = {1, 1 << 20}});
  command.add(&o.device, {.names = "--device",
                          .value = "NAME",
                          .help = "a Vulkan device beside the CPU",
                          .note = "cpu, gpu, auto or part of a name"});
}

}  // namespace scarp::bench
