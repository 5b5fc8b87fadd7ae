// SPDX-License-Identifier: MIT
// Time of direct sun on every node of a field, and the energy that a clear sky sends there, from its horizons: a node
// is lit at a moment if the centre of the sun is not below its horizon in the sun's azimuth. One position of the sun
// holds for the whole field.
//
//   beam       what a plane that faces the sun receives (clear_sky.h, at the node's height), times the cosine between
//              the sun and the node's normal, while the node is lit
//   diffuse    of the horizontal, times the sky view factor: the sky is equally bright all over
//   reflected  albedo times the radiation of level, unshaded ground at the node's height, times 1 - sky view factor
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scarp/analysis/horizon.h"
#include "scarp/analysis/shadow.h"

namespace scarp {

/// A span of time, with the sun where it is in its middle.
struct SunMoment {
  SunDirection sun{};  ///< altitude above 0, at most pi/2
  double hours = 0;    ///< length of the span
  double day_of_year = 1;
};

/// The air and the ground, on which the energy depends besides the sun.
struct ClearSkyGround {
  double linke = 3;                        ///< turbidity, 1 to 8
  double albedo = 0.2;                     ///< of the ground around, 0 to 1
  std::span<const float> sky_view_factor;  ///< SkyMeasure::sky_view_factor of the rows
  std::optional<double> transmittance{};   ///< above 0, at most 1: instead of `linke` (clear_sky.h)
};

/// kWh per square metre of ground; NaN on holes.
struct SunEnergy {
  std::vector<float> beam, diffuse, reflected;
};

/// Rows from north to south.
struct SunHours {
  std::vector<float> hours;               ///< of direct sun; NaN on holes
  std::vector<std::int32_t> first, last;  ///< indices of the first and last moment with sun; -1: none
  SunEnergy energy;                       ///< if asked for
};

/// Rows [first, last) of the field, with energy if there is `ground`. Runs on all threads. Throws Error for a direction
/// or a setting out of range, an infinite length, and as Horizons::rows() does.
SunHours sun_hours(const Horizons& horizons, std::span<const SunMoment> moments, int first, int last,
                   const ClearSkyGround* ground = nullptr, const Progress& progress = {});

/// The same of a block of nodes, in rows of the block. Throws Error for an empty block and for nodes outside the field.
SunHours sun_hours(const Horizons& horizons, std::span<const SunMoment> moments, const NodeRect& nodes,
                   const ClearSkyGround* ground = nullptr, const Progress& progress = {});

}  // namespace scarp
