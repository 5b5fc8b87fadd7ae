// SPDX-License-Identifier: MIT
// Shadows cast by the sun on a field. sight.h defines what blocks a sun ray. The Earth is flat here: one sun direction
// holds for the whole field, and heights are not lowered.
//
//   const auto codes = scarp::shadow(field, {.azimuth = scarp::radians(135), .altitude = scarp::radians(20)});
#pragma once

#include <cstdint>
#include <vector>

#include "scarp/analysis/sight.h"
#include "scarp/base/progress.h"

namespace scarp {

/// Light on a node.
enum class Shade : std::uint8_t {
  lit,          ///< nothing blocks the sun
  self_shaded,  ///< the first grid line that the ray to the sun crosses blocks it: the ground itself faces away
  cast_shadow,  ///< ground farther away blocks it
  hole,         ///< no sample
};

/// Direction to the sun. Grid north is the direction of decreasing rows.
struct SunDirection {
  double azimuth = 0;   ///< radians clockwise from grid north, finite
  double altitude = 0;  ///< radians above the horizon, 0 < altitude <= pi/2
};

/// The direction from a node to the sun, in grid units. It is rounded once; all later computations are exact.
struct SunRay {
  /// A vector of cells: the larger of |col| and |row| is kUnit, the other is rounded, so the direction is off by at
  /// most 2^-27 cells per cell.
  std::int64_t col, row;
  double rise;  ///< metres that the ray rises along the whole vector

  static constexpr std::int64_t kUnit = std::int64_t{1} << 26;
};

/// The steps between nodes on the ground, in metres east and north.
struct NodeSteps {
  dvec2 col, row;  ///< to the next column and row
};

/// The steps of a field, relative to grid north.
NodeSteps node_steps(const HeightField& field);
/// Throws Error if the direction is out of range. `azimuth` is relative to the north of the steps.
SunRay sun_ray(const NodeSteps& steps, const SunDirection& sun);
/// The same with the field's cells and grid north.
SunRay sun_ray(const HeightField& field, const SunDirection& sun);

/// Returns the code of every node, rows from north to south. Throws Error for a direction out of range or a wrapped
/// field.
std::vector<Shade> shadow(const HeightField& field, const SunDirection& sun, const Progress& progress = {});

}  // namespace scarp
