// SPDX-License-Identifier: MIT
// `scarp-bench seams`: very many rays at the lines where height fields meet, as fields of a scene and as tiles. A ray
// that comes from above all ground and is below all of it before it leaves the terrain must hit, whatever is between.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include "bench/commands.h"
#include "bench/random.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/scarp.h"
#include "scarp/scene/tiled_terrain.h"

namespace scarp::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kTiles = 4, kCells = 32, kSide = kTiles * kCells + 1;
constexpr std::int64_t kPiece = 4096;
constexpr double kRelief = 6;  // metres from the lowest to the highest ground

// A terrain of kTiles x kTiles fields, with a corner of the world at its south-west sample.
struct SeamTerrain {
  std::string name;
  Scene scene;
  double cell, corner, base;
};

// The share of the relief at a node of the whole terrain, the same for all fields that meet there.
double relief_at(int col, int row, std::uint64_t seed) {
  const double rough = Random(seed, static_cast<std::uint64_t>(row * kSide + col)).uniform();
  return 0.5 + 0.3 * std::sin(0.17 * col) * std::cos(0.13 * row) + 0.2 * (2 * rough - 1);
}

HeightField field_of_tile(int tile_col, int tile_row, int level, double cell, double base, Surface surface,
                          std::uint64_t seed) {
  const int step = 1 << level, side = kCells / step + 1;
  std::vector<float> samples;
  for (int row = 0; row < side; ++row) {
    for (int col = 0; col < side; ++col) {
      const double share = relief_at(tile_col * kCells + col * step, tile_row * kCells + row * step, seed);
      samples.push_back(static_cast<float>(base + kRelief * share));
    }
  }
  return HeightField::own(std::move(samples), side, side,
                          {.cell_x = cell * step, .cell_y = cell * step, .surface = surface});
}

SeamTerrain fields_in_a_scene(double cell, double corner, Surface surface, std::uint64_t seed) {
  std::vector<ScenePart> parts;
  for (int i = 0; i < kTiles * kTiles; ++i) {
    const int col = i % kTiles, row = i / kTiles;
    const double x = corner + col * kCells * cell, y = corner + (kTiles - 1 - row) * kCells * cell;
    parts.push_back({Terrain(field_of_tile(col, row, 0, cell, 0, surface, seed)), {.origin = {x, y, 0}}});
  }
  return {
      fmt::format("scene, {}, cell {} at {}", surface == Surface::bilinear ? "bilinear" : "triangles", cell, corner),
      combine(parts), cell, corner, 0};
}

SeamTerrain tiles(double cell, double base, bool levels, Surface surface, std::uint64_t seed) {
  TiledTerrain terrain({kTiles, kTiles, kCells, kCells, {.cell_x = cell, .cell_y = cell, .surface = surface}});
  terrain.edit([&](auto& editor) {
    for (int i = 0; i < kTiles * kTiles; ++i) {
      const int col = i % kTiles, row = i / kTiles;
      editor.put({col, row}, field_of_tile(col, row, levels ? (3 * col + row) % 4 : 0, cell, base, surface, seed));
    }
  });
  return {fmt::format("tiles{}, {}, cell {}, base {} m", levels ? " of 4 levels" : "",
                      surface == Surface::bilinear ? "bilinear" : "triangles", cell, base),
          terrain.read().scene(), cell, 0, base};
}

std::vector<SeamTerrain> terrains(std::uint64_t seed) {
  std::vector<SeamTerrain> all;
  for (const Surface surface : {Surface::bilinear, Surface::triangles}) {
    all.push_back(fields_in_a_scene(1, 0, surface, seed));
    all.push_back(fields_in_a_scene(0.3, 0, surface, seed));
    all.push_back(fields_in_a_scene(0.1, 123456.7, surface, seed));
    all.push_back(tiles(0.3, 0, false, surface, seed));
    all.push_back(tiles(0.3, 0, true, surface, seed));
    all.push_back(tiles(1.0 / 3, 8000, true, surface, seed));
  }
  return all;
}

// How a ray comes to the seam; each crosses a line where fields meet near the ground there.
enum class Aim { steep, flat, corner, along, upright };
constexpr std::array kAims{Aim::steep, Aim::flat, Aim::corner, Aim::along, Aim::upright};
constexpr std::array kAimNames{"steep", "flat", "corner", "along a seam", "upright"};

