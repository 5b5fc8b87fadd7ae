// SPDX-License-Identifier: MIT
#include "bench/leak_judge.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scarp::bench {
namespace {

using Real = long double;

constexpr Real kUnit = 0x1p-53L;  // unit roundoff of the marches' doubles
constexpr Real kRoundings = 16;   // numerics.md
constexpr Real kCounted = 11;     // of these, the number that is counted there

Real height(const CellHeights& h, Real u, Real v) {
  const Real north = h.h00 + u * (static_cast<Real>(h.h10) - h.h00),
             south = h.h01 + u * (static_cast<Real>(h.h11) - h.h01);
  return north + v * (south - north);
}

Real height_of_triangle(const CellHeights& h, bool south_east, Real u, Real v) {
  if (!south_east) return h.h00 + u * (static_cast<Real>(h.h10) - h.h00) + v * (static_cast<Real>(h.h01) - h.h00);
  return h.h11 + (1 - u) * (static_cast<Real>(h.h01) - h.h11) + (1 - v) * (static_cast<Real>(h.h10) - h.h11);
}

// Whether division by this is exact in doubles.
bool divides_exactly(double cell) {
  int exponent = 0;
  return std::frexp(cell, &exponent) == 0.5;
}
bool is_double(Real x) { return static_cast<Real>(static_cast<double>(x)) == x; }

Real clamped(Real x) { return std::clamp<Real>(x, 0, 1); }
int within(Real cell, int cells) {
  const auto c = static_cast<std::int64_t>(cell) % cells;
  return static_cast<int>(c < 0 ? c + cells : c);
}

}  // namespace

LeakJudge::LeakJudge(const LeakField& ground, const Ray& ray)
    : ground_(ground),
      field_(ground.field),
      ray_(ray),
      triangles_(field_.settings().surface == Surface::triangles),
      wraps_(field_.wraps()),
      on_surface_(ray.start == RayStart::on_surface) {
  const HeightFieldSettings& to = field_.settings();
  ox_ = ray.origin.x / Real{to.cell_x};
  oy_ = field_.rows() - 1 - ray.origin.y / Real{to.cell_y};
  oz_ = (ray.origin.z / Real{to.exaggeration} - to.offset) / to.scale;
  dx_ = ray.direction.x / Real{to.cell_x};
  dy_ = -ray.direction.y / Real{to.cell_y};
  dz_ = ray.direction.z / (Real{to.exaggeration} * to.scale);
  low_ = field_.min_sample(), high_ = field_.max_sample();
  offset_ = std::abs(to.offset) / Real{to.scale};
  exact_plan_ = divides_exactly(to.cell_x) && divides_exactly(to.cell_y) && is_double(oy_) &&
                field_.rows() - 1 - oy_ == ray.origin.y / Real{to.cell_y};
  t0_ = ray.t_min, t1_ = ray.t_max;
  // A ray that starts outside of the field by rounding, and enters later, is on the surface at its start.
  if (on_surface_) put_on_surface();
  if (!wraps_) clip();
  if (stands_on_ground()) must_hit_ = true;
  if (!(t0_ <= t1_)) return;
  c0_ = on_surface_ ? Real{0} : clearance(t0_);
  if (!c0_ || hugs_border() || holes_between(t0_, t1_)) return;
  // Rounding moves the time at which the border is crossed: the more slowly the ray crosses, the more.
  const Real in = t0_ + late_, out = t1_ - early_;
  if (!(in <= out)) return;
  const auto c0 = on_surface_ ? c0_ : clearance(in), c1 = clearance(out);
  begins_above_ = c0 && (on_surface_ || *c0 > bound(in));
  must_hit_ = begins_above_ && c1 && *c1 < -under(out);
  if (field_.settings().solid && from_outside_ && *c0_ < -bound(t0_) && c0 && *c0 < -bound(in)) must_hit_ = true;
}

// Moves the ray up or down so that it starts on the surface of its cell.
void LeakJudge::put_on_surface() {
  const CellHeights h = *field_.cell_heights(ray_.start_cell);
  const Real u = clamped(x(t0_) - ray_.start_cell.col), v = clamped(y(t0_) - ray_.start_cell.row);
  oz_ = (triangles_ ? height_of_triangle(h, u + v > 1, u, v) : height(h, u, v)) - dz_ * t0_;
}

