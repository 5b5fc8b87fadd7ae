// SPDX-License-Identifier: MIT
// The definition of horizons: which crossings of a line of sight with the grid count, and the slope to each of them.
//
// All nodes of a field share the crossings of one azimuth: seen from a node, the k-th crossing is the same number of
// columns and rows away, with the same weight between its two samples. One table per azimuth serves all nodes.
//
//     azimuth with the larger step along the columns (the major axis), m rows per column:
//
//     node o---+---+---+---+         major crossing k: column line k, at row k m, between two rows
//          |  ..x  |   |   |         minor crossing q: row line q, at column q / m, between two columns;
//          +---+--.x---x---+                           one at a node is the major crossing there
//          |   |   | x'.   |
//          +---+---+---+--.x         x  crossing: its ground is linear between the two samples of that side
//
// Slope to a crossing, in floats, each line one rounding:
//
//   ground  = fma(w, second - first, first - z)       z: the node's height plus the eye's; heights are floats, metres
//   slope   = fma(ground, 1 / D, -drop)               D: horizontal distance; drop = (D^2 + w (1 - w) side^2) c / D
//
// where c is SightCurvature::per_square_metre() and side the length between the two samples: both are lowered before
// the ground between them is taken, as for lines of sight (sight.h). The horizon of a node is the largest slope over
// all crossings whose samples exist; of equal ones, the nearest counts. It is a maximum over a fixed set by one
// expression: it depends on no order, vector width, tile or thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "scarp/analysis/sight.h"

namespace scarp {

/// A component of a direction this small, relative to the other, is the rounding of the angle.
inline constexpr double kNoDirection = 0x1p-40;

/// One crossing, relative to a node. Offsets count columns and rows.
struct HorizonCrossing {
  std::int32_t col, row;                ///< of the first sample
  std::int32_t second_col, second_row;  ///< from the first sample to the second; 0, 0 at a node
  float w;                              ///< weight of the second sample, 0 <= w < 1
  float per_distance;                   ///< 1 / D in 1/m
  float drop;                           ///< slope that curvature takes away
  double steps;                         ///< cells along the major axis
};

/// The crossings of one azimuth, outwards, as far as a field reaches.
class HorizonCrossings {
 public:
  /// `azimuth`: radians clockwise from grid north, finite. `reach`: horizontal metres up to which ground counts, > 0.
  /// Directions within kNoDirection of an axis or, in cells, of a diagonal are exactly that; crossings within rounding
  /// of a node are the node. `cells`: lengths in metres, if not those of the field.
  HorizonCrossings(const HeightField& field, double azimuth, double reach, const SightCurvature& curvature,
                   const std::optional<dvec2>& cells = {});

  const std::vector<HorizonCrossing>& all() const { return all_; }
  /// Whether the major axis is that of the columns; else that of the rows.
  bool along_columns() const { return along_columns_; }
  /// Whether the line goes towards higher columns, and towards higher rows (1), or lower (-1).
  int col_sign() const { return col_sign_; }
  int row_sign() const { return row_sign_; }
  /// Minor cells per major cell, 0 to 1.
  double tilt() const { return tilt_; }
  /// Length of one major step in metres.
  double step() const { return step_; }
  /// SightCurvature::per_square_metre().
  double curvature() const { return curvature_; }
  /// Number of crossings up to that many steps along the major axis, and up to that many lines of the minor axis.
  std::size_t count_to_major(int steps) const { return counted(major_, steps); }
  std::size_t count_to_minor(int lines) const { return counted(minor_, lines); }
  /// Whether some node of the field has a major crossing at this number of steps.
  bool has_major(int steps) const { return steps > 0 && static_cast<std::size_t>(steps) < major_.size(); }

 private:
  std::size_t counted(const std::vector<std::uint32_t>& counts, int lines) const {
    const auto at = static_cast<std::size_t>(lines);
    return at < counts.size() ? counts[at] : all_.size();
  }

  bool along_columns_;
  int col_sign_, row_sign_;
  double tilt_, step_, curvature_;
  std::vector<HorizonCrossing> all_;
  std::vector<std::uint32_t> major_, minor_;
};

}  // namespace scarp
