// SPDX-License-Identifier: MIT
#include "scarp/analysis/sight_parts.h"

#include <algorithm>
#include <cmath>

#include "scarp/analysis/sight_crossings.h"

namespace scarp {
namespace {

SightEnd moved(SightEnd end, const NodeRect& part) {
  end.col -= part.col_begin;
  end.row -= part.row_begin;
  return end;
}

// The nearest obstruction and the least clearance of both; ties as if the crossings of `later` were added to `result`.
void add(LineOfSight& result, const LineOfSight& later) {
  if (later.clearance < result.clearance) {
    result.clearance = later.clearance;
    result.clearance_along = later.clearance_along;
  }
  if (!later.visible && (result.visible || later.obstruction->along < result.obstruction->along)) {
    result.visible = false;
    result.obstruction = later.obstruction;
  }
}

}  // namespace

NodeRect SightParts::nodes_between(double col, double row, double other_col, double other_row, double beside) const {
  const auto low = [&](double a, double b) {
    return std::max(static_cast<int>(std::floor(std::min(a, b)) - beside), 0);
  };
  const auto end = [&](double a, double b, int nodes) {
    return std::min(static_cast<int>(std::ceil(std::max(a, b)) + beside) + 1, nodes);
  };
  return {low(col, other_col), low(row, other_row), end(col, other_col, cols_), end(row, other_row, rows_)};
}

NodeRect SightParts::around(const SightEnd& end) const {
  const double col = rounded_end(end.col), row = rounded_end(end.row);
  return nodes_between(col, row, col, row, 0);
}

std::vector<NodeRect> SightParts::along(const SightEnd& from, const SightEnd& to) const {
  const double cols = to.col - from.col, rows = to.row - from.row, length = std::max(std::abs(cols), std::abs(rows));
  std::vector<NodeRect> parts;
  for (double at = 0; at < length; at += side_) {
    const double begin = at / length, end = std::min(at + side_, length) / length;
    // Positions are rounded by less than a cell.
    parts.push_back(nodes_between(from.col + begin * cols, from.row + begin * rows, from.col + end * cols,
                                  from.row + end * rows, 1));
  }
  return parts;
}

SightAnswer SightParts::answer(const SightEnd& typed_from, const SightEnd& typed_to, const SightCurvature& curvature,
                               std::optional<double> wavelength, const Read& read) const {
  const SightEnd from = SightLine::checked(cols_, rows_, typed_from, "observer"),
                 to = SightLine::checked(cols_, rows_, typed_to, "target");
  const auto over = [&](const HeightField& part, const NodeRect& nodes) {
    const SightEnd here = moved(from, nodes);
    return SightLine(here, moved(to, nodes), SightGround(part, here.col, here.row, curvature));
  };
  const NodeRect near = around(from), far = around(to);
  const HeightField at_from = read(near);
  SightLine whole = over(at_from, near);
  whole.stand_observer(whole.from_, whole.ground_);
  const HeightField at_to = read(far);
  whole.stand_target(moved(to, far), over(at_to, far).ground_);

  SightAnswer answers[2];  // of column and row lines
  for (const NodeRect& nodes : along(from, to)) {
    const HeightField part = read(nodes);
    SightLine line = over(part, nodes);
    line.eye_ = whole.eye_, line.target_ = whole.target_, line.distance_ = whole.distance_;
    for (int axis = 0; axis < 2; ++axis) {
      visit_sight(line, axis, [&](const SightCrossing& at) {
        at.add_to(answers[axis].line, line);
        if (wavelength) at.add_to(answers[axis].fresnel, line, *wavelength);
        return true;
      });
    }
  }
  SightAnswer answer = answers[0];
  add(answer.line, answers[1].line);
  if (answers[1].fresnel.share < answer.fresnel.share) answer.fresnel = answers[1].fresnel;
  if (auto& block = answer.line.obstruction) {
    block->col = from.col + block->along * (to.col - from.col);
    block->row = from.row + block->along * (to.row - from.row);
  }
  answer.line.distance = whole.distance();
  answer.line.eye = whole.eye();
  answer.line.target = whole.target() + whole.ground().drop(whole.to().col, whole.to().row);
  return answer;
}

}  // namespace scarp
