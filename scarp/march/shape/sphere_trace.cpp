// SPDX-License-Identifier: MIT
#include "scarp/march/shape/sphere_trace.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scarp/march/ray_clip.h"
#include "scarp/march/usual_ray.h"

namespace scarp {
namespace {

// Shortest segment, as a fraction of the ray's part in the field's box, for any tolerance.
constexpr double kShortest = 0x1p-40;
// Linear models are followed to slightly before they reach the surface, by more than their rounding.
constexpr double kShort = 1 - 0x1p-20;
// Slightly beyond where the ray is known to be inside.
constexpr double kBeyond = 1 + 0x1p-10;
// Length factor of the next segment after a free one, and after one that is not.
constexpr double kGrowth = 2, kShrink = 0.4;
// Length of a segment relative to the previous ball.
constexpr double kCertainAhead = 4;
// Balls that grow by less, along a face for example, do not advance quickly enough.
constexpr double kGrowing = 1.125;
// Number of such balls before a segment, whose bound costs as much as about 8 values.
constexpr int kPatience = 6;

// First segment of a ray from the surface, as a fraction of all: short enough to skip most of a shape.
constexpr double kFirst = 0x1p-8;

// Which side of the surface the ray is on.
enum class Medium { outside, inside };

enum class Ended { crossing, exit, exhausted };
struct WalkEnd {
  Ended ended;
  double t;       // end; for a crossing, the last time known to be before it
  double beyond;  // for a crossing: a time after it, or t if the ray is indistinguishable from a crossing
};

class Trace {
 public:
  Trace(const DistanceField& field, const Ray& ray, const SphereTraceSettings& settings, MarchStats& stats)
      : field_(field), ray_(ray), settings_(settings), stats_(stats), speed_(length(ray.direction)) {
    t_enter_ = ray.t_min, t_exit_ = ray.t_max;
    const ShapeBox& box = field.box();
    if (box.empty()) {
      t_exit_ = -std::numeric_limits<double>::infinity();
      return;
    }
    for (int axis = 0; axis < 3; ++axis) {
      clip(std::max(box.low[axis], -kDistanceReach), std::min(box.high[axis], kDistanceReach), ray.origin[axis],
           ray.direction[axis]);
    }
    // The ray certainly starts in the box; rounding may place it slightly outside.
    if (ray.start == RayStart::on_surface) t_enter_ = ray.t_min;
    if (!crosses()) return;
    from_ = length(ray.origin);
    shortest_ = kShortest * (t_exit_ - t_enter_);
  }

  Hit closest() {
    Hit hit;
    double t = behind_ = t_enter_;
    return first_outside(t, hit) ? closest_from_outside(t) : hit;
  }

  // Returns the closest hit behind the one returned last.
  Hit next() {
    Hit hit;
    double t = behind_;
    if (emerge(t, hit)) return closest_from_outside(t);
    if (hit.status == HitStatus::below && !began_inside_) hit.status = HitStatus::miss;
    return hit;
  }

  bool any() {
    Hit hit;
    double t = t_enter_;
    if (!first_outside(t, hit)) return bool(hit);
    return follow(t, Medium::outside).ended == Ended::crossing;
  }

 private:
  static constexpr double kRounding = 0x1p-50;  // 8 roundings of 2^-53
  static constexpr int kMostSecants = 100;      // far more than the 10 or so that are taken

  bool crosses() const { return t_enter_ <= t_exit_ && speed_ > 0; }
  double value(double t) {
    ++stats_.steps;
    return field_.value(ray_.at(t));
  }
  DistanceSegment segment(double t0, double t1, bool rates) {
    ++stats_.cell_tests;
    return field_.along(ray_.origin, ray_.direction, t0, t1, rates);
  }
  // Error bound of a value at t: the position is rounded, and the value is 1-Lipschitz in it.
  double rounding(double t) const {
    const double reach = from_ + std::abs(t) * speed_;
    return field_.rounding(reach) + kRounding * reach;
  }
  bool used_up() const { return stats_.steps + stats_.cell_tests >= static_cast<std::uint32_t>(settings_.max_steps); }
  double least_at(double t) const { return std::max(shortest_, settings_.tolerance * (t - ray_.t_min)); }

  Hit hit_at(double t) const {
    Hit hit;
    hit.status = HitStatus::hit;
    hit.t = t;
    hit.height = ray_.at(t).z;
    return hit;
  }
  static Hit exhausted(double t) {
    Hit hit;
    hit.status = HitStatus::exhausted;
    hit.t = t;
    return hit;
  }

