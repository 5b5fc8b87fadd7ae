// SPDX-License-Identifier: MIT
// `scarp-bench tiles`: batches over the same ground as one field, as tiles and as combined fields, on one thread.
//
//   camera   a camera above the south, row by row        feet    2 cells down from random points
//   lidar    a scanner 2 cells above the ground, 64      probe   2 cells in any direction from random points
//            rows over 2,048 azimuths, 120 cells         sun     to a sun 20 degrees high, from random points
//
// Answers are compared: the same rays must hit at the same t.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string>
#include <vector>

#include "bench/call_ways.h"
#include "bench/command.h"
#include "bench/commands.h"
#include "bench/fields.h"
#include "bench/random.h"
#include "bench/rays.h"
#include "bench/report.h"
#include "bench/trace_options.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/scarp.h"
#include "scarp/scene/tiled_terrain.h"

namespace scarp::bench {
namespace {

struct TilesOptions {
  FieldOptions field;
  std::vector<int> sizes{1025};
  std::vector<std::string> of{"camera", "lidar", "feet", "probe", "sun"};
  std::vector<std::string> over{"tiles", "combined"}, calls{"batch", "single"};
  int cells = 256;  // of a tile
  int points = 1 << 17;
  int repeats = 5;
};

using Json = nlohmann::ordered_json;

// Relative difference of t up to which hits are the same: rays are translated to the corner of a tile.
constexpr double kSame = 1e-6;

// The part of a field that a tile covers, without a copy.
HeightField part_of(const HeightField& field, int cells, TilePlace place) {
  return field.visit([&](const auto& grid) {
    return HeightField::view(grid.row(place.row * cells) + place.col * cells, cells + 1, cells + 1, field.settings(),
                             grid.row(1) - grid.row(0));
  });
}

class TileBench {
 public:
  explicit TileBench(const TilesOptions& options) : options_(options) {}

  void run(int size) {
    if ((size - 1) % options_.cells != 0) {
      throw Error(
          fmt::format("tiles: {} cells are not a multiple of the {} of a tile (choose another --size or --cells)",
                      size - 1, options_.cells));
    }
    FieldOptions of_size = options_.field;
    of_size.size = size;
    const BenchField ground = load_field(of_size);
    const int side = (size - 1) / options_.cells;
    const Terrain one(ground.field);
    TiledTerrain tiled({side, side, options_.cells, options_.cells, ground.field.settings()});
    std::vector<ScenePart> parts;
    tiled.edit([&](auto& editor) {
      for (int i = 0; i < side * side; ++i) {
        const TilePlace place{i % side, i / side};
        const HeightField part = part_of(ground.field, options_.cells, place);
        editor.put(place, part);
        const dvec3 corner(place.col * part.width(), (side - 1 - place.row) * part.depth(), 0);
        parts.push_back({Terrain(part), {.origin = corner}});
      }
    });
    const TerrainTiles tiles = tiled.read();
    const Scene combined = combine(parts);
    size_ = size;
    for (const std::string& task : options_.of) {
      const std::vector<Ray> rays = rays_of(ground.field, task);
      compare(task, rays, one.scene(), "tiles", tiles.scene());
      compare(task, rays, one.scene(), "combined", combined);
    }
  }

  void report(const ReportOptions& report) const {
    print_table(lines_, 4);
    write_json(report, rows_);
  }

 private:
  std::vector<Ray> rays_of(const HeightField& field, const std::string& task) const {
    std::vector<Ray> rays;
    const double w = field.width(), d = field.depth();
    if (task == "camera") {
      const int width = 640, height = options_.points / width;
      const PinholeCamera camera = primary_camera(field, width, height);
      for (int row = 0; row < height; ++row) {
        for (int col = 0; col < width; ++col) {
          const dvec3 direction = camera.forward + (2 * (col + 0.5) / width - 1) * camera.half_width * camera.right +
                                  (1 - 2 * (row + 0.5) / height) * camera.half_height * camera.up;
          rays.push_back({.origin = camera.eye, .direction = direction});
        }
      }
    } else if (task == "lidar") {
      const int elevations = 64, azimuths = options_.points / elevations;
      const dvec3 eye(0.47 * w, 0.53 * d, field.height(0.47 * w, 0.53 * d).value() + 2);
      for (int row = 0; row < elevations; ++row) {
        for (int col = 0; col < azimuths; ++col) {
          const double elevation = (-25 + row * 40.0 / elevations) * 0.017453292519943295;
          const double azimuth = 6.283185307179586 * col / azimuths;
          const dvec3 direction(std::sin(azimuth) * std::cos(elevation), std::cos(azimuth) * std::cos(elevation),
                                std::sin(elevation));
          rays.push_back({.origin = eye, .direction = direction, .t_max = 120});
        }
      }
    } else {
      for (int i = 0; i < options_.points; ++i) {
        Random random(1, static_cast<std::uint64_t>(i));
        const double x = random.uniform(2, w - 2), y = random.uniform(2, d - 2), z = field.height(x, y).value();
        const double angle = random.uniform(0, 6.2831853);
        if (task == "feet") {
          rays.push_back({.origin = {x, y, z + 0.5}, .direction = {0, 0, -1}, .t_max = 2});
        } else if (task == "probe") {
          rays.push_back(
              {.origin = {x, y, z + 0.5}, .direction = {std::cos(angle), std::sin(angle), -0.4}, .t_max = 2});
        } else {
          rays.push_back({.origin = {x, y, z + 0.01}, .direction = {0.66, 0.66, 0.34}});
        }
      }
    }
    return rays;
  }

