// SPDX-License-Identifier: MIT
#include "scarp/march/height/device_ray.h"

#include <algorithm>
#include <cmath>

#include "scarp/accel/ground_buffers.glsl.h"
#include "scarp/base/two_floats.h"
#include "scarp/march/height/grid_axis.h"
#include "scarp/march/height/rim_time.h"
#include "scarp/march/ray_clip.h"
#include "scarp/march/usual_ray.h"

namespace scarp {
namespace {

// A ray that moves by less than this, in cells, over its whole length counts as not moving: far below the resolution of
// floats in a cell.
constexpr double kStandstill = 0x1p-40;
// Slope, in sample units per cell, beyond which a ray counts as vertical: floats cannot represent more.
constexpr double kSteepest = 0x1p80;
constexpr double kUnit = 0x1p-53;
// Positions up to which doubles resolve neighbouring cells well enough.
constexpr double kFarthestCell = 0x1p40;

struct TwoFloats {
  float high, low;
};

TwoFloats two_floats(double x) {
  TwoFloats sum{};
  split(x, sum.high, sum.low);
  return sum;
}

// The part of a ray that counts as over the field along one axis: including the allowance of the border, within which a
// nearly vertical ray may descend to it.
template <bool Wraps>
struct AxisTimes {
  double enter, exit;
  AxisTimes(const GridAxis<Wraps>& axis, double seam) {
    const double off = seam + HeightField::rounding_of_line(axis.origin, axis.cells);
    const double late = axis.moves() ? off * std::abs(axis.per_direction) : 0;
    enter = axis.enter_time() - late, exit = axis.exit_time() + late;
    if (!axis.moves() && !(axis.origin >= -off && axis.origin <= axis.cells + off)) exit = -HUGE_VAL;
  }
};

// Packs a ray, with two floats per number. Times beyond kScarpNever are stored as kScarpNever.
void pack(glsl::ScarpRay& out, Cell cell, dvec2 place, double height, const dvec3& direction, double length) {
  // A ray that does not move along an axis stays in its cell.
  constexpr double kInCell = 1 - 0x1p-24;
  for (int axis = 0; axis < 2; ++axis) {
    if (direction[axis] == 0) place[axis] = std::min(place[axis], kInCell);
  }
  const TwoFloats u = two_floats(place.x), v = two_floats(place.y), z = two_floats(height);
  out.cell = {cell.col, cell.row};
  out.place = {u.high, v.high};
  out.place_low = {u.low, v.low};
  for (int axis = 0; axis < 3; ++axis) {
    const TwoFloats d = two_floats(direction[axis]);
    out.direction[axis] = d.high;
    out.direction_low[axis] = d.low;
    if (axis < 2) {
      const double never{glsl::kScarpNever};
      out.per_direction[axis] =
          static_cast<float>(direction[axis] == 0 ? never : std::clamp(1 / direction[axis], -never, never));
    }
  }
  const TwoFloats end = two_floats(std::min(length, double{glsl::kScarpNever}));
  out.z = z.high;
  out.z_low = z.low;
  out.end = end.high;
  out.end_low = end.low;
}

// A ray for max-mip.
template <bool Wraps>
DeviceRay on_grid(const HeightField& field, const Ray& ray, double seam) {
  DeviceRay result;
  GridRay local = field.grid_from_world(ray);
  // The longer horizontal component, or that of a vertical ray, is scaled to 1 to 2 by a power of two, which is exact.
  double speed = std::max(std::abs(local.direction.x), std::abs(local.direction.y));
  if (speed == 0) speed = std::abs(local.direction.z);
  if (!(speed > 0) || !std::isfinite(speed)) return result;
  const int exponent = std::ilogb(speed);
  for (int axis = 0; axis < 3; ++axis) local.direction[axis] = std::ldexp(local.direction[axis], -exponent);
  const double first = std::ldexp(ray.t_min, exponent), last = std::ldexp(ray.t_max, exponent);
  result.per_time = std::ldexp(1.0, -exponent);
  const bool strict = ray.start == RayStart::on_surface;
  glsl::ScarpRay& out = result.ray;
  std::uint32_t flags = 0;

  if constexpr (Wraps) {
    for (int axis = 0; axis < 2; ++axis) {
      for (const double t : {first, last}) {
        if (!(std::abs(local.origin[axis] + local.direction[axis] * t) < kFarthestCell)) {
          result.known = HitStatus::exhausted;
          result.begin = first;
          return result;
        }
      }
    }
  }
  GridAxis<Wraps> x(local.origin.x, local.direction.x, field.cell_cols());
  GridAxis<Wraps> y(local.origin.y, local.direction.y, field.cell_rows());
  double begin = first, end = last, way = last;
  Cell cell = ray.start_cell;
  if (strict) {
    x.begin_in(cell.col, begin);
    y.begin_in(cell.row, begin);
    flags |= glsl::kScarpOnSurface;
  }
  const AxisTimes<Wraps> across_x(x, seam), across_y(y, seam);
  if constexpr (!Wraps) {
    const double border = std::max(across_x.enter, across_y.enter);
    way = std::min({last, across_x.exit, across_y.exit});
    if (!(way > -HUGE_VAL)) return result;
    if (!strict) {
      if (border >= begin) flags |= glsl::kScarpFromOutside;
      begin = std::max(begin, border);
      if (!(begin <= way)) return result;
    }
  }
  const double highest = field.max_sample(), lowest = field.min_sample();
  const double z = local.origin.z, dz = local.direction.z;
  bool before = false;
  if (!strict && z + dz * begin > highest) {
    if (!(dz < 0)) return result;
    const double quotient = (highest - z) / dz, top = quotient - 2 * kUnit * std::abs(quotient);
    if (top > way) return result;
    flags |= glsl::kScarpAbove;
    before = top > begin;
    begin = std::max(begin, top);
  }
  if (!strict)
    cell = before ? Cell{x.cell_before(begin), y.cell_before(begin)} : Cell{x.cell_after(begin), y.cell_after(begin)};

  const bool holes = field.nodata_count() > 0;
  if (!strict && (holes || !Wraps)) {
    result.lingers =
        lingers_at_line(field, local, lowest, highest, begin, way, seam, holes ? RimLines::all : RimLines::borders);
  }
  const double u = x.place(begin, cell.col), v = y.place(begin, cell.row);
  // The remaining part: only walls can be hit above or below all ground.
  const double height = z + dz * begin, relief = std::max(highest - lowest, 1.0);
  const bool walls = field.settings().solid && field.nodata_count() > 0;
  double low_way = way;
  if (dz < 0 && !(walls && std::isfinite(way))) low_way = begin + (std::max(height - lowest, 0.0) + relief) / -dz;
  if (dz > 0) low_way = begin + (std::max(highest - height, 0.0) + relief) / dz;
  if (!std::isfinite(way)) end = low_way;
  const double exit = way;
  way = std::min(way, low_way);
  const auto stands = [&](const GridAxis<Wraps>& axis) {
    return std::abs(axis.direction) * (way - begin) < kStandstill;
  };
  dvec3 direction{stands(x) ? 0 : x.direction, stands(y) ? 0 : y.direction, dz};
  // A ray that does not move never reaches a border.
  if (direction.x == 0 && x.moves() && !Wraps) end = std::min(end, across_x.exit);
  if (direction.y == 0 && y.moves() && !Wraps) end = std::min(end, across_y.exit);
  double length = std::max(end - begin, 0.0);
  if ((direction.x == 0 && direction.y == 0) || std::abs(dz) > kSteepest) {
    flags |= glsl::kScarpUpright;
    const int upright = dz == 0 ? 0 : std::ilogb(dz);
    direction = {0, 0, std::ldexp(dz, -upright)};
    length = std::ldexp(std::min(end, exit) - begin, upright);
    begin = std::ldexp(begin, upright);
    result.per_time = std::ldexp(result.per_time, -upright);
  }

  out.flags = flags;
  pack(out, cell, {u, v}, height, direction, length);
  result.begin = begin;
  result.marches = true;
  return result;
}

}  // namespace

glsl::ScarpField device_field(const HeightField& field, const MaxPyramid* pyramid) {
  const HeightFieldSettings& settings = field.settings();
  glsl::ScarpField result{};
  result.cells = {field.cell_cols(), field.cell_rows()};
  result.samples = {field.cols(), field.rows()};
  result.flags = (settings.surface == Surface::triangles ? glsl::kScarpTriangles : 0) |
                 (field.nodata_count() > 0 ? glsl::kScarpHoles : 0) | (field.wraps() ? glsl::kScarpWraps : 0) |
                 (settings.solid ? glsl::kScarpSolid : 0);
  result.lowest = static_cast<float>(field.min_sample());
  result.highest = static_cast<float>(field.max_sample());
  if (pyramid) {
    const TwoFloats base = two_floats(pyramid->code().base);
    result.top_level = pyramid->top_level();
    result.code_base = base.high;
    result.code_base_low = base.low;
    result.code_step = static_cast<float>(pyramid->code().step);
  }
  return result;
}

glsl::ScarpLeanCodes device_codes(const HeightField& field, const MaxPyramid& pyramid) {
  return {static_cast<float>(pyramid.code().per_step), pyramid.code().code_over(field.max_sample()),
          glsl::kGroundSpread * static_cast<float>(pyramid.cell_relief() * pyramid.code().step)};
}

DeviceRay device_ray(const HeightField& field, const Ray& ray, double seam) {
  if (!field.has_cells() || field.all_nodata() || !is_followable(ray)) return {};
  return field.wraps() ? on_grid<true>(field, ray, seam) : on_grid<false>(field, ray, seam);
}

DeviceRay sampled_device_ray(const HeightField& field, const Ray& ray, bool clip_at_top) {
  DeviceRay result;
  if (!field.has_cells() || field.all_nodata() || !is_followable(ray)) return result;
  GridRay local = field.grid_from_world(ray);
  const double longest =
      std::max({std::abs(local.direction.x), std::abs(local.direction.y), std::abs(local.direction.z)});
  if (!(longest > 0) || !std::isfinite(longest)) return result;
  const int exponent = std::ilogb(longest);
  dvec3 world;
  for (int axis = 0; axis < 3; ++axis) {
    local.direction[axis] = std::ldexp(local.direction[axis], -exponent);
    world[axis] = std::ldexp(ray.direction[axis], -exponent);
  }
  const double first = std::ldexp(ray.t_min, exponent);
  double border = -HUGE_VAL, end = std::ldexp(ray.t_max, exponent);
  const int cells[] = {field.cell_cols(), field.cell_rows()};
  if (!field.wraps()) {
    for (int axis = 0; axis < 2; ++axis)
      clip_to_range(0, cells[axis], local.origin[axis], local.direction[axis], border, end);
  }
  double begin = std::max(first, border);
  if (std::isinf(end))
    clip_to_range(field.min_sample(), field.max_sample(), local.origin.z, local.direction.z, begin, end);
  if (!(begin <= end) || std::isinf(end)) return result;
  double last = end;
  if (clip_at_top && !(local.direction.z < 0)) {
    const double rise = field.max_sample() - (local.origin.z + local.direction.z * begin);
    if (rise < 0) return result;
    // Rounding must not make it earlier.
    if (local.direction.z > 0) last = std::min(end, begin + rise / local.direction.z * (1 + 4 * kUnit));
  }
  int cell[2];
  double place[2];
  for (int axis = 0; axis < 2; ++axis) {
    double position = local.origin[axis] + local.direction[axis] * begin;
    if (field.wraps()) position -= std::floor(position / cells[axis]) * cells[axis];
    position = std::clamp(position, 0.0, static_cast<double>(cells[axis]));
    cell[axis] = std::min(static_cast<int>(position), cells[axis] - 1);
    place[axis] = position - cell[axis];
  }
  glsl::ScarpRay& out = result.ray;
  out.flags = 0;
  if (ray.start == RayStart::on_surface)
    out.flags |= glsl::kScarpOnSurface;
  else if (border >= first)
    out.flags |= glsl::kScarpFromOutside;
  pack(out, {cell[0], cell[1]}, {place[0], place[1]}, local.origin.z + local.direction.z * begin, local.direction,
       last - begin);
  const HeightFieldSettings& settings = field.settings();
  const double speed = length(world);
  out.travelled = static_cast<float>(begin - first);
  out.exit = static_cast<float>(end - begin);
  out.per_height = static_cast<float>(settings.scale * settings.exaggeration / speed);
  out.cell_time = static_cast<float>(std::min(settings.cell_x, settings.cell_y) / speed);
  result.per_time = std::ldexp(1.0, -exponent);
  result.begin = begin;
  result.marches = true;
  return result;
}

Hit hit_from_device(const Ray& ray, const DeviceRay& prepared, const glsl::ScarpHit& answer) {
  Hit hit;
  if (!prepared.marches) {
    hit.status = prepared.known;
    if (hit.status == HitStatus::exhausted) hit.t = ray.t_min;
    return hit;
  }
  const double time = prepared.begin + static_cast<double>(answer.time) + static_cast<double>(answer.time_low);
  const double t = std::clamp(time * prepared.per_time, ray.t_min, ray.t_max);
  switch (answer.status) {
    case glsl::kScarpMiss:
      return hit;
    case glsl::kScarpBelow:
      hit.status = HitStatus::below;
      return hit;
    case glsl::kScarpExhausted:
      hit.status = HitStatus::exhausted;
      hit.t = t;
      return hit;
    default:
      hit.status = HitStatus::hit;
      hit.wall = answer.status == glsl::kScarpWall;
  }
  hit.t = t;
  hit.cell = {answer.cell.x, answer.cell.y};
  hit.u = static_cast<double>(answer.place.x);
  hit.v = static_cast<double>(answer.place.y);
  hit.height = ray.at(t).z;
  return hit;
}

}  // namespace scarp
