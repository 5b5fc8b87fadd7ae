// SPDX-License-Identifier: MIT
#include "scarp/march/lipschitz.h"

#include <algorithm>
#include <cmath>

#include "scarp/base/error.h"
#include "scarp/march/height/ground.h"

namespace scarp {
namespace {

// The largest block of the pyramid round a cell that has no hole; level 0 is the cell.
int hole_free_level(const MaxPyramid& pyramid, Cell cell) {
  int level = 0;
  while (level < pyramid.top_level()) {
    const MaxPyramid::Level& next = pyramid.levels()[static_cast<std::size_t>(level)];
    const std::ptrdiff_t row = cell.row >> (level + 1), col = cell.col >> (level + 1);
    if (pyramid.minima()[next.begin + row * next.cols + col] == MaxPyramid::kNoMinimum) break;
    ++level;
  }
  return level;
}

template <class T>
Hit march(const Ground<T>& ground, const HeightTarget& target, const Ray& ray, const LipschitzSettings& settings,
          double shrink, MarchStats& stats) {
  Hit hit;
  if (!ground.crosses()) return hit;
  const bool has_holes = target.field->nodata_count() > 0;
  const double per_metre = 1 / ground.metres_per_t();
  const bool on_surface = ray.start == RayStart::on_surface;
  double t = ground.t_enter + (on_surface ? ground.cell_time() : 0.0);
  for (int step = 0; t <= ground.t_exit; ++step) {
    if (step == settings.max_steps) {
      hit.status = HitStatus::exhausted;
      hit.t = t;
      return hit;
    }
    ++stats.steps;
    const auto sample = ground.at(t);
    if (!sample.valid) {
      t = ground.leave_time(sample.cell, 0, t);
      continue;
    }
    const double free = sample.clearance * shrink * per_metre;
    if (sample.clearance < 0) {
      // Under the ground: there from the start, or out of a hole.
      if (on_surface && step == 0) return ground.hit(t, sample);
      if (target.field->settings().solid && t > ray.t_min) {
        hit = ground.hit(t, sample);
        hit.wall = true;
        return hit;
      }
      hit.status = step == 0 ? HitStatus::below : HitStatus::exhausted;
      if (hit.status == HitStatus::exhausted) hit.t = t;
      return hit;
    }
    if (free <= settings.tolerance * (t - ray.t_min)) return ground.hit(t, sample);
    const double next = t + free;
    t = has_holes ? std::min(next, ground.leave_time(sample.cell, hole_free_level(*target.pyramid, sample.cell), t))
                  : next;
  }
  return hit;
}

}  // namespace

Hit march_lipschitz(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats) {
  MarchStats counted;
  Hit hit;
  double shrink = settings.lipschitz.shrink;
  if (shrink == 0) {
    if (std::isnan(target.slope))
      throw Error("lipschitz: neither the field's slope bound (HeightTarget::slope) nor a shrink factor is given");
    shrink = 1 / std::hypot(1.0, target.slope);
  }
  if (target.field->has_cells() && !target.field->all_nodata()) {
    hit = target.field->visit([&](const auto& grid) {
      return march(Ground(*target.field, grid, ray), target, ray, settings.lipschitz, shrink, counted);
    });
  }
  if (stats) *stats = counted;
  return hit;
}

}  // namespace scarp
