// SPDX-License-Identifier: MIT
#include "scarp/render/surface/detail_texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scarp/base/error.h"
#include "scarp/vk/real.glsl.h"

namespace scarp::glsl {
namespace {

using ScarpTexels = std::span<const float>;

real scarp_texel(ScarpTexels texels, int index) { return static_cast<double>(texels[static_cast<std::size_t>(index)]); }

}  // namespace
}  // namespace scarp::glsl

#include "scarp/render/surface/detail_texture.glsl.h"

namespace scarp {
namespace {

// Calls add(i, share) for each of the `from` fine entries that coarse entry `to` of `count` covers; shares sum to 1.
template <class Add>
void for_covered(int to, int count, int from, const Add& add) {
  const double wide = static_cast<double>(from) / count, low = to * wide, high = low + wide;
  for (int i = static_cast<int>(low); i < from && i < high; ++i)
    add(i, (std::min(high, i + 1.0) - std::max(low, static_cast<double>(i))) / wide);
}

// Averages a level of size `from` to one of size `to`.
std::vector<float> coarser(std::span<const float> texels, const glsl::ivec2& from, const glsl::ivec2& to) {
  std::vector<float> means;
  means.reserve(static_cast<std::size_t>(to.x) * static_cast<std::size_t>(to.y));
  for (int row = 0; row < to.y; ++row) {
    for (int col = 0; col < to.x; ++col) {
      double sum = 0;
      for_covered(row, to.y, from.y, [&](int r, double down) {
        for_covered(col, to.x, from.x,
                    [&](int c, double across) { sum += down * across * glsl::scarp_texel(texels, r * from.x + c); });
      });
      means.push_back(static_cast<float>(sum));
    }
  }
  return means;
}

double fraction(double x) { return x - std::floor(x); }

}  // namespace

DetailTexture::DetailTexture(int width, int height, std::span<const std::uint8_t> rgba)
    : width_(width), height_(height) {
  if (width < 1 || height < 1 || width > kMostSide || height > kMostSide) {
    throw Error(
        fmt::format("detail texture: {} x {} pixels (must be 1 to {} from side to side)", width, height, kMostSide));
  }
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (rgba.size() != 4 * pixels) throw Error("detail texture: the pixels are not 4 bytes each");
  for (std::size_t i = 0; i < rgba.size(); i += 4)
    texels_.push_back(static_cast<float>((0.2126 * rgba[i] + 0.7152 * rgba[i + 1] + 0.0722 * rgba[i + 2]) / 255));
  const double mean = std::accumulate(texels_.begin(), texels_.end(), 0.0) / static_cast<double>(pixels);
  for (float& texel : texels_) texel = static_cast<float>(2 * (static_cast<double>(texel) - mean));
  std::size_t begin = 0;
  for (glsl::ivec2 size(width, height); size.x > 1 || size.y > 1;) {
    const glsl::ivec2 next = glsl::scarp_coarser_texture(size);
    const std::vector<float> level = coarser(std::span(texels_).subspan(begin), size, next);
    begin = texels_.size();
    texels_.insert(texels_.end(), level.begin(), level.end());
    size = next;
  }
}

double DetailTexture::at(const dvec2& position, double size, double footprint) const {
  const dvec2 place(fraction(position.x / size), 1 - fraction(position.y / size * width_ / height_));
  return glsl::scarp_texture_detail(texels_, {width_, height_}, place, footprint * width_ / size);
}

}  // namespace scarp
