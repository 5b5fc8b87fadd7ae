// SPDX-License-Identifier: MIT
// Batches over tiles and over many combined fields: bit for bit the answers of single rays, over random tilings with
// holes and missing tiles, along seams and through corners, from surfaces, as cameras, and in scenes of several
// objects.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "cases.h"
#include "march/height/spiteful.h"
#include "scarp/scarp.h"
#include "scarp/scene/tiled_terrain.h"

namespace scarp {
namespace {

using test::Random;
using test::uniform;
using test::whole;

// Random heights of a whole terrain, and the same as tiles and as fields in a scene.
struct Ground {
  TileLayout layout;
  std::optional<HeightField> field;  // all samples, also those of missing tiles
  std::optional<TerrainTiles> tiles;
  std::vector<ScenePart> parts;
};

template <class T>
Ground make_ground(Random& random, const TileLayout& layout, double relief, double hole_share, double missing_share,
                   bool levels) {
  const int side = layout.cols * layout.cell_cols + 1, height = layout.rows * layout.cell_rows + 1;
  const T nodata = std::is_floating_point_v<T> ? T(-999) : T(99);
  Ground ground{layout, {}, {}, {}};
  ground.layout.ground.nodata = static_cast<double>(nodata);
  std::vector<T> all;
  for (int row = 0; row < height; ++row) {
    for (int col = 0; col < side; ++col) {
      const double hill = std::sin(0.21 * col) * std::cos(0.17 * row);
      all.push_back(static_cast<T>(relief * (hill + uniform(random, 0, 0.4))));
      if (uniform(random, 0, 1) < hole_share) all.back() = nodata;
    }
  }
  ground.field = HeightField::own(all, side, height, ground.layout.ground);
  TiledTerrain terrain(ground.layout);
  terrain.edit([&](auto& editor) {
    for (int i = 0; i < layout.cols * layout.rows; ++i) {
      const TilePlace place{i % layout.cols, i / layout.cols};
      if (uniform(random, 0, 1) < missing_share) continue;
      const int level = levels ? whole(random, 0, 2) : 0, step = 1 << level;
      const int own_cols = (layout.cell_cols >> level) + 1, own_rows = (layout.cell_rows >> level) + 1;
      std::vector<T> own;
      for (int row = 0; row < own_rows; ++row) {
        for (int col = 0; col < own_cols; ++col) {
          own.push_back(all[static_cast<std::size_t>((place.row * layout.cell_rows + row * step) * side +
                                                     place.col * layout.cell_cols + col * step)]);
        }
      }
      HeightFieldSettings settings = ground.layout.ground;
      settings.cell_x *= step, settings.cell_y *= step;
      const HeightField field = HeightField::own(std::move(own), own_cols, own_rows, settings);
      editor.put(place, field);
      const dvec3 corner(place.col * layout.cell_cols * layout.ground.cell_x,
                         (layout.rows - 1 - place.row) * layout.cell_rows * layout.ground.cell_y, 0);
      ground.parts.push_back({Terrain(field), {.origin = corner}});
    }
  });
  ground.tiles = terrain.read();
  return ground;
}

Ground random_ground(Random& random, int round) {
  TileLayout layout{.cols = whole(random, 1, 6), .rows = whole(random, 1, 6)};
  const bool levels = round % 3 == 1;
  layout.cell_cols = levels ? 4 * whole(random, 1, 6) : whole(random, 1, 29);
  layout.cell_rows = levels ? 4 * whole(random, 1, 6) : whole(random, 1, 29);
  layout.ground.cell_x = round % 2 ? 1 : uniform(random, 0.2, 3);
  layout.ground.cell_y = round % 2 ? 1 : uniform(random, 0.2, 3);
  if (round % 4 == 2) layout.ground.surface = Surface::triangles;
  const double holes = round % 3 == 2 ? 0.03 : 0, missing = round % 2 ? 0.2 : 0;
  // Stitched samples near 1,000 are rounded.
  const double relief = round % 5 == 4 ? 1000 : uniform(random, 1, 9);
  if (round % 7 == 3 || round % 7 == 5)
    return make_ground<std::int16_t>(random, layout, relief, holes, missing, levels);
  return make_ground<float>(random, layout, relief, holes, missing, levels);
}

// Where tiles meet: on a line or a corner, often on the ground.
dvec3 at_seam(Random& random, const Ground& ground) {
  const TileLayout& of = ground.layout;
  const double width = of.cell_cols * of.ground.cell_x, depth = of.cell_rows * of.ground.cell_y;
  dvec3 p(uniform(random, -0.1, 1.1) * of.cols * width, uniform(random, -0.1, 1.1) * of.rows * depth, 0);
  if (whole(random, 0, 2)) p.x = width * whole(random, 0, of.cols);
  if (whole(random, 0, 2)) p.y = depth * whole(random, 0, of.rows);
  const auto height = ground.tiles->height(p.x, p.y);
  p.z = height && whole(random, 0, 1) ? *height : uniform(random, -3, 12);
  return p;
}

Ray ray_at_seam(Random& random, const Ground& ground) {
  // A ray that falls a whole tile stays within rounding of a seam in y, and a little beside one in x.
  constexpr double kBeside = 1e-9, kRounded = 1e-12, kGrazing = 1e-3;
  const dvec3 aim = at_seam(random, ground);
  dvec3 direction(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 0.2));
  switch (whole(random, 0, 5)) {
    case 0:
      direction = {0, 0, -1};
      break;  // vertical
    case 1:
      direction.x *= kBeside, direction.y *= kRounded;
      break;  // nearly so
    case 2:
      direction.x = 0;
      break;  // along a seam
    case 3:
      direction.y = 0, direction.z *= kGrazing;
      break;  // along a seam and the ground
    default:
      break;
  }
  Ray ray{.origin = aim - uniform(random, -2, 30) * direction, .direction = direction};
  if (whole(random, 0, 2) == 0) ray.t_max = uniform(random, 0, 40);
  if (whole(random, 0, 5) == 0) ray.t_min = uniform(random, -5, ray.t_max < 40 ? ray.t_max : 40);
  if (whole(random, 0, 3) == 0) ray.origin = aim + dvec3(0, 0, 0.5), ray.t_max = 1.5;
  return ray;
}

// Rays of all kinds, in the order in which they are made or in that of a camera.
std::vector<Ray> rays_over(Random& random, const Ground& ground, int count) {
  std::vector<Ray> rays;
  for (const auto& kind : test::spiteful_rays()) {
    for (int i = 0; i < count / 20; ++i) rays.push_back(kind.make(*ground.field, random));
  }
  for (int i = 0; i < count; ++i) rays.push_back(ray_at_seam(random, ground));
  for (const Ray& ray : test::rays_of_unusual_numbers(*ground.field)) {
    if (ray.start == RayStart::free) rays.push_back(ray);
  }
  return rays;
}

std::vector<Ray> camera_over(Random& random, const Ground& ground, int columns, int rows) {
  const dvec3 eye = at_seam(random, ground) + dvec3(0, 0, uniform(random, 0, 9));
  const double turn = uniform(random, 0, 6.3), pitch = uniform(random, -0.9, 0.1), wide = uniform(random, 0.2, 1.2);
  const dvec3 forward(std::sin(turn) * std::cos(pitch), std::cos(turn) * std::cos(pitch), std::sin(pitch));
  const dvec3 right(std::cos(turn), -std::sin(turn), 0), up = cross(right, forward);
  std::vector<Ray> rays;
  const double t_max = whole(random, 0, 1) ? std::numeric_limits<double>::infinity() : uniform(random, 5, 60);
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < columns; ++col) {
      const double x = wide * (2 * (col + 0.5) / columns - 1), y = wide * (1 - 2 * (row + 0.5) / rows) * rows / columns;
      rays.push_back({.origin = eye, .direction = forward + x * right + y * up, .t_max = t_max});
    }
  }
  return rays;
}

