// SPDX-License-Identifier: MIT
#include "scarp/analysis/sight_edges.h"

#include <cstdlib>

namespace scarp {

CrossingTerms SightEdges::edge_terms(const HorizonLine& edge, HorizonSample sample) const {
  const std::int64_t x = frame_.x(sample.ring), y = frame_.y(sample.side);
  CrossingTerms terms{};
  terms.e = view_.eye();
  terms.g0 = lowered(edge.from);
  terms.g1 = lowered(edge.to);
  std::int64_t w1, steps, length;
  if (edge.from.ring == edge.to.ring) {
    // Along a ring: crossed after `steps` rings.
    steps = frame_.x(edge.from.ring);
    length = x;
    w1 = y * steps - frame_.y(edge.from.side) * length;
  } else {
    // A spoke from the outer sample to the inner one: crossed after `steps` sides.
    steps = std::abs(frame_.y(edge.from.side));
    length = std::abs(y);
    w1 = frame_.x(edge.from.ring) * length - x * steps;
  }
  terms.w0 = static_cast<double>(length - w1);
  terms.w1 = static_cast<double>(w1);
  terms.v0 = static_cast<double>(length - steps);
  terms.v1 = static_cast<double>(steps);
  return terms;
}

CrossingTerms SightEdges::sample_terms(HorizonSample before, HorizonSample sample) const {
  const int steps = frame_.x(before.ring), length = frame_.x(sample.ring);
  CrossingTerms terms{};
  terms.e = view_.eye();
  terms.g0 = lowered(before);
  terms.w0 = length;
  terms.v0 = length - steps;
  terms.v1 = steps;
  return terms;
}

}  // namespace scarp
