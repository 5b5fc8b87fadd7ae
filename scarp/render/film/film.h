// SPDX-License-Identifier: MIT
// Converts colours of points to a picture of bytes: tiles, several samples per pixel.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scarp/base/vec.h"

namespace scarp {

/// Pixels of a picture.
struct ImageSize {
  int width = 0, height = 0;
};

/// Rows from the top, 3 bytes per pixel (red, green, blue; sRGB), no padding.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
  std::vector<std::uint8_t> alpha{};  ///< opacity, a byte per pixel; empty: all pixels are opaque

  Image() = default;
  /// Black.
  Image(int image_width, int image_height);
  std::uint8_t* pixel(int x, int y) { return rgb.data() + 3 * (std::int64_t{y} * width + x); }
  const std::uint8_t* pixel(int x, int y) const { return rgb.data() + 3 * (std::int64_t{y} * width + x); }
  void make_transparent() { alpha.assign(rgb.size() / 3, 0); }
  /// Requires that `alpha` is not empty.
  std::uint8_t& opacity(int x, int y) { return alpha[static_cast<std::size_t>(std::int64_t{y} * width + x)]; }
};

/// The opacity byte for a fraction of a pixel's points.
std::uint8_t opacity_byte(std::size_t shown, std::size_t points);

/// Sets a pixel from linear light.
void set_pixel(Image& image, int x, int y, vec3 linear);

/// Compresses bright colours in linear light, so that bright sunlit surfaces keep their detail (scarp_toned()). Colours
/// whose largest channel is at most 0.7 do not change; 1.75 becomes 1; hues are preserved up to there.
vec3 toned(vec3 linear);

/// Pixels [x0, x1) x [y0, y1).
struct PixelTile {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  std::size_t pixels() const { return static_cast<std::size_t>(x1 - x0) * static_cast<std::size_t>(y1 - y0); }
};

/// A picture cut into tiles of a few hundred neighbouring points.
class PixelTiles {
 public:
  /// `width` and `height` in pixels, with aa x aa points per pixel, aa 1..16.
  PixelTiles(int width, int height, int aa);

  std::int64_t count() const { return across_ * down_; }
  std::int64_t columns() const { return across_; }
  std::int64_t rows() const { return down_; }
  /// Side in pixels of a tile that is not clipped at the border of the picture.
  int side() const { return side_; }
  PixelTile operator[](std::int64_t i) const;

 private:
  int width_, height_, side_;
  std::int64_t across_, down_;
};

/// Maximum number of points in a tile.
constexpr std::size_t kMostPointsOfTile = 1024;

/// A sample position in a picture; pixel (i, j) covers [i, i+1) x [j, j+1).
struct PicturePoint {
  double x, y;
  int pixel_x, pixel_y;
  int index;  ///< index of the point in its pixel, from 0
};

/// Returns aa x aa evenly spaced points per pixel: pixels row by row, the points of one pixel together.
std::vector<PicturePoint> points_of(const PixelTile& tile, int aa);

/// The mean colour of the points of one pixel, in linear light.
vec3 mean_colour(std::span<const vec3> points);

}  // namespace scarp
