// SPDX-License-Identifier: MIT
// The axes of a sweep over rings of samples.
#pragma once

#include "scarp/analysis/horizon_envelope.h"
#include "scarp/analysis/sight.h"

namespace scarp {

enum class SweepDirection : std::uint8_t { east, west, south, north };

/// A field seen along the direction of a sweep. Rings are lines of constant `ring` (a column for sweeps to the east and
/// west, otherwise a row); `side` counts along them. x and y are relative to an origin, x in the direction of the
/// sweep.
class RingFrame {
 public:
  RingFrame(const HeightField& field, Node origin, SweepDirection direction)
      : along_cols_(direction == SweepDirection::east || direction == SweepDirection::west),
        sign_(direction == SweepDirection::east || direction == SweepDirection::south ? 1 : -1),
        rings_(along_cols_ ? field.cols() : field.rows()),
        sides_(along_cols_ ? field.rows() : field.cols()),
        ring_from_(along_cols_ ? origin.col : origin.row),
        side_from_(along_cols_ ? origin.row : origin.col) {}

  bool along_cols() const { return along_cols_; }
  int sign() const { return sign_; }  ///< direction of the sweep: +1 or -1 ring per step
  int rings() const { return rings_; }
  int sides() const { return sides_; }
  int x(int ring) const { return sign_ * (ring - ring_from_); }
  int y(int side) const { return side - side_from_; }
  int ring(int x) const { return ring_from_ + sign_ * x; }
  int side(int y) const { return side_from_ + y; }
  Node node(int ring, int side) const { return along_cols_ ? Node{ring, side} : Node{side, ring}; }
  Node node(HorizonSample s) const { return node(s.ring, s.side); }

 private:
  bool along_cols_;
  int sign_, rings_, sides_, ring_from_, side_from_;
};

}  // namespace scarp
