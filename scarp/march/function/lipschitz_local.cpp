// SPDX-License-Identifier: MIT
#include "scarp/march/function/lipschitz_local.h"

#include "scarp/march/function/lipschitz_local_walk.h"
#include "scarp/march/usual_ray.h"

namespace scarp {

Hit march_lipschitz_local(const HeightFunction& function, const Ray& ray, const MarchSettings& settings,
                          MarchStats* stats, FunctionUse use) {
  if (const double longest = longest_of(ray.direction); !is_usual(longest)) [[unlikely]] {
    return at_usual_length(
        ray, longest, [&](const Ray& usual) { return march_lipschitz_local(function, usual, settings, stats, use); });
  }
  LocalWalk walk(function, ray, use, settings);
  const dvec2 origin(ray.origin), direction(ray.direction);
  while (walk.question() != LocalWalk::Question::done) {
    switch (walk.question()) {
      case LocalWalk::Question::bound:
        walk.answer(function.along(origin, direction, walk.t0(), walk.t1(), use));
        break;
      case LocalWalk::Question::gain:
        walk.answer_gain(function.slope_along(origin, direction, walk.t0(), walk.t1(), use));
        break;
      default:
        walk.answer_height(function.value(origin.x + direction.x * walk.t0(), origin.y + direction.y * walk.t0(), use));
    }
  }
  if (stats) *stats = walk.stats();
  return walk.hit();
}

}  // namespace scarp
