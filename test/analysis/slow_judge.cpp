// SPDX-License-Identifier: MIT
#include "analysis/slow_judge.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scarp::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A crossing: its position along the ray, in multiples of the direction, and the height of the ground there.
struct GroundAt {
  Rational along, height;
};

Rational floor_of(const Rational& x) {
  boost::multiprecision::cpp_int quotient = numerator(x) / denominator(x);
  if (numerator(x) < 0 && quotient * denominator(x) != numerator(x)) --quotient;
  return Rational(quotient);
}

// The ground where the ray start + along * (col, row) crosses line k of an axis; nullopt if there is no ground.
std::optional<GroundAt> ground_on_line(const SightGround& ground, int axis, int k, const Rational start[2],
                                       const Rational direction[2]) {
  const int cols = ground.field().cols(), rows = ground.field().rows();
  const Rational along = (k - start[axis]) / direction[axis];
  const Rational place = start[1 - axis] + along * direction[1 - axis];
  if (along <= 0 || place < 0 || place > (axis == 0 ? rows : cols) - 1) return std::nullopt;
  const Rational low = floor_of(place), part = place - low;
  const auto node = [&](int step) {
    const int j = low.convert_to<int>() + step;
    return ground.lowered(axis == 0 ? Node{k, j} : Node{j, k});
  };
  const auto first = node(0);
  if (!first) return std::nullopt;
  if (part == 0) return GroundAt{along, Rational(*first)};
  const auto second = node(1);
  if (!second) return std::nullopt;
  return GroundAt{along, Rational(*first) * (1 - part) + Rational(*second) * part};
}

// All crossings of a ray after its start.
std::vector<GroundAt> all_crossings(const SightGround& ground, const Rational start[2], const Rational direction[2]) {
  std::vector<GroundAt> crossings;
  const int lines[2] = {ground.field().cols(), ground.field().rows()};
  for (int axis = 0; axis < 2; ++axis)
    for (int k = 0; direction[axis] != 0 && k < lines[axis]; ++k)
      if (const auto at = ground_on_line(ground, axis, k, start, direction)) crossings.push_back(*at);
  return crossings;
}

std::vector<GroundAt> crossings_between(const SightGround& ground, double col, double row, double to_col,
                                        double to_row) {
  const Rational start[2] = {Rational(col), Rational(row)};
  const Rational direction[2] = {Rational(to_col) - start[0], Rational(to_row) - start[1]};
  auto crossings = all_crossings(ground, start, direction);
  std::erase_if(crossings, [](const GroundAt& at) { return at.along >= 1; });
  return crossings;
}

}  // namespace

bool judge_line(const SightGround& ground, double col, double row, double eye, double to_col, double to_row,
                double target) {
  const Rational from(eye), to(target);
  for (const GroundAt& at : crossings_between(ground, col, row, to_col, to_row))
    if (at.height > from + at.along * (to - from)) return false;
  return true;
}

Seen judge_seen(const Viewpoint& view, Node node) {
  const auto lowered = view.ground().lowered(node);
  if (!lowered) return Seen::hole;
  const double target = view.target(*lowered);
  if (!view.in_range(node, target)) return Seen::out_of_range;
  const Node from = view.observer();
  return judge_line(view.ground(), from.col, from.row, view.eye(), node.col, node.row, target) ? Seen::visible
                                                                                               : Seen::hidden;
}

std::vector<Seen> judge_viewshed(const HeightField& field, Node observer, const ViewshedSettings& settings) {
  const Viewpoint view(field, observer, settings);
  std::vector<Seen> codes;
  for (int row = 0; row < field.rows(); ++row)
    for (int col = 0; col < field.cols(); ++col) codes.push_back(judge_seen(view, {col, row}));
  return codes;
}

double judge_least_visible(const Viewpoint& view, Node node) {
  const auto lowered = view.ground().lowered(node);
  if (!lowered || !view.in_range(node, view.target(*lowered))) return std::numeric_limits<double>::quiet_NaN();
  const Node from = view.observer();
  const Rational eye(view.eye());
  std::optional<Rational> least;
  for (const GroundAt& at : crossings_between(view.ground(), from.col, from.row, node.col, node.row)) {
    const Rational height = eye + (at.height - eye) / at.along;
    if (!least || height > *least) least = height;
  }
  if (!least) return -kInfinity;
  // The smallest double that is not less than it.
  double rounded = least->convert_to<double>();
  while (Rational(rounded) < *least) rounded = std::nextafter(rounded, kInfinity);
  while (Rational(std::nextafter(rounded, -kInfinity)) >= *least) rounded = std::nextafter(rounded, -kInfinity);
  return rounded;
}

Shade judge_shade(const SightGround& ground, const SunRay& sun, Node node) {
  const auto height = ground.height(node);
  if (!height) return Shade::hole;
  const Rational start[2] = {Rational(node.col), Rational(node.row)};
  const Rational direction[2] = {Rational(sun.col), Rational(sun.row)};
  const auto crossings = all_crossings(ground, start, direction);
  const auto blocks = [&](const GroundAt& at) { return at.height > Rational(*height) + at.along * Rational(sun.rise); };
  if (std::none_of(crossings.begin(), crossings.end(), blocks)) return Shade::lit;
  // The first grid line is one cell away along the larger axis, whether or not there is ground.
  const Rational nearest = Rational(1) / Rational(SunRay::kUnit);
  for (const GroundAt& at : crossings)
    if (at.along == nearest && blocks(at)) return Shade::self_shaded;
  return Shade::cast_shadow;
}

std::vector<Shade> judge_shadow(const HeightField& field, const SunDirection& sun) {
  const SightGround ground(field);
  const SunRay ray = sun_ray(field, sun);
  std::vector<Shade> codes;
  for (int row = 0; row < field.rows(); ++row)
    for (int col = 0; col < field.cols(); ++col) codes.push_back(judge_shade(ground, ray, {col, row}));
  return codes;
}

}  // namespace scarp::test
