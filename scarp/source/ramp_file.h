// SPDX-License-Identifier: MIT
// Colours for values, from files: .cpt of the Generic Mapping Tools, and pictures one row high.
//
//   .cpt    lines "low colour high colour", ascending and without gaps; a colour is R G B (0..255), R/G/B, or a grey.
//           Between low and high it goes over from one to the other. Lines of B, F and N (below, above, no data) and
//           what follows a ';' are skipped. "# HINGE = 0" in a file from -1 to 1: both halves are stretched, the hinge
//           stays.
//   row     a PNG of N x 1 pixels (of higher ones the first row counts): N colours evenly spaced from the lowest value
//   to
//           the highest
//
// A file whose values go from 0 to 1, or with a hinge from -1 to 1, is laid over whatever range it is used for; others
// have values of their own, metres for heights.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scarp/base/vec.h"

namespace scarp {

struct RampSlice {
  double low, high;          ///< low < high
  vec3 srgb_low, srgb_high;  ///< 0..1
};

struct RampStops {
  std::vector<RampSlice> slices;  ///< ascending, each beginning where the one before ends; not empty
  bool stretched = false;         ///< values 0..1, or -1..1 about a hinge, instead of those that are coloured
  bool hinged = false;
};

/// Throws Error naming file and line: unreadable, no colours, values that are not ascending, a colour that is none (of
/// the models HSV and CMYK there are none).
RampStops read_cpt(const std::string& path);

/// Of colours from low to high, 3 bytes each; one or more.
RampStops ramp_of_row(std::span<const std::uint8_t> rgb);

}  // namespace scarp
