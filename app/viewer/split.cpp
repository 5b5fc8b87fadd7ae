// SPDX-License-Identifier: MIT
#include "app/viewer/split.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace scarp::viewer {
namespace {

constexpr double kReach = 6;  // distance in pixels within which the divider can be grabbed

}  // namespace

Image stretched(const Image& image, int width, int height) {
  Image to(width, height);
  for (int y = 0; y < height; ++y) {
    const int from_y = static_cast<int>((std::int64_t{2} * y + 1) * image.height / (std::int64_t{2} * height));
    for (int x = 0; x < width; ++x) {
      const int from_x = static_cast<int>((std::int64_t{2} * x + 1) * image.width / (std::int64_t{2} * width));
      std::copy_n(image.pixel(from_x, from_y), 3, to.pixel(x, y));
    }
  }
  return to;
}

Image split_image(const Image& left, const Image& right, int column) {
  Image image = right;
  const std::ptrdiff_t bytes = std::ptrdiff_t{3} * std::clamp(column, 0, image.width);
  for (int y = 0; y < image.height; ++y) {
    const std::ptrdiff_t row = std::ptrdiff_t{3} * y * image.width;
    std::copy_n(left.rgb.begin() + row, bytes, image.rgb.begin() + row);
  }
  return image;
}

int SplitLine::column(int width) const { return static_cast<int>(std::lround(share_ * width)); }

bool SplitLine::is_at(const dvec2& place, const dvec2& size) const {
  return std::abs(place.x - share_ * size.x) <= kReach;
}

void SplitLine::drag_to(double x, double width) { share_ = std::clamp(x / width, 0.0, 1.0); }

}  // namespace scarp::viewer
