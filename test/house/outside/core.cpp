// SPDX-License-Identifier: MIT
// Links scarp::core alone: a ray straight down on a plane 5 m high.
#include <cstdint>
#include <vector>

#include "scarp/accel/max_pyramid.h"
#include "scarp/field/height_field.h"
#include "scarp/march/height/max_mip.h"

int main() {
  const std::vector<std::int16_t> samples(9, 5);
  const auto field = scarp::HeightField::view(samples.data(), 3, 3, 3);
  const scarp::MaxPyramid pyramid(field);
  scarp::Ray ray;
  ray.origin = {0.5, 0.5, 15};
  ray.direction = {0, 0, -1};
  const scarp::Hit hit = scarp::march_max_mip({&field, &pyramid}, ray);
  return hit && hit.t == 10.0 ? 0 : 1;
}
