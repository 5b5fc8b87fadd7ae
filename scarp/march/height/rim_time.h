// SPDX-License-Identifier: MIT
// How long a ray stays beside grid lines within the ground's height range: determines whether rims of holes may be
// crossed at the time of a line, or must be followed (max_mip_rims.h).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "scarp/march/height/rounding.h"

namespace scarp {

/// Limits a time range to the part in which the ray is between two heights, in sample units, with a margin far beyond
/// rounding_of_clearance(), so that its side on entry is known. Returns whether any part is left.
inline bool clip_to_heights(const HeightField& field, const GridRay& ray, double low, double high, double& begin,
                            double& end) {
  const double offset = std::abs(field.settings().offset) / field.settings().scale;
  const double upright = std::abs(ray.origin.z) + std::abs(low) + std::abs(high) + offset;
  const double room = (high - low) + 0x1p-40 * upright + std::numeric_limits<double>::min();
  const double z = ray.origin.z, dz = ray.direction.z;
  if (dz == 0) return begin <= end && z >= low - room && z <= high + room;
  const double a = (low - room - z) / dz, b = (high + room - z) / dz;
  begin = std::max(begin, std::min(a, b)), end = std::min(end, std::max(a, b));
  return begin <= end;
}

/// The lines at which a ray may linger: all, or those where the field ends.
enum class RimLines : std::uint8_t { all, borders };

/// Returns whether the ray, in this time and between these heights, stays within the allowance of a line for so long
/// that its height there is not known to kQuickRim.
inline bool lingers_at_line(const HeightField& field, const GridRay& ray, double low, double high, double begin,
                            double end, double seam, RimLines lines = RimLines::all) {
  if (!clip_to_heights(field, ray, low, high, begin, end)) return false;
  const double relief = field.max_sample() - field.min_sample();
  const auto lingers = [&](int axis) {
    const double d = ray.direction[axis], along = std::abs(ray.direction[1 - axis]);
    if (d != 0 && std::abs(ray.direction.z) + along * relief <= kQuickRim * relief * std::abs(d)) return false;
    const auto at = [&](double t) { return d == 0 ? ray.origin[axis] : ray.origin[axis] + d * t; };
    const double a = at(begin), b = at(end), off = rounding_of_line(field, ray, axis, seam);
    const double least = std::min(a, b) - off, most = std::max(a, b) + off;
    const int cells = axis == 0 ? field.cell_cols() : field.cell_rows();
    if (lines == RimLines::borders) return (least <= 0 && most >= 0) || (least <= cells && most >= cells);
    return std::floor(most) >= std::ceil(least);
  };
  return lingers(0) || lingers(1);
}

}  // namespace scarp
