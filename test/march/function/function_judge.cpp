// SPDX-License-Identifier: MIT
#include "march/function/function_judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scarp/march/function/function_ray.h"
#include "scarp/march/function/lipschitz_local.h"

namespace scarp::test {
namespace {

// Twice the rounding of a time to float, relative.
constexpr double kTime = 0x1p-23;

Ray moved(Ray ray, double metres) {
  ray.origin.z += metres;
  return ray;
}
double clearance(const HeightFunction& function, const Ray& ray, double t) {
  const dvec3 p = ray.at(t);
  return p.z - function.value(p.x, p.y);
}

// No hit is passed: a hit of a higher ray is also hit, and no later.
std::string objection_to_loss(const HeightFunction& function, const Ray& ray, double delta, const Hit& hit,
                              double late) {
  const Hit met = march_lipschitz_local(function, moved(ray, delta));
  if (!met || hit.status == HitStatus::exhausted) return {};
  if (!hit) return fmt::format("lost a crossing at t = {}", met.t);
  if (hit.t > met.t + late) return fmt::format("hit at t = {}, after a crossing at t = {}", hit.t, met.t);
  return {};
}

// At a hit, the test of an approximate march holds.
std::string objection_to_place(const HeightFunction& function, const Ray& ray, double delta, const Hit& hit,
                               double limit) {
  if (!hit) return {};
  const double h = clearance(function, ray, hit.t);
  return h <= limit + delta ? "" : fmt::format("a hit {} m above the ground, where {} are allowed", h, limit + delta);
}

}  // namespace

std::string function_objection(std::string_view march, const MarchSettings& settings, const HeightFunction& function,
                               const Ray& ray, double delta, const Hit& hit) {
  const double speed = length(ray.direction), way = (hit ? hit.t : 0) - ray.t_min;
  if (march == "lipschitz-local") {
    const double late = (2 * settings.lipschitz_local.tolerance + kTime) * way;
    if (const std::string lost = objection_to_loss(function, ray, delta, hit, late); !lost.empty()) return lost;
    const Hit lower = march_lipschitz_local(function, moved(ray, -delta));
    if (hit && lower.status == HitStatus::miss) return fmt::format("a hit at t = {} where there is none", hit.t);
    if (hit && lower && hit.t < lower.t - late)
      return fmt::format("hit at t = {}, before the crossing at t = {}", hit.t, lower.t);
    return {};
  }
  if (march == "lipschitz") {
    if (const std::string lost = objection_to_loss(function, ray, delta, hit, kTime * way); !lost.empty()) return lost;
    const double steep = std::hypot(1.0, function.bound_everywhere().slope);
    return objection_to_place(function, ray, delta, hit, 1.001 * settings.lipschitz.tolerance * way * speed * steep);
  }
  if (march == "naive")
    return objection_to_place(function, ray, delta, hit, (1 + kTime) * settings.naive.tolerance * way * speed);
  if (march == "relaxed")
    return objection_to_place(function, ray, delta, hit, (1 + kTime) * settings.relaxed.tolerance * way * speed);
  // fixed-step: points are counted, so they equal those in double.
  const FunctionRay part(function, ray, FunctionUse::march, settings.function.reach, FunctionRay::Unrounded{});
  const double step = settings.function.step / speed;
  if (!part.crosses() || part.clearance(part.t_enter) <= delta) return {};
  double nearest = delta;  // of the points around the hit
  for (int i = 0; i < settings.fixed_step.max_steps; ++i) {
    const double t = std::min(part.t_enter + i * step, part.t_exit), h = part.clearance(t);
    if (hit && std::abs(t - hit.t) <= step * (1 + kTime)) nearest = std::min(nearest, h - delta);
    if (h < -delta && !(hit && hit.t <= t + kTime * (t - ray.t_min)))
      return fmt::format("passed a point {} m under the ground at t = {}", -h, t);
    if (t == part.t_exit || (hit && t > hit.t + step)) break;
  }
  return hit && nearest > 0 ? fmt::format("a hit at t = {}, where no point is on the ground", hit.t) : "";
}

}  // namespace scarp::test
