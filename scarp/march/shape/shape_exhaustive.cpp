// SPDX-License-Identifier: MIT
#include "scarp/march/shape/shape_exhaustive.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scarp/march/function/function_interval.h"

namespace scarp {
namespace {

using namespace judge;
using namespace shape;

using Place = std::array<Position, 3>;

// Cosines and sines are the C library's, accurate to 2 units in the last place.
Interval about(double x) { return {x - 0x1p-50, x + 0x1p-50}; }

Interval root(const Interval& square) { return sqrt(max(Interval(0.0), square)); }
Interval length_of(const Interval& x, const Interval& y) { return root(square(x) + square(y)); }
Interval length_of(const Interval& x, const Interval& y, const Interval& z) {
  return root(square(x) + square(y) + square(z));
}
Interval positive(const Interval& x) { return max(Interval(0.0), x); }

class Evaluation {
 public:
  explicit Evaluation(const Interval& t) : t_(t) {}

  Interval of(const Shape& shape, const Place& p) const {
    return std::visit([&](const auto& form) { return value(form, *shape, p); }, shape->form);
  }

 private:
  Interval at(const Place& p, int axis) const { return p[static_cast<std::size_t>(axis)].over(t_); }

  Interval value(const Sphere& s, const ShapeNode&, const Place& p) const {
    return length_of(at(p, 0), at(p, 1), at(p, 2)) - s.radius;
  }
  Interval value(const Box& b, const ShapeNode&, const Place& p) const {
    const Interval x = abs(at(p, 0)) - (Interval(b.half.x) - b.round),
                   y = abs(at(p, 1)) - (Interval(b.half.y) - b.round),
                   z = abs(at(p, 2)) - (Interval(b.half.z) - b.round);
    return length_of(positive(x), positive(y), positive(z)) + min(Interval(0.0), max(max(x, y), z)) - b.round;
  }
  Interval value(const HalfSpace& h, const ShapeNode&, const Place& p) const {
    const Interval nx(h.normal.x), ny(h.normal.y), nz(h.normal.z), size = length_of(nx, ny, nz);
    const Position along = nx * p[0] + ny * p[1] + nz * p[2];
    return along.over(t_) / size - h.height;
  }
  Interval value(const Capsule& c, const ShapeNode&, const Place& p) const {
    Place away = p;
    std::array<Interval, 3> axis;
    Position along{};
    Interval square_length(0.0);
    for (int i = 0; i < 3; ++i) {
      const auto n = static_cast<std::size_t>(i);
      axis[n] = Interval(c.to[i]) - c.from[i];
      away[n].base -= c.from[i];
      along = along + axis[n] * away[n];
      square_length += square(axis[n]);
    }
    Interval share(0.0);
    if (square_length.lower() > 0) share = max(Interval(0.0), min(Interval(1.0), along.over(t_) / square_length));
    return length_of(at(away, 0) - share * axis[0], at(away, 1) - share * axis[1], at(away, 2) - share * axis[2]) -
           c.radius;
  }
  Interval value(const Cylinder& c, const ShapeNode&, const Place& p) const {
    const Interval r = length_of(at(p, 0), at(p, 1)) - c.radius, z = abs(at(p, 2)) - c.half_height;
    return length_of(positive(r), positive(z)) + min(Interval(0.0), max(r, z));
  }
  // In the half plane of (distance from the axis, z): inside of three lines, or the distance to the nearest of the
  // three sides.
  Interval value(const Cone& c, const ShapeNode&, const Place& p) const {
    const Interval r = length_of(at(p, 0), at(p, 1)), z = at(p, 2), lean = Interval(c.radius) - c.top;
    const Interval size = length_of(lean, Interval(c.height));
    const Interval side = ((r - c.radius) * c.height + z * lean) / size;
    const Interval inside = max(side, max(-z, z - c.height));
    if (inside.upper() <= 0) return inside;
    const auto to_side = [&](double r0, double z0, double r1, double z1) {
      const Interval dr = Interval(r1) - r0, dz = Interval(z1) - z0;
      const Interval share =
          max(Interval(0.0), min(Interval(1.0), ((r - r0) * dr + (z - z0) * dz) / (square(dr) + square(dz))));
      return square(r - r0 - share * dr) + square(z - z0 - share * dz);
    };
    Interval nearest = min(to_side(0, 0, c.radius, 0), to_side(c.radius, 0, c.top, c.height));
    nearest = min(nearest, c.top > 0 ? to_side(0, c.height, c.top, c.height) : square(r) + square(z - c.height));
    const Interval outside = root(nearest);
    return inside.lower() >= 0 ? outside : hull(min(inside, Interval(0.0)), outside);
  }
  Interval value(const Torus& torus, const ShapeNode&, const Place& p) const {
    return length_of(length_of(at(p, 0), at(p, 1)) - torus.radius, at(p, 2)) - torus.tube;
  }
  Interval value(const Ellipsoid& e, const ShapeNode& node, const Place& p) const {
    const Interval norm = length_of(at(p, 0) / e.radii.x, at(p, 1) / e.radii.y, at(p, 2) / e.radii.z);
    return clamped((norm - 1.0) * std::min({e.radii.x, e.radii.y, e.radii.z}), node, p);
  }
  static Interval shrink(double slope) { return Interval(1.0) / root(Interval(1.0) + square(Interval(slope))); }
  Interval value(const FunctionGround& g, const ShapeNode& node, const Place& p) const {
    const Interval height = height_over(g.function->function(), FunctionUse::march, p[0], p[1], t_);
    return clamped((at(p, 2) - height) * shrink(g.function->bound_everywhere().slope), node, p);
  }
  Interval value(const FieldGround& g, const ShapeNode& node, const Place& p) const {
    const HeightField& field = *g.field;
    Interval x = at(p, 0), y = at(p, 1);
    Interval walls(-std::numeric_limits<double>::infinity());
    if (!field.wraps()) {
      const Interval across = max(-x, x - field.width()), along = max(-y, y - field.depth());
      walls = length_of(positive(across), positive(along)) + min(Interval(0.0), max(across, along));
      x = max(Interval(0.0), min(Interval(field.width()), x));
      y = max(Interval(0.0), min(Interval(field.depth()), y));
    }
    Interval value = max(walls, (at(p, 2) - height_of(field, x, y)) * shrink(g.slope));
    if (g.holes) value = max(value, over_hole(*g.holes, x, y));
    return clamped(value, node, p);
  }
  // Distance to the rim of the nearest hole, positive over holes, capped at the length of a cell.
  static Interval over_hole(const HeightField& field, const Interval& x, const Interval& y) {
    const HeightFieldSettings& s = field.settings();
    const double far = std::min(s.cell_x, s.cell_y);
    const Interval anything(-far, far);
    const Interval col = x / s.cell_x, row = double(field.rows() - 1) - y / s.cell_y;
    constexpr double kMostCells = 4;
    if (width(col) > kMostCells || width(row) > kMostCells) return anything;
    const int cols = field.cell_cols(), rows = field.cell_rows();
    const auto exists = [&](double c, double r) { return field.wraps() || (c >= 0 && r >= 0 && c < cols && r < rows); };
    const auto is_hole = [&](double c, double r) {
      const auto wrapped = [](double at, int count) { return static_cast<int>(at - std::floor(at / count) * count); };
      return !field.cell_heights({wrapped(c, cols), wrapped(r, rows)});
    };
    // Distance between a position along an axis and a cell on side `d` of cell `c`, in cells.
    const auto away = [](const Interval& place, double c, int d) {
      return d == 0 ? Interval(0.0) : d > 0 ? positive(c + 1.0 - place) : positive(place - c);
    };
    Interval range = Interval::empty();
    for (double r = std::floor(row.lower()); r <= std::floor(row.upper()); ++r) {
      for (double c = std::floor(col.lower()); c <= std::floor(col.upper()); ++c) {
        // The last line belongs to the cells before it.
        const double own_c = field.wraps() ? c : std::clamp(c, 0.0, cols - 1.0);
        const double own_r = field.wraps() ? r : std::clamp(r, 0.0, rows - 1.0);
        const Interval u = intersect(col, Interval(own_c, own_c + 1)), v = intersect(row, Interval(own_r, own_r + 1));
        if (empty(u) || empty(v)) continue;
        const bool hole = is_hole(own_c, own_r);
        Interval nearest(far);
        for (int dr = -1; dr <= 1; ++dr) {
          for (int dc = -1; dc <= 1; ++dc) {
            if ((dr == 0 && dc == 0) || !exists(own_c + dc, own_r + dr) || is_hole(own_c + dc, own_r + dr) == hole)
              continue;
            nearest = min(nearest, length_of(away(u, own_c, dc) * s.cell_x, away(v, own_r, dr) * s.cell_y));
          }
        }
        range = hull(range, hole ? nearest : -nearest);
      }
    }
    return empty(range) ? anything : range;
  }
  // Extremes of a bilinear cell, and of planes, are at corners of the region.
  static Interval height_of(const HeightField& field, const Interval& x, const Interval& y) {
    const HeightFieldSettings& s = field.settings();
    const Interval all(field.min_height(), field.max_height());
    const Interval col = x / s.cell_x, row = double(field.rows() - 1) - y / s.cell_y;
    constexpr double kMostCells = 4;
    if (width(col) > kMostCells || width(row) > kMostCells) return all;
    const auto first = [&](const Interval& at, int count) {
      const double cell = std::floor(at.lower());
      return field.wraps() ? cell : std::clamp(cell, 0.0, count - 1.0);
    };
    const auto last = [&](const Interval& at, int count) {
      const double cell = std::floor(at.upper());
      return field.wraps() ? cell : std::clamp(cell, 0.0, count - 1.0);
    };
    const auto wrapped = [](double at, int count) { return static_cast<int>(at - std::floor(at / count) * count); };
    const int cols = field.cell_cols(), rows = field.cell_rows();
    Interval range = Interval::empty();
    for (double r = first(row, rows); r <= last(row, rows); ++r) {
      for (double c = first(col, cols); c <= last(col, cols); ++c) {
        const auto h = field.cell_heights({wrapped(c, cols), wrapped(r, rows)});
        if (!h) return all;
        const Interval u = intersect(col - c, Interval(0, 1)), v = intersect(row - r, Interval(0, 1)), one(1.0);
        if (empty(u) || empty(v)) continue;
        for (const double cu : {u.lower(), u.upper()}) {
          for (const double cv : {v.lower(), v.upper()}) {
            const Interval a(cu), b(cv);
            if (s.surface == Surface::bilinear) {
              range =
                  hull(range, (one - a) * ((one - b) * h->h00 + b * h->h01) + a * ((one - b) * h->h10 + b * h->h11));
              continue;
            }
            // Each of the two planes whose triangle the box overlaps.
            if (u.lower() + v.lower() <= 1)
              range = hull(range, h->h00 + a * (Interval(h->h10) - h->h00) + b * (Interval(h->h01) - h->h00));
            if (u.upper() + v.upper() >= 1)
              range = hull(range,
                           h->h11 + (one - a) * (Interval(h->h01) - h->h11) + (one - b) * (Interval(h->h10) - h->h11));
          }
        }
      }
    }
    if (empty(range)) return all;
    return (range * s.scale + s.offset) * s.exaggeration;
  }

