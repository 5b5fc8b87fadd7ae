// SPDX-License-Identifier: MIT
// Colour files of gdaldem color-relief (GDAL's documentation of gdaldem, "color-relief"); r.colors of GRASS and the
// colour map export of QGIS use the same format.
//
//   # comment                     lines "value R G B [A]" in any order; separators are blanks, tabs, commas and colons
//   0      46 154  88             components are 0..255, or one name: white, black, red, green, blue, yellow, magenta,
//   900,251,255,128,255           cyan, aqua, grey, gray, orange, brown, purple, violet, indigo
//   50%    white                  values are metres or percent of the range, the same in all lines
//   nv     0 0 0 0                nv and default (holes), and the line INTERPOLATION:INTERPOLATED of QGIS are skipped
//
// Colours between two values are interpolated in sRGB; two lines with the same value make a step. Opacity is ignored.
#pragma once

#include <string>

#include "scarp/source/table/ramp_file.h"

namespace scarp {

/// Throws Error naming file and line: unreadable, no colours, an invalid value or colour, a mixture of percent and
/// metres, another QGIS interpolation.
RampStops read_colour_relief(const std::string& path);

}  // namespace scarp
