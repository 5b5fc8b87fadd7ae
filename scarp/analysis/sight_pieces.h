// SPDX-License-Identifier: MIT
// A line of sight cut into pieces as long as a block of maxima: most pieces are above all ground beside them.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "scarp/analysis/block_maxima.h"
#include "scarp/analysis/crossing_sign.h"
#include "scarp/analysis/line_of_sight.h"
#include "scarp/analysis/sight_line.h"

namespace scarp {

/// The range of nodes next to a piece of a line, which is also that of the grid lines that it may cross. Ends included.
struct SightBox {
  int low[2], high[2];  ///< columns, rows
};

class SightPieces {
 public:
  /// `line` and `maxima` must outlive the pieces.
  SightPieces(const SightLine& line, const BlockMaxima& maxima) : line_(line), maxima_(maxima) {
    length_ = std::max(std::abs(line.to().col - line.from().col), std::abs(line.to().row - line.from().row));
    diagonal_ = std::hypot(line.ground().cells().x, line.ground().cells().y);
    largest_ = std::abs(line.eye()) + std::abs(line.target());
  }

  /// Length in cells along the axis in which the line is longer. Positions of pieces are measured along that axis.
  double length() const { return length_; }

  SightBox box(double begin, double end) const {
    constexpr double kRounding = 1e-6;  // cells; positions are below 2^20, rounded to 2^-32
    const int sides[2] = {line_.ground().field().cols(), line_.ground().field().rows()};
    SightBox box{};
    for (int axis = 0; axis < 2; ++axis) {
      const auto place = [&](double cells) {
        const double along = cells / length_;
        return axis == 0 ? line_.col(along) : line_.row(along);
      };
      const double a = place(begin), b = place(end);
      box.low[axis] = std::max(static_cast<int>(std::floor(std::min(a, b) - kRounding)), 0);
      box.high[axis] = std::min(static_cast<int>(std::ceil(std::max(a, b) + kRounding)), sides[axis] - 1);
    }
    return box;
  }

  /// Returns a lower bound of the height of the line above the ground in a piece, by blocks of `side` samples.
  double clearance(const SightBox& box, double begin, double end, int side) const {
    const double top = maxima_.highest(side, box.low[0], box.low[1], box.high[0], box.high[1]);
    if (top == -std::numeric_limits<double>::infinity()) return std::numeric_limits<double>::infinity();
    const double near = begin / length_, far = end / length_;
    const auto ray = [&](double along) { return line_.eye() + along * (line_.target() - line_.eye()); };
    // The nodes of a side that the line crosses are at most a diagonal nearer to the eye than the crossing.
    const double reach = std::max(near * line_.distance() - diagonal_, 0.0);
    const double drop = line_.ground().drop_at(reach * reach);
    const double rounding = 16 * kSumRounding * (largest_ + std::abs(top) + drop);
    return std::min(ray(near), ray(far)) - (top - drop) - rounding;
  }

 private:
  const SightLine& line_;
  const BlockMaxima& maxima_;
  double length_ = 0, diagonal_ = 0, largest_ = 0;
};

}  // namespace scarp
