// SPDX-License-Identifier: MIT
#include "scarp/march/sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scarp/base/error.h"
#include "scarp/march/closest_of.h"

namespace scarp {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kUnit = 0x1p-53;

bool finite(const dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// Returns when a point that starts outside, at q from the centre, enters a ball or, with q and m perpendicular to its
// axis, a cylinder. Computed at the point of closest approach: the difference of squares of a long path and a small
// radius would lose all digits.
// Source: E. Haines et al., "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems (2019).
double enter_round(const dvec3& q, const dvec3& m, double radius) {
  const double square = dot(m, m), closest = -dot(q, m) / square;
  if (!(closest > 0)) return kNever;  // away from it, or along an axis
  const double height = length(q + closest * m);
  if (height > radius) return kNever;
  return std::max(0.0, closest - std::sqrt((radius - height) * (radius + height) / square));
}

// Tests a point that moves from p by m against parts of the surface of a dilated body, each of which belongs to the
// body.
class MovingPoint {
 public:
  MovingPoint(const dvec3& p, const dvec3& m, double radius) : p_(p), m_(m), radius_(radius) {}

  double first() const { return first_; }

  void corner(const dvec3& at) { take(enter_round(p_ - at, m_, radius_)); }

  void edge(const dvec3& at, const dvec3& along) {
    const double square = dot(along, along);
    if (square == 0) return;
    const auto across = [&](const dvec3& v) { return v - dot(v, along) / square * along; };
    const dvec3 q = p_ - at;
    const double t = enter_round(across(q), across(m_), radius_);
    if (!(t < first_)) return;
    const double place = dot(q + t * m_, along);
    if (place >= 0 && place <= square) take(t);
  }

  // The triangle or, if `whole`, the parallelogram of two sides, moved out by the radius.
  void face(const dvec3& at, const dvec3& u, const dvec3& v, bool whole) {
    dvec3 n = cross(u, v);
    const double area = length(n);
    if (!(area > 0)) return;
    n /= area;
    const dvec3 q = p_ - at;
    double height = dot(n, q), rise = dot(n, m_);
    if (height < 0) height = -height, rise = -rise, n = -n;
    if (!(rise < 0) || height < radius_) return;
    const double t = (height - radius_) / -rise;
    if (!(t < first_)) return;
    const dvec3 x = q + t * m_;
    const dvec3 normal = cross(u, v) / area;
    const double along_u = dot(cross(x, v), normal) / area, along_v = dot(cross(u, x), normal) / area;
    if (along_u >= 0 && along_v >= 0 && (whole ? along_u <= 1 && along_v <= 1 : along_u + along_v <= 1)) take(t);
  }

 private:
  void take(double t) { first_ = std::min(first_, t); }

  dvec3 p_, m_;
  double radius_;
  double first_ = kNever;
};

double to_segment(const dvec3& a, const dvec3& d, const dvec3& p) {
  const double square = dot(d, d);
  const double along = square > 0 ? std::clamp(dot(p - a, d) / square, 0.0, 1.0) : 0.0;
  return length(a + along * d - p);
}

}  // namespace

void validate(const Capsule& capsule, const dvec3& motion) {
  if (!finite(capsule.a) || !finite(capsule.b)) throw Error("sweep: the ends of the capsule must be finite");
  if (!(capsule.radius >= 0 && std::isfinite(capsule.radius)))
    throw Error("sweep: the radius of the capsule must be finite and not negative");
  if (!finite(motion)) throw Error("sweep: the motion must be finite");
}

std::optional<double> sweep_time(const Capsule& capsule, const dvec3& motion, const Triangle& triangle, double last) {
  const auto& [a, b, c] = triangle;
  const dvec3 d = capsule.b - capsule.a;
  // The motion starts near the triangle, so that squares of long paths do not cancel its size.
  const double square = dot(motion, motion);
  double begin = 0;
  if (square > 0) {
    const dvec3 middle = (a + b + c) / 3.0;
    const double size =
        std::sqrt(std::max({dot(a - middle, a - middle), dot(b - middle, b - middle), dot(c - middle, c - middle)})) +
        length(d) + capsule.radius;
    const double beside = dot(middle - capsule.a, motion) / square, reach = (1 + 16 * kUnit) * size / std::sqrt(square);
    if (beside + reach < 0 || beside - reach > last) return {};
    begin = std::max(0.0, beside - reach);
  }
  const dvec3 p = capsule.a + begin * motion;
  if (closest_of_segment_and_triangle(p, d, triangle).square() <= capsule.radius * capsule.radius) return begin;
  MovingPoint point(p, motion, capsule.radius);
  const dvec3 sides[3] = {b - a, c - b, a - c};
  const bool extended = d != dvec3(0.0);
  for (int i = 0; i < 3; ++i) {
    const dvec3& corner = triangle[static_cast<std::size_t>(i)];
    point.corner(corner);
    point.edge(corner, sides[i]);
    if (!extended) continue;
    point.corner(corner - d);
    point.edge(corner - d, sides[i]);
    point.edge(corner, -d);
    point.face(corner, sides[i], -d, true);
  }
  point.face(a, b - a, c - a, false);
  if (extended) point.face(a - d, b - a, c - a, false);
  const double t = begin + point.first();
  if (!(t <= last)) return {};
  return t;
}

Contact overlap_at(const Capsule& capsule, const dvec3& motion, const ClosestPair& closest, const dvec3& n) {
  const dvec3 away = closest.first - closest.second;
  Contact contact{0, closest.second, normalize(away != dvec3(0.0) ? away : dot(n, motion) > 0 ? -n : n)};
  // The end that is farthest behind the plane leaves it last.
  const double above =
      std::min(dot(contact.normal, capsule.a - closest.second), dot(contact.normal, capsule.b - closest.second));
  contact.depth = std::max(0.0, capsule.radius - (away != dvec3(0.0) ? length(away) : std::min(above, 0.0)));
  return contact;
}

Contact contact_at(const Capsule& capsule, const dvec3& motion, const Triangle& triangle, double t) {
  const Capsule there{capsule.a + t * motion, capsule.b + t * motion, capsule.radius};
  Contact contact = overlap_at(there, motion, closest_of_segment_and_triangle(there.a, there.b - there.a, triangle),
                               cross(triangle[1] - triangle[0], triangle[2] - triangle[0]));
  contact.t = t;
  if (t > 0) contact.depth = 0;
  return contact;
}

double sweep_bound(const Capsule& capsule, const dvec3& motion, const dvec3& low, const dvec3& high, double last) {
  double begin = 0, end = last;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = capsule.a[axis], b = capsule.b[axis], m = motion[axis];
    const double wide = capsule.radius + 16 * kUnit *
                                             (std::abs(a) + std::abs(b) + std::abs(m) + capsule.radius +
                                              std::abs(low[axis]) + std::abs(high[axis]));
    // Possible positions of the segment's lower end.
    const double lowest = low[axis] - wide - std::max(0.0, b - a), highest = high[axis] + wide + std::max(0.0, a - b);
    if (m == 0) {
      if (!(a >= lowest && a <= highest)) return kNever;
      continue;
    }
    const double in = ((m > 0 ? lowest : highest) - a) / m, out = ((m > 0 ? highest : lowest) - a) / m;
    begin = std::max(begin, in), end = std::min(end, out);
  }
  if (!(begin <= end)) return kNever;
  // The ball around the box: for a small box much tighter than a box around the capsule.
  const dvec3 centre = 0.5 * (low + high), d = capsule.b - capsule.a;
  const double rounding = 64 * kUnit * (length(capsule.a) + length(d) + length(motion) + length(low) + length(high));
  const double reach = capsule.radius + 0.5 * length(high - low) + rounding;
  if (to_segment(capsule.a, d, centre) <= reach) return begin;
  MovingPoint point(capsule.a, motion, reach);
  point.corner(centre);
  if (d != dvec3(0.0)) {
    point.corner(centre - d);
    point.edge(centre, -d);
  }
  return point.first() <= end ? std::max(begin, point.first()) : kNever;
}

}  // namespace scarp
