// SPDX-License-Identifier: MIT
// A ray over a terrain function: the part of it that can hit the ground, its height above the ground, and the rounding
// error of that number.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "scarp/base/ray.h"
#include "scarp/field/height_function.h"
#include "scarp/march/ray_clip.h"

namespace scarp {

class FunctionRay {
 public:
  struct Unrounded {};

  FunctionRay() = default;
  /// `reach` is the maximum distance along the ray, in metres.
  FunctionRay(const HeightFunction& function, const Ray& ray, FunctionUse use,
              double reach = std::numeric_limits<double>::infinity())
      : FunctionRay(function, ray, use, reach, Unrounded{}) {
    if (crosses()) set_rounding(bound(t_enter, t_exit));
  }
  /// Without rounding(), for callers that compute the bound along the whole ray themselves and set it.
  FunctionRay(const HeightFunction& function, const Ray& ray, FunctionUse use, double reach, Unrounded)
      : function_(&function), ray_(&ray), use_(use), speed_(length(ray.direction)) {
    t_enter = ray.t_min;
    t_exit = std::min(ray.t_max, ray.t_min + reach / speed_);
    const FunctionBound& all = function.bound_everywhere(use);
    // The ground's range, widened by the rounding of the division below.
    const double slack = kRounding * (std::abs(all.low) + std::abs(all.high) + std::abs(ray.origin.z));
    clip(-kFunctionReach, kFunctionReach, ray.origin.x, ray.direction.x);
    clip(-kFunctionReach, kFunctionReach, ray.origin.y, ray.direction.y);
    begins_under = ray.start == RayStart::free && ray.origin.z + ray.direction.z * ray.t_min < all.low - slack;
    clip(all.low - slack, all.high + slack, ray.origin.z, ray.direction.z);
  }
  void set_rounding(const SegmentBound& whole) { rounding_ = whole.rounding + rounding_of_height(t_enter, t_exit); }

  double t_enter = 0,
         t_exit = 0;          ///< the part of the ray that is within the ground's range; empty if t_enter > t_exit
  bool begins_under = false;  ///< whether the ray starts below all ground, and enters its range from there

  bool crosses() const { return t_enter <= t_exit && std::isfinite(t_exit) && speed_ > 0; }
  double metres_per_t() const { return speed_; }
  const Ray& ray() const { return *ray_; }
  /// Computed height above the ground in metres, and its maximum error anywhere on the ray.
  double clearance(double t) const {
    const dvec3 p = ray_->at(t);
    return p.z - function_->value(p.x, p.y, use_);
  }
  double rounding() const { return rounding_; }

  SegmentBound bound(double t0, double t1) const {
    return function_->along(dvec2(ray_->origin), dvec2(ray_->direction), t0, t1, use_);
  }
  /// Rounding error of the ray's height between two times.
  double rounding_of_height(double t0, double t1) const {
    return kRounding * (std::abs(ray_->origin.z) + std::abs(ray_->direction.z) * std::max(std::abs(t0), std::abs(t1)));
  }

  Hit hit(double t) const {
    Hit hit;
    hit.status = HitStatus::hit;
    hit.t = t;
    hit.height = ray_->at(t).z;
    return hit;
  }
  Hit ended(HitStatus status, double t) const {
    Hit hit;
    hit.status = status;
    if (status == HitStatus::exhausted) hit.t = t;
    return hit;
  }

 private:
  static constexpr double kRounding = 0x1p-49;  // 16 roundings of 2^-53

  void clip(double low, double high, double o, double d) { clip_to_range(low, high, o, d, t_enter, t_exit); }

  const HeightFunction* function_ = nullptr;
  const Ray* ray_ = nullptr;
  FunctionUse use_ = FunctionUse::march;
  double speed_ = 0;
  double rounding_ = 0;
};

}  // namespace scarp
