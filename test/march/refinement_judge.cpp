// SPDX-License-Identifier: MIT
#include "march/refinement_judge.h"

#include <cmath>

#include "march/height/spiteful.h"
#include "scarp/march/height/exhaustive.h"

namespace scarp::test {
namespace {

constexpr int kRays = 400;
constexpr double kNear = 2;  // in cells: within the same crossing, not an earlier one that the march has passed

// Height above the ground that counts as a hit, per distance.
double tolerance_of(std::string_view march, const MarchSettings& settings) {
  return march == "naive" ? settings.naive.tolerance : march == "relaxed" ? settings.relaxed.tolerance : 0;
}

double clearance(const HeightField& field, const Ray& ray, double t) {
  const dvec3 p = ray.at(t);
  return p.z - field.height(p.x, p.y).value_or(NAN);
}

}  // namespace

RefinementErrors refinement_errors(std::string_view march, Refinement refinement, const CastAll& cast) {
  const HeightField field = hills(257, 257, Surface::bilinear);
  Random random(31);
  std::vector<Ray> rays;
  for (int i = 0; i < kRays; ++i) {
    Ray ray = along_hills(field, random, false);
    ray.origin.z += 5;
    ray.direction.z = uniform(random, -0.6, -0.05);
    rays.push_back(ray);
  }
  MarchSettings settings;
  settings.fixed_step.interpolate = false;
  const std::vector<Hit> plain = cast(field, rays, settings);
  settings.sampling.refinement = refinement;
  const std::vector<Hit> refined = cast(field, rays, settings);
  const double tolerance = tolerance_of(march, settings);
  RefinementErrors errors;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!plain[i] || !refined[i]) continue;
    const Ray& ray = rays[i];
    const double speed = length(ray.direction);
    const auto off = [&](double t) {
      // relaxed may come from below.
      const double h = clearance(field, ray, t);
      return std::abs((march == "relaxed" ? std::abs(h) : h) - tolerance * speed * t);
    };
    ++errors.hits;
    errors.plain += off(plain[i].t) <= kRefinedTo;
    errors.refined += off(refined[i].t) <= kRefinedTo;
    // The ray reaches the limit where a ray lower by the limit meets the ground.
    Ray lower = ray;
    lower.direction.z -= tolerance * speed;
    const Hit judge = march_exhaustive({&field}, lower);
    if (!judge || std::abs(plain[i].t - judge.t) * speed > kNear || clearance(field, ray, plain[i].t) < -kNear)
      continue;
    if (march == "relaxed" && clearance(field, ray, refined[i].t) < 0) continue;
    errors.along_plain += std::abs(plain[i].t - judge.t) * speed;
    errors.along_refined += std::abs(refined[i].t - judge.t) * speed;
  }
  return errors;
}

}  // namespace scarp::test