  Interval value(const Moved& m, const ShapeNode&, Place p) const {
    for (int axis = 0; axis < 3; ++axis) p[static_cast<std::size_t>(axis)].base -= m.by[axis];
    return of(m.shape, p);
  }
  Interval value(const Turned& turned, const ShapeNode&, const Place& p) const {
    // Back: by the negative angle. p cos + (n x p) sin + n (n . p) (1 - cos).
    const Interval c = about(std::cos(turned.angle)), s = -about(std::sin(turned.angle));
    const Interval size = length_of(Interval(turned.axis.x), Interval(turned.axis.y), Interval(turned.axis.z));
    const Interval n[3] = {turned.axis.x / size, turned.axis.y / size, turned.axis.z / size};
    const Position along = n[0] * p[0] + n[1] * p[1] + n[2] * p[2];
    Place q;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      q[i] = c * p[i] + (s * n[j]) * p[k] + (-(s * n[k])) * p[j] + (n[i] * (1.0 - c)) * along;
    }
    return of(turned.shape, q);
  }
  Interval value(const Scaled& s, const ShapeNode&, Place p) const {
    for (Position& axis : p) axis = (Interval(1.0) / s.factor) * axis;
    return of(s.shape, p) * s.factor;
  }
  Interval value(const Repeated& r, const ShapeNode&, const Place& p) const {
    const ShapeBox& box = r.shape->box;
    if (box.empty() || r.period == dvec3(0.0)) return of(r.shape, p);
    // For shapes that do not overlap the value is that of the nearest; for bounds it is smaller, but of the same sign.
    std::array<double, 3> from{}, to{};
    for (int axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      const double period = r.period[axis], count = r.count[i];
      if (period == 0) continue;
      const Interval away = (at(p, axis) - 0.5 * (Interval(box.low[axis]) + box.high[axis])) / period;
      from[i] = std::round(away.lower()), to[i] = std::round(away.upper());
      if (count > 0) from[i] = std::clamp(from[i], -count, count), to[i] = std::clamp(to[i], -count, count);
      from[i] -= 1, to[i] += 1;
      if (count > 0) from[i] = std::max(from[i], -count), to[i] = std::min(to[i], count);
      constexpr double kMostCopies = 8;
      if (to[i] - from[i] > kMostCopies) return {-period, std::numeric_limits<double>::infinity()};
    }
    Interval nearest(std::numeric_limits<double>::infinity());
    for (double x = from[0]; x <= to[0]; ++x) {
      for (double y = from[1]; y <= to[1]; ++y) {
        for (double z = from[2]; z <= to[2]; ++z) {
          Place copy = p;
          copy[0].base -= Interval(x) * r.period.x;
          copy[1].base -= Interval(y) * r.period.y;
          copy[2].base -= Interval(z) * r.period.z;
          nearest = min(nearest, of(r.shape, copy));
        }
      }
    }
    return nearest;
  }

