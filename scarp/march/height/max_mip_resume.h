// SPDX-License-Identifier: MIT
// `max-mip` for a ray that is known to be above the ground for some part: the hand-over from max_mip_simd.cpp.
#pragma once

#include <limits>

#include "scarp/field/height_field.h"
#include "scarp/march/height/height_target.h"

namespace scarp {

namespace max_mip {
/// No part of the ray is known to be clear.
constexpr double kNotClear = -std::numeric_limits<double>::infinity();

/// Whether the whole ray is where cells of a wrapped field can be counted.
bool countable(const GridRay& local, const Ray& ray);
}  // namespace max_mip

/// march_max_mip() and occluded_max_mip(), bit for bit, for a ray that is above the ground by more than rounding
/// (rounding.h) from its start to t_clear; if it starts on the surface, from where it leaves its first cell.
Hit resume_max_mip(const HeightTarget& target, const Ray& ray, double t_clear);
bool resume_occluded_max_mip(const HeightTarget& target, const Ray& ray, double t_clear);

/// First cell of a ray from the surface.
struct SurfaceStart {
  bool decided = false;  ///< whether `hit` is the answer; otherwise the ray continues
  Hit hit{};
  double t = 0;        ///< where it leaves the cell
  double z = 0;        ///< its height at t = 0, in sample units, such that it starts on the surface
  bool above = false;  ///< whether it leaves the cell above the ground
};
SurfaceStart start_max_mip(const HeightTarget& target, const Ray& ray);

}  // namespace scarp
