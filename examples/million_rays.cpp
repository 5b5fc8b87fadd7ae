// SPDX-License-Identifier: MIT
// A million rays in one call: finds the part of a terrain that is visible in an oblique view, and how much of it is in
// shadow.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "scarp/scarp.h"

int main() {
  // Round hills 100 m high on a square grid, 25 cells apart; cells of 10 m.
  const int side = 1001;
  std::vector<std::int16_t> heights;
  for (int row = 0; row < side; ++row) {
    for (int col = 0; col < side; ++col) {
      const int x = col % 50 - 25, y = row % 50 - 25;
      heights.push_back(static_cast<std::int16_t>(std::max(0, 100 - (x * x + y * y) / 4)));
    }
  }
  const auto terrain = scarp::Terrain::view(heights.data(), side, side, {.cell_x = 10.0, .cell_y = 10.0});

  // Parallel rays towards the north, 45 degrees down. hits[i] belongs to rays[i].
  std::vector<scarp::Ray> rays;
  for (int i = 0; i < 1000 * 1000; ++i)
    rays.push_back({.origin = {5.0 + 10 * (i % 1000), 5.0 + 8 * (i / 1000) - 200, 200}, .direction = {0, 1, -1}});
  std::vector<scarp::Hit> hits(rays.size());
  scarp::cast(terrain, rays, hits);

  // Rays from each hit to the sun, low in the east. to_sun[i] starts on the surface of hit from[i].
  std::vector<scarp::Ray> to_sun;
  std::vector<const scarp::Hit*> from;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!hits[i]) continue;
    to_sun.push_back({.origin = rays[i].at(hits[i].t), .direction = {3, 0, 1}});
    from.push_back(&hits[i]);
  }
  std::vector<std::uint8_t> shadow(to_sun.size());
  scarp::occluded(terrain, to_sun, shadow, from);

  std::printf("%zu rays, %zu hits, %td in shadow\n", rays.size(), to_sun.size(),
              std::count(shadow.begin(), shadow.end(), 1));
  return 0;
}
