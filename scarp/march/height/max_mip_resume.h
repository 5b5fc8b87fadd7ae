// SPDX-License-Identifier: MIT
// `max-mip` for a ray of which a part is known to be above the ground: where max_mip_simd.cpp hands over.
#pragma once

#include <limits>

#include "scarp/field/height_field.h"
#include "scarp/march/height/height_target.h"

namespace scarp {

namespace max_mip {
/// Nothing is known of the ray.
constexpr double kNotClear = -std::numeric_limits<double>::infinity();

/// In a field that wraps round: whether all of the ray is where cells can be counted.
bool countable(const GridRay& local, const Ray& ray);
}  // namespace max_mip

/// march_max_mip() and occluded_max_mip(), bit for bit, of a ray that is above the ground by more than rounding
/// (rounding.h) from its begin to t_clear; of one that begins on the surface, from where it leaves its first cell.
Hit resume_max_mip(const HeightTarget& target, const Ray& ray, double t_clear);
bool resume_occluded_max_mip(const HeightTarget& target, const Ray& ray, double t_clear);

/// The begin of a ray from the surface: its first cell.
struct SurfaceStart {
  bool decided = false;  ///< the answer is `hit`; else the ray goes on
  Hit hit{};
  double t = 0;        ///< where it leaves the cell
  double z = 0;        ///< its height at t = 0, in sample units, such that it begins on the surface
  bool above = false;  ///< whether it leaves the cell above the ground
};
SurfaceStart start_max_mip(const HeightTarget& target, const Ray& ray);

}  // namespace scarp
