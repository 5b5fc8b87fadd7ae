// SPDX-License-Identifier: MIT
// Time of direct sun on every node of a field, from its horizons: a node is lit at a moment if the centre of the sun is
// not below its horizon in the sun's azimuth. One position of the sun holds for the whole field.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scarp/analysis/horizon.h"
#include "scarp/analysis/shadow.h"

namespace scarp {

/// A span of time, with the sun where it is in its middle.
struct SunMoment {
  SunDirection sun{};  ///< altitude above 0, at most pi/2
  double hours = 0;    ///< length of the span
};

/// Rows from north to south.
struct SunHours {
  std::vector<float> hours;               ///< of direct sun; NaN on holes
  std::vector<std::int32_t> first, last;  ///< indices of the first and last moment with sun; -1: none
};

/// Rows [first, last) of the field. Runs on all threads. Throws Error for a direction out of range, an infinite length,
/// and as Horizons::rows() does.
SunHours sun_hours(const Horizons& horizons, std::span<const SunMoment> moments, int first, int last,
                   const Progress& progress = {});

}  // namespace scarp
