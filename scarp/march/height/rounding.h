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
  constexpr double kUnit = 0x1p-53, kRoundings = 16;  // numerics.md counts 8 for each of two fields
  const double cells = axis == 0 ? field.cell_cols() : field.cell_rows();
  return seam + kRoundings * kUnit * (std::abs(ray.origin[axis]) + cells);
}

/// Returns the maximum error of the clearance where a ray crosses a rim, the border of the field or of a hole: that
/// above, and what follows from the time of the crossing. `axis` is that of the line.
inline double rounding_at_rim(const HeightField& field, const GridRay& ray, double t, double relief, int axis,
                              double seam) {
  const int along = 1 - axis;
  const double off = rounding_of_line(field, ray, axis, seam);
  // A ray that almost runs along the rim: at most a cell.
  const double late = std::min(off / std::abs(ray.direction[axis]), 1 / std::abs(ray.direction[along]));
  return rounding_of_clearance(field, ray, t, relief) +
         late * (std::abs(ray.direction.z) + std::abs(ray.direction[along]) * relief) + off * relief;
}

/// The axis whose lines the ray crosses faster: that of the time at which it passes a node.
inline int faster_axis(const GridRay& ray) { return std::abs(ray.direction.x) >= std::abs(ray.direction.y) ? 0 : 1; }

/// Longest time between the two lines of a node that count as crossed at once.
inline double rounding_of_node_time(const HeightField& field, const GridRay& ray, double seam) {
  const int axis = faster_axis(ray);
  return rounding_of_line(field, ray, axis, seam) / std::abs(ray.direction[axis]);
}

}  // namespace scarp
