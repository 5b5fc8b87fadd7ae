// SPDX-License-Identifier: MIT
#include <cmath>

#include "scarp/analysis/line_of_sight.h"
#include "scarp/analysis/sight_crossings.h"

namespace scarp {

double fresnel_radius(double wavelength, double from, double to) {
  return std::sqrt(wavelength * from * to / (from + to));
}

FresnelClearance fresnel_clearance(const SightLine& line, double wavelength) {
  FresnelClearance least;
  for (int axis = 0; axis < 2; ++axis) {
    visit_sight(line, axis, [&](const SightCrossing& at) {
      at.add_to(least, line, wavelength);
      return true;
    });
  }
  return least;
}

}  // namespace scarp