  Hit closest_from_outside(double t) {
    const WalkEnd walk = follow(t, Medium::outside);
    behind_ = walk.beyond;
    if (walk.ended == Ended::crossing) return hit_at(walk.beyond > walk.t ? crossing(walk.t, walk.beyond) : walk.t);
    if (walk.ended == Ended::exhausted) return exhausted(walk.t);
    Hit hit;
    hit.status = began_inside_ ? HitStatus::below : HitStatus::miss;
    return hit;
  }

  // Moves t to where the ray is outside for the first time. Returns false if the answer is known before, in `hit`.
  bool first_outside(double& t, Hit& hit) {
    if (!crosses()) return false;
    if (ray_.start == RayStart::on_surface) return leave(t, hit);
    const double f = value(t);
    if (f > rounding(t)) return true;
    if (f >= -rounding(t)) {
      hit = hit_at(t);
      return false;
    }
    began_inside_ = true;
    return emerge(t, hit);
  }

  // From inside: moves t to where the ray is outside. Returns false if the ray ends first, with the answer in `hit`.
  bool emerge(double& t, Hit& hit) {
    for (;;) {
      hit = Hit{};
      hit.status = HitStatus::below;
      const WalkEnd walk = follow(t, Medium::inside);
      if (walk.ended == Ended::exhausted) hit = exhausted(walk.t);
      if (walk.ended != Ended::crossing) return false;
      t = std::max(walk.beyond, walk.t + least_at(walk.t));
      if (t >= t_exit_) return false;
      // Emerging is like starting on the surface: if the ray turns back into it at once, as at the seam of two touching
      // solids, it was never outside and continues inside.
      if (leave(t, hit)) return true;
      if (!hit) return false;
    }
  }

  // From the surface: advances while the ray provably loses no more distance than rounding, until it is clear of the
  // surface. Returns false if it loses distance at once (a hit here), or at the end.
  bool leave(double& t, Hit& hit) {
    const double start = t;
    // The given start may be slightly inside: by the rounding of the ray that found the point.
    const double begin = std::min(0.0, value(t));
    double length = kFirst * (t_exit_ - t);
    while (t < t_exit_) {
      if (used_up()) {
        hit = exhausted(t);
        return false;
      }
      const DistanceSegment s = segment(t, t + length, true);
      const double rounded = rounding(t);
      if (2 * s.rate_low >= -rounded || length <= shortest_) {
        t = std::min(t + length, t_exit_);
        length *= kGrowth;
        const double f = value(t);
        if (f > 4 * rounded) return true;
        if (f < begin - 2 * rounded) {
          hit = hit_at(start);
          return false;
        }
        continue;
      }
      if (s.rate_high < -rounded) {
        hit = hit_at(start);
        return false;
      }
      length *= 0.25;
    }
    return false;
  }

  // Follows the ray along one side of the surface to its crossing: by balls while they grow, otherwise by segments.
  WalkEnd follow(double t, Medium side) {
    const double sign = side == Medium::outside ? 1 : -1;
    double length = 0;  // of the next segment
    int patience = kPatience;
    while (t < t_exit_) {
      if (used_up()) return {Ended::exhausted, t, t};
      const double free = (sign * value(t) - rounding(t)) / speed_;
      const bool grows = kCertainAhead * free > kGrowing * length;
      if (free > least_at(t) && (grows || --patience >= 0)) {
        if (grows) patience = kPatience;
        t += free;
        length = kCertainAhead * free;
        continue;
      }
      if (length == 0) length = t_exit_ - t;
      // Segments, while they are free, or longer than a ball would be.
      while (true) {
        const double end = std::min(t + length, t_exit_);
        const auto [until, sunk] = proof(segment(t, end, false), t, end, sign);
        if (until == end) {
          t = end;
          length *= kGrowth;
          break;
        }
        const double least = least_at(t);
        if (length <= least) return {Ended::crossing, t, crossed_by(t, least, sign)};
        const double gained = until - t;
        length = std::max(least, sunk < end ? std::min((sunk - until) * kBeyond, kShrink * length)
                                            : std::max(gained, kShrink * (end - until)));
        t = until;
        if (used_up()) return {Ended::exhausted, t, t};
      }
    }
    return {Ended::exit, t, t};
  }

