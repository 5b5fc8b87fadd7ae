// SPDX-License-Identifier: MIT
// From a query to the traversal of `max-mip`: handles directions of any length, fields of any sample type, and rays
// along lines.
#pragma once

#include <cmath>
#include <type_traits>
#include <vector>

#include "scarp/base/kept_memory.h"
#include "scarp/base/march_trace.h"
#include "scarp/march/height/exhaustive.h"
#include "scarp/march/height/max_mip_resume.h"
#include "scarp/march/height/max_mip_walk.h"
#include "scarp/march/usual_ray.h"

namespace scarp::max_mip {
namespace {

// A ray along a grid line belongs to the cells on both sides, where either may be a hole. Their blocks differ, so the
// pyramid is useless.
bool runs_along_line(const GridRay& ray) {
  const auto along = [&](int axis) {
    return std::isinf(1 / ray.direction[axis]) && ray.origin[axis] == std::floor(ray.origin[axis]);
  };
  return along(0) || along(1);
}

template <Ask ask>
Hit march_along_line(const HeightTarget& target, const Ray& ray, const Wanted& wanted, MarchStats* stats) {
  if (ask != Ask::as_wanted || wanted.bisects) return march_exhaustive(target, ray, {}, stats);
  Hit hit;
  KeptVector<Hit> own;
  std::vector<Hit>& hits = wanted.all ? *wanted.all : own;
  hit.status = (wanted.from_below ? all_hits_from_below_exhaustive : all_hits_exhaustive)(target, ray, hits);
  if (wanted.all) return hit;
  for (const Hit& one : hits) {
    if (!wanted.accept || (*wanted.accept)(one)) return one;
  }
  if (hit) hit.status = HitStatus::miss;
  return hit;
}

template <Ask ask>
Hit march(const HeightTarget& target, const Ray& ray, const Wanted& wanted, MarchStats* stats) {
  require(target, HeightPart::pyramid);
  const HeightField& field = *target.field;
  Hit hit;
  if (stats) *stats = {};
  if (!field.has_cells() || field.all_nodata() || !is_followable(ray)) return hit;
  const GridRay local = field.grid_from_world(ray);
  const double longest = longest_of(local.direction);
  if (!is_usual(longest)) {
    // A direction that is finite and not zero in metres may be neither in cells.
    const double length = is_direction(longest) ? longest : longest_of(ray.direction);
    if (!is_direction(length)) return hit;
    const int exponent = std::ilogb(length);
    const HitFilter accept = [&](Hit one) {
      one.t = std::ldexp(one.t, -exponent);
      return (*wanted.accept)(one);
    };
    Wanted usual = wanted;
    usual.t_clear = kNotClear;
    if (wanted.accept) usual.accept = &accept;
    // Any hit is computed as the closest hit, because its height is needed below.
    constexpr Ask with_height = ask == Ask::any ? Ask::closest : ask;
    hit = march<with_height>(target, scaled_down(ray, exponent), usual, stats);
    hit.t = std::ldexp(hit.t, -exponent);
    if (wanted.trace) wanted.trace->scale_times(exponent);
    if (wanted.all) {
      for (Hit& one : *wanted.all) one.t = std::ldexp(one.t, -exponent);
    }
    // From 10^308 cells away, positions overflow.
    if (hit && !std::isfinite(wanted.all ? wanted.all->front().height : hit.height)) {
      if (wanted.all) wanted.all->clear();
      return {};
    }
    return hit;
  }
  if (field.wraps() && !countable(local, ray)) {
    hit.status = HitStatus::exhausted;
    hit.t = ray.t_min;
    return hit;
  }
  if (field.nodata_count() > 0 && ray.start == RayStart::free && runs_along_line(local))
    return march_along_line<ask>(target, ray, wanted, stats);
  field.visit([&](const auto& grid) {
    using T = std::remove_cvref_t<decltype(grid.data[0])>;
    const auto run = [&]<bool holes, bool wraps>() {
      Walk<T, holes, wraps, ask> walk(target, grid, ray, local, wanted, hit);
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
}  // namespace scarp::max_mip
