// SPDX-License-Identifier: MIT
// The definition of every map of this station: what blocks a line of sight or a sun ray. Engines and the slow judge
// (test/analysis/slow_judge.h) give the same answer for every cell, to the last bit.
//
//        row line                      o  node: a sample; a map has one pixel per node
//   o-------x------o                   x  crossing of the line of sight with a grid line
//   |     /        |
//   |   /          | column line       Height of the ground at a crossing: linear between the two samples at the ends
//   x/             |                   of that side. There is no ground between crossings.
//   o--------------o
//
// Surface `crossings`
// - A *height* is HeightField::height_from_sample(): metres, a double. Seen from an observer it is *lowered* by
//   curvature and refraction: lowered() below, rounded to double. From here on all arithmetic is exact.
// - A crossing blocks if its ground is strictly above the ray. A ray that grazes the ground passes.
// - Crossings count strictly between the two ends of a line of sight, and strictly after the start of a sun ray. The
//   cells around an end therefore never block by themselves, and neighbouring samples always see one another.
// - Holes: a crossing at a node counts if the node has a sample; any other crossing counts if both ends of its side
//   have one. Rays pass crossings that do not count. The field's outermost lines are grid lines like all others.
//   There is nothing beyond them: a sun ray that leaves the field is not blocked.
//
// Ends
// - Observers and targets of viewsheds are nodes. Ends of single lines of sight are anywhere in the field, rounded to
//   1/kSubcells of a cell. The ground at an end is bilinear between the samples around it: one at a node, two on a grid
//   line, four elsewhere. It is a hole if one of them is missing.
// - The eye is at ground + observer height, or at a height above sea. The target is at lowered ground + target height.
//   Heights above ground are >= 0.
// - It is an error if an end is outside the field or on a hole (unless its height is above sea), or if the eye is below
//   the ground, unless it may be (`under_surface`): then the field is a surface above the ground on which ends stand.
// - Distances are horizontal: sqrt(dx^2 + dy^2) of metres. Limits apply to targets only; ground at any distance blocks.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>

#include "scarp/base/vec.h"
#include "scarp/field/height_field.h"

namespace scarp {

/// Steps per cell to which ends of lines of sight are rounded. Weights of crossings are then integers below 2^53.
inline constexpr std::int64_t kSubcells = 1024;
/// Largest number of columns or rows of a field that this station accepts.
inline constexpr int kMaxSightSide = 1 << 20;

/// A node of a field.
struct Node {
  int col = 0;
  int row = 0;
  friend bool operator==(const Node&, const Node&) = default;
};

/// Reference of a height.
enum class HeightDatum : std::uint8_t { ground, sea };

/// Curvature of the Earth and refraction of light.
struct SightCurvature {
  /// 1 - refraction coefficient, 0..10; 0: flat Earth; 6/7: visible light; 1/k for an effective Earth radius of k times
  /// the true one
  double coefficient = 6.0 / 7;
  double diameter = 2 * 6378137.;  ///< diameter of the body in metres, > 0
  /// Metres by which a point at this squared distance (m^2) appears lower.
  double per_square_metre() const { return coefficient / diameter; }
};

/// Throws Error if a member is out of range.
void validate(const SightCurvature& curvature);

/// The heights of a field's nodes as seen by one observer. `col` and `row` of the observer may lie between nodes. A
/// plain view: the field must outlive it, without edits.
class SightGround {
 public:
  /// `cells`: lengths of a column and a row step in metres, if not those of the field. Throws Error for a wrapped
  /// field, a side above kMaxSightSide, a length or a curvature out of range.
  SightGround(const HeightField& field, double observer_col, double observer_row, const SightCurvature& curvature,
              const std::optional<dvec2>& cells = {});
  /// Without curvature: heights are unchanged.
  explicit SightGround(const HeightField& field);

  const HeightField& field() const { return *field_; }
  /// Lengths of a column and a row step in metres.
  const dvec2& cells() const { return cells_; }

  /// Horizontal distance from the observer to a place, squared, in m^2.
  double square_distance(double col, double row) const {
    const double x = (col - col_) * cells_.x, y = (row - row_) * cells_.y;
    return x * x + y * y;
  }
  /// Metres by which a place appears lower.
  double drop(double col, double row) const { return drop_at(square_distance(col, row)); }
  double drop_at(double square_distance) const { return per_square_metre_ * square_distance; }
  /// Returns the lowered height of a place whose height is known.
  double lowered(double height, double col, double row) const { return height - drop(col, row); }

  /// Returns the height of a node in metres, or nullopt on a hole. The node must exist.
  std::optional<double> height(Node node) const {
    const std::ptrdiff_t at = node.row * row_stride_ + node.col;
    double sample = 0;
    switch (type_) {
      case SampleType::int16:
        sample = static_cast<const std::int16_t*>(samples_)[at];
        break;
      case SampleType::uint16:
        sample = static_cast<const std::uint16_t*>(samples_)[at];
        break;
      case SampleType::float32:
        sample = static_cast<double>(static_cast<const float*>(samples_)[at]);
        break;
    }
    if (has_holes_ && (sample == nodata_ || std::isnan(sample))) return std::nullopt;
    return field_->height_from_sample(sample);
  }
  /// Returns the lowered height of a node, or nullopt on a hole. The node must exist.
  std::optional<double> lowered(Node node) const {
    const auto h = height(node);
    return h ? std::optional(lowered(*h, node.col, node.row)) : std::nullopt;
  }
  /// Returns the bilinear height at a place, or nullopt outside and on holes.
  std::optional<double> height_at(double col, double row) const;

 private:
  const HeightField* field_;
  dvec2 cells_;
  double col_ = 0, row_ = 0;
  double per_square_metre_ = 0;
  // Copies from the field: lines of sight read too few samples for HeightField::visit() to pay off.
  const void* samples_ = nullptr;
  std::ptrdiff_t row_stride_ = 0;
  SampleType type_ = SampleType::float32;
  bool has_holes_ = false;
  double nodata_ = 0;
};

/// Compass azimuth from one place to another relative to grid north, in radians, 0..2pi; 0 if both are the same. `east`
/// and `north` in metres.
inline double compass_azimuth(double east, double north) {
  const double azimuth = std::atan2(east, north);
  return azimuth < 0 ? azimuth + 2 * std::numbers::pi : azimuth;
}

}  // namespace scarp