// A ray from above all ground to below it within the terrain.
Ray ray_to_seam(const SeamTerrain& to, Aim aim, Random& random) {
  const double length = kTiles * kCells * to.cell, tile = kCells * to.cell;
  const auto seam = [&] { return tile * (1 + random.below(kTiles - 1)); };
  for (;;) {
    dvec3 p(seam(), random.uniform(0, length), to.base + kRelief * random.uniform());
    if (aim == Aim::corner) p.y = seam();
    dvec3 d(random.uniform(-1, 1), random.uniform(-1, 1), -1);
    if (aim == Aim::steep) d.x *= 0.1, d.y *= 0.1;
    if (aim == Aim::flat) d.z = -random.uniform(0.2, 0.5) * kRelief / tile;
    if (aim == Aim::along) d.x = 0;
    if (aim == Aim::upright) d.x = d.y = 0;
    if (random.below(2)) std::swap(p.x, p.y), std::swap(d.x, d.y);
    p += dvec3(to.corner, to.corner, 0);
    const Ray ray{.origin = p - d * ((to.base + kRelief + 1 - p.z) / -d.z), .direction = d};
    const dvec3 end = ray.at((kRelief + 2) / -d.z);
    const auto inside = [&](const dvec3& q) {
      const double x = q.x - to.corner, y = q.y - to.corner;
      return std::min(x, y) > 0 && std::max(x, y) < length;
    };
    if (inside(ray.origin) && inside(end)) return ray;
  }
}

}  // namespace

void run_seams(const SeamsOptions& options, const ReportOptions& report) {
  const Stopwatch watch;
  const std::vector<SeamTerrain> all = terrains(options.seed);
  struct Count {
    std::atomic<std::int64_t> rays{0}, lost{0}, any_lost{0};
  };
  std::vector<Count> counts(all.size() * kAims.size());
  const std::int64_t pieces = (options.rays + kPiece - 1) / kPiece;
  parallel_for(pieces, 1, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t piece = begin; piece < end; ++piece) {
      const std::size_t which = static_cast<std::size_t>(piece) % counts.size();
      const SeamTerrain& terrain = all[which / kAims.size()];
      const std::int64_t first = piece * kPiece, count = std::min(kPiece, options.rays - first);
      std::vector<Ray> rays;
      for (std::int64_t i = 0; i < count; ++i) {
        Random random(options.seed + 1, static_cast<std::uint64_t>(first + i));
        rays.push_back(ray_to_seam(terrain, kAims[which % kAims.size()], random));
      }
      std::vector<Hit> hits(rays.size());
      std::vector<std::uint8_t> blocked(rays.size());
      terrain.scene.closest_hits(rays, hits);
      terrain.scene.occluded(rays, blocked);
      counts[which].rays += count;
      counts[which].lost += std::count_if(hits.begin(), hits.end(), [](const Hit& hit) { return !hit; });
      counts[which].any_lost += std::count(blocked.begin(), blocked.end(), 0);
    }
  });
  Json rows = Json::array();
  std::vector<std::vector<std::string>> lines{{"terrain", "rays to", "rays", "lost", "any-hit lost"}};
  std::int64_t lost = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    Json row;
    row["terrain"] = all[i / kAims.size()].name;
    row["aim"] = kAimNames[i % kAims.size()];
    row["rays"] = counts[i].rays.load();
    row["lost"] = counts[i].lost.load();
    row["any_hit_lost"] = counts[i].any_lost.load();
    row["seed"] = options.seed;
    lost += counts[i].lost + counts[i].any_lost;
    lines.push_back({row["terrain"], row["aim"], short_number(row["rays"]), short_number(row["lost"]),
                     short_number(row["any_hit_lost"])});
    rows.push_back(row);
  }
  fmt::print("{} rays, seed {}\n", options.rays, options.seed);
  print_table(lines, 2);
  fmt::print("{:.0f} s, {:.3g} us of processor time per ray\n", watch.wall_s(),
             1e6 * watch.cpu_s() / static_cast<double>(options.rays));
  write_json(report, rows);
  if (lost > 0) throw Error(fmt::format("seams: {} of {} rays were lost", lost, options.rays));
}

}  // namespace scarp::bench
