// SPDX-License-Identifier: MIT
// The ground that `max-mip` traverses: as it is or, for hits from below, inverted. Inverted heights are multiplied by
// -1, and maxima become minima: a ray that hits from below hits the inverted ground from above, at the same t, so
// everything proven for hits from above holds for hits from below. A block with a hole has no minimum: its inverted
// maximum is that of the highest code.
#pragma once

#include <cstdint>

#include "scarp/accel/max_pyramid.h"
#include "scarp/field/height_field.h"
#include "scarp/field/sample_grid.h"

namespace scarp::max_mip {

/// MayInvert: whether it can be inverted. If not, queries do not pay for the possibility.
template <class T, bool MayInvert>
class WalkGround {
 public:
  WalkGround(const HeightField& field, const MaxPyramid& pyramid, const SampleGrid<T>& grid, bool is_inverted)
      : inverted_(is_inverted),
        field_(field),
        grid_(grid),
        code_(pyramid.code()),
        blocks_(pyramid.blocks()),
        minima_(pyramid.minima()),
        base_(MayInvert && is_inverted ? -(code_.base + code_.step * kHighestCode) : code_.base) {}

  /// Whether it is inverted.
  bool inverted() const { return MayInvert && inverted_; }
  bool is_hole(int col, int row) const { return grid_.is_hole(col, row); }
  [[gnu::always_inline]] CellHeights cell(int col, int row) const {
    const CellHeights h = grid_.cell(col, row);
    if (inverted()) return {-h.h00, -h.h10, -h.h01, -h.h11};
    return h;
  }
  double highest() const { return inverted() ? -field_.min_sample() : field_.max_sample(); }
  double lowest() const { return inverted() ? -field_.max_sample() : field_.min_sample(); }
  /// Height in metres of the field itself.
  double metres(double height) const { return field_.height_from_sample(inverted() ? -height : height); }

  /// Codes of a block's bounds; minima are kNoMinimum for blocks with a hole.
  std::uint16_t maximum(std::ptrdiff_t entry) const { return inverted() ? other(minima_[entry]) : highest_in(entry); }
  std::uint16_t minimum(std::ptrdiff_t entry) const {
    if (inverted()) {
      return minima_[entry] == MaxPyramid::kNoMinimum ? MaxPyramid::kNoMinimum : other(highest_in(entry));
    }
    return minima_[entry];
  }
  /// Height of a code in sample units, exactly the expression by which it was rounded outwards.
  double height(std::uint16_t code) const { return inverted() ? -code_.height(other(code)) : code_.height(code); }
  /// Height of code 0, to two roundings, and codes per sample unit.
  double base() const { return base_; }
  double per_step() const { return code_.per_step; }
  /// Rounding of a height when converted to a code, per magnitude: 6 times 2^-53 (block_rules.h), rounded up to 8.
  /// Inverted, the base is -(base + 65535 step): 2 more, rounded up to 12.
  double rounding_of_code() const { return (inverted() ? 12 : 8) * 0x1p-53; }

 private:
  static constexpr int kHighestCode = 65535;
  std::uint16_t highest_in(std::ptrdiff_t entry) const { return static_cast<std::uint16_t>(blocks_[entry]); }
  static std::uint16_t other(std::uint16_t code) { return static_cast<std::uint16_t>(kHighestCode - code); }

  bool inverted_;
  const HeightField& field_;
  const SampleGrid<T>& grid_;
  HeightCode code_;
  const std::uint32_t* blocks_;
  const std::uint16_t* minima_;
  double base_;
};

}  // namespace scarp::max_mip
