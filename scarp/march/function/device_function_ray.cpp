// SPDX-License-Identifier: MIT
#include "scarp/march/function/device_function_ray.h"

#include <algorithm>
#include <cmath>

#include "scarp/base/two_floats.h"
#include "scarp/march/function/function_ray.h"
#include "scarp/march/ray_clip.h"

namespace scarp {
namespace {

// Rounding of a coordinate in pairs of floats: scarp_two_line() of march/two_float.glsl.h.
constexpr double kPair = 0x1p-43;

void split(const dvec3& value, glsl::vec3& high, glsl::vec3& low) {
  for (int axis = 0; axis < 3; ++axis) scarp::split(value[axis], high[axis], low[axis]);
}

// Packs the part of a ray from t_enter to t_exit, with times in units of 1 to 2 metres.
void pack(DeviceFunctionRay& result, const Ray& ray, double t_enter, double t_exit) {
  const double speed = length(ray.direction);
  const int exponent = std::ilogb(speed);
  result.begin = t_enter;
  result.per_time = std::ldexp(1.0, -exponent);
  glsl::ScarpFunctionRay& out = result.ray;
  split(ray.at(t_enter), out.origin, out.origin_low);
  split(ray.direction * result.per_time, out.direction, out.direction_low);
  out.exit = static_cast<float>(std::ldexp(t_exit - t_enter, exponent));
  out.travelled = static_cast<float>(std::ldexp(t_enter - ray.t_min, exponent));
  out.speed = static_cast<float>(speed * result.per_time);
  out.flags = ray.start == RayStart::on_surface && t_enter == ray.t_min ? glsl::kScarpFromSurface : 0;
  result.marches = true;
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
  pack(result, ray, part.t_enter, part.t_exit);
  const dvec3 begin = ray.at(part.t_enter), end = ray.at(part.t_exit);
  const double farthest = std::max({std::abs(begin.x), std::abs(begin.y), std::abs(end.x), std::abs(end.y)});
  // The rounding of the height and of the ray itself.
  result.ray.rounding = static_cast<float>(
      (rounding.at(farthest) + kPair * (std::abs(begin.z) + std::abs(end.z - begin.z))) * (1 + 0x1p-20));
  return result;
}

double shape_ray_growth(const ShapeSingleRounding& rounding) { return rounding.per_metre() + 0x1p-22; }

DeviceFunctionRay device_shape_ray(const DistanceField& shape, const ShapeSingleRounding& rounding, const Ray& ray) {
  DeviceFunctionRay result;
  const ShapeBox& box = shape.box();
  if (box.empty()) return result;
  double t_enter = ray.t_min, t_exit = ray.t_max;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = std::max(box.low[axis], -kDistanceReach), high = std::min(box.high[axis], kDistanceReach);
    // More than the rounding of the quotients below.
    const double o = ray.origin[axis], d = ray.direction[axis];
    const double slack = 0x1p-50 * (std::abs(o) + std::max(std::abs(low), std::abs(high)));
    clip_to_range(low - slack, high + slack, o, d, t_enter, t_exit);
  }
  if (!(t_exit >= ray.t_min)) return result;
  // It is known to start in the box, but rounding may place it slightly outside.
  if (ray.start == RayStart::on_surface) t_enter = ray.t_min;
  if (!(t_enter <= t_exit) || !std::isfinite(t_exit)) return result;
  pack(result, ray, t_enter, t_exit);
  const double reach = length(ray.at(t_enter));
  result.ray.rounding = static_cast<float>((rounding.at(reach) + 0x1p-22 * reach) * (1 + 0x1p-20));
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