  // Parts without a box are empty and are dropped.
  Interval value(const Union& u, const ShapeNode&, const Place& p) const {
    Interval all(std::numeric_limits<double>::infinity());
    bool first = true;
    for (const Shape& part : u.parts) {
      if (part->box.empty()) continue;
      const Interval one = of(part, p);
      all = first ? one : minimum(all, one, u.smooth);
      first = false;
    }
    return all;
  }
  Interval value(const Intersection& x, const ShapeNode& node, const Place& p) const {
    Interval all = of(x.parts.front(), p);
    for (std::size_t i = 1; i < x.parts.size(); ++i) all = -minimum(-all, -of(x.parts[i], p), x.smooth);
    return x.parts.size() == 1 ? all : clamped(all, node, p);
  }
  Interval value(const Subtraction& s, const ShapeNode&, const Place& p) const {
    if (s.what->box.empty()) return of(s.from, p);
    return -minimum(-of(s.from, p), of(s.what, p), s.smooth);
  }
  Interval value(const Painted& painted, const ShapeNode&, const Place& p) const { return of(painted.shape, p); }

  // Monotone in both operands.
  static Interval minimum(const Interval& a, const Interval& b, double radius) {
    if (radius == 0 || !std::isfinite(a.upper()) || !std::isfinite(b.upper()))
      return min(a, b) - Interval(0, 0.25 * radius);
    return hull(smooth(a.lower(), b.lower(), radius), smooth(a.upper(), b.upper(), radius));
  }
  // b - radius f((b - a) / radius): a parabola between the two lines, which meets them `radius` from their
  // intersection.
  static Interval smooth(double a, double b, double radius) {
    const Interval apart = abs(Interval(b) - a), short_of = positive(radius - apart);
    return std::min(a, b) - square(short_of) / (4.0 * Interval(radius));
  }

