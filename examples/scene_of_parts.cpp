// SPDX-License-Identifier: MIT
// A scene: a terrain from memory, voxels and a shape in one world, and rays from above.
#include <cstdint>
#include <cstdio>
#include <vector>

#include "scarp/scarp.h"

int main() {
  // A slope of 1:10 that rises to the east, 1 km wide.
  const int side = 101;
  std::vector<std::int16_t> heights;
  for (int i = 0; i < side * side; ++i) heights.push_back(static_cast<std::int16_t>(i % side));
  const auto terrain = scarp::Terrain::view(heights.data(), side, side, {.cell_x = 10.0, .cell_y = 10.0});

  // A tower of 4 x 4 x 40 voxels of 5 m from a volume in memory, and a ball with a radius of 30 m.
  const std::vector<std::uint8_t> volume(4 * 4 * 40, 1);
  const auto tower = scarp::Voxels::copy(volume.data(), {4, 4, 40}, {.side = 5.0});
  const auto ball = scarp::scene_shape(scarp::DistanceField(scarp::make_shape(scarp::shape::Sphere{.radius = 30})));

  // The positions of the parts in metres. Two balls share one field.
  const scarp::Scene scene = scarp::combine({{terrain},
                                             {tower, {.origin = {300, 500, 25}}},
                                             {ball, {.origin = {500, 500, 120}}},
                                             {ball, {.scale = 2, .origin = {700, 500, 200}}}});

  const char* const names[] = {"terrain", "tower", "ball", "large ball"};
  for (const double x : {100.0, 310.0, 500.0, 700.0}) {
    const scarp::Ray down{.origin = {x, 510, 1000}, .direction = {0, 0, -1}};
    const scarp::Hit hit = scarp::cast(scene, down);
    if (!hit) continue;
    const scarp::SceneSurface surface = scene.surface(down, hit);
    std::printf("x = %.0f m: %s at z = %.2f m, normal (%.2f, %.2f, %.2f)\n", x, names[hit.object], surface.position.z,
                surface.normal.x, surface.normal.y, surface.normal.z);
  }
  return 0;
}
