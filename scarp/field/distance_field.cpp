// SPDX-License-Identifier: MIT
#include "scarp/field/distance_field.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scarp/field/distance_local.h"
#include "scarp/field/distance_run.h"

namespace scarp {
namespace {

using distance::BentMode;
using distance::GradientMode;
using distance::PointMode;

// Gradient of a 1-Lipschitz function from its values at the corners of a tetrahedron; its length is arbitrary at a
// crease.
dvec3 from_differences(const DistanceField& field, const dvec3& p) {
  constexpr double kStep = 0x1p-17;  // relative step: about the cube root of the rounding error, 2^-53
  const double h = kStep * std::max({1.0, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  dvec3 sum(0.0);
  for (const dvec3& corner : {dvec3(1, -1, -1), dvec3(-1, -1, 1), dvec3(-1, 1, -1), dvec3(1, 1, 1)}) {
    sum += corner * field.value(p + h * corner);
  }
  return sum / (4 * h);
}

}  // namespace

DistanceField::DistanceField(Shape shape) : shape_(std::move(shape)), program_(compile(shape_)) {}

double DistanceField::value(const dvec3& position) const {
  return distance::run(program_, PointMode<double>{}, position).value;
}

double DistanceField::rounding(double reach) const {
  double rounding = program_.rounding + program_.rounding_per_metre * reach;
  if (!program_.functions.empty()) {
    const int i =
        reach <= 1 ? 0 : std::min(std::ilogb(reach) + 1, static_cast<int>(program_.ground_rounding.size()) - 1);
    rounding += program_.ground_rounding[static_cast<std::size_t>(i)];
  }
  return rounding;
}

int DistanceField::material(const dvec3& position) const {
  return distance::run(program_, PointMode<double>{}, position).material;
}

dvec3 DistanceField::gradient(const dvec3& position) const {
  const dvec3 g = distance::run(program_, GradientMode{}, {position, kNoTurn}).value.gradient;
  return length(g) > 0 ? g : from_differences(*this, position);
}

dvec3 DistanceField::normal(const dvec3& position) const {
  dvec3 g = distance::run(program_, GradientMode{FunctionUse::normal}, {position, kNoTurn}).value.gradient;
  if (!(length(g) > 0)) g = from_differences(*this, position);
  // Where the gradient vanishes, any direction is valid; use up.
  return length(g) > 0 ? normalize(g) : dvec3(0, 0, 1);
}

DistanceSegment DistanceField::along(const dvec3& origin, const dvec3& direction, double t0, double t1,
                                     bool rates) const {
  const dvec3 p = origin + 0.5 * (t0 + t1) * direction, d = 0.5 * (t1 - t0) * direction;
  const double radius = length(d) * (1 + 0x1p-40);
  // Twice: for the values at the middle, and for values computed at other positions.
  const double rounding = 2 * this->rounding(length(p) + radius);
  const BentMode::Value v = distance::run(program_, BentMode{radius, rates}, {p, d}).value;
  return {v.f.mid, v.f.slope[0], v.f.rest + rounding, v.f.low - rounding, v.f.high + rounding, v.rate_low, v.rate_high};
}

}  // namespace scarp
