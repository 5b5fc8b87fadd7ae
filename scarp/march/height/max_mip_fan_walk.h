// SPDX-License-Identifier: MIT
// Between max_mip_fan.cpp and the vector code of max_mip_fan_simd.cpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "scarp/march/height/grid_axis.h"
#include "scarp/march/height/max_mip_fan.h"

namespace scarp::max_mip {

/// Lines between the hits of two rays of a column beyond which a batch answers them faster, over wrapped ground.
/// Measured (doc/dev/decisions/march.md).
constexpr float kFarthestGap = 128;

/// A ray that floats do not decide, by its place in the arrays. It is above the ground up to t_clear, or kNotClear.
struct FanRest {
  std::ptrdiff_t ray;
  double t_clear;
};

/// Whether vectors walk over the field and from the origin: otherwise all rays go to the batch.
bool walks_fan(const HeightTarget& target, const Fan& fan);

/// Returns the share of the rays of a fan, 0 to 1, that a walk is likely to answer in less time than a batch.
/// Requires walks_fan().
double share_to_walk(const HeightTarget& target, const Fan& fan);

/// Whether a cell or a neighbour of it is so. Neighbours over a seam are those in the next copy.
template <class Is>
bool any_cell_beside(const HeightField& field, const Cell& at, const Is& is) {
  // The number of a cell in the field; negative: there is none.
  const auto within = [&](int number, int cells) {
    if (number >= 0 && number < cells) return number;
    return field.wraps() ? in_first_copy(number, cells) : -1;
  };
  for (int r = at.row - 1; r <= at.row + 1; ++r) {
    const int row = within(r, field.cell_rows());
    if (row < 0) continue;
    for (int c = at.col - 1; c <= at.col + 1; ++c) {
      const int col = within(c, field.cell_cols());
      if (col >= 0 && is(Cell{col, row})) return true;
    }
  }
  return false;
}

/// The place of a ray in the arrays of a fan.
inline std::ptrdiff_t place_of(const Fan& fan, int column, int row) {
  return row * fan.row_stride + column / kFanStrip * fan.strip_stride + column % kFanStrip;
}

/// Answers the rays of columns [begin, end) but for those that it appends to `rest`.
void walk_fan(const HeightTarget& target, const Fan& fan, const FanHits& hits, int begin, int end,
              const FanOptions& options, std::vector<FanRest>& rest, FanStats& stats);

/// Time up to which a ray is above the ground.
inline double clear_time(const HeightField& field, const Ray& ray, const FanSight& sight) {
  const HeightField::GridScales scales = field.grid_scales();
  return std::abs(static_cast<double>(sight.clear)) /
         std::max(std::abs(ray.direction.x) * scales.per_cell_x, std::abs(ray.direction.y) * scales.per_cell_y);
}

/// Sets the hits of the rays whose cells are known.
void answer_seen(const HeightTarget& target, std::span<const Ray> rays, std::span<const FanSight> sights,
                 std::span<Hit> hits);

/// Sets the sights of these rays.
void look_fan(const HeightTarget& target, const Fan& fan, FanSight* sights, int begin, int end,
              const FanOptions& options, FanStats& stats);

}  // namespace scarp::max_mip
