// SPDX-License-Identifier: MIT
#include "march/height/rounding_judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace scarp::test {
namespace {

constexpr double kFloat = 0x1p-24;
// Number of roundings (numerics.md), rounded up to a power of two.
constexpr double kRoundings = 16;
// Roundings of the ray from world coordinates, as for the marches in double.
constexpr double kWorldRoundings = 32;
// A value with an error of delta is compared with a bound of delta.
constexpr double kCertain = 2;

}  // namespace

RoundingJudge::RoundingJudge(const HeightField& field, const Ray& ray, double tile, double world_unit)
    : field_(field), ray_(ray), tile_(tile), world_unit_(world_unit), strict_(ray.start == RayStart::on_surface) {
  if (!field.has_cells() || field.all_nodata()) return;
  const GridRay local = field.grid_from_world(ray);
  const double longest =
      std::max({std::abs(local.direction.x), std::abs(local.direction.y), std::abs(local.direction.z)});
  const int exponent = std::ilogb(longest);
  origin_ = local.origin;
  for (int axis = 0; axis < 3; ++axis) direction_[axis] = std::ldexp(local.direction[axis], -exponent);
  scale_ = std::ldexp(1.0, exponent);
  begin_ = std::ldexp(ray.t_min, exponent);
  end_ = std::ldexp(ray.t_max, exponent);
  std::vector<double> times;
  const int cells[] = {field.cell_cols(), field.cell_rows()};
  const double first = begin_;
  if (!field.wraps()) {
    for (int axis = 0; axis < 2; ++axis) {
      if (direction_[axis] == 0) {
        if (!(origin_[axis] >= 0 && origin_[axis] <= cells[axis])) return;
        continue;
      }
      const double a = -origin_[axis] / direction_[axis], b = (cells[axis] - origin_[axis]) / direction_[axis];
      begin_ = std::max(begin_, std::min(a, b));
      end_ = std::min(end_, std::max(a, b));
    }
    from_outside_ = begin_ > first + kWorldRoundings * world_unit_ * std::abs(first);
    may_be_from_outside_ = begin_ >= first;
    if (begin_ - first <= 4 * sideways(begin_)) may_be_from_outside_ = true;
  }
  if (std::isinf(end_)) {
    // Vertical: until no more hits are possible.
    const double relief = field.max_sample() - field.min_sample() + 1;
    end_ = begin_ +
           (std::abs(origin_.z + direction_.z * begin_ - field.min_sample()) + 2 * relief) / std::abs(direction_.z);
  }
  if (!(begin_ <= end_)) return;
  meets_field_ = true;
  times = {begin_, end_};
  const auto add_lines = [&](double o, double d, double offset) {
    if (d == 0) return;
    const double a = o + d * begin_, b = o + d * end_;
    for (double k = std::ceil(std::min(a, b) - 1); k <= std::max(a, b) + 1; ++k) {
      const double t = (k + offset - o) / d;
      if (t > begin_ && t < end_) times.push_back(t);
    }
  };
  add_lines(origin_.x, direction_.x, 0);
  add_lines(origin_.y, direction_.y, 0);
  if (field.settings().surface == Surface::triangles) {
    add_lines(origin_.x + origin_.y, direction_.x + direction_.y, 0);
  }
  std::sort(times.begin(), times.end());
  if (strict_) {
    const CellHeights h = field.cell_heights(ray.start_cell).value();
    start_relief_ = std::max({h.h00, h.h10, h.h01, h.h11}) - std::min({h.h00, h.h10, h.h01, h.h11});
    const auto in_cell = [](double position, int cell, int count, bool wraps) {
      const double copies = wraps ? std::round((position - cell - 0.5) / count) * count : 0;
      return std::clamp(position - copies - cell, 0.0, 1.0);
    };
    const double u = in_cell(at(0, begin_), ray.start_cell.col, cells[0], field.wraps());
    const double v = in_cell(at(1, begin_), ray.start_cell.row, cells[1], field.wraps());
    origin_.z = height_in_cell(field.settings().surface, h, u, v) - direction_.z * begin_;
  }
  for (std::size_t i = 0; i + 1 < times.size(); ++i) add_piece(times[i], times[i + 1]);
}