// The part of the ray over the field.
void LeakJudge::clip() {
  const auto axis = [&](Real o, Real d, int cells) {
    if (d == 0) {
      if (!(o >= 0 && o <= cells)) t1_ = -std::numeric_limits<Real>::infinity();
      return;
    }
    const Real a = -o / d, b = (cells - o) / d;
    const Real e = sideways(std::max(std::abs(a), std::abs(b))) / std::abs(d);
    if (std::min(a, b) > t0_ - e) from_outside_ = from_outside_ || std::min(a, b) > t0_, late_ = std::max(late_, e);
    if (std::max(a, b) < t1_ + e) early_ = std::max(early_, e);
    t0_ = std::max(t0_, std::min(a, b));
    t1_ = std::min(t1_, std::max(a, b));
  };
  axis(ox_, dx_, field_.cell_cols());
  axis(oy_, dy_, field_.cell_rows());
}

// Rounding error of a position in plan, in cells.
LeakJudge::Real LeakJudge::sideways(Real t) const {
  return kRoundings * kUnit * (std::abs(ox_) + std::abs(dx_ * t) + std::abs(oy_) + std::abs(dy_ * t) + field_.rows());
}

LeakJudge::Real LeakJudge::bound(Real t) const {
  const Real upright = std::abs(oz_) + std::abs(dz_ * t) + std::max(std::abs(low_), std::abs(high_)) + offset_;
  return kRoundings * kUnit * upright + sideways(t) * (high_ - low_);
}

// Depth below the surface at which a hit is certain: for a ray from the surface, the computed depth must exceed B.
LeakJudge::Real LeakJudge::under(Real t) const { return (on_surface_ ? 2 : 1) * bound(t); }

// Whether a ray is so close to the border, along its whole length, that rounding may put it outside.
bool LeakJudge::hugs_border() const {
  if (wraps_ || exact_plan_) return false;
  const Real e = sideways(std::max(std::abs(t0_), std::abs(t1_)));
  const auto hugs = [&](Real a, Real b, int cells) { return std::max(a, b) <= e || std::min(a, b) >= cells - e; };
  return hugs(x(t0_), x(t1_), field_.cell_cols()) || hugs(y(t0_), y(t1_), field_.cell_rows());
}

// Whether there may be a hole under the ray: any touched cell in the box of its ends counts.
bool LeakJudge::holes_between(Real from, Real to) const {
  if (field_.nodata_count() == 0) return false;
  const Real e = sideways(std::max(std::abs(from), std::abs(to)));
  const auto first = [&](Real a, Real b) { return static_cast<int>(std::ceil(std::min(a, b) - e)) - 1; };
  const auto last = [&](Real a, Real b) { return static_cast<int>(std::floor(std::max(a, b) + e)) + 1; };
  CellBox box{first(x(from), x(to)), first(y(from), y(to)), last(x(from), x(to)), last(y(from), y(to))};
  if (wraps_ &&
      (box.col_begin < 0 || box.row_begin < 0 || box.col_end > field_.cell_cols() || box.row_end > field_.cell_rows()))
    return true;
  box = {std::clamp(box.col_begin, 0, field_.cell_cols()), std::clamp(box.row_begin, 0, field_.cell_rows()),
         std::clamp(box.col_end, 0, field_.cell_cols()), std::clamp(box.row_end, 0, field_.cell_rows())};
  return ground_.holes.any(box);
}

std::optional<LeakJudge::Place> LeakJudge::place_at(Real t) const {
  const auto cell = [&](Real position, int cells) {
    const Real c = static_cast<Real>(std::floor(static_cast<double>(position)));
    return wraps_ ? c : std::clamp<Real>(c, 0, cells - 1);
  };
  const Real col = cell(x(t), field_.cell_cols()), row = cell(y(t), field_.cell_rows());
  const auto h = field_.cell_heights({within(col, field_.cell_cols()), within(row, field_.cell_rows())});
  if (!h) return {};
  return Place{col, row, *h};
}

std::optional<LeakJudge::Place> LeakJudge::place_of(const Hit& hit) const {
  const auto h = field_.cell_heights(hit.cell);
  if (!h) return {};
  const auto copy = [&](Real position, int cell, double place, int cells) {
    if (!wraps_) return static_cast<Real>(cell);
    return cell + cells * static_cast<Real>(std::round(static_cast<double>((position - place - cell) / cells)));
  };
  return Place{copy(x(hit.t), hit.cell.col, hit.u, field_.cell_cols()),
               copy(y(hit.t), hit.cell.row, hit.v, field_.cell_rows()), *h};
}

std::optional<LeakJudge::Real> LeakJudge::clearance(Real t) const {
  const auto place = place_at(t);
  if (!place) return {};
  const Real u = clamped(x(t) - place->col), v = clamped(y(t) - place->row);
  return z(t) - (triangles_ ? height_of_triangle(place->h, u + v > 1, u, v) : height(place->h, u, v));
}

