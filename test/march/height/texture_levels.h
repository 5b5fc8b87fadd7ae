// SPDX-License-Identifier: MIT
// Content of the textures of scarp/march/height/textures.glsl.h and max_mip_easy.glsl.h, level by level, rows one after
// the other.
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
        texel[0] = pyramid.maximum_code(entry);
        texel[1] = pyramid.minima()[entry];
      }
    }
    levels.push_back(std::move(level));
    cols = std::max(cols / 2, 1U);
    rows = std::max(rows / 2, 1U);
  }
  return levels;
}

/// The mip levels of easy_maxima (max_mip_easy.glsl.h).
inline std::vector<TextureLevel> maxima_of(const HeightField& field) {
  const TextureLevel heights = heights_of(field)[0];
  const std::uint32_t cols = heights.cols - 1, rows = heights.rows - 1;
  std::vector<TextureLevel> levels = {{std::bit_ceil(cols), std::bit_ceil(rows), {}}};
  levels[0].texels.resize(std::size_t{levels[0].cols} * levels[0].rows);
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t col = 0; col < cols; ++col) {
      const float* north = &heights.texels[std::size_t{row} * heights.cols + col];
      const float* south = north + heights.cols;
      levels[0].texels[std::size_t{row} * levels[0].cols + col] = std::max({north[0], north[1], south[0], south[1]});
    }
  }
  while (levels.back().texels.size() > 1) {
    const TextureLevel& fine = levels.back();
    TextureLevel coarse{std::max(fine.cols / 2, 1U), std::max(fine.rows / 2, 1U), {}};
    for (std::uint32_t row = 0; row < coarse.rows; ++row) {
      for (std::uint32_t col = 0; col < coarse.cols; ++col) {
        const auto texel = [&](std::uint32_t c, std::uint32_t r) {
          return fine.texels[std::size_t{std::min(r, fine.rows - 1)} * fine.cols + std::min(c, fine.cols - 1)];
        };
        coarse.texels.push_back(std::max({texel(2 * col, 2 * row), texel(2 * col + 1, 2 * row),
                                          texel(2 * col, 2 * row + 1), texel(2 * col + 1, 2 * row + 1)}));
      }
    }
    levels.push_back(std::move(coarse));
  }
  return levels;
}

}  // namespace scarp::test