bool RoundingJudge::exists(int col, int row) const {
  return field_.wraps() || (col >= 0 && row >= 0 && col < field_.cell_cols() && row < field_.cell_rows());
}

Cell RoundingJudge::within(int col, int row) const {
  const int cols = field_.cell_cols(), rows = field_.cell_rows();
  return {((col % cols) + cols) % cols, ((row % rows) + rows) % rows};
}

bool RoundingJudge::is_ground(int col, int row) const {
  return exists(col, row) && field_.cell_heights(within(col, row)).has_value();
}

CellHeights RoundingJudge::heights(int col, int row) const { return field_.cell_heights(within(col, row)).value(); }

// Range of heights around a cell.
double RoundingJudge::relief(int col, int row) const {
  double most = start_relief_;
  for (int c = col - 1; c <= col + 1; ++c) {
    for (int r = row - 1; r <= row + 1; ++r) {
      if (!is_ground(c, r)) continue;
      const CellHeights h = heights(c, r);
      most = std::max(most, std::max({h.h00, h.h10, h.h01, h.h11}) - std::min({h.h00, h.h10, h.h01, h.h11}));
    }
  }
  return most;
}

double RoundingJudge::clearance(int col, int row, double t) const {
  const double u = std::clamp(at(0, t) - col, 0.0, 1.0), v = std::clamp(at(1, t) - row, 0.0, 1.0);
  return origin_.z + direction_.z * t - height_in_cell(field_.settings().surface, heights(col, row), u, v);
}

// Sideways error of a march from the true ray, in cells.
double RoundingJudge::sideways(double t) const {
  const double way = std::min(std::abs(direction_.x * (t - begin_)) + std::abs(direction_.y * (t - begin_)), 2 * tile_);
  const double world = std::abs(origin_.x) + std::abs(direction_.x * t) + std::abs(origin_.y) +
                       std::abs(direction_.y * t) + field_.rows();
  return kRoundings * kFloat * (way + 1) + kWorldRoundings * world_unit_ * world;
}

double RoundingJudge::delta(int col, int row, double t) const {
  const double steep = relief(col, row);
  const double flat = std::max(std::abs(direction_.x), std::abs(direction_.y));
  // A march uses the bound at its exit from the cell.
  if (flat > 0) t += 1 / flat;
  const double s = std::min(t - begin_, flat > 0 ? tile_ / flat : HUGE_VAL);
  const double world = std::abs(origin_.z) + std::abs(direction_.z * t) +
                       std::max(std::abs(field_.min_sample()), std::abs(field_.max_sample())) +
                       std::abs(field_.settings().offset) / field_.settings().scale;
  return kRoundings * kFloat * (2 * std::abs(direction_.z * s) + steep) + sideways(t) * steep +
         kWorldRoundings * world_unit_ * world;
}

// Whether a ray from the surface is truly below it at t or on the rest of the cell there: its march subtracts the whole
// bound.
bool RoundingJudge::comes_below(double t, double off) const {
  for (const Event& event : events_) {
    if (event.t < t - off) continue;
    if (event.what == Event::hole || event.touches_hole || event.clearance < 0) return true;
    if (!event.enters && event.t > t + off) return false;
  }
  return false;
}

// Whether a piece of the ray in a cell is within sideways rounding of a hole or border; or, border_only, stays that
// close to the border.
bool RoundingJudge::near(int col, int row, double begin, double end, bool border_only) const {
  const double e = 2 * std::max(sideways(begin), sideways(end));
  for (int dc = -1; dc <= 1; ++dc) {
    for (int dr = -1; dr <= 1; ++dr) {
      if ((dc == 0 && dr == 0) || (border_only ? exists(col + dc, row + dr) : is_ground(col + dc, row + dr))) continue;
      int ends = 0;
      for (const double t : {begin, end}) {
        const double u = at(0, t) - col, v = at(1, t) - row;
        const bool x = dc == 0 || (dc < 0 ? u <= e : u >= 1 - e), y = dr == 0 || (dr < 0 ? v <= e : v >= 1 - e);
        ends += x && y;
      }
      if (ends >= (border_only && (dc == 0 || dr == 0) ? 2 : 1)) return true;
    }
  }
  return false;
}

