// SPDX-License-Identifier: MIT
#include "scarp/analysis/profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scarp/analysis/sight_crossings.h"

namespace scarp {

std::vector<ProfilePoint> profile(const SightLine& line) {
  std::vector<ProfilePoint> points;
  const auto add = [&](double along, double lowered, double ray, double drop) {
    const double col = line.col(along), row = line.row(along);
    points.push_back({along, along * line.distance(), col, row, lowered + drop, drop, ray + drop});
  };
  std::vector<double> holes;
  add(0, line.ground_at_eye(), line.eye(), 0);
  for (int axis = 0; axis < 2; ++axis)
    visit_sight(
        line, axis,
        [&](const SightCrossing& at) {
          // Crossings at nodes are found along both axes.
          if (axis == 0 || at.at.w1 > 0 || line.from().col == line.to().col)
            add(at.along(), at.ground(), at.ray(), at.drop(line.ground()));
          return true;
        },
        [&](const Crossing& at) { holes.push_back(static_cast<double>(at.steps) / static_cast<double>(at.length)); },
        {});
  add(1, line.ground().lowered(line.ground_at_target(), line.to().col, line.to().row), line.target(),
      line.ground().drop(line.to().col, line.to().row));
  std::stable_sort(points.begin(), points.end(),
                   [](const ProfilePoint& a, const ProfilePoint& b) { return a.along < b.along; });
  std::sort(holes.begin(), holes.end());
  auto hole = holes.begin();
  for (ProfilePoint& point : points) {
    while (hole != holes.end() && *hole < point.along) {
      point.after_hole = true;
      ++hole;
    }
  }
  // The steepest point so far, as seen from the eye, hides everything below it.
  double steepest = -std::numeric_limits<double>::infinity();
  for (ProfilePoint& point : points) {
    if (point.along == 0) continue;
    const double slope = (point.ground - point.drop - line.eye()) / point.along;
    point.visible = !(slope < steepest);
    if (slope > steepest) steepest = slope;
  }
  return points;
}

}  // namespace scarp
