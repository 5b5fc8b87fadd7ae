// SPDX-License-Identifier: MIT
// Selects the hits that count: by the side of the surface, and by a filter.
#pragma once

#include <cstdint>
#include <functional>

#include "scarp/base/ray.h"

namespace scarp {

/// The sides of a height field that rays hit.
enum class Sides : std::uint8_t {
  above,  ///< a ray hits where it goes from above the surface to on or below it
  below,  ///< a ray hits where it goes from below the surface to on or above it
  both,
};

/// Returns whether a hit counts; otherwise the ray continues as if the surface had a hole there. Called for some or all
/// hits in the ray's range, not always in order of t; possibly from several threads at once.
using HitFilter = std::function<bool(const Hit&)>;

struct HitRules {
  Sides sides = Sides::above;
  const HitFilter* accept = nullptr;  ///< null: all hits count

  bool plain() const { return sides == Sides::above && !accept; }
};

}  // namespace scarp
