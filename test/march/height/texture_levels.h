// SPDX-License-Identifier: MIT
// What is in the two textures of scarp/march/height/textures.glsl.h, level by level, rows one after the other.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "scarp/accel/max_pyramid.h"
#include "scarp/field/height_field.h"

namespace scarp::test {

struct TextureLevel {
  std::uint32_t cols, rows;
  std::vector<float> texels;  // channels of a texel together
};

inline std::vector<TextureLevel> heights_of(const HeightField& field) {
  TextureLevel level{static_cast<std::uint32_t>(field.cols()), static_cast<std::uint32_t>(field.rows()), {}};
  field.visit([&](const auto& grid) {
    for (int row = 0; row < field.rows(); ++row) {
      for (int col = 0; col < field.cols(); ++col) level.texels.push_back(static_cast<float>(grid.at(col, row)));
    }
  });
  return {level};
}

inline std::vector<TextureLevel> bounds_of(const MaxPyramid& pyramid) {
  std::vector<TextureLevel> levels;
  std::uint32_t cols = std::bit_ceil(static_cast<std::uint32_t>(pyramid.levels()[0].cols));
  std::uint32_t rows = std::bit_ceil(static_cast<std::uint32_t>(pyramid.levels()[0].rows));
  for (const auto& of : pyramid.levels()) {
    TextureLevel level{cols, rows, std::vector<float>(std::size_t{2} * cols * rows)};
    for (int row = 0; row < of.rows; ++row) {
      for (int col = 0; col < of.cols; ++col) {
        const std::ptrdiff_t entry = of.begin + std::ptrdiff_t{row} * of.cols + col;
        float* texel = &level.texels[2 * (static_cast<std::size_t>(row) * cols + static_cast<std::size_t>(col))];
        texel[0] = pyramid.maxima()[entry];
        texel[1] = pyramid.minima()[entry];
      }
    }
    levels.push_back(std::move(level));
    cols = std::max(cols / 2, 1U);
    rows = std::max(rows / 2, 1U);
  }
  return levels;
}

}  // namespace scarp::test