// Whether a piece of the ray in a hole stays on the rim of the ground beside it.
bool RoundingJudge::runs_along_ground(int col, int row, double begin, double end) const {
  const double e = 2 * std::max(sideways(begin), sideways(end));
  const auto keeps_to = [&](int axis, double line) {
    return std::abs(at(axis, begin) - line) <= e && std::abs(at(axis, end) - line) <= e;
  };
  return (keeps_to(0, col) && is_ground(col - 1, row)) || (keeps_to(0, col + 1) && is_ground(col + 1, row)) ||
         (keeps_to(1, row) && is_ground(col, row - 1)) || (keeps_to(1, row + 1) && is_ground(col, row + 1));
}

void RoundingJudge::add_event(int col, int row, double t, bool enters, double begin, double end) {
  Event event{};
  event.t = t;
  event.col = col;
  event.row = row;
  event.enters = enters;
  event.what = is_ground(col, row) ? Event::ground : Event::hole;
  event.brief = (end - begin) * std::max(std::abs(direction_.x), std::abs(direction_.y)) <= 4 * sideways(end);
  event.along_ground = event.what == Event::hole && runs_along_ground(col, row, begin, end);
  if (event.what == Event::ground) {
    event.clearance = clearance(col, row, t);
    event.delta = delta(col, row, t);
    event.touches_hole = near(col, row, begin, end, false);
  }
  event.may_leave = !field_.wraps() && near(col, row, begin, end, true);
  events_.push_back(event);
}

void RoundingJudge::add_piece(double begin, double end) {
  const double middle = 0.5 * (begin + end);
  int col = static_cast<int>(std::floor(at(0, middle))), row = static_cast<int>(std::floor(at(1, middle)));
  if (!field_.wraps()) {
    col = std::clamp(col, 0, field_.cell_cols() - 1);
    row = std::clamp(row, 0, field_.cell_rows() - 1);
  }
  add_event(col, row, begin, true, begin, end);
  if (is_ground(col, row)) {
    // The clearance is a parabola: its extreme.
    const double c = clearance(col, row, begin), m = clearance(col, row, middle), last = clearance(col, row, end);
    const double length = end - begin, a = 2 * (c - 2 * m + last) / (length * length),
                 b = (last - c) / length - a * length;
    const double vertex = -b / (2 * a);
    if (length > 0 && vertex > 0 && vertex < length) add_event(col, row, begin + vertex, false, begin, end);
  }
  add_event(col, row, end, false, begin, end);
}

// Possible beliefs, at `until`, of a march that has not reported a hit.
RoundingJudge::Beliefs RoundingJudge::follow(double until) const {
  Beliefs now;
  (strict_ ? now.above : now.unknown) = true;
  bool begun = false;
  const bool solid = field_.settings().solid;
  for (const Event& event : events_) {
    if (event.t > until) break;
    if (event.may_leave) now.gone = true;
    if (event.what == Event::hole) {
      // Rims are closed: the ray may be treated as over the ground, on either side of it.
      if (event.along_ground) {
        now.unknown = now.above = now.below = true;
        continue;
      }
      // A ray that starts this close to the ground may be treated as starting above it.
      if (!event.brief) {
        now.above = now.below = false;
        begun = true;
      }
      now.unknown = true;
      continue;
    }
    const double f = event.clearance, d = kCertain * event.delta;
    Beliefs next;
    next.gone = now.gone;
    if (now.above) next.above = f >= -d;
    if (now.below) {
      next.above = next.above || f > 0;
      next.below = f <= d;
    }
    if (now.unknown) {
      // A march may still be about to check.
      if (event.touches_hole || event.brief) next.unknown = true;
      const bool outside = begun || from_outside_, may_be_outside = begun || may_be_from_outside_ || event.touches_hole;
      if (f >= -d) next.above = true;
      if (f <= d && !(solid && outside)) next.below = true;
      if (f <= d && f >= -d) next.below = true;
      if (solid && may_be_outside && !outside) next.below = next.below || f <= d;
    }
    if (event.touches_hole) next.unknown = true;
    now = next;
    if (event.t > begin_ && !event.brief) begun = true;
  }
  return now;
}

