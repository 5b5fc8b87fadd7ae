// SPDX-License-Identifier: MIT
// `scarp-bench voxel-edits`: time that voxel accelerators take to follow an edit: spheres added to a grid and removed
// again, at random positions; compared with rebuilt accelerators.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/protocol.h"
#include "bench/random.h"
#include "bench/report.h"
#include "scarp/accel/empty_cubes.h"
#include "scarp/accel/empty_spheres.h"
#include "scarp/accel/octant_cubes.h"
#include "scarp/base/error.h"

namespace scarp::bench {
namespace {

// `voxel-edits`: time that voxel accelerators take to follow an edit.
struct VoxelEditsOptions {
  int side = 256;     // voxels
  double radius = 8;  // radius in voxels of the sphere that is added and removed
  int edits = 40;
};

using Json = nlohmann::ordered_json;

constexpr std::string_view kScenes[] = {"hills", "balls", "one voxel"};

double hill(int side, double x, double y) {
  return side * (0.4 + 0.1 * std::sin(7.7 * x / side) * std::cos(10.2 * y / side));
}

// Solid below hills; many balls; or almost empty, so that every edit is the nearest solid to the whole grid.
VoxelGrid scene(std::string_view name, int side, Random& random) {
  VoxelGrid grid(ivec3(side), 1);
  if (name == "hills") {
    grid.edit(grid.box(), [&](const ivec3& v, const VoxelGrid::Voxel&) {
      return v.z < hill(side, v.x, v.y) ? VoxelGrid::Voxel(1) : VoxelGrid::Voxel();
    });
  } else if (name == "balls") {
    for (int i = 0; i < 200; ++i) {
      const dvec3 centre(random.below(side), random.below(side), random.below(side));
      grid.fill_sphere(centre, side * (0.01 + 0.00004 * random.below(1000)), 1);
    }
  } else {
    grid.set({5, 7, 9}, 1);
  }
  return grid;
}

template <class Accelerator>
Json measure(std::string_view name, std::string_view of, const VoxelEditsOptions& options) {
  Random random(1, 0);
  VoxelGrid grid = scene(name, options.side, random);
  Accelerator built(grid);
  std::vector<double> added, removed;
  for (int i = 0; i < options.edits; ++i) {
    dvec3 centre(random.below(options.side), random.below(options.side), random.below(options.side));
    // Digging happens at the ground.
    if (name == "hills") centre.z = hill(options.side, centre.x, centre.y);
    const auto follow = [&](const VoxelBox& changed, std::vector<double>& seconds) {
      const Stopwatch watch;
      built.update(grid, changed);
      seconds.push_back(watch.wall_s());
    };
    follow(grid.fill_sphere(centre, options.radius, 1), added);
    follow(grid.clear_sphere(centre, options.radius), removed);
  }
  const Stopwatch watch;
  const Accelerator anew(grid);
  const double rebuild_s = watch.wall_s();
  if (!(anew == built)) throw Error(fmt::format("voxel-edits: {} differ from those built anew", of));
  Json row = {{"scene", name}, {"accelerator", of}, {"side", options.side}, {"radius", options.radius}};
  row["add_ms"] = 1e3 * median(added);
  row["add_worst_ms"] = 1e3 * *std::max_element(added.begin(), added.end());
  row["remove_ms"] = 1e3 * median(removed);
  row["remove_worst_ms"] = 1e3 * *std::max_element(removed.begin(), removed.end());
  row["rebuild_ms"] = 1e3 * rebuild_s;
  return row;
}

void run_voxel_edits(const VoxelEditsOptions& options, const ReportOptions& report) {
  Json rows = Json::array();
  for (const std::string_view name : kScenes) {
    rows.push_back(measure<OctantCubes>(name, "octants", options));
    rows.push_back(measure<EmptyCubes>(name, "cubes", options));
    rows.push_back(measure<EmptySpheres>(name, "spheres", options));
  }
  std::vector<std::vector<std::string>> lines{
      {"scene", "accelerator", "add ms", "worst", "remove ms", "worst", "rebuild ms"}};
  for (const Json& row : rows) {
    std::vector<std::string> line{row["scene"], row["accelerator"]};
    for (const char* key : {"add_ms", "add_worst_ms", "remove_ms", "remove_worst_ms", "rebuild_ms"})
      line.push_back(short_number(row[key]));
    lines.push_back(std::move(line));
  }
  print_table(lines, 2);
  write_json(report, rows);
}

}  // namespace

void add_voxel_edits(cli::Program& program) {
  auto [command, o] = add_command<VoxelEditsOptions>(
      program, "voxel-edits", "How long accelerators of voxels take to follow an edit", run_voxel_edits);
  command.add(&o.side, {.names = "--side", .help = "voxels per side", .range = {16, 512}});
  command.add(&o.radius, {.names = "--radius",
                          .help = "radius of the spheres that are added and removed, in voxels",
                          .range = cli::kAboveZero});
  command.add(&o.edits, {.names = "--edits", .help = "spheres", .range = {1, 100000}});
}

}  // namespace scarp::bench
