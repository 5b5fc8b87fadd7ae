// SPDX-License-Identifier: MIT
// `scarp-bench seams`: a large number of rays at the lines where height fields meet, as fields of a scene and as tiles.
// A ray that starts above all ground and is below all of it before it leaves the terrain must hit, and at its hit the
// ground must be as high as the ray. The judge interpolates the samples in long double.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/off_vertical.h"
#include "bench/protocol.h"
#include "bench/random.h"
#include "bench/report.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/scarp.h"
#include "scarp/scene/tiled_terrain.h"
#ifdef SCARP_BENCH_VULKAN
#include "scarp/scene/scene_vk.h"
#include "scarp/vk/device.h"
#endif

namespace scarp::bench {
namespace {

// `seams`: rays at the lines where height fields meet.
struct SeamsOptions {
  std::int64_t rays = 10'000'000;
  std::uint64_t seed = 1;
  std::string device;  // a Vulkan device instead of the CPU; empty: the CPU
};

using Json = nlohmann::ordered_json;

constexpr int kTiles = 4;
constexpr std::int64_t kPiece = 4096;
constexpr double kRelief = 6;  // metres from the lowest to the highest ground

// A terrain of kTiles x kTiles fields of `cells` x `cells`, with its south-west sample at the origin of `place`.
struct SeamTerrain {
  std::string name;
  int cells;
  double cell, base;
  Surface surface;
  bool levels;  // whether tiles have several levels of resolution
  bool tiles;   // whether the fields are tiles of one TiledTerrain
  Placement place{};
  std::optional<Scene> scene{};

