// SPDX-License-Identifier: MIT
// Pictures as GDAL reads them: rows of colours, and images draped over a raster. Needs a build with GDAL.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scarp/source/raster.h"

namespace scarp {

/// Rows from the top, 4 bytes (red, green, blue, opacity; sRGB) a pixel, no padding.
struct ColourImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;
  std::vector<std::string> files;  ///< as Raster::files
};

/// The first row of a picture of 8 bits per channel, grey, palette or colours. Throws Error naming the file.
ColourImage read_colour_row(const std::string& path);

/// A picture brought onto the ground of a raster: its upper left pixel at the north-west corner, its last one at the
/// south-east corner, between samples as GDAL's warper has it (bilinear), whatever CRS it has; transparent where it
/// reaches not. A raster and a picture without georeference lie on one another from border to border. Throws Error
/// naming the file: unreadable, only one of both with a georeference, a picture that lies beside the raster.
ColourImage read_overlay(const std::string& path, const Georeference& georeference, int cols, int rows);

}  // namespace scarp
