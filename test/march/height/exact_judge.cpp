// SPDX-License-Identifier: MIT
#include "march/height/exact_judge.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace scarp::test {
namespace {

Rational floor_of(const Rational& x) {
  using boost::multiprecision::cpp_int;
  cpp_int quotient = numerator(x) / denominator(x);
  if (quotient * denominator(x) > numerator(x)) --quotient;
  return Rational(quotient);
}

struct Corners {
  Rational h00, h10, h01, h11;
};

// One axis: the ray's position and its cell, counted over all copies of the field.
struct Axis {
  Rational origin, direction;
  int cells;
  bool wraps;
  Rational cell = 0;

  bool moves() const { return direction != 0; }
  bool exists() const { return wraps || (cell >= 0 && cell < cells); }
  Rational at(const Rational& t) const { return origin + direction * t; }
  int within() const {
    const Rational copy = wraps ? floor_of(cell / cells) * cells : Rational(0);
    return static_cast<int>(cell - copy);
  }
  // Lines crossed at t are behind.
  void enter(const Rational& t) {
    const Rational position = at(t);
    cell = direction < 0 ? -floor_of(-position) - 1 : floor_of(position);
    if (!wraps) cell = std::clamp(cell, Rational(0), Rational(cells - 1));
  }
  // The copy of a cell that the ray is over.
  void enter(const Rational& t, int known) {
    cell = known;
    if (wraps) cell += floor_of((at(t) - known) / cells) * cells;
    // The next copy starts at the far side of the last cell.
    if (wraps && at(t) - cell > 1) cell += cells;
  }
  std::optional<Rational> next() const {
    if (!moves()) return {};
    return (cell + (direction > 0 ? 1 : 0) - origin) / direction;
  }
  std::optional<Rational> border(bool leaving) const {
    if (!moves() || wraps) return {};
    return ((direction > 0) == leaving ? Rational(cells) - origin : -origin) / direction;
  }
};

class Caster {
 public:
  Caster(const HeightField& field, const Ray& ray)
      : field_(field), strict_(ray.start == RayStart::on_surface), t_min_(ray.t_min) {
    const HeightFieldSettings& to = field.settings();
    const Rational scale = Rational(to.scale) * Rational(to.exaggeration);
    x_ = {Rational(ray.origin.x) / Rational(to.cell_x), Rational(ray.direction.x) / Rational(to.cell_x),
          field.cell_cols(), field.wraps()};
    y_ = {field.rows() - 1 - Rational(ray.origin.y) / Rational(to.cell_y),
          -Rational(ray.direction.y) / Rational(to.cell_y), field.cell_rows(), field.wraps()};
    z_ = (Rational(ray.origin.z) - Rational(to.offset) * Rational(to.exaggeration)) / scale;
    dz_ = Rational(ray.direction.z) / scale;
    if (std::isfinite(ray.t_max)) t_max_ = t_end_ = Rational(ray.t_max);
  }