LeakJudge::Piece LeakJudge::piece(const Place& place, Real t, bool south_east) const {
  const CellHeights& h = place.h;
  const Real u = x(t) - place.col, v = y(t) - place.row;
  if (triangles_) {
    const Real hu = south_east ? static_cast<Real>(h.h11) - h.h01 : static_cast<Real>(h.h10) - h.h00;
    const Real hv = south_east ? static_cast<Real>(h.h11) - h.h10 : static_cast<Real>(h.h01) - h.h00;
    return {z(t) - height_of_triangle(h, south_east, u, v), dz_ - hu * dx_ - hv * dy_, 0};
  }
  const Real hu = static_cast<Real>(h.h10) - h.h00, hv = static_cast<Real>(h.h01) - h.h00;
  const Real twist = static_cast<Real>(h.h11) - h.h01 - hu;
  return {z(t) - height(h, u, v), dz_ - (hu + twist * v) * dx_ - (hv + twist * u) * dy_, -twist * dx_ * dy_};
}

// Time for which the ray has been in the cell (or triangle) at t, or will be, within its range. `room`: width in cells
// of a strip along its lines that does not count.
LeakJudge::Real LeakJudge::time_in_cell(const Place& place, Real t, bool back, Real room) const {
  // Forwards, a cell is followed to its end, even beyond the end of the ray.
  const bool moves = dx_ != 0 || dy_ != 0;
  Real time = back ? t - t0_ : moves ? std::numeric_limits<Real>::infinity() : t1_ - t;
  const auto axis = [&](Real position, Real d) {
    if (d == 0) return;
    const Real way = ((d > 0) == back ? position : 1 - position) - room;
    time = std::min(time, std::max<Real>(way, 0) / std::abs(d));
  };
  axis(x(t) - place.col, dx_);
  axis(y(t) - place.row, dy_);
  return std::max<Real>(time, 0);
}

// Monotone rise of the clearance in the time `length` up to t, in one cell: the part of a parabola after its minimum.
LeakJudge::Real LeakJudge::risen(const Place& place, Real t, Real length) const {
  bool upper = false;
  if (triangles_) {
    // No further than the diagonal.
    const Real since = (x(t) - place.col + y(t) - place.row - 1) / (dx_ + dy_);
    if (since > 0) length = std::min(length, since);
    upper = south_east(place, t - length / 2);
  }
  const Piece f = piece(place, t, upper);
  if (!(f.b > 0)) return 0;
  if (f.a > 0) length = std::min(length, f.b / (2 * f.a));
  return f.b * length - f.a * length * length;
}

// Greatest depth below the surface that the ray reaches after t while descending monotonically within one cell.
LeakJudge::Real LeakJudge::deepest(const Place& place, Real t) const {
  Real length = time_in_cell(place, t, false);
  bool upper = false;
  if (triangles_) {
    // No further than the diagonal, when it is ahead.
    const Real ahead = 1 - (x(t) - place.col + y(t) - place.row), closing = dx_ + dy_;
    if (ahead / closing > 0 && std::abs(ahead) > 2 * sideways(t)) length = std::min(length, ahead / closing);
    upper = south_east(place, t + length / 2);
  }
  const Piece f = piece(place, t, upper);
  if (f.a > 0) length = std::min(length, std::max<Real>(0, -f.b / (2 * f.a)));
  return -(f.f + f.b * length + f.a * length * length);
}

const char* LeakJudge::lost(const Hit& hit, double share) const {
  if (hit.status == HitStatus::exhausted) return "given up";
  if (!hit && must_hit_) return "a ray that must hit";
  if (!hit || !(t0_ <= t1_) || !c0_) return nullptr;
  const Real from = t0_, t = from + share * (hit.t - from);
  // The ray is known to be above the ground only where it has certainly entered.
  if (!begins_above_ || t < from + late_ || t > t1_ - early_ || holes_between(from, t)) return nullptr;
  const auto c = clearance(t);
  return c && *c < -under(t) ? "a hit before the one that is told" : nullptr;
}

// Cells by which rounding may move a line from the ray: numerics.md, "Rims and seams".
LeakJudge::Real LeakJudge::allowance(int axis) const {
  return kRoundings * kUnit * (std::abs(axis == 0 ? ox_ : oy_) + (axis == 0 ? field_.cell_cols() : field_.cell_rows()));
}

