// SPDX-License-Identifier: MIT
// Editing a terrain: a ridge blocks the line of sight between two points until a cutting is dug through it.
#include <cmath>
#include <cstdio>
#include <vector>

#include "scarp/scarp.h"

namespace {

// The segment between two points, 2 m above the ground, is t in [0, 1] of a ray whose direction is their difference.
bool sees(const scarp::Terrain& terrain, scarp::dvec2 eye, scarp::dvec2 target) {
  const scarp::dvec3 a(eye, terrain.height(eye.x, eye.y).value() + 2);
  const scarp::dvec3 b(target, terrain.height(target.x, target.y).value() + 2);
  return !scarp::occluded(terrain, {.origin = a, .direction = b - a, .t_max = 1});
}

}  // namespace

int main() {
  // A ridge 100 m high from west to east through the middle of a plain, 1 km wide.
  const int side = 101;
  std::vector<float> heights;
  for (int i = 0; i < side * side; ++i) {
    const double to_ridge = std::abs(i / side - 50) / 10.0;
    heights.push_back(static_cast<float>(100.0 * std::exp(-to_ridge * to_ridge)));
  }
  auto terrain = scarp::Terrain::own(heights, side, side, {.cell_x = 10.0, .cell_y = 10.0});
  std::printf("before: the target is %s\n", sees(terrain, {500, 100}, {500, 900}) ? "visible" : "hidden");

  // 5 columns at x = 480 .. 520 m, from border to border. Only the pyramid entries over them are updated.
  const scarp::SampleRect cutting{.col = 48, .row = 0, .cols = 5, .rows = side};
  const std::vector<float> ground(static_cast<std::size_t>(cutting.cols * cutting.rows), 0.0f);
  terrain.set_samples(cutting, ground.data());
  std::printf("after: the target is %s\n", sees(terrain, {500, 100}, {500, 900}) ? "visible" : "hidden");
  return 0;
}
