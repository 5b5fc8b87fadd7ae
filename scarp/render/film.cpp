// SPDX-License-Identifier: MIT
#include "scarp/render/film.h"

#include <algorithm>

#include "scarp/base/parallel.h"
#include "scarp/render/ramp.h"

namespace scarp {
namespace {

// Pixels along a tile's side: neighbouring rays meet the same cells, and a tile is some milliseconds of work.
constexpr int kTile = 16;

}  // namespace

Image::Image(int image_width, int image_height)
    : width(image_width),
      height(image_height),
      rgb(3 * static_cast<std::size_t>(image_width) * static_cast<std::size_t>(image_height)) {}

void set_pixel(Image& image, int x, int y, vec3 linear) {
  std::uint8_t* rgb = image.pixel(x, y);
  rgb[0] = srgb_byte(linear.x);
  rgb[1] = srgb_byte(linear.y);
  rgb[2] = srgb_byte(linear.z);
}

void for_each_pixel(int width, int height, const std::function<void(int, int)>& body, const Progress& progress) {
  const std::int64_t across = (width + kTile - 1) / kTile, down = (height + kTile - 1) / kTile;
  parallel_for(
      across * down, 1,
      [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t tile = begin; tile < end; ++tile) {
          const int x0 = static_cast<int>(tile % across) * kTile, y0 = static_cast<int>(tile / across) * kTile;
          for (int y = y0; y < std::min(y0 + kTile, height); ++y) {
            for (int x = x0; x < std::min(x0 + kTile, width); ++x) body(x, y);
          }
        }
      },
      progress);
}

vec3 mean_colour(int x, int y, int aa, const PointColour& colour) {
  vec3 sum(0.0f);
  for (int j = 0; j < aa; ++j) {
    for (int i = 0; i < aa; ++i) sum += colour({x + (i + 0.5) / aa, y + (j + 0.5) / aa, x, y, j * aa + i});
  }
  return sum * (1.0f / static_cast<float>(aa * aa));
}

Image develop(int width, int height, int aa, const PointColour& colour, const Progress& progress) {
  Image image(width, height);
  for_each_pixel(
      width, height, [&](int x, int y) { set_pixel(image, x, y, mean_colour(x, y, aa, colour)); }, progress);
  return image;
}

}  // namespace scarp
