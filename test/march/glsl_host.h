// SPDX-License-Identifier: MIT
// The host functions that the marches' shader text requires, compiled as C++, over a field in memory.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <vector>

#include "scarp/accel/max_pyramid.h"
#include "scarp/accel/max_quads.glsl.h"
#include "scarp/field/height_field.h"
#include "scarp/vk/glsl_cpp.h"

namespace scarp::glsl {

inline thread_local const HeightField* host_field = nullptr;
inline thread_local const MaxPyramid* host_pyramid = nullptr;

inline float scarp_sample(int col, int row) {
  if (col < 0 || row < 0 || col >= host_field->cols() || row >= host_field->rows())
    throw std::out_of_range("a sample outside the field");
  return host_field->visit([&](const auto& grid) { return static_cast<float>(grid.at(col, row)); });
}
inline vec4 scarp_corners(int col, int row) {
  return {scarp_sample(col, row), scarp_sample(col + 1, row), scarp_sample(col, row + 1),
          scarp_sample(col + 1, row + 1)};
}
inline bool scarp_is_nodata(float sample) {
  return std::isnan(sample) || static_cast<double>(sample) == host_field->settings().nodata;
}
inline float scarp_maximum(int level, int col, int row) {
  const MaxPyramid::Level& at = host_pyramid->levels()[static_cast<std::size_t>(level - 1)];
  return host_pyramid->maximum_code(at.begin + static_cast<std::ptrdiff_t>(row) * at.cols + col);
}
inline float scarp_minimum(int level, int col, int row) {
  const MaxPyramid::Level& at = host_pyramid->levels()[static_cast<std::size_t>(level - 1)];
  return host_pyramid->minima()[at.begin + static_cast<std::ptrdiff_t>(row) * at.cols + col];
}

/// The quads of ground_buffers.glsl.h, as max_quads.comp builds them.
class HostQuads {
 public:
  HostQuads(const HeightField& field, const MaxPyramid& pyramid) {
    const HeightCode& code = pyramid.code();
    const float base = static_cast<float>(code.base), base_low = static_cast<float>(code.base - double{base});
    const float per_step = static_cast<float>(code.per_step);
    const auto cell_code = [&](int col, int row) -> uint {
      if (col >= field.cell_cols() || row >= field.cell_rows()) return 0;
      float highest = static_cast<float>(field.min_sample());
      for (const int x : {col, (col + 1) % field.cols()}) {
        for (const int y : {row, (row + 1) % field.rows()}) {
          const float sample = scarp_sample(x, y);
          if (!scarp_is_nodata(sample)) highest = std::max(highest, sample);
        }
      }
      return scarp_code_above(highest, base, base_low, per_step);
    };
    for (const MaxPyramid::Level& at : pyramid.levels()) {
      Level level{at.cols, {}};
      for (int row = 0; row < at.rows; ++row) {
        for (int col = 0; col < at.cols; ++col) {
          uint codes[4];
          for (int child = 0; child < 4; ++child) {
            const int x = 2 * col + child % 2, y = 2 * row + child / 2;
            codes[child] = levels_.empty() ? cell_code(x, y) : levels_.back().highest(x, y);
          }
          level.quads.emplace_back(codes[0] | codes[1] << 16, codes[2] | codes[3] << 16);
        }
      }
      levels_.push_back(level);
    }
  }

  uvec2 at(int level, int col, int row) const {
    const Level& of = levels_[static_cast<std::size_t>(level - 1)];
    return of.quads[static_cast<std::size_t>(row) * static_cast<std::size_t>(of.cols) + static_cast<std::size_t>(col)];
  }

 private:
  struct Level {
    int cols;
    std::vector<uvec2> quads;
    uint highest(int col, int row) const {
      const std::size_t at =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(col);
      if (col >= cols || at >= quads.size()) return 0;
      const uvec2 quad = quads[at];
      return std::max({quad.x & 0xffffu, quad.x >> 16, quad.y & 0xffffu, quad.y >> 16});
    }
  };
  std::vector<Level> levels_;
};

inline thread_local std::optional<HostQuads> host_quads;

inline uvec2 scarp_quad(int level, int col, int row) { return host_quads->at(level, col, row); }

}  // namespace scarp::glsl
