// SPDX-License-Identifier: MIT
// Rays over terrain functions.
#pragma once

#include <cmath>

#include "field/terrain_functions.h"
#include "scarp/base/ray.h"
#include "scarp/field/height_function.h"

namespace scarp::test {

// Eyes near the ground and high above it; rays along the ground, up, steeply down, and of any length.
inline Ray random_ray(const HeightFunction& function, FunctionRandom& random) {
  const double x = random.between(-5000, 5000), y = random.between(-5000, 5000);
  const double azimuth = random.between(0, 6.28318), kind = random.between(0, 4);
  const double above = kind < 1 ? random.between(0.01, 2) : random.between(5, 300);
  const double rise = kind < 2 ? random.between(-0.05, 0.05) : random.between(-1, 0.2);
  const double scale = std::exp2(random.between(-3, 3));
  Ray ray;
  ray.origin = {x, y, function.value(x, y) + above};
  ray.direction = dvec3(std::cos(azimuth), std::sin(azimuth), rise) * scale;
  ray.t_max = 10000 / scale;
  return ray;
}

}  // namespace scarp::test
