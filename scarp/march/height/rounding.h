// SPDX-License-Identifier: MIT
// Rounding error bounds of a ray's clearance. doc/dev/numerics.md shows how hits depend on them. u = 2^-53.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "scarp/field/height_field.h"

namespace scarp {

/// Returns the maximum rounding error of ray height - surface height at time t, in sample units, from world coordinates
/// to a march's clearance: 16 u times the magnitude of the operands, including the offset of the ray into the grid.
/// `relief` is the height difference around the ray: of its cell, or of the whole field.
///
/// Roundings of each quantity on the way to the clearance, times u, of the largest value that it takes:
///
///     into grid units (a product or two)    3    coordinates and height, abs(o) and abs(d t)
///     time of a line: 1/d, k - o, product   3    the coordinate at t
///     o + d t, minus the cell               3    abs(o) + abs(d t)
///     ray height o_z + d_z t                2    abs(o_z) + abs(d_z t)
///     surface a + w (b - a), difference     3    the samples
///
/// No quantity goes through more than 11 roundings; 16 is the next power of two. Errors of coordinates change the
/// clearance through the slope: at most `relief` per cell.
inline double rounding_of_clearance(const HeightField& field, const GridRay& ray, double t, double relief) {
  constexpr double kUnit = 0x1p-53;  // unit roundoff of double
  constexpr double kRoundings = 16;  // counted above
  // Products below 2^-1022 are rounded by half of the smallest positive number instead.
  constexpr double kSubnormal = kRoundings / 2 * std::numeric_limits<double>::denorm_min();
  const double low = field.min_sample(), high = field.max_sample();
  const double sideways = std::abs(ray.origin.x) + std::abs(ray.direction.x * t) + std::abs(ray.origin.y) +
                          std::abs(ray.direction.y * t) + field.rows();
  const double upright = std::abs(ray.origin.z) + std::abs(ray.direction.z * t) +
                         std::max(std::abs(low), std::abs(high)) +
                         std::abs(field.settings().offset) / field.settings().scale;
  // Finite, so that a height that overflows is not within rounding of the ground.
  return std::min(std::numeric_limits<double>::max(), kRoundings * kUnit * (upright + sideways * relief) + kSubnormal);
}
inline double rounding_of_clearance(const HeightField& field, const GridRay& ray, double t) {
  return rounding_of_clearance(field, ray, t, field.max_sample() - field.min_sample());
}

/// Returns the distance in cells by which a grid line may appear displaced where a ray crosses it: by rounding, and by
/// HeightTarget's `seam`. `axis`: 0 for lines of constant column, 1 for those of constant row.
inline double rounding_of_line(const HeightField& field, const GridRay& ray, int axis, double seam) {
  return seam + HeightField::rounding_of_line(ray.origin[axis], axis == 0 ? field.cell_cols() : field.cell_rows());
}

/// The larger of the values for both axes: the maximum distance between positions that two fields, or a ray and a line,
/// treat as one.
inline double widest_rounding_of_line(const HeightField& field, const GridRay& ray, double seam) {
  return std::max(rounding_of_line(field, ray, 0, seam), rounding_of_line(field, ray, 1, seam));
}

/// Change of a ray's height over the allowance, relative to the relief of the field, up to which a crossing of a hole's
/// rim counts as one point. With an allowance of at most 2^-26 of a cell that is 2^-16 of the relief. Steeper rays are
/// followed within the allowance (max_mip_rims.h).
constexpr double kQuickRim = 0x1p10;

/// Returns the maximum height, in sample units, by which a ray may be below the surface at a rim (the border of the
/// field or of a hole) and still touch it: the rounding of its clearance, plus the height difference along the edge
/// over the allowance of a line.
inline double rounding_at_rim(const HeightField& field, const GridRay& ray, double t, double relief, double seam) {
  return rounding_of_clearance(field, ray, t, relief) + widest_rounding_of_line(field, ray, seam) * relief;
}

/// The same for a ray that leaves a hole across a line of an axis: includes the change of its clearance during the
/// crossing, at most kQuickRim.
inline double rounding_at_hole(const HeightField& field, const GridRay& ray, double t, double relief, int axis,
                               double seam) {
  const double off = rounding_of_line(field, ray, axis, seam);
  const double rate = std::abs(ray.direction.z) + std::abs(ray.direction[1 - axis]) * relief;
  const double most = kQuickRim * off * (field.max_sample() - field.min_sample());
  return rounding_at_rim(field, ray, t, relief, seam) + std::min(off * rate / std::abs(ray.direction[axis]), most);
}

/// The axis whose lines the ray crosses faster; it determines the time at which the ray passes a node.
inline int faster_axis(const GridRay& ray) { return std::abs(ray.direction.x) >= std::abs(ray.direction.y) ? 0 : 1; }

/// Longest time between the two lines of a node that count as crossed at once.
inline double rounding_of_node_time(const HeightField& field, const GridRay& ray, double seam) {
  const int axis = faster_axis(ray);
  return rounding_of_line(field, ray, axis, seam) / std::abs(ray.direction[axis]);
}

}  // namespace scarp
