// SPDX-License-Identifier: MIT
#include "scarp/march/height/patch_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scarp/march/closest_of.h"

namespace scarp {
namespace {

struct Place {
  double u, v;
};

// Newton's steps end when the next one is a fraction of the slack: its square is far below it. Places beyond kFar, in
// sides from the middle, do not come back.
constexpr int kMostSteps = 8;
constexpr double kConverged = 0x1p-4, kFar = 8;

// A body that touches the patch at `point`, beside its plane with the normal n.
struct Touch {
  dvec3 point, n;
  double radius;
  double slope;  // > 0; see below
};

// Returns whether no point of the patch is deeper than `slack` in the body. With the origin at the contact and heights
// along n, at a distance D from n:
// - The patch rises by dot(n, pu) du + dot(n, pv) dv + n.z twist du dv. The last term is at most k0 x y for horizontal
//   distances x, y, so at most k0 / 2 times the square of the horizontal distance h. Where it is positive, D^2 is at
//   least h^2 (1 - (k0 h / 2)^2): the rise is at most k D^2 / 2 with k = k0 / (1 - (k0 h / 2)^2).
// - The body is a union of balls with that radius, one of which touches the plane at the origin. The others are moved
//   from it, by s along the plane and by at least `slope` * s upwards. At D, such a ball is at least
//   slope s + (D - s)^2 / (2 radius) high. The smallest of these is D^2 / (2 radius) for D up to slope * radius, and
//   beyond it slope D - slope^2 radius / 2.
bool is_clear(const Patch& patch, const Place& at, const Touch& touch, double slack) {
  const dvec3 up(0, 0, patch.twist);
  const auto rise = [](double slope, double place) { return std::max({0.0, slope * (1 - place), -slope * place}); };
  const double tilt =
      rise(dot(touch.n, patch.along_u + at.v * up), at.u) + rise(dot(touch.n, patch.along_v + at.u * up), at.v);
  if (!(tilt <= slack / 4)) return false;
  const double x = std::abs(patch.along_u.x), y = std::abs(patch.along_v.y);
  const double k0 = std::abs(touch.n.z * patch.twist) / (x * y);
  const double bent = k0 * std::hypot(std::max(at.u, 1 - at.u) * x, std::max(at.v, 1 - at.v) * y) / 2;
  if (!(bent < 0.5)) return false;
  constexpr double kMargin = 1 + 0x1p-30;  // for rounding
  const double k = kMargin * k0 / (1 - bent * bent);
  if (!(k * touch.radius < 1)) return false;
  double reach = 0;
  for (const double u : {0.0, 1.0}) {
    for (const double v : {0.0, 1.0}) reach = std::max(reach, length(patch.at(u, v) - touch.point));
  }
  const double lies = touch.slope * touch.radius;
  return reach <= lies || touch.slope * (reach - lies / 2) >= k * reach * reach / 2;
}

class PatchSweep {
 public:
  PatchSweep(const Patch& patch, const Capsule& capsule, const dvec3& motion, double slack)
      : patch_(patch), capsule_(capsule), motion_(motion), speed_(length(motion)), slack_(slack) {}

  // Solves p(u, v) + radius * normal(u, v) = e + t * motion for u, v and t: the contact of an end within the patch.
  std::optional<PatchContact> within(double last) const {
    Place at{0.5, 0.5};
    for (int i = 0; i < kMostSteps; ++i) {
      const dvec3 up(0, 0, patch_.twist);
      const dvec3 pu = patch_.along_u + at.v * up, pv = patch_.along_v + at.u * up;
      dvec3 m = cross(pu, pv);
      double size = length(m);
      if (dot(m, motion_) > 0) size = -size;
      const dvec3 n = m / size, p = patch_.at(at.u, at.v), e = end_below(n);
      // Derivatives of the unit normal.
      const auto across = [&](const dvec3& of_m) { return (of_m - dot(n, of_m) * n) / size; };
      const dvec3 su = pu + capsule_.radius * across(cross(pu, up)), sv = pv + capsule_.radius * across(cross(up, pv));
      const dvec3 off = e - (p + capsule_.radius * n), normal = cross(su, sv);
      const double det = -dot(normal, motion_);
      if (!(std::abs(det) > 0)) return {};
      const double t = dot(normal, off) / det;
      const dvec3 rest = off + t * motion_;
      const double square = dot(normal, normal);
      const double du = dot(cross(rest, sv), normal) / square, dv = dot(cross(su, rest), normal) / square;
      if (std::abs(du) * length(pu) + std::abs(dv) * length(pv) <= kConverged * slack_) {
        const bool inside = at.u >= 0 && at.u <= 1 && at.v >= 0 && at.v <= 1;
        if (!inside || !(t >= 0 && t <= last)) return {};
        return judged({{t, p, n}}, at);
      }
      at.u += du, at.v += dv;
      if (!(std::max(std::abs(at.u - 0.5), std::abs(at.v - 0.5)) < kFar)) return {};
    }
    return {};
  }

