// SPDX-License-Identifier: MIT
// Who sees whom: a ray from one point above the ground to another, and whether anything stands between them.
#include <cmath>
#include <cstdio>
#include <vector>

#include "scarp/accel/max_pyramid.h"
#include "scarp/field/height_field.h"
#include "scarp/march/height/max_mip.h"

namespace {

// A point above the ground at (x, y), metres.
scarp::dvec3 above(const scarp::HeightField& field, double x, double y, double height) {
  return {x, y, field.height(x, y).value() + height};
}

// The segment between two points is t in [0, 1] of a ray whose direction is their difference. A ray that only touches
// the ground counts as blocked here.
bool sees(const scarp::HeightField& field, const scarp::MaxPyramid& pyramid, scarp::dvec3 eye, scarp::dvec3 target) {
  scarp::Ray ray;
  ray.origin = eye;
  ray.direction = target - eye;
  ray.t_max = 1.0;
  return !scarp::occluded_max_mip({&field, &pyramid}, ray);
}

}  // namespace

int main() {
  // A ridge 100 m high from west to east through the middle of a plain, 1 km wide, with a notch at x = 500 m.
  const int side = 101;
  std::vector<float> heights;
  for (int row = 0; row < side; ++row) {
    for (int col = 0; col < side; ++col) {
      const double to_ridge = std::abs(row - 50) / 10.0;
      const bool notch = std::abs(col - 50) <= 2;
      heights.push_back(static_cast<float>(notch ? 0.0 : 100.0 * std::exp(-to_ridge * to_ridge)));
    }
  }
  const auto field = scarp::HeightField::view(heights.data(), side, side, side, {.cell_x = 10.0, .cell_y = 10.0});
  const scarp::MaxPyramid pyramid(field);

  const scarp::dvec3 eye = above(field, 500, 100, 2);
  for (const double x : {300.0, 500.0, 700.0}) {
    const scarp::dvec3 target = above(field, x, 900, 2);
    std::printf("from x = 500 m the point at x = %.0f m is %s\n", x,
                sees(field, pyramid, eye, target) ? "seen" : "hidden");
  }
  return 0;
}
