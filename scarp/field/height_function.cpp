// SPDX-License-Identifier: MIT
#include "scarp/field/height_function.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scarp/field/function_run.h"

namespace scarp {
namespace {

using function::Jet;
using function::kSlack;
using function::Taylor;

// A coordinate along a segment, origin + t * direction, including the rounding of positions.
Taylor<1> coordinate(double origin, double direction, double t0, double t1) {
  Taylor<1> t;
  const double middle = 0.5 * (t0 + t1), half = 0.5 * (t1 - t0);
  const double rounding = kSlack * (std::abs(origin) + std::abs(direction) * std::max(std::abs(t0), std::abs(t1)));
  t.mid = origin + direction * middle;
  t.slope[0] = direction * half;
  t.rest = rounding;
  t.low = t.mid - std::abs(t.slope[0]) - rounding;
  t.high = t.mid + std::abs(t.slope[0]) + rounding;
  t.error = rounding;
  return t;
}

// A side of a rectangle, as direction i of two; positions in the rectangle are exact.
Taylor<2> side(double low, double high, std::size_t i) {
  Taylor<2> t;
  t.mid = 0.5 * (low + high);
  t.slope[i] = 0.5 * (high - low);
  t.rest = kSlack * std::max(std::abs(low), std::abs(high));
  t.low = low, t.high = high;
  return t;
}

}  // namespace

HeightFunction::HeightFunction(Function function) : function_(std::move(function)) {
  for (const FunctionUse use : {FunctionUse::march, FunctionUse::shadow, FunctionUse::normal}) {
    programs_[static_cast<int>(use)] = compile(function_, use);
    everywhere_[static_cast<int>(use)] = bound({-kFunctionReach, kFunctionReach, -kFunctionReach, kFunctionReach}, use);
  }
  normals_are_of_march_ = program(FunctionUse::normal) == program(FunctionUse::march);
}

double HeightFunction::value(double x, double y, FunctionUse use) const { return function::run(program(use), x, y); }

dvec2 HeightFunction::gradient(double x, double y, FunctionUse use) const {
  using Number = Jet<double, 2>;
  const Number h = function::run(program(use), Number{x, {1, 0}}, Number{y, {0, 1}});
  return {h.d[0], h.d[1]};
}

FunctionBound HeightFunction::bound(const FunctionRectangle& r, FunctionUse use) const {
  using Number = Jet<Taylor<2>, 2>;
  const Taylor<2> one = function::from_constant<2>(1), zero;
  const Number h = function::run(program(use), Number{side(r.x_low, r.x_high, 0), {one, zero}},
                                 Number{side(r.y_low, r.y_high, 1), {zero, one}});
  const auto most = [](const Taylor<2>& t) { return std::max(std::abs(t.low), std::abs(t.high)); };
  return {h.v.low, h.v.high, std::hypot(most(h.d[0]), most(h.d[1])) * (1 + kSlack), h.v.error};
}

SegmentBound HeightFunction::along(dvec2 origin, dvec2 direction, double t0, double t1, FunctionUse use) const {
  const Taylor<1> h =
      function::run(program(use), coordinate(origin.x, direction.x, t0, t1), coordinate(origin.y, direction.y, t0, t1));
  return {h.mid, h.slope[0], h.rest, h.low, h.high, h.error};
}

dvec2 HeightFunction::slope_along(dvec2 origin, dvec2 direction, double t0, double t1, FunctionUse use) const {
  using Number = Jet<Taylor<1>, 1>;
  const Number h = function::run(
      program(use), Number{coordinate(origin.x, direction.x, t0, t1), {function::from_constant<1>(direction.x)}},
      Number{coordinate(origin.y, direction.y, t0, t1), {function::from_constant<1>(direction.y)}});
  return {h.d[0].low, h.d[0].high};
}

}  // namespace scarp