  void compare(const std::string& task, const std::vector<Ray>& rays, const Scene& one, const std::string& over,
               const Scene& other) {
    if (std::find(options_.over.begin(), options_.over.end(), over) == options_.over.end()) return;
    const bool any_hit = task == "sun";
    std::vector<Hit> of_one(rays.size()), of_other(rays.size());
    std::vector<std::uint8_t> blocked(rays.size());
    const auto in_batch = [&](const Scene& scene, std::vector<Hit>& hits) {
      return [&scene, &hits, &rays, &blocked, any_hit] {
        any_hit ? occluded(scene, rays, blocked) : cast(scene, rays, hits);
      };
    };
    const auto singly = [&](const Scene& scene, std::vector<Hit>& hits) {
      return [&scene, &hits, &rays, &blocked, any_hit] {
        for (std::size_t i = 0; i < rays.size(); ++i) {
          if (any_hit) {
            blocked[i] = occluded(scene, rays[i]);
          } else {
            hits[i] = cast(scene, rays[i]);
          }
        }
      };
    };
    for (const std::string& call : options_.calls) {
      const bool batch = call == "batch";
      const std::vector<double> ns =
          batch ? measure_ways({{"one", in_batch(one, of_one)}, {over, in_batch(other, of_other)}}, rays.size(),
                               options_.repeats)
                : measure_ways({{"one", singly(one, of_one)}, {over, singly(other, of_other)}}, rays.size(),
                               options_.repeats);
      cast(one, rays, of_one), cast(other, rays, of_other);
      std::int64_t differ = 0;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        differ += of_one[i].status != of_other[i].status ||
                  (of_one[i] && std::abs(of_one[i].t - of_other[i].t) > kSame * (1 + of_one[i].t));
      }
      Json row;
      row["size"] = size_, row["cells"] = options_.cells, row["task"] = task, row["over"] = over, row["call"] = call;
      row["one_ns"] = ns[0], row["ns"] = ns[1], row["ratio"] = ns[1] / ns[0], row["differ"] = differ;
      lines_.push_back({std::to_string(size_), std::to_string(options_.cells), task, over, call,
                        short_number(row["one_ns"]), short_number(row["ns"]), short_number(row["ratio"]),
                        std::to_string(differ)});
      rows_.push_back(std::move(row));
    }
  }

  const TilesOptions& options_;
  int size_ = 0;
  Json rows_ = Json::array();
  std::vector<std::vector<std::string>> lines_{
      {"size", "cells", "task", "over", "call", "one ns", "ns", "ratio", "differ"}};
};

void run_tiles(const TilesOptions& options, const ReportOptions& report) {
  const ThreadLimit one(1);
  TileBench tiles(options);
  for (const int size : options.sizes) tiles.run(size);
  tiles.report(report);
}

}  // namespace

void add_tiles(cli::Program& program) {
  auto [command, o] = add_command<TilesOptions>(
      program, "tiles", "Batches over tiles and combined fields beside one field, on one thread", run_tiles);
  add_sizes_option(command, o.sizes);
  command.add(&o.cells, {.names = "--cells", .help = "cells per side of a tile", .range = {1, 32766}});
  command.add(cli::List<std::string>{&o.of}, {.names = "--of",
                                              .help = "rays to measure",
                                              .choices = {"camera", "lidar", "feet", "probe", "sun"},
                                              .closed = true});
  command.add(
      cli::List<std::string>{&o.over},
      {.names = "--over", .help = "what is compared with one field", .choices = {"tiles", "combined"}, .closed = true});
  command.add(cli::List<std::string>{&o.calls},
              {.names = "--calls", .help = "calls to measure", .choices = {"batch", "single"}, .closed = true});
  command.add(&o.points, {.names = "--points", .help = "rays per pass, about", .range = {640, 1 << 26}});
  add_ground_options(command, o.field);
  add_repeats_option(command, o.repeats);
}

}  // namespace scarp::bench
