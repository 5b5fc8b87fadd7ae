// SPDX-License-Identifier: MIT
// Maps of the ground that an observer sees and of sunlit ground, as on the command line. Links scarp::scarp.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "scarp/analysis/line_of_sight.h"
#include "scarp/analysis/shadow.h"
#include "scarp/analysis/viewshed.h"
#include "scarp/scarp.h"

int main() {
  const int side = 401;
  std::vector<float> heights;
  for (int row = 0; row < side; ++row) {
    for (int col = 0; col < side; ++col)
      heights.push_back(static_cast<float>(60.0 * std::sin(0.03 * col) * std::cos(0.04 * row)));
  }
  const auto terrain = scarp::Terrain::view(heights.data(), side, side, {.cell_x = 25.0, .cell_y = 25.0});
  const scarp::HeightField& field = terrain.field();

  // One code per sample, rows from north to south. The observer stands on a hilltop.
  const std::vector<scarp::Seen> seen = scarp::viewshed(field, {52, 79}, {.observer_height = 1.7});
  const auto visible = std::count(seen.begin(), seen.end(), scarp::Seen::visible);

  // A morning sun in the east-south-east, 12 degrees above the horizon.
  constexpr double degree = std::numbers::pi / 180;
  const std::vector<scarp::Shade> shades = scarp::shadow(field, {.azimuth = 110 * degree, .altitude = 12 * degree});
  const auto lit = std::count(shades.begin(), shades.end(), scarp::Shade::lit);

  const scarp::LineOfSight sight =
      scarp::line_of_sight(field, {.col = 52, .row = 79, .height = 1.7}, {.col = 262, .row = 157, .height = 1.7});
  std::printf("%td samples visible, %td lit; the other hilltop is %s, %.1f m above the ground between\n", visible, lit,
              sight.visible ? "visible" : "hidden", sight.clearance);
  return 0;
}
