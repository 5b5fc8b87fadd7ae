// SPDX-License-Identifier: MIT
#include "march/height/easy_judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scarp/march/ray_clip.h"

namespace scarp::test {
namespace {

// The factors of numerics.md: sideways per cell, vertically per unit of height.
constexpr double kSideways = 0x1p-21, kVertically = 0x1p-20;
// The judge's own rounding, in doubles, and that of clipping the ray.
constexpr double kDoubles = 32 * 0x1p-53;
// Number of roundings of a time.
constexpr double kTimes = 8 * 0x1p-24;

}  // namespace

EasyJudge::EasyJudge(const HeightField& field, const GridRay& ray, double t_max, bool clipped)
    : field_(field), ray_(ray), cells_{field.cell_cols(), field.cell_rows()}, t_max_(t_max) {
  if (!field.has_cells()) return;
  double begin = 0, end = t_max;
  for (int axis = 0; axis < 2; ++axis)
    clip_to_range(0, cells_[axis], ray.origin[axis], ray.direction[axis], begin, end);
  t_in_ = begin;
  const dvec3 &o = ray.origin, &d = ray.direction;
  if (o.z + d.z * begin > field.max_sample() && d.z < 0) t_in_ = std::max(t_in_, (field.max_sample() - o.z) / d.z);
  t_out_ = end;
  origin_ = clipped ? std::max(cells_[0], cells_[1]) : std::max(std::abs(o.x), std::abs(o.y));
  height_ = clipped ? std::abs(o.z + d.z * t_in_) : std::abs(o.z) + std::abs(d.z * t_in_);
  if (d.z != 0) {
    // No hit is possible later.
    const double relief = field.max_sample() - field.min_sample() + 1;
    t_out_ = std::min(t_out_, t_in_ + (std::abs(o.z + d.z * t_in_ - field.min_sample()) + 2 * relief) / std::abs(d.z));
  }
  over_field_ = t_in_ <= t_out_;
  if (!over_field_) return;
  lines_ = {t_in_, t_out_};
  for (int axis = 0; axis < 2; ++axis) {
    if (d[axis] == 0) continue;
    const double a = at(axis, t_in_), b = at(axis, t_out_);
    for (double k = std::ceil(std::min(a, b)); k <= std::max(a, b); ++k) {
      const double t = (k - o[axis]) / d[axis];
      if (t > t_in_ && t < t_out_) lines_.push_back(t);
    }
  }
  std::sort(lines_.begin(), lines_.end());
}

Cell EasyJudge::cell_at(double t) const {
  const auto cell = [&](int axis) {
    return std::clamp(static_cast<int>(std::floor(std::clamp(at(axis, t), -1.0, cells_[axis] + 1.0))), 0,
                      cells_[axis] - 1);
  };
  return {cell(0), cell(1)};
}

double EasyJudge::clearance(Cell cell, double t) const {
  const double u = std::clamp(at(0, t) - cell.col, 0.0, 1.0), v = std::clamp(at(1, t) - cell.row, 0.0, 1.0);
  return at(2, t) - height_in_cell(Surface::bilinear, field_.cell_heights(cell).value(), u, v);
}

double EasyJudge::sideways(double t) const {
  const double speed = std::max(std::abs(ray_.direction.x), std::abs(ray_.direction.y));
  return kSideways * (std::max(cells_[0], cells_[1]) + origin_ + speed * (t - t_in_) + 1) +
         kDoubles * (std::max(std::abs(ray_.origin.x), std::abs(ray_.origin.y)) + speed * t);
}

double EasyJudge::delta(double t) const {
  // Around the cell: a displaced ray may be in the next one.
  const Cell cell = cell_at(t);
  double relief = 0, highest = 0;
  for (int col = std::max(cell.col - 1, 0); col <= std::min(cell.col + 1, cells_[0] - 1); ++col) {
    for (int row = std::max(cell.row - 1, 0); row <= std::min(cell.row + 1, cells_[1] - 1); ++row) {
      const CellHeights h = field_.cell_heights({col, row}).value();
      const double high = std::max({h.h00, h.h10, h.h01, h.h11}), low = std::min({h.h00, h.h10, h.h01, h.h11});
      relief = std::max(relief, high - low);
      highest = std::max({highest, std::abs(high), std::abs(low)});
    }
  }
  return kVertically * (height_ + std::abs(ray_.direction.z) * (t - t_in_) + highest) + 2 * sideways(t) * relief +
         kDoubles * (std::abs(ray_.origin.z) + std::abs(ray_.direction.z) * t);
}

// The least clearance in a piece, in multiples of delta.
double EasyJudge::deepest(const Piece& piece) const {
  const double middle = 0.5 * (piece.begin + piece.end);
  const Cell cell = cell_at(middle);
  const double f0 = clearance(cell, piece.begin), f1 = clearance(cell, middle), f2 = clearance(cell, piece.end);
  double least = std::min(f0, f2);
  // f0 + b s + a s^2, s from 0 to 1.
  const double a = 2 * (f0 - 2 * f1 + f2), b = f2 - f0 - a;
  if (a > 0 && b < 0 && -b < 2 * a) least = std::min(least, f0 - b * b / (4 * a));
  return least / delta(middle);
}

// The least clearance before a time, in multiples of delta, wherever a ray displaced by the bound is still over the
// field.
double EasyJudge::passes_by(double until) const {
  double from = t_in_ + kTimes * t_in_, to = std::min(t_out_, until) - kTimes * std::min(t_out_, until);
  for (int axis = 0; axis < 2; ++axis) {
    if (ray_.direction[axis] == 0) continue;
    const double e = 2 * sideways(t_out_);
    clip_to_range(e, cells_[axis] - e, ray_.origin[axis], ray_.direction[axis], from, to);
  }
  double least = HUGE_VAL;
  for (std::size_t i = 0; i + 1 < lines_.size(); ++i) {
    const Piece piece{std::max(lines_[i], from), std::min(lines_[i + 1], to)};
    if (piece.begin < piece.end) least = std::min(least, deepest(piece));
  }
  return least;
}

bool EasyJudge::may_begin_below() const { return over_field_ && clearance(cell_at(t_in_), t_in_) <= delta(t_in_); }

std::string EasyJudge::objection(const EasyAnswer& answer) const {
  if (!answer.hit) {
    const double least = over_field_ ? passes_by(HUGE_VAL) : HUGE_VAL;
    worst_ = std::max(worst_, -least);
    return least < -1 ? fmt::format("passes ground, by {} delta", -least) : "";
  }
  const double t = answer.t, slack = kTimes * t;
  // Only a displaced ray may reach the field's corner.
  const bool near = t >= 0 && t <= t_max_;
  if (!near) return "out of the ray's range";
  const double e = sideways(t);
  const double places[] = {answer.cell.col + answer.u, answer.cell.row + answer.v};
  if (answer.cell.col < 0 || answer.cell.row < 0 || answer.cell.col >= cells_[0] || answer.cell.row >= cells_[1] ||
      !(answer.u >= 0 && answer.u <= 1 && answer.v >= 0 && answer.v <= 1))
    return "a cell that does not exist";
  for (int axis = 0; axis < 2; ++axis) {
    if (!(std::abs(places[axis] - at(axis, t)) <= e))
      return fmt::format("axis {}: at {}, not {}, bound {}", axis, at(axis, t), places[axis], e);
  }
  const double f = clearance(cell_at(t), t) / delta(t);
  const bool starts =
      t <= t_in_ + slack + e / std::max({std::abs(ray_.direction.x), std::abs(ray_.direction.y), 1e-300});
  worst_ = std::max(worst_, starts ? f : std::abs(f));
  if (f > 1) return fmt::format("hits {} delta above the ground", f);
  if (f < -1 && !starts) return fmt::format("hits {} delta below the ground", -f);
  if (f < -1 && !answer.below) return "does not tell that it starts below";
  if (answer.below && !starts) return "tells that it starts below elsewhere";
  const double least = passes_by(t);
  if (!starts) worst_ = std::max(worst_, -least);
  return least < -1 && !starts ? fmt::format("passes ground before, by {} delta", -least) : "";
}

}  // namespace scarp::test