  ExactAnswer cast(const Cell& start) {
    if (!field_.has_cells() || field_.all_nodata()) return answer_;
    Rational t = t_min_;
    bool from_outside = false;
    for (const Axis* axis : {&x_, &y_}) {
      if (field_.wraps()) continue;
      if (!axis->moves() && (axis->origin < 0 || axis->origin > axis->cells)) return answer_;
      if (const auto enter = axis->border(false)) {
        from_outside = from_outside || *enter >= t_min_;
        t = std::max(t, *enter);
      }
      if (const auto leave = axis->border(true)) t_end_ = t_end_ ? std::min(*t_end_, *leave) : *leave;
    }
    // A vertical ray is followed until it is below all ground.
    if (!t_end_) t_end_ = dz_ < 0 ? std::max(t, (Rational(field_.min_sample()) - 1 - z_) / dz_) : Rational(t + 1);
    if (t > *t_end_) return answer_;
    if (strict_) {
      x_.enter(t, start.col);
      y_.enter(t, start.row);
      side_ = Side::above;
      z_ -= clearance(corners().value(), t, south_east(t));
    } else {
      x_.enter(t);
      y_.enter(t);
    }
    if (!strict_ && !corners()) touch_around(t);
    for (bool first = true;; first = false) {
      const auto tx = x_.next(), ty = y_.next();
      const bool through_x = tx && (!ty || *tx <= *ty);
      const auto line = through_x ? tx : ty;
      // The range is closed: if it ends on a line, the ray touches the next cell.
      const bool ends = !line || *line > *t_end_ || (*line == *t_end_ && (strict_ || t_max_ != line));
      const Rational out = line ? std::min(*t_end_, *line) : *t_end_;
      choose_side_of_line();
      if (const auto h = corners()) {
        if (side_ == Side::unknown) find_side(*h, t, first, from_outside);
        if (out > t) {
          cell(*h, t, out);
        }
      } else if (out > t || !line || *line > t) {
        side_ = Side::unknown;
      }
      if (side_ == Side::unknown && !strict_ && line && out == *line) touch_around(out);
      if (ends) break;
      Axis& axis = through_x ? x_ : y_;
      axis.cell += axis.direction > 0 ? 1 : -1;
      if (!axis.exists()) break;
      t = std::max(t, *line);
    }
    if (!answer_.hits.empty()) answer_.status = HitStatus::hit;
    return answer_;
  }

 private:
  enum class Side { unknown, above, below };

  std::optional<Corners> corners() const {
    const auto h = field_.cell_heights({x_.within(), y_.within()});
    if (!h) return {};
    return Corners{Rational(h->h00), Rational(h->h10), Rational(h->h01), Rational(h->h11)};
  }
  // A ray along a line is over the cells on both sides; a cell with ground takes precedence.
  void choose_side_of_line() {
    const auto sides = [&](Axis& axis) {
      const bool along = !strict_ && !axis.moves() && floor_of(axis.origin) == axis.origin;
      std::vector<Rational> cells;
      for (const int before : {0, 1}) {
        const Rational cell = axis.origin - before;
        if (along && (axis.wraps || (cell >= 0 && cell < axis.cells))) cells.push_back(cell);
      }
      return along ? cells : std::vector{axis.cell};
    };
    for (const Rational& col : sides(x_)) {
      for (const Rational& row : sides(y_)) {
        x_.cell = col, y_.cell = row;
        if (corners()) return;
      }
    }
  }

  // Ground may touch the ray at a node, or where the ray starts on a rim.
  void touch_around(const Rational& t) {
    const Rational x = x_.at(t), y = y_.at(t);
    const auto beside = [](const Rational& place) {
      const Rational after = floor_of(place);
      return after == place ? std::vector<Rational>{after, after - 1} : std::vector{after};
    };
    const Axis way_x = x_, way_y = y_;
    for (const Rational& col : beside(x)) {
      for (const Rational& row : beside(y)) {
        x_.cell = col, y_.cell = row;
        if (!x_.exists() || !y_.exists() || side_ != Side::unknown) continue;
        const auto h = corners();
        if (!h) continue;
        if (clearance(*h, t, south_east(t)) != 0) continue;
        side_ = Side::below;
        add({t, t, 0, 0, 0, true, false});
      }
    }
    x_ = way_x, y_ = way_y;
  }

  bool triangles() const { return field_.settings().surface == Surface::triangles; }
  Rational u(const Rational& t) const { return x_.at(t) - x_.cell; }
  Rational v(const Rational& t) const { return y_.at(t) - y_.cell; }
  bool south_east(const Rational& t) const { return u(t) + v(t) > 1; }

