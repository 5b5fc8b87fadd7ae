// SPDX-License-Identifier: MIT
// Converts rays over terrain functions and against distance fields to the form that the single-precision marches use
// (march/ray_states.glsl.h), and converts results back.
//
//   Ray, double ──▶ clipped to where the field can be hit, two floats per number ──▶ march in floats ──▶ Hit
#pragma once

#include "scarp/accel/function_words.h"
#include "scarp/accel/shape_words.h"
#include "scarp/march/ray_states.glsl.h"

namespace scarp {

/// A ray prepared for a single-precision march.
struct DeviceFunctionRay {
  glsl::ScarpFunctionRay ray{};
  double begin = 0;      ///< t = begin + time * per_time
  double per_time = 1;   ///< a power of two
  bool marches = false;  ///< whether there is anything to march; otherwise `known` is the result
  HitStatus known = HitStatus::miss;
};

/// `ray` must be valid (validate() of march/height/queries.h); it is followed for at most `reach` metres.
DeviceFunctionRay device_function_ray(const HeightFunction& function, const SingleRounding& rounding, const Ray& ray,
                                      FunctionUse use, double reach);

/// Prepares a ray against a distance field, clipped to the field's box. The ray's `rounding` is evaluated at its start.
DeviceFunctionRay device_shape_ray(const DistanceField& shape, const ShapeSingleRounding& rounding, const Ray& ray);
/// Error growth per metre along such a ray: the evaluation error plus the error from rounding positions to float
/// (values change by at most 1 m per m).
double shape_ray_growth(const ShapeSingleRounding& rounding);

/// Rays for RayRuns (ray_runs_vk.h) that carry their own state.
struct FunctionRays {
  using Prepared = DeviceFunctionRay;
  using Ray = glsl::ScarpFunctionRay;
  using Hit = glsl::ScarpFunctionHit;
  static Hit none() { return glsl::scarp_function_miss(); }
  static bool under_way(const Hit& hit) { return hit.status == glsl::kScarpFunctionUnderWay; }
  static void go_on(Ray& ray, const Hit& hit) { ray.state = hit.state; }
  /// Replaces `hit` by the result of a run, and adds the costs of earlier runs.
  static void add(const Hit& answer, Hit& hit) {
    const std::uint32_t bounds = hit.bounds, heights = hit.heights;
    hit = answer;
    hit.bounds += bounds;
    hit.heights += heights;
  }
  static bool is_hit(const DeviceFunctionRay& prepared, const Hit& hit) {
    return prepared.marches && hit.status == glsl::kScarpFunctionHit;
  }
};

/// Returns the result for a ray.
Hit hit_from_device(const Ray& ray, const DeviceFunctionRay& prepared, const glsl::ScarpFunctionHit& answer);

}  // namespace scarp
