// SPDX-License-Identifier: MIT
#include "scarp/march/device_function_ray.h"

#include <algorithm>
#include <cmath>

#include "scarp/march/function_ray.h"

namespace scarp {
namespace {

// What pairs of floats lose of a coordinate: scarp_two_line() of march/two_float.glsl.h.
constexpr double kPair = 0x1p-43;

void split(const dvec3& value, glsl::vec3& high, glsl::vec3& low) {
  for (int axis = 0; axis < 3; ++axis) {
    high[axis] = static_cast<float>(value[axis]);
    low[axis] = static_cast<float>(value[axis] - static_cast<double>(high[axis]));
  }
}

}  // namespace

DeviceFunctionRay device_function_ray(const HeightFunction& function, const SingleRounding& rounding, const Ray& ray,
                                      FunctionUse use, double reach) {
  DeviceFunctionRay result;
  const FunctionRay part(function, ray, use, reach, FunctionRay::Unrounded{});
  if (part.begins_under) {
    result.known = HitStatus::below;
    return result;
  }
  if (!part.crosses()) return result;
  const int exponent = std::ilogb(part.metres_per_t());
  result.begin = part.t_enter;
  result.per_time = std::ldexp(1.0, -exponent);
  const dvec3 origin = ray.at(part.t_enter), end = ray.at(part.t_exit), direction = ray.direction * result.per_time;
  glsl::ScarpFunctionRay& out = result.ray;
  split(origin, out.origin, out.origin_low);
  split(direction, out.direction, out.direction_low);
  out.exit = static_cast<float>(std::ldexp(part.t_exit - part.t_enter, exponent));
  out.travelled = static_cast<float>(std::ldexp(part.t_enter - ray.t_min, exponent));
  out.speed = static_cast<float>(length(direction));
  const double farthest = std::max({std::abs(origin.x), std::abs(origin.y), std::abs(end.x), std::abs(end.y)});
  // Of the height, and of the ray's own.
  out.rounding = static_cast<float>(
      (rounding.at(farthest) + kPair * (std::abs(origin.z) + std::abs(end.z - origin.z))) * (1 + 0x1p-20));
  out.flags = ray.start == RayStart::on_surface && part.t_enter == ray.t_min ? glsl::kScarpFromSurface : 0;
  result.marches = true;
  return result;
}

Hit hit_from_device(const Ray& ray, const DeviceFunctionRay& prepared, const glsl::ScarpFunctionHit& answer) {
  Hit hit;
  if (!prepared.marches) {
    hit.status = prepared.known;
    return hit;
  }
  hit.status = answer.status == glsl::kScarpFunctionHit         ? HitStatus::hit
               : answer.status == glsl::kScarpFunctionBelow     ? HitStatus::below
               : answer.status == glsl::kScarpFunctionExhausted ? HitStatus::exhausted
                                                                : HitStatus::miss;
  if (hit.status == HitStatus::hit || hit.status == HitStatus::exhausted)
    hit.t = std::clamp(prepared.begin + static_cast<double>(answer.time) * prepared.per_time, ray.t_min, ray.t_max);
  if (hit) hit.height = ray.at(hit.t).z;
  return hit;
}

}  // namespace scarp
