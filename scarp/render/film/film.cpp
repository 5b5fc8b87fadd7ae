// SPDX-License-Identifier: MIT
#include "scarp/render/film/film.h"

#include <algorithm>

#include "scarp/render/light/colour.glsl.h"
#include "scarp/render/surface/ramp.h"

namespace scarp {
namespace {

// Pixels along a tile's side: neighbouring rays visit the same cells, and a tile takes a few milliseconds.
constexpr int kTile = 32;
constexpr int kMostPointsPerSide = 32;
static_assert(kMostPointsPerSide * kMostPointsPerSide == kMostPointsOfTile);

}  // namespace

Image::Image(int image_width, int image_height)
    : width(image_width),
      height(image_height),
      rgb(3 * static_cast<std::size_t>(image_width) * static_cast<std::size_t>(image_height)) {}

std::uint8_t opacity_byte(std::size_t shown, std::size_t points) {
  return static_cast<std::uint8_t>((255 * shown + points / 2) / points);
}

void set_pixel(Image& image, int x, int y, vec3 linear) {
  std::uint8_t* rgb = image.pixel(x, y);
  rgb[0] = srgb_byte(linear.x);
  rgb[1] = srgb_byte(linear.y);
  rgb[2] = srgb_byte(linear.z);
}

vec3 toned(vec3 linear) { return glsl::scarp_toned(linear); }

PixelTiles::PixelTiles(int width, int height, int aa)
    : width_(width),
      height_(height),
      side_(std::min(kTile, kMostPointsPerSide / aa)),
      across_((width + side_ - 1) / side_),
      down_((height + side_ - 1) / side_) {}

PixelTile PixelTiles::operator[](std::int64_t i) const {
  const int x0 = static_cast<int>(i % across_) * side_, y0 = static_cast<int>(i / across_) * side_;
  return {x0, y0, std::min(x0 + side_, width_), std::min(y0 + side_, height_)};
}

std::vector<PicturePoint> points_of(const PixelTile& tile, int aa) {
  std::vector<PicturePoint> points;
  points.reserve(tile.pixels() * static_cast<std::size_t>(aa * aa));
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      for (int j = 0; j < aa; ++j) {
        for (int i = 0; i < aa; ++i) points.push_back({x + (i + 0.5) / aa, y + (j + 0.5) / aa, x, y, j * aa + i});
      }
    }
  }
  return points;
}

vec3 mean_colour(std::span<const vec3> points) {
  vec3 sum(0.0f);
  for (const vec3& point : points) sum += point;
  return sum * (1.0f / static_cast<float>(points.size()));
}

}  // namespace scarp
