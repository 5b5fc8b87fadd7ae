// SPDX-License-Identifier: MIT
// What the marches over terrain functions need of a ray: the part of it that can meet the ground, how high it is above
// the ground, and what rounding can do to that number.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "scarp/base/ray.h"
#include "scarp/field/height_function.h"

namespace scarp {

class FunctionRay {
 public:
  /// `reach` is how many metres the ray is followed at most.
  FunctionRay(const HeightFunction& function, const Ray& ray, FunctionUse use,
              double reach = std::numeric_limits<double>::infinity())
      : function_(function), ray_(ray), use_(use), speed_(length(ray.direction)) {
    t_enter = ray.t_min;
    t_exit = std::min(ray.t_max, ray.t_min + reach / speed_);
    const FunctionBound& all = function.bound_everywhere(use);
    // The ground's range, wider by what the division below can lose.
    const double slack = kRounding * (std::abs(all.low) + std::abs(all.high) + std::abs(ray.origin.z));
    clip(-kFunctionReach, kFunctionReach, ray.origin.x, ray.direction.x);
    clip(-kFunctionReach, kFunctionReach, ray.origin.y, ray.direction.y);
    begins_under = ray.start == RayStart::free && ray.origin.z + ray.direction.z * ray.t_min < all.low - slack;
    clip(all.low - slack, all.high + slack, ray.origin.z, ray.direction.z);
    if (!crosses()) return;
    rounding_ = bound(t_enter, t_exit).rounding + rounding_of_height(t_enter, t_exit);
  }

  double t_enter, t_exit;     ///< the part of the ray that is within the ground's range; empty when t_enter > t_exit
  bool begins_under = false;  ///< whether the ray begins under all ground, and comes into its range from there

  bool crosses() const { return t_enter <= t_exit && std::isfinite(t_exit) && speed_ > 0; }
  double metres_per_t() const { return speed_; }
  const Ray& ray() const { return ray_; }
  /// Metres above the ground, as computed, and how far from the truth that may be anywhere on the ray.
  double clearance(double t) const {
    return ray_.origin.z + ray_.direction.z * t -
           function_.value(ray_.origin.x + ray_.direction.x * t, ray_.origin.y + ray_.direction.y * t, use_);
  }
  double rounding() const { return rounding_; }

  SegmentBound bound(double t0, double t1) const {
    return function_.along({ray_.origin.x, ray_.origin.y}, {ray_.direction.x, ray_.direction.y}, t0, t1, use_);
  }
  /// The least and greatest rate at which the ray gains height over the ground, metres per t.
  dvec2 gain(double t0, double t1) const {
    const dvec2 slope =
        function_.slope_along({ray_.origin.x, ray_.origin.y}, {ray_.direction.x, ray_.direction.y}, t0, t1, use_);
    return {ray_.direction.z - slope.y, ray_.direction.z - slope.x};
  }
  /// What a few roundings can do to the ray's height between two times.
  double rounding_of_height(double t0, double t1) const {
    return kRounding * (std::abs(ray_.origin.z) + std::abs(ray_.direction.z) * std::max(std::abs(t0), std::abs(t1)));
  }

  Hit hit(double t) const {
    Hit hit;
    hit.status = HitStatus::hit;
    hit.t = t;
    hit.height = ray_.at(t).z;
    return hit;
  }
  Hit ended(HitStatus status, double t) const {
    Hit hit;
    hit.status = status;
    if (status == HitStatus::exhausted) hit.t = t;
    return hit;
  }

  /// The time of a crossing between t0, above the ground, and t1, on or under it, where the clearance is h1: by secants
  /// of which the end that stays is weighed less and less ("Illinois"), until the clearance is rounding or doubles end.
  double crossing(double t0, double t1, double h1, MarchStats& stats) const {
    ++stats.cell_tests;
    double h0 = clearance(t0);
    int kept = 0;
    for (int i = 0; i < kMostSecants; ++i) {
      const double t = t0 + (t1 - t0) * (h0 / (h0 - h1));
      if (!(t > t0 && t < t1)) break;
      ++stats.cell_tests;
      const double h = clearance(t);
      if (std::abs(h) <= rounding_) return t;
      if (h > 0) {
        t0 = t, h0 = h;
        if (kept == 1) h1 *= 0.5;
        kept = 1;
      } else {
        t1 = t, h1 = h;
        if (kept == -1) h0 *= 0.5;
        kept = -1;
      }
    }
    return t1;
  }

 private:
  static constexpr double kRounding = 0x1p-49;  // 16 roundings of 2^-53
  static constexpr int kMostSecants = 100;      // far more than the 10 or so that smooth ground takes

  void clip(double low, double high, double o, double d) {
    if (d == 0) {
      if (!(o >= low && o <= high)) t_exit = -std::numeric_limits<double>::infinity();
      return;
    }
    const double a = (low - o) / d, b = (high - o) / d;
    t_enter = std::max(t_enter, std::min(a, b));
    t_exit = std::min(t_exit, std::max(a, b));
  }

  const HeightFunction& function_;
  const Ray& ray_;
  FunctionUse use_;
  double speed_;
  double rounding_ = 0;
};

}  // namespace scarp
