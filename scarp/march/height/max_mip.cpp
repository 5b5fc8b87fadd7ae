// SPDX-License-Identifier: MIT
#include "scarp/march/height/max_mip.h"

#include <algorithm>
#include <cmath>

#include "scarp/march/height/exhaustive.h"
#include "scarp/march/height/max_mip_resume.h"
#include "scarp/march/height/max_mip_walk.h"
#include "scarp/march/usual_ray.h"

namespace scarp {
namespace {

using max_mip::Ask;
using max_mip::kNotClear;

// Beyond this many cells doubles cannot distinguish neighbouring cells.
constexpr double kFarthestCell = 0x1p51;

// A ray along a grid line belongs to the cells on both sides, where either may be a hole. Their blocks differ, so the
// pyramid is of no use.
bool runs_along_line(const GridRay& ray) {
  const auto along = [&](int axis) {
    return ray.direction[axis] == 0 && ray.origin[axis] == std::floor(ray.origin[axis]);
  };
  return along(0) || along(1);
}

template <Ask ask>
Hit march_along_line(const HeightTarget& target, const Ray& ray, MarchStats* stats, std::vector<Hit>* all) {
  if constexpr (ask != Ask::all) return march_exhaustive(target, ray, {}, stats);
  Hit hit;
  hit.status = all_hits_exhaustive(target, ray, *all);
  return hit;
}

template <Ask ask>
Hit march(const HeightTarget& target, const Ray& ray, int halvings, double t_clear, MarchStats* stats,
          std::vector<Hit>* all) {
  require(target, HeightPart::pyramid);
  const HeightField& field = *target.field;
  Hit hit;
  if (stats) *stats = {};
  if (!field.has_cells() || field.all_nodata()) return hit;
  const GridRay local = field.grid_from_world(ray);
  const double longest = longest_of(local.direction);
  if (!is_usual(longest)) {
    if (!is_direction(longest)) return hit;
    const int exponent = std::ilogb(longest);
    hit = march<ask>(target, scaled_down(ray, exponent), halvings, kNotClear, stats, all);
    hit.t = std::ldexp(hit.t, -exponent);
    if (all) {
      for (Hit& one : *all) one.t = std::ldexp(one.t, -exponent);
    }
    return hit;
  }
  if (field.wraps() && !max_mip::countable(local, ray)) {
    hit.status = HitStatus::exhausted;
    hit.t = ray.t_min;
    return hit;
  }
  if (field.nodata_count() > 0 && ray.start == RayStart::free && runs_along_line(local))
    return march_along_line<ask>(target, ray, stats, all);
  field.visit([&](const auto& grid) {
    using T = std::remove_cvref_t<decltype(grid.data[0])>;
    const auto run = [&]<bool holes, bool wraps>() {
      max_mip::Walk<T, holes, wraps, ask> walk(target, grid, ray, local, halvings, t_clear, hit, all);
      walk.run();
      if (stats) *stats = walk.stats;
    };
    if (field.wraps()) {
      grid.has_holes ? run.template operator()<true, true>() : run.template operator()<false, true>();
    } else {
      grid.has_holes ? run.template operator()<true, false>() : run.template operator()<false, false>();
    }
  });
  return hit;
}

}  // namespace

bool max_mip::countable(const GridRay& local, const Ray& ray) {
  for (const double t : {ray.t_min, ray.t_max}) {
    for (int axis = 0; axis < 2; ++axis) {
      if (!(std::abs(local.origin[axis] + local.direction[axis] * t) < kFarthestCell)) return false;
    }
  }
  return std::abs(local.origin.x) < kFarthestCell && std::abs(local.origin.y) < kFarthestCell;
}

Hit march_max_mip(const HeightTarget& target, const Ray& ray, const MarchSettings&, MarchStats* stats) {
  return march<Ask::closest>(target, ray, 0, kNotClear, stats, nullptr);
}

Hit march_max_mip_bisect(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats) {
  return march<Ask::bisected>(target, ray, settings.bisect.halvings, kNotClear, stats, nullptr);
}

bool occluded_max_mip(const HeightTarget& target, const Ray& ray) {
  return march<Ask::any>(target, ray, 0, kNotClear, nullptr, nullptr).status == HitStatus::hit;
}

Hit resume_max_mip(const HeightTarget& target, const Ray& ray, double t_clear) {
  return march<Ask::closest>(target, ray, 0, t_clear, nullptr, nullptr);
}

bool resume_occluded_max_mip(const HeightTarget& target, const Ray& ray, double t_clear) {
  return march<Ask::any>(target, ray, 0, t_clear, nullptr, nullptr).status == HitStatus::hit;
}

SurfaceStart start_max_mip(const HeightTarget& target, const Ray& ray) {
  require(target, HeightPart::pyramid);
  const HeightField& field = *target.field;
  const GridRay local = field.grid_from_world(ray);
  SurfaceStart start;
  if (!is_usual(longest_of(local.direction))) {
    start.decided = true;
    start.hit = march_max_mip(target, ray);
    return start;
  }
  Hit hit;
  field.visit([&](const auto& grid) {
    using T = std::remove_cvref_t<decltype(grid.data[0])>;
    const auto first_cell = [&]<bool holes>() {
      using Walk = max_mip::Walk<T, holes, false, Ask::closest>;
      start = Walk(target, grid, ray, local, 0, kNotClear, hit, nullptr).start();
    };
    grid.has_holes ? first_cell.template operator()<true>() : first_cell.template operator()<false>();
  });
  start.hit = hit;
  return start;
}

HitStatus all_hits_max_mip(const HeightTarget& target, const Ray& ray, std::vector<Hit>& hits) {
  hits.clear();
  return march<Ask::all>(target, ray, 0, kNotClear, nullptr, &hits).status;
}

}  // namespace scarp
