// SPDX-License-Identifier: MIT
#include "scarp/analysis/sun_edges.h"

#include <cstdlib>

namespace scarp {

SweepDirection SweptSun::direction(const SunRay& ray) {
  if (std::abs(ray.col) >= std::abs(ray.row)) return ray.col > 0 ? SweepDirection::west : SweepDirection::east;
  return ray.row > 0 ? SweepDirection::north : SweepDirection::south;
}

// One step before the first ring.
Node SweptSun::origin(const HeightField& field, const SunRay& ray) {
  switch (direction(ray)) {
    case SweepDirection::west:
      return {field.cols(), 0};
    case SweepDirection::east:
      return {-1, 0};
    case SweepDirection::north:
      return {0, field.rows()};
    case SweepDirection::south:
      break;
  }
  return {0, -1};
}

int SunEdges::edge_above(const HorizonLine& edge, HorizonSample sample) const {
  const RingFrame& frame = sun_.frame;
  const std::int64_t x = frame.x(sample.ring), y = frame.y(sample.side);
  const std::int64_t edge_x = frame.x(edge.from.ring), edge_y = frame.y(edge.from.side);
  CrossingTerms terms{};
  std::int64_t w1, steps, length;
  if (edge.from.ring == edge.to.ring) {
    // Along a ring: crossed after `steps` rings.
    length = SunRay::kUnit;
    steps = x - edge_x;
    w1 = (y - edge_y) * length + sun_.across * steps;
  } else {
    // A spoke from the outer sample to the inner one: crossed after `steps` sides.
    length = std::abs(sun_.across);
    steps = sun_.across > 0 ? edge_y - y : y - edge_y;
    w1 = (edge_x - x) * length + SunRay::kUnit * steps;
  }
  terms.g0 = height(edge.from);
  terms.w0 = static_cast<double>(length - w1);
  terms.g1 = height(edge.to);
  terms.w1 = static_cast<double>(w1);
  terms.e = height(sample);
  terms.v0 = static_cast<double>(length);
  terms.r = sun_.rise;
  terms.v1 = static_cast<double>(steps);
  return sign_of(terms);
}

bool SunEdges::sample_above(HorizonSample sample, HorizonSample other) const {
  CrossingTerms terms{};
  terms.g0 = height(sample);
  terms.w0 = static_cast<double>(SunRay::kUnit);
  terms.e = height(other);
  terms.v0 = static_cast<double>(SunRay::kUnit);
  terms.r = sun_.rise;
  terms.v1 = sun_.frame.x(other.ring) - sun_.frame.x(sample.ring);
  return sign_of(terms) > 0;
}

}  // namespace scarp
