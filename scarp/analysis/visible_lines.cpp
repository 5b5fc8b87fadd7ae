// SPDX-License-Identifier: MIT
#include "scarp/analysis/visible_lines.h"

#include <cmath>
#include <cstdint>
#include <limits>

#include "scarp/analysis/sight_crossings.h"
#include "scarp/analysis/sight_pieces.h"
#include "scarp/base/parallel.h"
#include "scarp/field/sample_grid.h"

namespace scarp {
namespace {

constexpr double kMachineEpsilon = std::numeric_limits<double>::epsilon();

// The crossings of a line with the grid lines of one axis, in doubles. Grid lines are exact.
struct AxisCrossings {
  int first, last;  // grid lines strictly between the ends
  double start;     // cells along the axis
  double per_line;  // fraction of the line per grid line
  double across;    // cells at the start, along the other axis
  double slope;     // cells of the other axis per grid line
};

AxisCrossings axis_crossings(double from, double to, double across, double to_across) {
  AxisCrossings axis{};
  axis.first = static_cast<int>(std::floor(std::min(from, to))) + 1;
  axis.last = static_cast<int>(std::ceil(std::max(from, to))) - 1;
  axis.start = from;
  axis.per_line = 1 / (to - from);
  axis.across = across;
  axis.slope = (to_across - across) * axis.per_line;
  return axis;
}

// One line over samples of one type.
template <class T>
class VisibleLine {
 public:
  VisibleLine(const SampleGrid<T>& grid, const SightLine& line, const BlockMaxima& maxima)
      : grid_(grid), line_(line), pieces_(line, maxima), field_(line.ground().field()) {
    const SightEnd &from = line.from(), &to = line.to();
    axes_[0] = axis_crossings(from.col, to.col, from.row, to.row);
    axes_[1] = axis_crossings(from.row, to.row, from.col, to.col);
    // A position has two roundings of numbers smaller than the field's sides, and a factor with two more.
    place_error_ = 4 * kMachineEpsilon * std::max(grid.cols, grid.rows);
    // Each of at most eight operations has an error of half a unit of terms no larger than these.
    ends_error_ = 8 * kMachineEpsilon * (std::abs(line.eye()) + std::abs(line.target()));
  }

  bool is_visible() {
    // Tests the middles of pieces first: most lines are blocked, and most of these in several places.
    near_.clear();
    if (!look(0, pieces_.length(), BlockMaxima::kCoarse)) return false;
    for (const SightBox& box : near_)
      if (!passes(0, box.low[0], box.high[0]) || !passes(1, box.low[1], box.high[1])) return false;
    return true;
  }

 private:
  // Collects the pieces of [begin, end) that ground may block. Returns false if it certainly blocks one.
  bool look(double begin, double end, int side) {
    for (double at = begin; at < end; at += side) {
      const double to = std::min(at + side, end);
      const SightBox box = pieces_.box(at, to);
      if (pieces_.clearance(box, at, to, side) >= 0) continue;
      if (side == BlockMaxima::kCoarse) {
        if (!look(at, to, BlockMaxima::kSide)) return false;
      } else {
        const int axis = box.high[0] - box.low[0] >= box.high[1] - box.low[1] ? 0 : 1;
        const int middle = (box.low[axis] + box.high[axis]) / 2;
        if (!passes(axis, middle, middle)) return false;
        near_.push_back(box);
      }
    }
    return true;
  }

  bool passes(int axis, int low, int high) const {
    const AxisCrossings& lines = axes_[axis];
    for (int k = std::max(low, lines.first); k <= std::min(high, lines.last); ++k) {
      const double steps = k - lines.start, place = lines.across + lines.slope * steps;
      const double below = std::floor(place), part = place - below;
      // Next to a node, it is uncertain which samples count.
      if (part < place_error_ || part > 1 - place_error_) {
        if (blocks(axis, k)) return false;
        continue;
      }
      const int j = static_cast<int>(below);
      const T first = axis == 0 ? grid_.at(k, j) : grid_.at(j, k);
      const T second = axis == 0 ? grid_.at(k, j + 1) : grid_.at(j + 1, k);
      if (grid_.is_nodata(first) || grid_.is_nodata(second)) continue;
      const double g0 = lowered(first, axis, k, j), g1 = lowered(second, axis, k, j + 1);
      const double ray = line_.eye() + steps * lines.per_line * (line_.target() - line_.eye());
      const double over = g0 + part * (g1 - g0) - ray;
      const double error =
          ends_error_ + 8 * kMachineEpsilon * (std::abs(g0) + std::abs(g1)) + place_error_ * std::abs(g1 - g0);
      if (over > error || (over >= -error && blocks(axis, k))) return false;
    }
    return true;
  }
  double lowered(T sample, int axis, int k, int j) const {
    const double height = field_.height_from_sample(static_cast<double>(sample));
    return axis == 0 ? line_.ground().lowered(height, k, j) : line_.ground().lowered(height, j, k);
  }
  // Decides exactly.
  bool blocks(int axis, int k) const {
    bool blocked = false;
    visit_sight(line_, axis,
                [&](const SightCrossing& at) {
                  blocked = sign_of(at.terms) > 0;
                  return true;
                },
                {k, k});
    return blocked;
  }

  const SampleGrid<T>& grid_;
  const SightLine& line_;
  SightPieces pieces_;
  const HeightField& field_;
  AxisCrossings axes_[2];
  double place_error_ = 0, ends_error_ = 0;
  std::vector<SightBox> near_;
};

}  // namespace

std::vector<char> visible_lines(const HeightField& field, std::span<const LineEnds> lines, const BlockMaxima& maxima,
                                const SightCurvature& curvature, const Progress& progress) {
  constexpr std::int64_t kGrain = 256;
  std::vector<char> visible(lines.size());
  field.visit([&]<class T>(const SampleGrid<T>& grid) {
    parallel_for(
        static_cast<std::int64_t>(lines.size()), kGrain,
        [&](std::int64_t begin, std::int64_t end) {
          for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
            const SightLine line(field, lines[i].from, lines[i].to, curvature);
            visible[i] = VisibleLine<T>(grid, line, maxima).is_visible();
          }
        },
        progress);
  });
  return visible;
}

}  // namespace scarp
