// SPDX-License-Identifier: MIT
// `scarp-bench scenes`: build time of a hierarchy over many objects, and rays per second on one thread: boxes and balls
// of 1 to 4 m at random in a cube, rotated at random. Edits of a LiveScene, by a step of at most 1 m along each axis or
// to any position in the cube, are compared with building a new scene. Then contacts with voxels and heights at the
// placements of the objects (scene_contacts.h).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/protocol.h"
#include "bench/random.h"
#include "bench/report.h"
#include "bench/scene_contacts.h"
#include "bench/trace_options.h"
#include "scarp/base/parallel.h"
#include "scarp/scene/live_scene.h"
#include "scarp/scene/scene.h"

namespace scarp::bench {
namespace {

// `scenes`: hierarchies over many objects.
struct ScenesOptions {
  std::vector<int> objects{1000, 10000, 100000};
  int rays = 100000;
  int contacts = 10000;  // queries of each kind
  int repeats = 5;
};

using Json = nlohmann::ordered_json;

constexpr double kRoom = 30;  // cubic metres per object

std::vector<SceneObject> objects_at_random(int count, double side) {
  Random random(1, 0);
  std::vector<SceneObject> objects;
  for (int i = 0; i < count; ++i) {
    Placement placement;
    const double a = random.uniform(0, 6.283);
    placement.turn = glm::dmat3({std::cos(a), std::sin(a), 0}, {-std::sin(a), std::cos(a), 0}, {0, 0, 1});
    placement.scale = random.uniform(0.5, 2);
    placement.origin = {random.uniform(0, side), random.uniform(0, side), random.uniform(0, side)};
    objects.push_back({static_cast<std::uint32_t>(random.below(2)), 0, placement});
  }
  return objects;
}

// Microseconds of LiveScene::edit() with one move, from the call to the return, when queries see it.
struct MoveTimes {
  double median_us, p99_us, worst_us;
};

MoveTimes measure_moves(LiveScene& live, const std::vector<SceneObject>& objects, double side, bool near) {
  constexpr int kMoves = 20000;
  Random random(3, 0);
  std::vector<Placement> places;
  for (const SceneObject& object : objects) places.push_back(object.placement);
  std::vector<double> us;
  for (int i = 0; i < kMoves; ++i) {
    const auto object = static_cast<std::uint32_t>(random.below(static_cast<int>(places.size())));
    Placement& place = places[object];
    const auto along = [&](double from) { return near ? from + random.uniform(-1, 1) : random.uniform(0, side); };
    place.origin = {along(place.origin.x), along(place.origin.y), along(place.origin.z)};
    const Stopwatch watch;
    live.edit([&](LiveScene::Editor& editor) { editor.move(object, place); });
    us.push_back(1e6 * watch.wall_s());
  }
  std::sort(us.begin(), us.end());
  return {us[kMoves / 2], us[kMoves / 100 * 99], us.back()};
}

Json measure_objects(const ScenesOptions& options, int count) {
  const double side = std::cbrt(kRoom * count);
  const std::vector<SceneFieldPtr> fields{scene_shape(DistanceField(make_shape(shape::Sphere{1}))),
                                          scene_shape(DistanceField(make_shape(shape::Box{{1, 1, 1}})))};
  const std::vector<SceneObject> objects = objects_at_random(count, side);
  std::vector<double> build_s, trace_s;
  Random random(2, 0);
  std::vector<Ray> rays(static_cast<std::size_t>(options.rays));
  for (Ray& ray : rays) {
    const auto inside = [&] {
      return dvec3(random.uniform(0, side), random.uniform(0, side), random.uniform(0, side));
    };
    ray.origin = inside() - dvec3(0, 2 * side, 0);
    ray.direction = normalize(inside() - ray.origin);
  }
  std::vector<Hit> hits(rays.size());
  std::size_t bytes = 0, found = 0;
  MarchStats all;
  for (int pass = 0; pass < options.repeats; ++pass) {
    const Stopwatch build;
    const Scene scene(fields, objects);
    build_s.push_back(build.cpu_s());
    const Stopwatch trace;
    scene.closest_hits(rays, hits);
    trace_s.push_back(trace.cpu_s());
    bytes = scene.bytes();
    if (pass > 0) continue;
    for (const Ray& ray : rays) {
      MarchStats stats;
      found += scene.closest_hit(ray, nullptr, &stats) ? 1 : 0;
      all.steps += stats.steps, all.boxes += stats.boxes;
    }
  }
  LiveScene live{Scene(fields, objects)};
  const MoveTimes near = measure_moves(live, objects, side, true), far = measure_moves(live, objects, side, false);
  std::vector<double> edited_s;
  for (int pass = 0; pass < options.repeats; ++pass) {
    const auto reading = live.read();
    const Stopwatch trace;
    reading.scene().closest_hits(rays, hits);
    edited_s.push_back(trace.cpu_s());
  }
  const auto per_ray = [&](std::uint32_t sum) { return static_cast<double>(sum) / static_cast<double>(rays.size()); };
  Json row;
  row["objects"] = count;
  row["build_s"] = median(build_s);
  row["bytes_per_object"] = static_cast<double>(bytes) / count;
  row["rays"] = rays.size();
  row["hits"] = found;
  row["boxes_per_ray"] = per_ray(all.boxes);
  row["steps_per_ray"] = per_ray(all.steps);
  row["mrays_per_cpu_s"] = 1e-6 * static_cast<double>(rays.size()) / median(trace_s);
  row["move_us"] = near.median_us;
  row["move_p99_us"] = near.p99_us;
  row["far_move_us"] = far.median_us;
  row["worst_move_us"] = std::max(near.worst_us, far.worst_us);
  row["edited_mrays_per_cpu_s"] = 1e-6 * static_cast<double>(rays.size()) / median(edited_s);
  row.update(measure_contacts(objects, side, options.contacts, options.repeats));
  return row;
}

void run_scenes(const ScenesOptions& options, const ReportOptions& report) {
  const ThreadLimit limit(1);
  Json rows = Json::array();
  std::vector<std::vector<std::string>> lines{{"objects", "build s", "bytes/object", "hits", "boxes/ray", "steps/ray",
                                               "Mrays/s (cpu)", "move us", "p99", "far us", "worst", "edited Mrays/s"}};
  std::vector<std::vector<std::string>> contacts{
      {"objects", "sweep us", "touch", "overlap us", "overlap", "closest us", "queries"}};
  for (const int count : options.objects) {
    const Json row = measure_objects(options, count);
    lines.push_back({fmt::format("{}", count), short_number(row["build_s"]), short_number(row["bytes_per_object"]),
                     fmt::format("{}", row["hits"].get<std::size_t>()), short_number(row["boxes_per_ray"]),
                     short_number(row["steps_per_ray"]), short_number(row["mrays_per_cpu_s"]),
                     short_number(row["move_us"]), short_number(row["move_p99_us"]), short_number(row["far_move_us"]),
                     short_number(row["worst_move_us"]), short_number(row["edited_mrays_per_cpu_s"])});
    contacts.push_back({fmt::format("{}", count), short_number(row["sweep_us"]), short_number(row["sweeps_touch"], 9),
                        short_number(row["overlap_us"]), short_number(row["boxes_overlap"], 9),
                        short_number(row["closest_us"]), short_number(row["contact_queries"], 9)});
    rows.push_back(row);
  }
  print_table(lines, 0);
  print_table(contacts, 0);
  write_json(report, rows);
}

}  // namespace

void add_scenes(cli::Program& program) {
  auto [command, o] = add_command<ScenesOptions>(program, "scenes",
                                                 "Hierarchies over many objects: how soon built, how fast", run_scenes);
  command.add(cli::List<int>{&o.objects}, {.names = "--objects", .help = "objects", .range = {1, 1 << 24}});
  command.add(&o.rays, {.names = "--rays", .help = "rays per pass", .range = {1, 1 << 28}});
  command.add(&o.contacts,
              {.names = "--contacts", .help = "sweeps, overlaps and closest points per pass", .range = {1, 1 << 24}});
  add_repeats_option(command, o.repeats);
}

}  // namespace scarp::bench