  // The first contact with the sides, which are straight.
  std::optional<PatchContact> at_sides(double last) const {
    const dvec3 corners[] = {patch_.at(0, 0), patch_.at(1, 0), patch_.at(1, 1), patch_.at(0, 1)};
    std::optional<PatchContact> best;
    for (std::size_t i = 0; i < 4; ++i) {
      const Triangle side{corners[i], corners[(i + 1) % 4], corners[(i + 1) % 4]};
      const auto t = sweep_time(capsule_, motion_, side, best ? best->t : last);
      if (!t || (best && !(*t < best->t))) continue;
      best = PatchContact{{*t, {}, {}}};
      const ClosestPair pair =
          closest_of_segment_and_triangle(capsule_.a + *t * motion_, capsule_.b - capsule_.a, side);
      best->point = pair.second, best->normal = pair.first - pair.second;
    }
    if (!best) return {};
    const double away = length(best->normal);
    if (!(away > 0)) return {};  // the centre line touches: no normal
    best->normal /= away;
    return judged(*best, {(best->point.x - patch_.corner.x) / patch_.along_u.x,
                          (best->point.y - patch_.corner.y) / patch_.along_v.y});
  }

 private:
  const dvec3& end_below(const dvec3& n) const { return dot(n, capsule_.b - capsule_.a) < 0 ? capsule_.b : capsule_.a; }

  // Sets `proven`.
  PatchContact judged(PatchContact contact, const Place& at) const {
    contact.proven = contact.t <= 0 || is_first(contact, at);
    return contact;
  }

  // At earlier times, the capsule was the union of balls that are moved back along the motion, and along the axis.
  bool is_first(const PatchContact& contact, const Place& at) const {
    const dvec3& n = contact.normal;
    // The end touches the plane.
    const double above = dot(n, end_below(n) + contact.t * motion_ - contact.point) - capsule_.radius;
    if (!(std::abs(above) <= slack_ / 4)) return false;
    double slope = slope_along(-motion_ / speed_, n);
    const dvec3 axis = capsule_.b - capsule_.a;
    if (axis != dvec3(0.0)) slope = std::min(slope, std::abs(slope_along(axis / length(axis), n)));
    return slope > 0 && is_clear(patch_, at, {contact.point, n, capsule_.radius, slope}, slack_);
  }

  // The rise of a unit vector along n, over its length across n.
  static double slope_along(const dvec3& d, const dvec3& n) {
    const double rise = dot(d, n);
    return rise / std::max(length(d - rise * n), std::numeric_limits<double>::min());
  }

  const Patch& patch_;
  const Capsule& capsule_;
  const dvec3& motion_;
  double speed_, slack_;
};

}  // namespace

std::optional<PatchContact> patch_contact(const Patch& patch, const Capsule& capsule, const dvec3& motion, double last,
                                          double slack) {
  if (motion == dvec3(0.0)) return {};
  const PatchSweep sweep(patch, capsule, motion, slack);
  auto best = sweep.within(last);
  if (best && best->proven) return best;
  const auto beside = sweep.at_sides(best ? best->t : last);
  return beside ? beside : best;
}

PatchPoint closest_of_patch(const Patch& patch, const dvec3& p, double slack) {
  const auto at_place = [&](const Place& at) {
    const dvec3 q = patch.at(at.u, at.v), away = p - q;
    PatchPoint point{at.u, at.v, q, length(away)};
    point.proven =
        point.distance == 0 ||
        is_clear(patch, at, {q, away / point.distance, point.distance, std::numeric_limits<double>::max()}, slack);
    return point;
  };
  const dvec3 up(0, 0, patch.twist);
  Place at{0.5, 0.5};
  for (int i = 0; i < kMostSteps; ++i) {
    const dvec3 pu = patch.along_u + at.v * up, pv = patch.along_v + at.u * up, q = patch.at(at.u, at.v) - p;
    const double a = dot(pu, pu), b = dot(pu, pv) + dot(q, up), c = dot(pv, pv), det = a * c - b * b;
    if (!(det > 0)) break;
    const double gu = dot(q, pu), gv = dot(q, pv), du = (b * gv - c * gu) / det, dv = (b * gu - a * gv) / det;
    at.u += du, at.v += dv;
    if (!(std::max(std::abs(at.u - 0.5), std::abs(at.v - 0.5)) < kFar)) break;
    if (std::abs(du) * std::sqrt(a) + std::abs(dv) * std::sqrt(c) > kConverged * slack) continue;
    if (!(at.u >= 0 && at.u <= 1 && at.v >= 0 && at.v <= 1)) break;
    if (const PatchPoint point = at_place(at); point.proven) return point;
    break;
  }
  // The closest point of the sides, which are straight.
  Place best{0, 0};
  double nearest = std::numeric_limits<double>::infinity();
  for (int side = 0; side < 4; ++side) {
    const double end = side / 2;
    const bool along_u = side % 2 == 0;
    const dvec3 from = along_u ? patch.at(0, end) : patch.at(end, 0);
    const dvec3 d = (along_u ? patch.at(1, end) : patch.at(end, 1)) - from;
    const double s = std::clamp(dot(p - from, d) / dot(d, d), 0.0, 1.0), distance = length(from + s * d - p);
    if (distance < nearest) nearest = distance, best = along_u ? Place{s, end} : Place{end, s};
  }
  return at_place(best);
}

}  // namespace scarp