std::string shown(const Ray& ray) {
  return testing::PrintToString(std::vector<double>{ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x,
                                                    ray.direction.y, ray.direction.z, ray.t_min, ray.t_max});
}

// Returns the number of hits.
int compare(const Scene& scene, const std::vector<Ray>& rays, const std::vector<const Hit*>& from,
            const std::string& what) {
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> blocked(rays.size(), 7);
  scene.closest_hits(rays, hits, {}, from);
  scene.occluded(rays, blocked, from);
  int found = 0, wrong = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Ray ray = rays[i];
    const Hit* start = from.empty() ? nullptr : from[i];
    if (!from.empty() && !start) ray.start = RayStart::free;
    const Hit hit = scene.closest_hit(ray, start);
    const bool same = hit == hits[i] && scene.occluded(ray, start) == (blocked[i] != 0) && blocked[i] <= 1;
    found += hit.status == HitStatus::hit;
    if (same || ++wrong > 3) continue;
    ADD_FAILURE() << what << ", ray " << i << ' ' << shown(ray) << ": status " << static_cast<int>(hits[i].status)
                  << ", t " << hits[i].t << ", part " << hits[i].part << ", blocked " << int{blocked[i]}
                  << " instead of " << static_cast<int>(hit.status) << ", " << hit.t << ", " << hit.part;
  }
  EXPECT_EQ(wrong, 0) << what << " of " << rays.size();
  return found;
}

