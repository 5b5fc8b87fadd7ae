// SPDX-License-Identifier: MIT
#include "scarp/analysis/line_of_sight.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scarp/analysis/sight_crossings.h"
#include "scarp/analysis/sight_pieces.h"
#include "scarp/base/error.h"

namespace scarp {
namespace {

// Returns the height of an end in metres above sea; sets `ground` to the ground below it.
double height_of(const SightGround& heights, const SightEnd& end, std::string_view name, double& ground) {
  const auto found = heights.height_at(end.col, end.row);
  ground = found.value_or(std::numeric_limits<double>::quiet_NaN());
  if (!found && end.datum == HeightDatum::ground)
    throw Error(fmt::format("{}: column {:.10g}, row {:.10g} is on nodata (give its height above sea)", name, end.col,
                            end.row));
  const double height = end.datum == HeightDatum::sea ? end.height : *found + end.height;
  if (found && height < *found && !end.under_surface)
    throw Error(fmt::format("{}: height {:.10g} m is below the ground at {:.10g} m", name, height, *found));
  return height;
}

}  // namespace

double rounded_end(double position) {
  constexpr auto kSteps = static_cast<double>(kSubcells);
  return std::round(position * kSteps) / kSteps;
}

SightEnd SightLine::checked(int cols, int rows, SightEnd end, std::string_view name) {
  const double last_col = cols - 1, last_row = rows - 1;
  end.col = rounded_end(end.col);
  end.row = rounded_end(end.row);
  if (!(end.col >= 0 && end.row >= 0 && end.col <= last_col && end.row <= last_row))
    throw Error(fmt::format("{}: column {:.10g}, row {:.10g} is outside the raster (columns 0 to {}, rows 0 to {})",
                            name, end.col, end.row, last_col, last_row));
  if (!std::isfinite(end.height) || (end.datum == HeightDatum::ground && end.height < 0))
    throw Error(fmt::format("{}: height {} m (must be 0 or more above ground)", name, end.height));
  return end;
}

void SightLine::stand_observer(const SightEnd& from, const SightGround& around) {
  eye_ = height_of(around, from, "observer", eye_ground_);
}

void SightLine::stand_target(const SightEnd& to, const SightGround& around) {
  target_ = around.lowered(height_of(around, to, "target", target_ground_), to.col, to.row);
  distance_ = std::sqrt(around.square_distance(to.col, to.row));
}

SightLine::SightLine(const HeightField& field, const SightEnd& from, const SightEnd& to,
                     const SightCurvature& curvature, const std::optional<dvec2>& cells)
    : from_(checked(field.cols(), field.rows(), from, "observer")),
      to_(checked(field.cols(), field.rows(), to, "target")),
      ground_(field, from_.col, from_.row, curvature, cells) {
  stand_observer(from_, ground_);
  stand_target(to_, ground_);
}

namespace {

// Searches for the obstruction and the least clearance, piece by piece, outwards along the line. Pieces are skipped if
// the line passes above all their nodes by more than the least clearance so far: they can neither block the line nor
// reduce the clearance.
class Search {
 public:
  Search(const SightLine& line, const BlockMaxima* maxima) : line_(line) {
    if (maxima) pieces_.emplace(line, *maxima);
  }

  LineOfSight run() {
    result_.distance = line_.distance();
    result_.eye = line_.eye();
    result_.target = line_.target() + line_.ground().drop(line_.to().col, line_.to().row);
    if (!pieces_) {
      for (int axis = 0; axis < 2; ++axis) visit(axis, {});
    } else if (pieces_->length() != 0) {
      search(0, pieces_->length(), BlockMaxima::kCoarse);
    }
    return result_;
  }

 private:
  // The line from `begin` to `end`, in cells along its larger axis.
  void search(double begin, double end, int side) {
    for (double at = begin; at < end; at += side) {
      const double to = std::min(at + side, end);
      const SightBox box = pieces_->box(at, to);
      if (passes(box, at, to, side)) continue;
      if (side == BlockMaxima::kCoarse) {
        search(at, to, BlockMaxima::kSide);
      } else {
        visit(0, {box.low[0], box.high[0]});
        visit(1, {box.low[1], box.high[1]});
      }
    }
  }

  bool passes(const SightBox& box, double at, double to, int side) const {
    // Pieces share grid lines at their ends: the obstruction so far may lie beyond this piece.
    const bool first_is_known = !result_.visible && result_.obstruction->along <= at / pieces_->length();
    return pieces_->clearance(box, at, to, side) >=
           (first_is_known ? result_.clearance : std::max(result_.clearance, 0.0));
  }

  void visit(int axis, const LineRange& range) {
    visit_sight(
        line_, axis,
        [&](const SightCrossing& at) {
          at.add_to(result_, line_);
          return true;
        },
        range);
  }

  const SightLine& line_;
  std::optional<SightPieces> pieces_;
  LineOfSight result_;
};

}  // namespace

LineOfSight line_of_sight(const HeightField& field, const SightEnd& from, const SightEnd& to,
                          const SightCurvature& curvature, const BlockMaxima* maxima,
                          const std::optional<dvec2>& cells) {
  return Search(SightLine(field, from, to, curvature, cells), maxima).run();
}

}  // namespace scarp