  // Returns a time at which the surface is crossed, within a few of the last intervals; t if there is none.
  double crossed_by(double t, double least, double sign) {
    for (const double ahead : {1, 2, 4}) {
      const double end = std::min(t + ahead * least, t_exit_);
      if (sign * value(end) <= 0) return end;
    }
    return t;
  }

  // The time until which a segment is proven to be on this side, and that from which it is proven not to be, if finite.
  struct Proof {
    double until, sunk;
  };
  static Proof proof(const DistanceSegment& s, double t0, double t1, double sign) {
    Proof proof{t1, std::numeric_limits<double>::infinity()};
    if ((sign > 0 ? s.low : -s.high) > 0) return proof;
    const double begin = sign * (s.mid - s.slope) - s.rest, end = sign * (s.mid + s.slope) - s.rest;
    if (begin <= 0) {
      proof.until = t0;
    } else if (end <= 0) {
      proof.until = t0 + kShort * (t1 - t0) * begin / (begin - end);
    }
    const double begin_most = begin + 2 * s.rest, end_most = end + 2 * s.rest;
    if (end_most < 0) proof.sunk = begin_most > 0 ? t0 + (t1 - t0) * begin_most / (begin_most - end_most) : t0;
    return proof;
  }

  // Finds the crossing between t0, outside, and t1: by secants that weigh the retained end less and less ("Illinois"),
  // until the value is within rounding error or no double is left in between.
  double crossing(double t0, double t1) {
    double f0 = value(t0), f1 = value(t1);
    if (f0 <= rounding(t0)) return t0;
    int kept = 0;
    for (int i = 0; i < kMostSecants; ++i) {
      const double t = t0 + (t1 - t0) * (f0 / (f0 - f1));
      if (!(t > t0 && t < t1)) break;
      const double f = value(t);
      if (std::abs(f) <= rounding(t)) return t;
      if (f > 0) {
        t0 = t, f0 = f;
        if (kept == 1) f1 *= 0.5;
        kept = 1;
      } else {
        t1 = t, f1 = f;
        if (kept == -1) f0 *= 0.5;
        kept = -1;
      }
    }
    return t1;
  }

  void clip(double low, double high, double o, double d) {
    const double slack = kRounding * (std::abs(o) + std::max(std::abs(low), std::abs(high)));
    clip_to_range(low - slack, high + slack, o, d, t_enter_, t_exit_);
  }

  const DistanceField& field_;
  const Ray& ray_;
  const SphereTraceSettings& settings_;
  MarchStats& stats_;
  double t_enter_ = 0, t_exit_ = 0;
  double speed_;
  double from_ = 0, shortest_ = 0;
  bool began_inside_ = false;
  double behind_ = 0;  // the hit that was returned last: on the surface or inside
};

}  // namespace

Hit march_sphere_trace(const DistanceField& field, const Ray& ray, const MarchSettings& settings, MarchStats* stats) {
  if (const double longest = longest_of(ray.direction); !is_usual(longest)) [[unlikely]] {
    return at_usual_length(ray, longest,
                           [&](const Ray& usual) { return march_sphere_trace(field, usual, settings, stats); });
  }
  MarchStats counted;
  const Hit hit = Trace(field, ray, settings.sphere_trace, counted).closest();
  if (stats) *stats = counted;
  return hit;
}

Hit march_sphere_trace_filtered(const DistanceField& field, const Ray& ray, const HitFilter& accept,
                                const MarchSettings& settings, MarchStats* stats) {
  if (const double longest = longest_of(ray.direction); !is_usual(longest)) [[unlikely]] {
    return at_usual_length(ray, longest, [&](const Ray& usual) {
      const HitFilter accept_usual = [&](Hit hit) {
        hit.t = std::ldexp(hit.t, -std::ilogb(longest));
        return accept(hit);
      };
      return march_sphere_trace_filtered(field, usual, accept_usual, settings, stats);
    });
  }
  MarchStats counted;
  Trace trace(field, ray, settings.sphere_trace, counted);
  Hit hit = trace.closest();
  while (hit && !accept(hit)) hit = trace.next();
  if (stats) *stats = counted;
  return hit;
}

bool occluded_sphere_trace(const DistanceField& field, const Ray& ray, const MarchSettings& settings) {
  if (!is_usual(longest_of(ray.direction))) [[unlikely]]
    return march_sphere_trace(field, ray, settings, nullptr).status == HitStatus::hit;
  MarchStats counted;
  return Trace(field, ray, settings.sphere_trace, counted).any();
}

}  // namespace scarp