// Compares rays, and rays from the surfaces that they hit.
int compare_all(Random& random, const Scene& scene, const std::vector<Ray>& rays, const std::string& what) {
  int found = compare(scene, rays, {}, what);
  std::vector<Hit> hits(rays.size());
  scene.closest_hits(rays, hits);
  std::vector<Ray> later;
  std::vector<const Hit*> from;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!hits[i] && i % 8 != 0) continue;
    const dvec3 p = hits[i] ? rays[i].at(hits[i].t) : rays[i].origin;
    if (!(std::abs(p.x) < 1e6 && std::abs(p.y) < 1e6 && std::abs(p.z) < 1e6)) continue;
    later.push_back(
        {.origin = p, .direction = {uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -0.3, 1)}});
    if (i % 3 == 0) later.back().t_max = uniform(random, 0, 30);
    if (hits[i] && i % 5 == 0) later.back().start = RayStart::on_surface, later.back().start_cell = hits[i].cell;
    if (hits[i]) later.back().start_object = hits[i].object;
    from.push_back(hits[i] ? &hits[i] : nullptr);
  }
  found += compare(scene, later, from, what + ", from surfaces");
  // The start that rays state themselves.
  if (scene.objects().size() == 1) found += compare(scene, later, {}, what + ", own starts");
  return found;
}

TEST(TileBatches, MatchSingleRays) {
  int found = 0;
  for (int round = 0; round < test::cases(210, 42, 21); ++round) {
    Random random(static_cast<unsigned>(round));
    const Ground ground = random_ground(random, round);
    const std::string what = "round " + std::to_string(round);
    found += compare_all(random, *ground.tiles, rays_over(random, ground, test::cases(2000, 700, 200)), what);
  }
  EXPECT_GT(found, 5000);
}

TEST(TileBatches, MatchSingleRaysOfCameras) {
  int found = 0;
  for (int round = 0; round < test::cases(280, 56, 14); ++round) {
    Random random(static_cast<unsigned>(round));
    const Ground ground = random_ground(random, round);
    const int columns = whole(random, 16, 70), rows = whole(random, 16, 60);
    std::vector<Ray> rays = camera_over(random, ground, columns, rows);
    const std::string what = "camera " + std::to_string(round);
    if (round % 4 == 3) {  // column by column
      const std::vector<Ray> before = rays;
      for (std::size_t i = 0; i < rays.size(); ++i)
        rays[i] = before[i % static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns) +
                         i / static_cast<std::size_t>(rows)];
    }
    found += compare(*ground.tiles, rays, {}, what);
    // Rays that do not belong to it.
    rays[rays.size() / 3].origin.z += 1, rays[rays.size() / 2].direction = {0, 0, -1};
    rays[rays.size() / 4].t_min = 0.5;
    found += compare(*ground.tiles, rays, {}, what + ", with others");
  }
  EXPECT_GT(found, 5000);
}

// Tiles as one of several objects, and many fields in one scene.
TEST(TileBatches, MatchSingleRaysInScenes) {
  int found = 0;
  for (int round = 0; round < test::cases(42, 14, 7); ++round) {
    Random random(static_cast<unsigned>(100 + round));
    const Ground ground = random_ground(random, round);
    const std::string what = "scene " + std::to_string(round);
    const std::vector<Ray> rays = rays_over(random, ground, 200);
    const double width = ground.tiles->scene().box().high.x;
    found +=
        compare_all(random, combine({{*ground.tiles}, {*ground.tiles, {.origin = {width / 2, 3, 1}}}}), rays, what);
    if (!ground.parts.empty()) found += compare_all(random, combine(ground.parts), rays, what + ", fields");
  }
  EXPECT_GT(found, 2000);
}

}  // namespace
}  // namespace scarp
