// SPDX-License-Identifier: MIT
#include "scarp/march/height/max_mip_easy.h"

#include <algorithm>
#include <cmath>

#include "scarp/march/height/max_mip_easy_ground.h"
#include "scarp/march/ray_clip.h"

namespace scarp {
namespace {

// The part of a ray over the field, in grid units, as a host with doubles passes it to the shader source.
struct Part {
  GridRay ray;
  double begin = 0, end = 0;  // times; the longest component of ray.direction is 1 to 2
  int exponent = 0;           // t = ldexp(time, -exponent)
  bool from_border = false;   // starts at the border ...
  bool from_top = false;      // ... or where the ray descends to the highest sample
};

Part part_over(const HeightField& field, const Ray& ray) {
  Part part;
  part.ray = field.grid_from_world(ray);
  dvec3 &o = part.ray.origin, &d = part.ray.direction;
  const double longest = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
  if (longest > 0) part.exponent = std::ilogb(longest);
  for (int axis = 0; axis < 3; ++axis) d[axis] = std::ldexp(d[axis], -part.exponent);
  part.begin = std::ldexp(ray.t_min, part.exponent);
  part.end = std::ldexp(ray.t_max, part.exponent);
  if (ray.start == RayStart::on_surface) return part;
  double border = -HUGE_VAL;
  clip_to_range(0, field.cell_cols(), o.x, d.x, border, part.end);
  clip_to_range(0, field.cell_rows(), o.y, d.y, border, part.end);
  part.from_border = border >= part.begin;
  part.begin = std::max(part.begin, border);
  if (o.z + d.z * part.begin > field.max_sample()) {
    if (d.z < 0) part.begin = std::max(part.begin, (field.max_sample() - o.z) / d.z);
    if (!(d.z < 0)) part.end = -HUGE_VAL;
    part.from_top = true;
  }
  return part;
}

}  // namespace

Hit march_max_mip_easy(const HeightTarget& target, const Ray& ray, const MarchSettings&, MarchStats* stats) {
  require(target, HeightPart::pyramid);
  const HeightField& field = *target.field;
  require_field(field, HeightFields::plain, "max-mip-easy");
  if (stats) *stats = {};
  Hit hit;
  if (!field.has_cells()) return hit;
  const Part part = part_over(field, ray);
  if (!(part.begin <= part.end)) return hit;
  const bool on_surface = ray.start == RayStart::on_surface;
  easy::Ground ground(field, *target.pyramid);
  dvec3 begin = part.ray.origin + part.begin * part.ray.direction;
  if (on_surface) {
    easy::Ground::EasyHit from{};
    from.cell = {ray.start_cell.col, ray.start_cell.row};
    from.place = {std::clamp(begin.x - ray.start_cell.col, 0.0, 1.0),
                  std::clamp(begin.y - ray.start_cell.row, 0.0, 1.0)};
    from.position = {begin.x, begin.y, 0};
    begin = ground.easy_above(from);
  }
  const easy::Ground::EasyHit found =
      ground.max_mip_easy(begin, part.ray.direction, static_cast<float>(part.end - part.begin), false);
  if (stats) *stats = {.steps = static_cast<std::uint32_t>(found.steps), .cell_tests = ground.cells()};
  if (!found.hit) return hit;
  hit.t = std::ldexp(part.begin + static_cast<double>(found.t), -part.exponent);
  if (!std::isfinite(hit.t)) return {};
  hit.t = std::clamp(hit.t, ray.t_min, ray.t_max);
  if (found.below && !on_surface && !part.from_top) {
    hit.wall = field.settings().solid && part.from_border;
    if (!hit.wall) {
      Hit below;
      below.status = HitStatus::below;
      return below;
    }
  }
  hit.status = HitStatus::hit;
  hit.cell = {found.cell.x, found.cell.y};
  hit.u = static_cast<double>(found.place.x);
  hit.v = static_cast<double>(found.place.y);
  hit.height = ray.at(hit.t).z;
  return hit;
}

}  // namespace scarp
