// SPDX-License-Identifier: MIT
// Images read through GDAL: colour rows, and overlays on a raster. Requires a build with GDAL.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scarp/source/raster/raster.h"

namespace scarp {

/// An image: rows from the top, 4 bytes (red, green, blue, opacity; sRGB) per pixel, no padding.
struct ColourImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;
  std::vector<std::string> files;  ///< as Raster::files
};

/// Returns the first row of an image with 8 bits per channel: grey, palette or colour. Throws Error naming the file.
ColourImage read_colour_row(const std::string& path);

/// Returns a whole image with 8 bits per channel. Throws Error naming the file, also if a side is longer than
/// `most_side` pixels.
ColourImage read_colour_image(const std::string& path, int most_side);

/// An image over part of a raster, or over all of it. Edges are fractions of the distance from the first sample to the
/// last: 0 is at the north-west sample, 1 at the south-east sample.
struct Overlay {
  ColourImage image;
  double west = 0, north = 0, east = 1, south = 1;
};

/// Returns the part of an image over a raster, interpolated bilinearly by GDAL's warper, from any CRS. An image in the
/// raster's CRS keeps its pixels. The result has at most `most_pixels` (>= 1) pixels and no side longer than 16384;
/// larger images are averaged first. A raster and an image that both lack a georeference are aligned border to border;
/// with `fit`, all are, and georeferences are ignored. Throws Error naming the file: unreadable, only one of the two
/// has a georeference, the image does not overlap the raster.
Overlay read_overlay(const std::string& path, const Georeference& georeference, int cols, int rows,
                     std::int64_t most_pixels, bool fit = false);

}  // namespace scarp
