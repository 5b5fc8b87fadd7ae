// SPDX-License-Identifier: MIT
// Heights in caller-owned memory, and a ray.
#include <cmath>
#include <cstdio>
#include <vector>

#include "scarp/scarp.h"

int main() {
  // 513 x 513 heights in metres, 10 m apart, rows from north to south: waves 160 m from trough to crest.
  const int side = 513;
  std::vector<float> heights;
  for (int row = 0; row < side; ++row) {
    for (int col = 0; col < side; ++col) {
      heights.push_back(static_cast<float>(40.0 * (std::sin(0.05 * col) + std::cos(0.04 * row))));
    }
  }

  // The terrain refers to the samples and does not copy them.
  const auto terrain = scarp::Terrain::view(heights.data(), side, side, {.cell_x = 10.0, .cell_y = 10.0});

  // From 500 m above the south-west corner to the north-east, descending 1 m per 9.9 m. x east, y north, z up.
  const scarp::Ray ray{.origin = {0, 0, 500}, .direction = {7, 7, -1}};
  const scarp::Hit hit = scarp::cast(terrain, ray);
  if (!hit) {
    std::puts("the ray misses the ground");
    return 1;
  }
  const scarp::dvec3 point = ray.at(hit.t);
  std::printf("hit at (%.2f, %.2f, %.2f) m in cell (%d, %d)\n", point.x, point.y, point.z, hit.cell.col, hit.cell.row);
  return 0;
}
