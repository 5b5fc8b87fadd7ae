// SPDX-License-Identifier: MIT
#include "scarp/analysis/sight_rays.h"

#include <algorithm>
#include <limits>

#include "scarp/analysis/crossing_sign.h"
#include "scarp/analysis/sight_line.h"

namespace scarp {
namespace {

GridLine between(Node from, Node to) { return {from.col, from.row, to.col - from.col, to.row - from.row, 1}; }

// The terms of the ground at a crossing; nullopt if it does not count.
std::optional<CrossingTerms> ground_terms(const SightGround& ground, const Crossing& at) {
  const auto first = ground.lowered(at.first);
  if (!first) return std::nullopt;
  const auto second = at.w1 > 0 ? ground.lowered(at.second) : first;
  if (!second) return std::nullopt;
  return CrossingTerms{*first, static_cast<double>(at.w0), *second, static_cast<double>(at.w1), 0, 0, 0, 0};
}

}  // namespace

bool sees(const SightGround& ground, Node observer, double eye, Node node, double target) {
  const GridLine line = between(observer, node);
  const auto clears = [&](const Crossing& at) {
    auto terms = ground_terms(ground, at);
    if (!terms) return true;
    terms->e = eye;
    terms->v0 = static_cast<double>(at.length - at.steps);
    terms->r = target;
    terms->v1 = static_cast<double>(at.steps);
    return sign_of(*terms) <= 0;
  };
  const HeightField& field = ground.field();
  return visit_crossings(line, 0, field.cols(), field.rows(), true, clears) &&
         visit_crossings(line, 1, field.cols(), field.rows(), true, clears);
}

double least_visible(const SightGround& ground, Node observer, double eye, Node node) {
  double least = -std::numeric_limits<double>::infinity();
  const GridLine line = between(observer, node);
  const auto raise = [&](const Crossing& at) {
    auto terms = ground_terms(ground, at);
    if (!terms) return true;
    terms->e = eye;
    terms->v0 = static_cast<double>(at.length - at.steps);
    terms->r = least;
    terms->v1 = static_cast<double>(at.steps);
    if (least == -std::numeric_limits<double>::infinity() || sign_of(*terms) > 0) least = least_clearing(*terms);
    return true;
  };
  const HeightField& field = ground.field();
  for (int axis = 0; axis < 2; ++axis) visit_crossings(line, axis, field.cols(), field.rows(), true, raise);
  return least;
}

Shade shade(const SightGround& ground, const SunRay& sun, Node node) {
  const auto height = ground.height(node);
  if (!height) return Shade::hole;
  const HeightField& field = ground.field();
  const GridLine line{node.col, node.row, sun.col, sun.row, 1};
  const double highest = field.max_height();
  bool blocked = false, at_first = true;
  const auto clears = [&](const Crossing& at) {
    const double w = static_cast<double>(at.length), steps = static_cast<double>(at.steps);
    if (auto terms = ground_terms(ground, at)) {
      terms->e = *height;
      terms->v0 = w;
      terms->r = sun.rise;
      terms->v1 = steps;
      blocked = sign_of(*terms) > 0;
    }
    if (blocked) return false;
    at_first = false;
    // The ray rises: once above all ground it is free.
    return sign_of({highest, w, 0, 0, *height, w, sun.rise, steps}) > 0;
  };
  // The first grid line crossed is always one of the larger axis.
  const int larger = std::abs(sun.col) >= std::abs(sun.row) ? 0 : 1;
  visit_crossings(line, larger, field.cols(), field.rows(), false, clears);
  if (blocked) return at_first ? Shade::self_shaded : Shade::cast_shadow;
  visit_crossings(line, 1 - larger, field.cols(), field.rows(), false, clears);
  return blocked ? Shade::cast_shadow : Shade::lit;
}

}  // namespace scarp
