// SPDX-License-Identifier: MIT
// Exact comparisons of the edges of a sector around an observer with lines of sight.
#pragma once

#include <cstdint>

#include "scarp/analysis/crossing_sign.h"
#include "scarp/analysis/ring_frame.h"
#include "scarp/analysis/viewshed.h"

namespace scarp {

/// Position of a sample on the horizon of a sector around the observer, the origin of the frame. Correctly rounded, and
/// exact in order and ties: two different quotients of integers below 2^20 differ by more than 2^-40.
inline double sight_u(const RingFrame& frame, HorizonSample s) {
  return static_cast<double>(frame.y(s.side)) / frame.x(s.ring);
}

class SightEdges : public HorizonEdges {
 public:
  SightEdges(const Viewpoint& view, const RingFrame& frame) : view_(view), frame_(frame) {}

  int edge_above(const HorizonLine& edge, HorizonSample sample) const override {
    CrossingTerms terms = edge_terms(edge, sample);
    terms.r = lowered(sample);
    return sign_of(terms);
  }
  int edge_above_target(const HorizonLine& edge, HorizonSample sample) const override {
    CrossingTerms terms = edge_terms(edge, sample);
    terms.r = view_.target(lowered(sample));
    return sign_of(terms);
  }
  double position(HorizonSample sample) const override { return sight_u(frame_, sample); }

  /// The terms of an edge against the line of sight to a sample, without the sample's height `r`. The sample is at u
  /// within the edge.
  CrossingTerms edge_terms(const HorizonLine& edge, HorizonSample sample) const;
  /// The terms of a sample that lies on the line of sight to another.
  CrossingTerms sample_terms(HorizonSample before, HorizonSample sample) const;
  /// Whether a sample is above the line of sight to another sample, or above the continuation of that line.
  bool sample_above(HorizonSample sample, HorizonSample other) const {
    CrossingTerms terms = sample_terms(sample, other);
    terms.r = lowered(other);
    return sign_of(terms) > 0;
  }
  /// Lowered height of a sample that is not a hole.
  double lowered(HorizonSample sample) const { return *view_.ground().lowered(frame_.node(sample)); }

 private:
  const Viewpoint& view_;
  const RingFrame& frame_;
};

}  // namespace scarp