// Whether the ray is vertical, to a quarter of the allowance, and passes through a point of the ground.
bool LeakJudge::stands_on_ground() const {
  if (on_surface_ || dz_ == 0) return false;
  const Real room = bound(0) + (high_ - low_) * 0x1p-20L;
  const Real a = (high_ + room - oz_) / dz_, b = (low_ - room - oz_) / dz_;
  if (!(a < b && a >= ray_.t_min && b <= ray_.t_max)) return false;
  const auto cells_at = [&](int axis, std::int64_t(&cell)[2]) {
    const Real p = axis == 0 ? x(a) : y(a), q = axis == 0 ? x(b) : y(b), off = allowance(axis) / 4;
    if (std::abs(p - q) > off) return false;
    cell[0] = static_cast<std::int64_t>(std::floor(std::max(p, q) - off));
    cell[1] = static_cast<std::int64_t>(std::floor(std::min(p, q) + off));
    return true;
  };
  std::int64_t cols[2], rows[2];
  if (!cells_at(0, cols) || !cells_at(1, rows)) return false;
  for (const std::int64_t col : cols) {
    for (const std::int64_t row : rows) {
      const int width = field_.cell_cols(), depth = field_.cell_rows();
      if (!wraps_ && !(col >= 0 && row >= 0 && col < width && row < depth)) continue;
      if (field_.cell_heights({within(static_cast<Real>(col), width), within(static_cast<Real>(row), depth)}))
        return true;
    }
  }
  return false;
}

// Distance that a march may treat as a touch of the line, or of either line of a node (numerics.md).
Real LeakJudge::bound_at_rim(const Hit& hit, const CellHeights& h, Real t, Real off) const {
  const Real relief = std::max({h.h00, h.h10, h.h01, h.h11}) - std::min({h.h00, h.h10, h.h01, h.h11});
  constexpr Real kQuick = 0x1p10L;  // numerics.md, "Rims and seams"
  Real most = bound(t);
  for (const int axis : {0, 1}) {
    const double place = axis == 0 ? hit.u : hit.v;
    const Real across = std::abs(axis == 0 ? dx_ : dy_), along = std::abs(axis == 0 ? dy_ : dx_);
    if (std::min(place, 1 - place) > off) continue;
    Real quick = 0;
    if (field_.nodata_count() > 0 && across > 0)
      quick = std::min(allowance(axis) / across * (std::abs(dz_) + along * relief),
                       kQuick * allowance(axis) * (high_ - low_));
    most = std::max(most, bound(t) + std::max(allowance(0), allowance(1)) * relief + quick);
  }
  return most;
}

const char* LeakJudge::false_hit(const Hit& hit) const {
  if (!hit) return nullptr;
  const Cell cell = hit.cell;
  if (!(hit.t >= ray_.t_min && hit.t <= ray_.t_max)) return "t outside the ray's range";
  if (!(hit.u >= 0 && hit.u <= 1 && hit.v >= 0 && hit.v <= 1) || cell.col < 0 || cell.row < 0 ||
      cell.col >= field_.cell_cols() || cell.row >= field_.cell_rows()) {
    return "no place of the field";
  }
  const auto place = place_of(hit);
  if (!place) return "in a hole";
  const Real t = hit.t, e = sideways(t), b = bound(t);
  // Within rounding, a ray next to a rim may touch it.
  if (std::abs(x(t) - place->col - hit.u) > e + allowance(0) ||
      std::abs(y(t) - place->row - hit.v) > e + allowance(1)) {
    return "not where the ray is";
  }
  const Real ground =
      triangles_ ? height_of_triangle(place->h, south_east(*place, t), hit.u, hit.v) : height(place->h, hit.u, hit.v);
  const Real c = z(t) - ground;
  const Real room = 2 * bound_at_rim(hit, place->h, t, 1);
  if (z(t) > high_ + room || (!hit.wall && z(t) < low_ - room)) return "not at a height of the ground";
  if (hit.wall) {
    if (!field_.settings().solid) return "a wall in a sheet";
    if (c > b) return "a wall above the ground";
    const bool at_side = std::min({hit.u, 1 - hit.u, hit.v, 1 - hit.v}) <= e;
    return at_side ? nullptr : "a wall inside the ground";
  }
  // Touches of rims have their own bound.
  const bool at_rim = std::min({hit.u, 1 - hit.u, hit.v, 1 - hit.v}) <= e;
  if (std::abs(c) > 2 * (at_rim ? std::max(b, bound_at_rim(hit, place->h, t, e)) : b)) return "not on the surface";

  if (on_surface_) {
    // At the start the clearance is zero by definition; from there on it must fall.
    const Real asked = kRoundings * kUnit *
                       (std::abs(oz_) + std::abs(dz_ * t) + std::max(std::abs(low_), std::abs(high_)) +
                        (std::abs(ox_) + std::abs(dx_ * t) + std::abs(oy_) + std::abs(dy_ * t)) * (high_ - low_));
    if (deepest(*place, t) < asked - kCounted / kRoundings * b) return "never strictly below";
  }
  // Near a hole, from which the ray may have come, only the time during which it is certainly over the cell counts.
  const Real unsure = holes_between(t, t) ? e + std::max(allowance(0), allowance(1)) : 0;
  const Real before = time_in_cell(*place, t, true, unsure);
  if (risen(*place, t, before) > 2 * b + std::abs(c)) return "a way out of the ground";
  // Above the surface where it enters the cell, by any amount, and below it here: it enters the ground.
  const Real came = t - before, u_in = x(came) - place->col, v_in = y(came) - place->row;
  const Real above =
      z(came) - (triangles_ ? height_of_triangle(place->h, u_in + v_in > 1, u_in, v_in) : height(place->h, u_in, v_in));
  if (before > 0 && above > 0) return nullptr;
  // At the entry of its cell: the ray came through the previous cell, if no other is in between.
  constexpr Real kBack = 0x1p-8L;  // of a cell
  const Real speed = std::max(std::abs(dx_), std::abs(dy_));
  if (speed > 0 && before * speed < 0x1p-20L) {
    const Real q = t - kBack / speed;
    const auto previous = q >= t0_ ? place_at(q) : std::nullopt;
    // If there is a hole within rounding, the ray may have come out of it.
    if (previous && !holes_between(t, t)) {
      const Real u = x(t) - previous->col, v = y(t) - previous->row;
      const bool reaches = std::min(u, v) >= -e && std::max(u, v) <= 1 + e;
      if (reaches &&
          risen(*previous, t, std::min(t - q, time_in_cell(*previous, q, true) + (t - q))) > 2 * b + std::abs(c))
        return "a way out of the ground";
    }
  }
  return nullptr;
}