  // Outside its box a value is at least the distance to it.
  Interval clamped(const Interval& value, const ShapeNode& node, const Place& p) const {
    if (node.box.empty()) return value;
    std::array<Interval, 3> away;
    for (int axis = 0; axis < 3; ++axis) {
      Interval& a = away[static_cast<std::size_t>(axis)];
      a = Interval(0.0);
      if (std::isfinite(node.box.low[axis])) a = max(a, node.box.low[axis] - at(p, axis));
      if (std::isfinite(node.box.high[axis])) a = max(a, at(p, axis) - node.box.high[axis]);
    }
    if (away[0].upper() <= 0 && away[1].upper() <= 0 && away[2].upper() <= 0) return value;
    const Interval distance = length_of(away[0], away[1], away[2]);
    const Interval larger = max(value, distance);
    return distance.lower() > 0 ? larger : hull(value, larger);
  }

  Interval t_;
};

}  // namespace

FunctionJudgement judge_shape(const Shape& shape, const Ray& ray, int most_evaluations) {
  double t_enter = ray.t_min, t_exit = ray.t_max;
  Place place;
  for (int axis = 0; axis < 3; ++axis) {
    const double o = ray.origin[axis], d = ray.direction[axis];
    place[static_cast<std::size_t>(axis)] = {Interval(o), Interval(d), Interval(0.0)};
    if (d == 0) continue;
    const double a = (-kMostLength - o) / d, b = (kMostLength - o) / d;
    t_enter = std::max(t_enter, std::min(a, b));
    t_exit = std::min(t_exit, std::max(a, b));
  }
  return first_crossing(t_enter, t_exit, ray.t_max, most_evaluations,
                        [&](const Interval& t) { return Evaluation(t).of(shape, place); });
}

}  // namespace scarp
