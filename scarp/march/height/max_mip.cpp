// SPDX-License-Identifier: MIT
#include "scarp/march/height/max_mip.h"

#include <algorithm>
#include <cmath>

#include "scarp/march/height/max_mip_ahead.h"
#include "scarp/march/height/max_mip_march.h"
#include "scarp/march/height/max_mip_resume.h"
#include "scarp/march/height/short_rays.h"

namespace scarp {
namespace {

using max_mip::Ahead;
using max_mip::Ask;
using max_mip::march;

// Beyond this many cells doubles cannot distinguish neighbouring cells.
constexpr double kFarthestCell = 0x1p51;
// Rays over less than this many cells are faster in the scalar traversal (scarp-bench calls).
constexpr double kFewCells = 4;

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
  return march<Ask::closest>(target, ray, {}, stats);
}

bool occluded_max_mip(const HeightTarget& target, const Ray& ray) {
  require(target, HeightPart::pyramid);
  double t_clear = max_mip::kNotClear;
  if (ray.start == RayStart::free && !max_mip::crosses_few_cells(*target.field, ray, kFewCells) &&
      max_mip::looks_ahead(target)) {
    const Ahead ahead = max_mip::look_ahead(target, ray, t_clear);
    if (ahead != Ahead::open) return ahead == Ahead::hit;
  }
  return resume_occluded_max_mip(target, ray, t_clear);
}

Hit resume_max_mip(const HeightTarget& target, const Ray& ray, double t_clear) {
  return march<Ask::closest>(target, ray, {.t_clear = t_clear}, nullptr);
}

bool resume_occluded_max_mip(const HeightTarget& target, const Ray& ray, double t_clear) {
  return march<Ask::any>(target, ray, {.t_clear = t_clear}, nullptr).status == HitStatus::hit;
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
      start = Walk(target, grid, ray, local, {}, hit).start();
    };
    grid.has_holes ? first_cell.template operator()<true>() : first_cell.template operator()<false>();
  });
  start.hit = hit;
  return start;
}

}  // namespace scarp
