// SPDX-License-Identifier: MIT
// Converts rays over terrain functions and against distance fields to the form of the marches in single precision
// (march/ray_states.glsl.h), and their results back.
//
//   Ray, double ──▶ clipped to where the field can be hit, two floats per number ──▶ march in floats ──▶ Hit
#pragma once

#include "scarp/accel/function_words.h"
#include "scarp/accel/shape_words.h"
#include "scarp/march/ray_states.glsl.h"

namespace scarp {

/// A ray on its way to a march in single precision.
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

/// The same against a distance field: clipped to its box. `rounding` of the ray is the one at its start.
DeviceFunctionRay device_shape_ray(const DistanceField& shape, const ShapeSingleRounding& rounding, const Ray& ray);
/// Growth of the error of values per metre of such a ray: of the values themselves, and of positions rounded to floats,
/// which change values by a metre per metre.
double shape_ray_growth(const ShapeSingleRounding& rounding);

/// Rays of RayRuns (ray_runs_vk.h) whose states travel with them.
struct FunctionRays {
  using Prepared = DeviceFunctionRay;
  using Ray = glsl::ScarpFunctionRay;
  using Hit = glsl::ScarpFunctionHit;
  static Hit none() { return glsl::scarp_function_miss(); }
  static bool under_way(const Hit& hit) { return hit.status == glsl::kScarpFunctionUnderWay; }
  static void go_on(Ray& ray, const Hit& hit) { ray.state = hit.state; }
  /// The result of a run, with the costs of earlier runs.
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
