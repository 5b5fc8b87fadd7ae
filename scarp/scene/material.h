// SPDX-License-Identifier: MIT
// Materials of a scene's surfaces, as plain data; render/surface/surface_colour.h computes colours from them.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "scarp/base/vec.h"

namespace scarp {

/// An index beyond all lists of materials: the field's own colours.
constexpr std::uint32_t kOwnMaterial = ~std::uint32_t{0};

/// The field's own colour: a voxel's palette entry, otherwise a neutral earth.
struct OwnColour {};

/// One colour, sRGB, 0..1.
struct PlainColour {
  vec3 colour{0.6f};
};

/// A ramp of render/surface/ramp.h over heights.
struct HeightRamp {
  std::string ramp;          ///< a name from ramp_names()
  double low = 0, high = 1;  ///< metres of world z, low <= high
};

/// Colours at given heights, blended in between.
struct HeightStops {
  std::vector<std::pair<double, vec3>> stops;  ///< world z in metres, rising, and sRGB 0..1; at least one
};

/// Two colours in alternating cubes, in the object's own space.
struct Checker {
  vec3 first{0.9f}, second{0.2f};  ///< sRGB, 0..1
  double size = 1;                 ///< side of a cube in metres, > 0
};

/// One material up to `from` and another one from `to` on, blended in between.
struct Blend {
  enum class By : std::uint8_t {
    slope,   ///< degrees between the normal and up, 0..180
    height,  ///< metres of world z
  };
  By by = By::slope;
  double from = 30, to = 40;        ///< from <= to
  std::uint32_t low = 0, high = 0;  ///< materials before this one in the list
};

using Material = std::variant<OwnColour, PlainColour, HeightRamp, HeightStops, Checker, Blend>;

}  // namespace scarp
