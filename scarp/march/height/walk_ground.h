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

template <class T, bool UpsideDown>
class WalkGround {
 public:
  WalkGround(const HeightField& field, const MaxPyramid& pyramid, const SampleGrid<T>& grid)
      : field_(field),
        grid_(grid),
        code_(pyramid.code()),
        blocks_(pyramid.blocks()),
        minima_(pyramid.minima()),
        base_(UpsideDown ? -(code_.base + code_.step * kHighestCode) : code_.base) {}

  bool is_hole(int col, int row) const { return grid_.is_hole(col, row); }
  CellHeights cell(int col, int row) const {
    const CellHeights h = grid_.cell(col, row);
    if constexpr (UpsideDown) return {-h.h00, -h.h10, -h.h01, -h.h11};
    return h;
  }
  double highest() const { return UpsideDown ? -field_.min_sample() : field_.max_sample(); }
  double lowest() const { return UpsideDown ? -field_.max_sample() : field_.min_sample(); }
  /// Height in metres of the field itself.
  double metres(double height) const { return field_.height_from_sample(UpsideDown ? -height : height); }

  /// Codes of a block's bounds; minima are kNoMinimum for blocks with a hole.
  std::uint16_t maximum(std::ptrdiff_t entry) const { return UpsideDown ? other(minima_[entry]) : highest_in(entry); }
  std::uint16_t minimum(std::ptrdiff_t entry) const {
    if constexpr (UpsideDown) {
      return minima_[entry] == MaxPyramid::kNoMinimum ? MaxPyramid::kNoMinimum : other(highest_in(entry));
    }
    return minima_[entry];
  }
  /// Height of a code in sample units, exactly the expression by which it was rounded outwards.
  double height(std::uint16_t code) const { return UpsideDown ? -code_.height(other(code)) : code_.height(code); }
  /// Height of code 0, to two roundings, and codes per sample unit.
  double base() const { return base_; }
  double per_step() const { return code_.per_step; }
  /// Rounding of a height when converted to a code: 6 times 2^-53, inverted 2 more for the base of codes; see
  /// numerics.md.
  static constexpr double kRoundingOfCode = (UpsideDown ? 12 : 8) * 0x1p-53;

 private:
  static constexpr int kHighestCode = 65535;
  std::uint16_t highest_in(std::ptrdiff_t entry) const { return static_cast<std::uint16_t>(blocks_[entry]); }
  static std::uint16_t other(std::uint16_t code) { return static_cast<std::uint16_t>(kHighestCode - code); }

  const HeightField& field_;
  const SampleGrid<T>& grid_;
  HeightCode code_;
  const std::uint32_t* blocks_;
  const std::uint16_t* minima_;
  double base_;
};

}  // namespace scarp::max_mip
