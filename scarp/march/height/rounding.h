// SPDX-License-Identifier: MIT
// Rounding error bounds of a ray's clearance, derived in doc/dev/numerics.md.
#pragma once

#include <algorithm>
#include <cmath>

#include "scarp/field/height_field.h"

namespace scarp {

/// Returns the maximum rounding error of ray height - surface height at time t, in sample units, from world coordinates
/// to a march's clearance: 16 u times the magnitude of the operands, including the offset of the ray into the grid.
/// `relief` is the height difference around the ray: of its cell, or of the whole field.
inline double rounding_of_clearance(const HeightField& field, const GridRay& ray, double t, double relief) {
  constexpr double kUnit = 0x1p-53;  // unit roundoff of double
  constexpr double kRoundings = 16;  // numerics.md counts 11
  const double low = field.min_sample(), high = field.max_sample();
  const double sideways = std::abs(ray.origin.x) + std::abs(ray.direction.x * t) + std::abs(ray.origin.y) +
                          std::abs(ray.direction.y * t) + field.rows();
  const double upright = std::abs(ray.origin.z) + std::abs(ray.direction.z * t) +
                         std::max(std::abs(low), std::abs(high)) +
                         std::abs(field.settings().offset) / field.settings().scale;
  return kRoundings * kUnit * (upright + sideways * relief);
}
inline double rounding_of_clearance(const HeightField& field, const GridRay& ray, double t) {
  return rounding_of_clearance(field, ray, t, field.max_sample() - field.min_sample());
}

/// Cells by which a line of the field may seem to be off where a ray crosses it: by rounding, and by `seam`, that of
/// HeightTarget. `axis`: 0 for lines of constant column, 1 for those of constant row.
inline double rounding_of_line(const HeightField& field, const GridRay& ray, int axis, double seam) {
  return seam + HeightField::rounding_of_line(ray.origin[axis], axis == 0 ? field.cell_cols() : field.cell_rows());
}

/// The larger of the two: how far apart the places are that two fields, or ray and line, take for one.
inline double widest_rounding_of_line(const HeightField& field, const GridRay& ray, double seam) {
  return std::max(rounding_of_line(field, ray, 0, seam), rounding_of_line(field, ray, 1, seam));
}

/// Allowances by which the height of a ray may change, per relief of the field, while it crosses the rim of a hole.
/// With an allowance of at most 2^-26 of a cell that is 2^-16 of the relief. Rays that change more are followed within
/// the allowance (max_mip_rims.h).
constexpr double kQuickRim = 0x1p10;

/// Returns the height, in sample units, by which a ray may be below the surface where it comes to a rim, the border of
/// the field or of a hole, and touch it: the rounding of its clearance, and the difference of heights along the edge
/// between two places that are as far apart as the allowance of a line.
inline double rounding_at_rim(const HeightField& field, const GridRay& ray, double t, double relief, double seam) {
  return rounding_of_clearance(field, ray, t, relief) + widest_rounding_of_line(field, ray, seam) * relief;
}

/// The same where a ray comes out of a hole over a line of an axis: with the change of its clearance in the time of the
/// crossing, at most kQuickRim.
inline double rounding_at_hole(const HeightField& field, const GridRay& ray, double t, double relief, int axis,
                               double seam) {
  const double off = rounding_of_line(field, ray, axis, seam);
  const double rate = std::abs(ray.direction.z) + std::abs(ray.direction[1 - axis]) * relief;
  const double most = kQuickRim * off * (field.max_sample() - field.min_sample());
  return rounding_at_rim(field, ray, t, relief, seam) + std::min(off * rate / std::abs(ray.direction[axis]), most);
}

/// The axis whose lines the ray crosses faster: that of the time at which it passes a node.
inline int faster_axis(const GridRay& ray) { return std::abs(ray.direction.x) >= std::abs(ray.direction.y) ? 0 : 1; }

/// Longest time between the two lines of a node that count as crossed at once.
inline double rounding_of_node_time(const HeightField& field, const GridRay& ray, double seam) {
  const int axis = faster_axis(ray);
  return rounding_of_line(field, ray, axis, seam) / std::abs(ray.direction[axis]);
}

}  // namespace scarp
