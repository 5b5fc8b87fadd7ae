// SPDX-License-Identifier: MIT
// The rings of one sector around an observer, and exact comparisons of their edges with lines of sight.
#pragma once

#include <cstdint>

#include "scarp/analysis/crossing_sign.h"
#include "scarp/analysis/horizon_envelope.h"
#include "scarp/analysis/viewshed.h"

namespace scarp {

enum class SectorDirection : std::uint8_t { east, west, south, north };

/// A sector seen along its main axis. Rings are lines of constant `ring` (a column in the sectors to the east and west,
/// else a row); `side` counts along them. x and y are relative to the observer, x outwards.
class SectorFrame {
 public:
  SectorFrame(const HeightField& field, Node observer, SectorDirection direction)
      : along_cols_(direction == SectorDirection::east || direction == SectorDirection::west),
        sign_(direction == SectorDirection::east || direction == SectorDirection::south ? 1 : -1),
        rings_(along_cols_ ? field.cols() : field.rows()),
        sides_(along_cols_ ? field.rows() : field.cols()),
        ring_from_(along_cols_ ? observer.col : observer.row),
        side_from_(along_cols_ ? observer.row : observer.col) {}

  bool along_cols() const { return along_cols_; }
  int sign() const { return sign_; }  ///< of a step outwards, in rings
  int rings() const { return rings_; }
  int sides() const { return sides_; }
  int x(int ring) const { return sign_ * (ring - ring_from_); }
  int y(int side) const { return side - side_from_; }
  int ring(int x) const { return ring_from_ + sign_ * x; }
  int side(int y) const { return side_from_ + y; }
  Node node(int ring, int side) const { return along_cols_ ? Node{ring, side} : Node{side, ring}; }
  Node node(HorizonSample s) const { return node(s.ring, s.side); }
  /// Position on the horizon. Correctly rounded, and exact in order and ties: two different quotients of integers
  /// below 2^20 differ by more than 2^-40.
  double u(HorizonSample s) const { return static_cast<double>(y(s.side)) / x(s.ring); }

 private:
  bool along_cols_;
  int sign_, rings_, sides_, ring_from_, side_from_;
};

class SightEdges : public HorizonJudge {
 public:
  SightEdges(const Viewpoint& view, const SectorFrame& frame) : view_(view), frame_(frame) {}

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
  double position(HorizonSample sample) const override { return frame_.u(sample); }

  /// The terms of an edge against the line of sight to a sample, but for the sample's height `r`. The sample is at u
  /// within the edge.
  CrossingTerms edge_terms(const HorizonLine& edge, HorizonSample sample) const;
  /// The terms of a sample that lies on the line of sight to another.
  CrossingTerms sample_terms(HorizonSample before, HorizonSample sample) const;
  /// Lowered height of a sample that is not a hole.
  double lowered(HorizonSample sample) const { return *view_.ground().lowered(frame_.node(sample)); }

 private:
  const Viewpoint& view_;
  const SectorFrame& frame_;
};

}  // namespace scarp