  Rational clearance(const Corners& h, const Rational& t, bool south_east) const {
    const Rational p = u(t), q = v(t);
    Rational ground;
    if (!triangles()) {
      ground = h.h00 * (1 - p) * (1 - q) + h.h10 * p * (1 - q) + h.h01 * (1 - p) * q + h.h11 * p * q;
    } else if (south_east) {
      ground = h.h11 + (1 - p) * (h.h01 - h.h11) + (1 - q) * (h.h10 - h.h11);
    } else {
      ground = h.h00 + p * (h.h10 - h.h00) + q * (h.h01 - h.h00);
    }
    return z_ + dz_ * t - ground;
  }

  void add(ExactHit hit) { answer_.hits.push_back(std::move(hit)); }

  void find_side(const Corners& h, const Rational& t, bool first, bool from_outside) {
    const Rational in = clearance(h, t, south_east(t));
    if (in == 0 && !strict_) {
      side_ = Side::below;
      add({t, t, 0, 0, 0, true, false});
      return;
    }
    side_ = in < 0 ? Side::below : Side::above;
    if (in >= 0) return;
    if (field_.settings().solid && (!first || from_outside)) {
      add({t, t, 0, 0, 0, true, true});
    } else if (first) {
      answer_.status = HitStatus::below;
    }
  }

  void cell(const Corners& h, const Rational& begin, const Rational& end) {
    const Rational across = x_.direction + y_.direction;
    if (triangles() && across != 0) {
      const Rational parting = (x_.cell + y_.cell + 1 - x_.origin - y_.origin) / across;
      if (parting > begin && parting < end) {
        piece(h, begin, parting);
        piece(h, parting, end);
        return;
      }
    }
    piece(h, begin, end);
  }

  // The clearance over a piece is a parabola: three values determine it.
  void piece(const Corners& h, const Rational& begin, const Rational& end) {
    const Rational length = end - begin, middle = (begin + end) / 2;
    const bool half = south_east(middle);
    const Rational c = clearance(h, begin, half), m = clearance(h, middle, half), last = clearance(h, end, half);
    const Rational a = 2 * (c - 2 * m + last) / (length * length), b = (last - c) / length - a * length;
    const Rational vertex = a == 0 ? Rational(-1) : Rational(-b / (2 * a));
    const bool bends = vertex > 0 && vertex < length;
    const Rational extreme = bends ? Rational((a * vertex + b) * vertex + c) : last;
    const auto is_down = [&](const Rational& f) { return strict_ ? f < 0 : f <= 0; };
    const bool peaks = side_ == Side::below && a < 0 && bends && extreme > 0;
    const bool dips = side_ == Side::above && a > 0 && bends && is_down(extreme);
    const bool falls = dips || ((side_ == Side::above || peaks) && is_down(last));
    if (falls) add({begin, end, a, b, c, false, false});
    if (last > 0 || (peaks && !falls)) {
      side_ = Side::above;
    } else if (falls) {
      side_ = Side::below;
    }
  }

  const HeightField& field_;
  bool strict_;
  Axis x_, y_;
  Rational z_, dz_, t_min_;
  std::optional<Rational> t_end_, t_max_;
  Side side_ = Side::unknown;
  ExactAnswer answer_;
};

}  // namespace

bool ExactHit::not_after(const Rational& t) const {
  if (t < begin) return false;
  if (at_begin || t >= end) return true;
  const Rational s = t - begin, f = (a * s + b) * s + c;
  // A parabola that opens upwards falls at its lower root, one that opens downwards at its upper root.
  if (a > 0) return f <= 0 || 2 * a * s + b >= 0;
  if (a < 0) return f <= 0 && 2 * a * s + b <= 0;
  return f <= 0;
}

bool ExactHit::is_at(double t, double tolerance) const {
  return not_after(Rational(t) + Rational(tolerance)) && !not_after(Rational(t) - Rational(tolerance));
}

ExactAnswer cast_exactly(const HeightField& field, const Ray& ray) { return Caster(field, ray).cast(ray.start_cell); }

}  // namespace scarp::test
