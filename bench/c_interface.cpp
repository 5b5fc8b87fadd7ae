// SPDX-License-Identifier: MIT
// `scarp-bench c`: the cost of a call of the C interface over the same call in C++, on the same rays in one run. Both
// libraries are compiled with the same flags; the C one is shared, the C++ one an archive.
#include <fmt/format.h>

#include <bit>
#include <string>
#include <vector>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/fields.h"
#include "bench/protocol.h"
#include "bench/rays.h"
#include "bench/report.h"
#include "bench/trace_options.h"
#include "scarp/scarp.h"
#include "scarp/scarp_c.h"

namespace scarp::bench {
namespace {

struct COptions {
  TraceOptions trace;
  std::vector<std::string> classes{"primary", "shadow"};
};

using Json = nlohmann::ordered_json;

scarp_ray c_ray(const Ray& ray) {
  return {{ray.origin.x, ray.origin.y, ray.origin.z},
          {ray.direction.x, ray.direction.y, ray.direction.z},
          ray.t_min,
          ray.t_max};
}

// The same view in C.
scarp_scene* c_scene(const HeightField& field) {
  return field.visit([&]<class T>(const SampleGrid<T>& grid) {
    scarp_heights heights{};
    heights.struct_size = sizeof heights;
    heights.samples = grid.data;
    heights.cols = field.cols(), heights.rows = field.rows();
    heights.row_stride = grid.row_stride;
    heights.type = sizeof(T) == 4 ? SCARP_FLOAT32 : std::is_signed_v<T> ? SCARP_INT16 : SCARP_UINT16;
    heights.surface = static_cast<std::int32_t>(field.settings().surface);
    heights.cell_x = field.settings().cell_x, heights.cell_y = field.settings().cell_y;
    heights.scale = field.settings().scale, heights.offset = field.settings().offset;
    heights.exaggeration = field.settings().exaggeration;
    if (field.settings().nodata) heights.has_nodata = 1, heights.nodata = *field.settings().nodata;
    scarp_scene* scene = nullptr;
    if (scarp_heights_view(&heights, &scene) != SCARP_OK) throw Error(scarp_last_error());
    return scene;
  });
}

// Median processor time of a pass in nanoseconds per ray; passes of both take turns.
struct Times {
  double cpp_ns, c_ns;
};
template <class Cpp, class C>
Times times(std::size_t rays, int repeats, const Cpp& cpp, const C& c) {
  std::vector<double> cpp_passes, c_passes;
  for (int pass = 0; pass <= repeats; ++pass) {
    const Stopwatch first;
    for (std::size_t i = 0; i < rays; ++i) cpp(i);
    const double between = first.cpu_s();
    const Stopwatch second;
    for (std::size_t i = 0; i < rays; ++i) c(i);
    if (pass == 0) continue;  // warms up
    cpp_passes.push_back(between), c_passes.push_back(second.cpu_s());
  }
  const double per_ray = 1e9 / static_cast<double>(rays);
  return {median(cpp_passes) * per_ray, median(c_passes) * per_ray};
}

void run_c(const COptions& options, const ReportOptions& report) {
  std::vector<RayClass> classes;
  for (const std::string& name : options.classes) classes.push_back(find_ray_class(name));
  const BenchField ground = load_field(options.trace.field);
  const Terrain terrain(ground.field);
  scarp_scene* scene = c_scene(ground.field);
  Json rows = Json::array();
  std::vector<std::vector<std::string>> lines{{"class", "call", "C++ ns", "C ns", "C - C++ ns", "differ"}};
  for (const RaySet& set : make_rays(ground, classes, options.trace.rays, options.trace.ray_seed)) {
    // Free rays: a start on a surface is given in another way in C.
    std::vector<Ray> rays = set.library_rays;
    std::vector<scarp_ray> c_rays;
    for (Ray& ray : rays) ray.start = RayStart::free, c_rays.push_back(c_ray(ray));
    std::vector<Hit> hits(rays.size());
    std::vector<scarp_hit> c_hits(rays.size());
    std::vector<std::uint8_t> blocked(rays.size()), c_blocked(rays.size());
    for (const bool any : {false, true}) {
      const Times found =
          any ? times(
                    rays.size(), options.trace.repeats, [&](std::size_t i) { blocked[i] = occluded(terrain, rays[i]); },
                    [&](std::size_t i) { scarp_occluded(scene, &c_rays[i], nullptr, &c_blocked[i]); })
              : times(
                    rays.size(), options.trace.repeats, [&](std::size_t i) { hits[i] = cast(terrain, rays[i]); },
                    [&](std::size_t i) { scarp_cast(scene, &c_rays[i], nullptr, &c_hits[i]); });
      std::int64_t differ = 0;
      for (std::size_t i = 0; i < rays.size(); ++i)
        differ += any ? blocked[i] != c_blocked[i] : !(hits[i] == std::bit_cast<Hit>(c_hits[i]));
      Json row;
      row["class"] = name_of(set.ray_class);
      row["call"] = any ? "occluded" : "cast";
      row["cpp_ns"] = found.cpp_ns;
      row["c_ns"] = found.c_ns;
      row["cost_ns"] = found.c_ns - found.cpp_ns;
      row["differ"] = differ;
      row["field"] = ground.name;
      row["size"] = ground.field.cols();
      lines.push_back({row["class"], row["call"], short_number(row["cpp_ns"]), short_number(row["c_ns"]),
                       short_number(row["cost_ns"]), short_number(differ)});
      rows.push_back(std::move(row));
    }
  }
  scarp_scene_release(scene);
  print_table(lines, 2);
  write_json(report, rows);
}

}  // namespace

void add_c(cli::Program& program) {
  auto [command, o] = add_command<COptions>(
      program, "c", "The cost of single calls of the C interface over those of C++, on the same rays", run_c);
  add_size_option(command, o.trace.field.size);
  add_classes_option(command, o.classes, {"primary", "shadow", "grazing", "ao"});
  add_ground_options(command, o.trace.field);
  add_repeats_option(command, o.trace.repeats);
  command.add(&o.trace.ray_seed, {.names = "--ray-seed", .help = "seed of the rays"});
  add_ray_size_option(
      command,
      [&trace = o.trace](const std::string& size) {
        if (size == "small") trace.rays = {160, 88, 4096, 4096, 1024, 32, 128};
      },
      "full: 1920 x 1080 pixels and 2^20 rays for each other class; small: 160 x 88 and 2^12, for tests");
}

}  // namespace scarp::bench
