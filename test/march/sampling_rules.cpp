// SPDX-License-Identifier: MIT
#include "march/sampling_rules.h"

#include <algorithm>
#include <cmath>

#include "scarp/march/height/device_ray.h"
#include "scarp/march/height/height_sampling.h"

namespace scarp::test {
namespace {

double step_of(const FixedStepSettings& settings, const HeightField& field, const Ray& ray) {
  return settings.step * std::min(field.settings().cell_x, field.settings().cell_y) / length(ray.direction);
}

// Whether rounding could change the decision at some sample of fixed-step.
bool undecided(const FixedStepSettings& settings, const HeightField& field, const Ray& ray,
               const RoundingJudge& judge) {
  const DeviceRay way = sampled_device_ray(field, ray);
  const double begin = way.begin * way.per_time, end = begin + static_cast<double>(way.ray.exit) * way.per_time;
  const double step = step_of(settings, field, ray);
  for (int i = 0; i <= settings.max_steps; ++i) {
    const double t = std::min(begin + i * step, end);
    const auto [low, high] = judge.clearance_at(t);
    if (low <= 0 && high >= 0) return true;
    if (t >= end) return false;
  }
  return false;
}

}  // namespace

std::string sampling_objection(std::string_view march, const MarchSettings& settings, const HeightField& field,
                               double slope, const Ray& ray, const RoundingJudge& judge, const Hit& hit) {
  // Lengths that doubles cannot square are beyond these marches in double, too.
  const double metres_per_t = length(ray.direction);
  if (!(metres_per_t > 0x1p-500 && std::isfinite(metres_per_t))) return {};
  const bool on_surface = ray.start == RayStart::on_surface;
  if (hit && !(hit.t >= ray.t_min && hit.t <= ray.t_max)) return "out of the ray's range";
  if (hit && !(hit.cell.col >= 0 && hit.cell.col < field.cell_cols() && hit.cell.row >= 0 &&
               hit.cell.row < field.cell_rows() && field.cell_heights(hit.cell)))
    return "a cell that does not exist";
  const double travelled = (hit.t - ray.t_min) * metres_per_t;
  const RoundingJudge::Bounds clearance = hit ? judge.clearance_at(hit.t) : RoundingJudge::Bounds{};
  if (march == "naive") {
    if (hit && clearance.low > settings.naive.tolerance * travelled) return "a hit above its tolerance";
  } else if (march == "relaxed") {
    const double tolerance = settings.relaxed.tolerance * travelled;
    if (hit && !hit.wall && !on_surface && (clearance.low > tolerance || clearance.high < -tolerance))
      return "a hit outside its tolerance";
  } else if (march == "lipschitz") {
    // A hit that a ray from the surface may step over does not count as passed.
    if (on_surface) return {};
    const double shrink = 1 / std::hypot(1.0, slope);
    if (hit.status == HitStatus::miss && !judge.may_miss()) return "passes a hit";
    // Within rounding the ray may still be on either side.
    const double near = (0x1p-20 + settings.lipschitz.tolerance) * travelled / metres_per_t;
    if ((hit || hit.status == HitStatus::exhausted) && !judge.may_pass(hit.t - near)) return "passes a hit before";
    // The distance travelled is a float.
    if (hit && !hit.wall && clearance.low > (settings.lipschitz.tolerance + 0x1p-20) * travelled / shrink)
      return "a hit above its tolerance";
    if (hit && !hit.wall && clearance.high < 0) return "a hit under the ground";
  } else if (march == "fixed-step") {
    const Hit exact = march_fixed_step({&field, nullptr}, ray, settings);
    // Between two samples the hit is as exact as their clearances: a hundredth of the step is far more.
    const bool same = hit.status == exact.status &&
                      (!hit || std::abs(hit.t - exact.t) <= 0.01 * step_of(settings.fixed_step, field, ray));
    if (!same && !undecided(settings.fixed_step, field, ray, judge)) return "another answer than in double";
  }
  return {};
}

}  // namespace scarp::test
