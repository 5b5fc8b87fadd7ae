// SPDX-License-Identifier: MIT
// Colour ramps from files: .cpt of the Generic Mapping Tools, and images one row high.
//
//   .cpt    lines "low colour high colour", ascending and without gaps; a colour is R G B (0..255), R/G/B, or a grey.
//           Colours between low and high are interpolated. Lines starting with B, F or N (below, above, no data) and
//           text after a ';' are ignored. "# HINGE = 0" in a file from -1 to 1: both halves are stretched, the hinge
//           stays.
//   row     a PNG of N x 1 pixels (only the first row of a higher image is used): N colours, evenly spaced from the
//           lowest to the highest value
//
// A file whose values range from 0 to 1, or from -1 to 1 with a hinge, is stretched over the range that it is applied
// to; other files have absolute values, in metres for heights.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scarp/base/vec.h"

namespace scarp {

/// A range of values and the colours at its ends.
struct RampSlice {
  double low, high;          ///< low < high
  vec3 srgb_low, srgb_high;  ///< 0..1
};

/// The slices of a colour ramp.
struct RampStops {
  std::vector<RampSlice> slices;  ///< ascending and contiguous; not empty
  bool stretched = false;         ///< values 0..1, or -1..1 about a hinge, instead of absolute ones
  bool hinged = false;
};

/// Throws Error naming file and line: unreadable, no colours, values that do not ascend, an invalid colour (the models
/// HSV and CMYK are not supported).
RampStops read_cpt(const std::string& path);

/// Returns a ramp of one or more colours, lowest first, 3 bytes each.
RampStops ramp_of_row(std::span<const std::uint8_t> rgb);

}  // namespace scarp
