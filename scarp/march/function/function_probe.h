// SPDX-License-Identifier: MIT
// The probe of terrain functions: the interface through which naive, fixed-step, relaxed and lipschitz sample a ray
// over one. The probe of height fields is height/height_probe.h. A function has no cells and no holes: Hit::cell stays
// empty. The ray is followed within the height range of the ground and within kFunctionReach.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "scarp/march/function/function_ray.h"
#include "scarp/march/sampling/sampling.h"
#include "scarp/march/usual_ray.h"

namespace scarp {

class FunctionProbe {
 public:
  explicit FunctionProbe(const FunctionRay& r)
      : t_enter(r.t_enter), t_exit(r.t_exit), ray_(r), per_metre_(1 / r.metres_per_t()) {}

  double t_enter, t_exit;  ///< the part of the ray that is within the ground's range

  const Ray& ray() const { return ray_.ray(); }
  double per_metre() const { return per_metre_; }
  /// Whether the ray starts where there is no ground: beyond kFunctionReach, or above all of it.
  bool from_outside() const { return t_enter > ray().t_min; }

  struct Sample {
    static constexpr bool valid = true;
    double clearance;  ///< vertical distance of the ray above the ground, in the unit of t
    double metres;     ///< the same, in metres
  };
  /// t per unit of Sample::clearance.
  static constexpr double per_clearance() { return 1; }
  Sample at(double t) const {
    const double metres = ray_.clearance(t);
    return {metres * per_metre_, metres};
  }

  Hit hit(double t, const Sample&) const { return ray_.hit(t); }
  Hit hit_before(double t, double, const Sample&) const { return ray_.hit(t); }

  /// The first step off the surface: a fraction of the exit distance, as there are no cells. lipschitz_local.h needs
  /// none.
  double blind_step() const { return 0x1p-10 * (t_exit - t_enter); }
  /// Minimum step of a ray below the ground, which may skip shorter stretches above the ground. At least what t can
  /// resolve.
  double least_step_under(double t) const { return std::max(0x1p-12 * blind_step(), 0x1p-50 * std::abs(t)); }
  /// fixed-step's step, and its minimum as a fraction of the distance travelled.
  double stride(const MarchSettings& settings) const { return settings.function.step * per_metre_; }
  double stride_share(const MarchSettings& settings) const { return settings.function.step_share; }
  static constexpr bool solid() { return false; }

  // Allows for rounding.
  bool under_ground(const Sample& sample) const { return sample.metres < -ray_.rounding(); }
  /// Returns a step that cannot reach the surface if the slope is within the bound that `shrink` assumes.
  double free_time(const Sample& sample, double shrink) const {
    const double metres = under_ground(sample) ? -sample.metres : sample.metres;
    return (metres - ray_.rounding()) * shrink / ray_.metres_per_t();
  }
  static constexpr double bounded_until(const Sample&, double) { return std::numeric_limits<double>::infinity(); }

 private:
  const FunctionRay& ray_;
  double per_metre_;
};

/// Calls march(probe, counted) if the ray can hit the ground; follows it for at most `reach` metres.
template <class March>
Hit march_over(const HeightFunction& function, const Ray& ray, FunctionUse use, double reach, MarchStats* stats,
               const March& march) {
  if (const double longest = longest_of(ray.direction); !is_usual(longest)) [[unlikely]] {
    return at_usual_length(ray, longest,
                           [&](const Ray& usual) { return march_over(function, usual, use, reach, stats, march); });
  }
  MarchStats counted;
  Hit hit;
  const FunctionRay r(function, ray, use, reach);
  if (r.begins_under) {
    hit.status = HitStatus::below;
  } else if (r.crosses()) {
    hit = march(FunctionProbe(r), counted);
  }
  if (stats) *stats = counted;
  return hit;
}

}  // namespace scarp