const char* LeakJudge::false_status(const Hit& hit) const {
  if (hit || !c0_ || hugs_border()) return nullptr;
  // Only if the first cell is certain.
  if (holes_between(t0_, t0_)) return nullptr;
  const Real b = bound(t0_);
  if (hit.status == HitStatus::below && (on_surface_ || *c0_ > b)) return "began above, not below";
  if (hit.status == HitStatus::miss && !on_surface_ && *c0_ < -b) return "began below, not told";
  return nullptr;
}

std::optional<double> LeakJudge::cut_behind(const Hit& hit) const {
  const auto place = place_of(hit);
  if (!place || hit.wall) return {};
  const Real length = time_in_cell(*place, hit.t, false) / 2;
  const double t = static_cast<double>(hit.t + length);
  // Because of rounding, the ray may have left the field before.
  if (t > t1_ - early_) return {};
  const Piece f = piece(*place, hit.t, south_east(*place, hit.t + length / 2));
  if (triangles_ && south_east(*place, hit.t) != south_east(*place, t)) return {};
  if (f.b > 0 || f.b + 2 * f.a * length > 0) return {};
  if (f.f + f.b * length + f.a * length * length > -2 * bound(t)) return {};
  return t < ray_.t_max && t > hit.t ? std::optional(t) : std::nullopt;
}

std::optional<double> LeakJudge::cut_before(const Hit& hit) const {
  const auto place = place_of(hit);
  if (!place || hit.wall) return {};
  const Real length = time_in_cell(*place, hit.t, true) / 2;
  const double t = static_cast<double>(hit.t - length);
  const Piece f = piece(*place, hit.t, south_east(*place, hit.t - length / 2));
  if (triangles_ && south_east(*place, hit.t) != south_east(*place, t)) return {};
  if (f.b > 0 || f.b - 2 * f.a * length > 0) return {};
  if (f.f - f.b * length + f.a * length * length < 2 * bound(t)) return {};
  return t > ray_.t_min && t < hit.t ? std::optional(t) : std::nullopt;
}

bool LeakJudge::same(const Hit& a, const Hit& b) const {
  if (a.status != b.status) return false;
  if (!a || (a.t == b.t && a.cell == b.cell)) return true;
  for (int i = 0; i <= kProbes; ++i) {
    const Real t = a.t + (Real{b.t} - a.t) * i / kProbes;
    const auto c = clearance(t);
    if (c && std::abs(*c) > 2 * bound(t)) return a.wall && b.wall && a.cell == b.cell;
  }
  return true;
}

}  // namespace scarp::bench
