// SPDX-License-Identifier: MIT
// From colours of points to a picture of bytes: tiles over all threads, several samples per pixel.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "scarp/base/progress.h"
#include "scarp/base/vec.h"

namespace scarp {

/// Rows from the top, 3 bytes (red, green, blue; sRGB) a pixel, no padding.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;

  Image() = default;
  /// Black.
  Image(int image_width, int image_height);
  std::uint8_t* pixel(int x, int y) { return rgb.data() + 3 * (std::int64_t{y} * width + x); }
  const std::uint8_t* pixel(int x, int y) const { return rgb.data() + 3 * (std::int64_t{y} * width + x); }
};

/// Sets a pixel from linear light.
void set_pixel(Image& image, int x, int y, vec3 linear);

/// Calls body(x, y) once for every pixel, tile by tile on all threads. Throws Interrupted when progress asks for it.
void for_each_pixel(int width, int height, const std::function<void(int, int)>& body, const Progress& progress);

/// A place in a picture whose colour is asked for; pixel (i, j) covers [i, i+1) x [j, j+1).
struct PicturePoint {
  double x, y;
  int pixel_x, pixel_y;
  int index;  ///< of the point in its pixel, from 0
};

/// Colour of a point of the picture in linear light.
using PointColour = std::function<vec3(const PicturePoint&)>;

/// The mean of aa x aa evenly spaced points in pixel (x, y), in linear light.
vec3 mean_colour(int x, int y, int aa, const PointColour& colour);

/// That of every pixel.
Image develop(int width, int height, int aa, const PointColour& colour, const Progress& progress);

}  // namespace scarp
