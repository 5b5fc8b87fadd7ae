// SPDX-License-Identifier: MIT
// `max-mip` with rules on which hits count, and the other queries that share that walk: all hits, and the closest one
// by bisection. Hits from above and hits from below are found separately, and the earlier one is the result.
#include <cmath>

#include "scarp/march/height/max_mip.h"
#include "scarp/march/height/max_mip_march.h"

namespace scarp {
namespace {

using max_mip::Ask;
using max_mip::march;

// Longest time after its start at which a ray from the surface may seem to cross it there.
double rounding_of_start(const HeightTarget& target, const Ray& ray) {
  const GridRay local = target.field->grid_from_world(ray);
  if (local.direction.x == 0 && local.direction.y == 0) return 0;
  return rounding_of_node_time(*target.field, local, target.seam);
}

}  // namespace

Hit march_max_mip_bisect(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats) {
  return march<Ask::as_wanted>(target, ray, {.bisects = true, .halvings = settings.bisect.halvings}, stats);
}

Hit traced_max_mip(const HeightTarget& target, const Ray& ray, const MarchSettings&, MarchStats* stats,
                   MarchTrace& trace) {
  trace.steps.clear();
  return march<Ask::as_wanted>(target, ray, {.trace = &trace}, stats);
}

Hit traced_max_mip_bisect(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                          MarchTrace& trace) {
  trace.steps.clear();
  return march<Ask::as_wanted>(target, ray, {.bisects = true, .halvings = settings.bisect.halvings, .trace = &trace},
                               stats);
}

HitStatus all_hits_max_mip(const HeightTarget& target, const Ray& ray, std::vector<Hit>& hits) {
  hits.clear();
  return march<Ask::as_wanted>(target, ray, {.all = &hits}, nullptr).status;
}

Hit march_max_mip_by_rules(const HeightTarget& target, const Ray& ray, const HitRules& rules, MarchStats* stats) {
  require(target, HeightPart::pyramid);
  if (rules.sides == Sides::above) return march<Ask::as_wanted>(target, ray, {.accept = rules.accept}, stats);
  HitFilter leaves_start;
  const HitFilter* accept = rules.accept;
  if (rules.sides == Sides::both && ray.start == RayStart::on_surface) {
    // Whichever side the ray heads for, its start is a crossing for the other side.
    leaves_start = [&rules, started = ray.t_min + rounding_of_start(target, ray)](const Hit& hit) {
      return hit.t > started && (!rules.accept || (*rules.accept)(hit));
    };
    accept = &leaves_start;
  }
  Hit below = march<Ask::as_wanted>(target, ray, {.from_below = true, .accept = accept}, stats);
  // The ray was above the ground, so below the inverted ground: a miss.
  if (below.status == HitStatus::below) below.status = HitStatus::miss;
  if (rules.sides == Sides::below) return below;
  MarchStats of_above;
  const Hit above = march<Ask::as_wanted>(target, ray, {.accept = accept}, stats ? &of_above : nullptr);
  if (stats) {
    stats->steps += of_above.steps, stats->level_changes += of_above.level_changes;
    stats->cell_tests += of_above.cell_tests;
  }
  return below && !(above && above.t <= below.t) ? below : above;
}

}  // namespace scarp