RoundingJudge::Bounds RoundingJudge::clearance_at(double t) const {
  t *= scale_;
  const double x = at(0, t), y = at(1, t), e = 2 * sideways(t);
  Bounds bounds{HUGE_VAL, -HUGE_VAL};
  for (const double dx : {-e, e}) {
    for (const double dy : {-e, e}) {
      const int col = static_cast<int>(std::floor(x + dx)), row = static_cast<int>(std::floor(y + dy));
      if (!is_ground(col, row)) return {};
      const double f = clearance(col, row, t), d = delta(col, row, t);
      bounds.low = std::min(bounds.low, f - d);
      bounds.high = std::max(bounds.high, f + d);
    }
  }
  const double metres = field_.settings().scale * field_.settings().exaggeration;
  return {bounds.low * metres, bounds.high * metres};
}

std::string RoundingJudge::objection(const Hit& hit) const {
  if (!hit) {
    if (hit.status == HitStatus::exhausted) return "gave up";
    if (!may_miss()) return "passes a hit";
    if (hit.status == HitStatus::below && !events_.empty() && events_[0].what == Event::ground &&
        (strict_ || events_[0].clearance > kCertain * events_[0].delta))
      return "below, where it begins above";
    if (hit.status == HitStatus::miss && !events_.empty() && events_[0].what == Event::ground && !strict_ &&
        !events_[0].touches_hole && !events_[0].may_leave && events_[0].clearance < -kCertain * events_[0].delta)
      return "not below, where it begins below";
    return {};
  }
  const double t = hit.t * scale_;
  if (!(hit.t >= ray_.t_min && hit.t <= ray_.t_max)) return "out of the ray's range";
  if (hit.cell.col < 0 || hit.cell.col >= field_.cell_cols() || hit.cell.row < 0 ||
      hit.cell.row >= field_.cell_rows() || !(hit.u >= 0 && hit.u <= 1 && hit.v >= 0 && hit.v <= 1) ||
      !field_.cell_heights(hit.cell)) {
    return "a place that does not exist";
  }
  // The copy of the cell that the ray is over.
  const auto copy = [&](double position, int cell, int count) {
    return field_.wraps() ? cell + static_cast<int>(std::round((position - cell - 0.5) / count)) * count : cell;
  };
  const double off = 4 * sideways(t);
  const double place[] = {at(0, t), at(1, t)};
  int col = copy(place[0], hit.cell.col, field_.cell_cols()), row = copy(place[1], hit.cell.row, field_.cell_rows());
  if (field_.wraps() && field_.cell_cols() == 1) col = static_cast<int>(std::floor(place[0]));
  if (field_.wraps() && field_.cell_rows() == 1) row = static_cast<int>(std::floor(place[1]));
  if (std::abs(place[0] - col - hit.u) > off && !(field_.cell_cols() == 1 && field_.wraps()))
    return fmt::format("column {} is off by {}, bound {}", place[0], place[0] - col - hit.u, off);
  if (std::abs(place[1] - row - hit.v) > off && !(field_.cell_rows() == 1 && field_.wraps()))
    return fmt::format("row {} is off by {}, bound {}", place[1], place[1] - row - hit.v, off);
  const double f = clearance(col, row, t), d = kCertain * delta(col, row, t);
  if (hit.wall ? f > d : std::abs(f) > d) return fmt::format("clearance {} there, bound {}", f, d);
  // Just before the hit: the gap is smaller than the bounds.
  const double speed = std::max(std::abs(direction_.x), std::abs(direction_.y));
  if (strict_ && !hit.wall && speed > 0 && !comes_below(t, off / speed)) return "hits what it starts on";
  const Beliefs before = follow(speed > 0 ? t - off / speed : t);
  if (hit.wall && !before.unknown && !events_.empty() && t > begin_ + off / speed) return "a wall where there is none";
  // The ray may have left the ground since then.
  bool rises = false;
  for (const Event& event : events_) {
    rises = rises || (event.what == Event::ground && event.clearance > 0 && std::abs(event.t - t) * speed <= off);
  }
  if (before.below && rises) return {};
  if (!before.above && !before.unknown) return before.any() ? "comes from below" : "passes a hit before";
  return {};
}

}  // namespace scarp::test