  int side() const { return kTiles * cells + 1; }
};

// A node of the whole terrain, the same for all fields that meet there.
float sample_at(const SeamTerrain& of, int col, int row, std::uint64_t seed) {
  const double rough = Random(seed, static_cast<std::uint64_t>(row * of.side() + col)).uniform();
  const double share = 0.5 + 0.3 * std::sin(0.17 * col) * std::cos(0.13 * row) + 0.2 * (2 * rough - 1);
  return static_cast<float>(of.base + kRelief * share);
}

// The ground at a position of a terrain with a single resolution, in the terrain's own space.
long double ground_at(const SeamTerrain& of, long double x, long double y, std::uint64_t seed) {
  const long double at_col = x / of.cell, at_row = of.side() - 1 - y / of.cell;
  const auto cell = [&](long double at) { return static_cast<int>(std::clamp<long double>(at, 0, of.side() - 2)); };
  const int col = cell(at_col), row = cell(at_row);
  const long double u = at_col - col, v = at_row - row;
  const long double h00 = sample_at(of, col, row, seed), h10 = sample_at(of, col + 1, row, seed),
                    h01 = sample_at(of, col, row + 1, seed), h11 = sample_at(of, col + 1, row + 1, seed);
  if (of.surface == Surface::bilinear) return (h00 * (1 - u) + h10 * u) * (1 - v) + (h01 * (1 - u) + h11 * u) * v;
  return u + v <= 1 ? h00 * (1 - u - v) + h10 * u + h01 * v : h11 * (u + v - 1) + h10 * (1 - v) + h01 * (1 - u);
}

HeightField field_of_tile(const SeamTerrain& of, int tile_col, int tile_row, int level, std::uint64_t seed) {
  const int step = 1 << level, side = of.cells / step + 1;
  std::vector<float> samples;
  for (int row = 0; row < side; ++row) {
    for (int col = 0; col < side; ++col)
      samples.push_back(sample_at(of, tile_col * of.cells + col * step, tile_row * of.cells + row * step, seed));
  }
  return HeightField::own(std::move(samples), side, side,
                          {.cell_x = of.cell * step, .cell_y = of.cell * step, .surface = of.surface});
}

std::string name_of(Surface surface) { return surface == Surface::bilinear ? "bilinear" : "triangles"; }

SeamTerrain fields_in_a_scene(double cell, int cells, const Placement& place, Surface surface, std::uint64_t seed) {
  SeamTerrain made{fmt::format("scene, {}, cell {} at {:.0f}", name_of(surface), cell, length(place.origin)),
                   cells,
                   cell,
                   0,
                   surface,
                   false,
                   false,
                   place};
  std::vector<ScenePart> parts;
  for (int i = 0; i < kTiles * kTiles; ++i) {
    const int col = i % kTiles, row = i / kTiles;
    const dvec3 corner(col * cells * cell, (kTiles - 1 - row) * cells * cell, 0);
    parts.push_back({Terrain(field_of_tile(made, col, row, 0, seed)), placed(place, {.origin = corner})});
  }
  made.scene = combine(parts);
  return made;
}

SeamTerrain tiles(double cell, int cells, double base, bool levels, const Placement& place, Surface surface,
                  std::uint64_t seed) {
  SeamTerrain made{fmt::format("tiles{}, {}, cell {}, base {} m at {:.0f}", levels ? " of 4 levels" : "",
                               name_of(surface), cell, base, length(place.origin)),
                   cells,
                   cell,
                   base,
                   surface,
                   levels,
                   true,
                   place};
  TiledTerrain terrain({kTiles, kTiles, cells, cells, {.cell_x = cell, .cell_y = cell, .surface = surface}});
  terrain.edit([&](auto& editor) {
    for (int i = 0; i < kTiles * kTiles; ++i) {
      const int col = i % kTiles, row = i / kTiles;
      editor.put({col, row}, field_of_tile(made, col, row, levels ? (3 * col + row) % 4 : 0, seed));
    }
  });
  made.scene = place.identity() ? terrain.read().scene() : combine({{terrain.read(), place}});
  return made;
}

std::vector<SeamTerrain> terrains(std::uint64_t seed) {
  const auto turned = [](double radians, const dvec3& axis) {
    return glm::dmat3(glm::rotate(glm::dmat4(1), radians, axis));
  };
  const Placement far{.origin = {123456.7, 123456.7, 0}},
      askew{.turn = turned(0.6, {0, 0, 1}), .origin = {1e3, -2e3, 5}};
  // On the surface of the Earth, relative to its centre.
  const Placement earth{.turn = turned(0.9, {1, 2, 3}), .origin = {4.1e6, 3.2e6, -3.7e6}};
  std::vector<SeamTerrain> all;
  for (const Surface surface : {Surface::bilinear, Surface::triangles}) {
    all.push_back(fields_in_a_scene(1, 32, {}, surface, seed));
    all.push_back(fields_in_a_scene(0.3, 31, {}, surface, seed));
    all.push_back(fields_in_a_scene(0.1, 32, far, surface, seed));
    all.push_back(fields_in_a_scene(30.7, 23, askew, surface, seed));
    all.push_back(fields_in_a_scene(7.7, 24, earth, surface, seed));
    all.push_back(fields_in_a_scene(92.65, 17, earth, surface, seed));
    all.push_back(tiles(0.3, 32, 0, false, {}, surface, seed));
    all.push_back(tiles(0.3, 32, 0, true, {}, surface, seed));
    all.push_back(tiles(1.0 / 3, 32, 8000, true, {}, surface, seed));
    all.push_back(tiles(30.7, 16, 0, false, {}, surface, seed));
    all.push_back(tiles(0.71, 24, 0, true, {}, surface, seed));
    all.push_back(tiles(92.6, 19, 0, false, earth, surface, seed));
  }
  return all;
}

// How a ray approaches the seam; each crosses a line where fields meet, close to the ground.
enum class Aim { steep, flat, corner, along, upright, leaning, leaning_corner };
constexpr std::array kAims{Aim::steep,   Aim::flat,    Aim::corner,        Aim::along,
                           Aim::upright, Aim::leaning, Aim::leaning_corner};
constexpr std::array kAimNames{
    "steep", "flat", "corner", "along a seam", "upright", "nearly upright", "corner, nearly upright"};

// A ray from above all ground to below it within the terrain, in the terrain's own space.
Ray ray_to_seam(const SeamTerrain& to, Aim aim, Random& random) {
  const double length = kTiles * to.cells * to.cell, tile = to.cells * to.cell;
  const auto seam = [&] { return tile * (1 + random.below(kTiles - 1)); };
  for (;;) {
    dvec3 p(seam(), random.uniform(0, length), to.base + kRelief * random.uniform());
    if (aim == Aim::corner || aim == Aim::leaning_corner) p.y = seam();
    dvec3 d(random.uniform(-1, 1), random.uniform(-1, 1), -1);
    if (aim == Aim::steep) d.x *= 0.1, d.y *= 0.1;
    if (aim == Aim::flat) d.z = -random.uniform(0.2, 0.5) * kRelief / tile;
    if (aim == Aim::along) d.x = 0;
    if (aim == Aim::upright) d.x = d.y = 0;
    if (aim == Aim::leaning || aim == Aim::leaning_corner) {
      d.x = off_vertical(random), d.y = random.below(2) ? off_vertical(random) : 0;
      // Off the seam by the rounding of this position or of the world position.
      if (random.below(2)) p.x += random.uniform(-2, 2) * 0x1p-53 * (p.x + glm::length(to.place.origin));
    }
    if (random.below(2)) std::swap(p.x, p.y), std::swap(d.x, d.y);
    const Ray ray{.origin = p - d * ((to.base + kRelief + 1 - p.z) / -d.z), .direction = d};
    const dvec3 end = ray.at((kRelief + 2) / -d.z);
    const auto inside = [&](const dvec3& q) { return std::min(q.x, q.y) > 0 && std::max(q.x, q.y) < length; };
    if (inside(ray.origin) && inside(end)) return ray;
  }
}

Ray placed_ray(const SeamTerrain& to, const Ray& ray) {
  Ray world = ray;
  world.origin = to.place.world_from_field(ray.origin);
  world.direction = to.place.turn * ray.direction;
  return world;
}

// Whether a hit is where the ray hits the ground, to the promised accuracy: a thousandth of a cell, vertically.
bool is_on_ground(const SeamTerrain& of, const Ray& ray, const Hit& hit, std::uint64_t seed) {
  const long double t = hit.t, z = ray.origin.z + ray.direction.z * t, room = 1e-3L * of.cell;
  if (std::abs(hit.height - z) > room || z < of.base - room || z > of.base + kRelief + room) return false;
  if (of.levels) return true;
  return std::abs(z - ground_at(of, ray.origin.x + ray.direction.x * t, ray.origin.y + ray.direction.y * t, seed)) <=
         room;
}

// Tiles do not run on devices.
void move_to_device(std::vector<SeamTerrain>& terrains, const std::string& choice) {
#ifdef SCARP_BENCH_VULKAN
  const Device device({.choice = choice});
  std::erase_if(terrains, [](const SeamTerrain& of) { return of.tiles; });
  for (SeamTerrain& terrain : terrains) terrain.scene = scene_on(device, *terrain.scene);
  fmt::print("on {}\n", device.description().name);
#else
  (void)terrains;
  throw Error(fmt::format("--device {}: this program was built without Vulkan", choice));
#endif
}

// Throws Error, after the report, if a ray is lost.
void run_seams(const SeamsOptions& options, const ReportOptions& report) {
  const Stopwatch watch;
  std::vector<SeamTerrain> all = terrains(options.seed);
  if (!options.device.empty()) move_to_device(all, options.device);
  struct Count {
    std::atomic<std::int64_t> rays{0}, lost{0}, any_lost{0}, wrong{0};
  };
  std::vector<Count> counts(all.size() * kAims.size());
  const std::int64_t pieces = (options.rays + kPiece - 1) / kPiece;
  const bool alone_too = options.device.empty();  // a device takes as long for one ray as for thousands
  const auto trace = [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t piece = begin; piece < end; ++piece) {
      const std::size_t which = static_cast<std::size_t>(piece) % counts.size();
      const SeamTerrain& terrain = all[which / kAims.size()];
      const std::int64_t first = piece * kPiece, count = std::min(kPiece, options.rays - first);
      std::vector<Ray> own, rays;
      for (std::int64_t i = 0; i < count; ++i) {
        Random random(options.seed + 1, static_cast<std::uint64_t>(first + i));
        own.push_back(ray_to_seam(terrain, kAims[which % kAims.size()], random));
        rays.push_back(placed_ray(terrain, own.back()));
      }
      std::vector<Hit> hits(rays.size());
      std::vector<std::uint8_t> blocked(rays.size());
      terrain.scene->closest_hits(rays, hits);
      terrain.scene->occluded(rays, blocked);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const Hit alone = alone_too ? terrain.scene->closest_hit(rays[i]) : hits[i];
        counts[which].wrong +=
            !(alone == hits[i]) || (hits[i] && !is_on_ground(terrain, own[i], hits[i], options.seed));
      }
      counts[which].rays += count;
      counts[which].lost += std::count_if(hits.begin(), hits.end(), [](const Hit& hit) { return !hit; });
      counts[which].any_lost += std::count(blocked.begin(), blocked.end(), 0);
    }
  };
  if (alone_too) {
    parallel_for(pieces, 1, trace);
  } else {
    trace(0, pieces);  // a scene on a device takes one call at a time
  }
  Json rows = Json::array();
  std::vector<std::vector<std::string>> lines{{"terrain", "rays to", "rays", "lost", "any-hit lost", "wrong"}};
  std::int64_t lost = 0, wrong = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    Json row;
    row["terrain"] = all[i / kAims.size()].name;
    row["aim"] = kAimNames[i % kAims.size()];
    row["rays"] = counts[i].rays.load();
    row["lost"] = counts[i].lost.load();
    row["any_hit_lost"] = counts[i].any_lost.load();
    row["wrong"] = counts[i].wrong.load();
    row["seed"] = options.seed;
    lost += counts[i].lost + counts[i].any_lost;
    wrong += counts[i].wrong;
    lines.push_back({row["terrain"], row["aim"], short_number(row["rays"]), short_number(row["lost"]),
                     short_number(row["any_hit_lost"]), short_number(row["wrong"])});
    rows.push_back(row);
  }
  fmt::print("{} rays, seed {}\n", options.rays, options.seed);
  print_table(lines, 2);
  fmt::print("{:.0f} s, {:.3g} us of processor time per ray\n", watch.wall_s(),
             1e6 * watch.cpu_s() / static_cast<double>(options.rays));
  write_json(report, rows);
  if (lost > 0 || wrong > 0)
    throw Error(fmt::format("seams: {} of {} rays were lost, {} hit elsewhere", lost, options.rays, wrong));
}

}  // namespace

void add_seams(cli::Program& program) {
  auto [command, o] = add_command<SeamsOptions>(
      program, "seams", "Rays at the lines where height fields meet: how many are lost", run_seams);
  command.add(&o.rays, {.names = "--rays", .help = "rays in all", .range = {1, 1e15}});
  command.add(&o.seed, {.names = "--seed", .help = "seed of terrains and rays"});
  command.add(&o.device, {.names = "--device",
                          .value = "NAME",
                          .help = "a Vulkan device instead of the CPU, for the fields of scenes",
                          .note = "cpu, gpu, auto or part of a name"});
}

}  // namespace scarp::bench
