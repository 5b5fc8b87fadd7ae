// SPDX-License-Identifier: MIT
// The shader source of `max-mip-easy`, compiled as C++: a class that implements its texture lookups with a field and
// its pyramid, and has its functions as members.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <limits>

#include "scarp/accel/max_pyramid.h"
#include "scarp/field/height_field.h"

namespace scarp::easy {

using glm::abs, glm::clamp, glm::max, glm::min;
using glm::ivec2, glm::vec2, glm::vec3, glm::vec4;
using std::sqrt;

class Ground {
 public:
  /// The field has cells and no holes, does not wrap, and has a bilinear surface.
  Ground(const HeightField& field, const MaxPyramid& pyramid) : field_(field), pyramid_(pyramid) {}

  ivec2 easy_cells() const { return {field_.cell_cols(), field_.cell_rows()}; }
  int easy_top_level() const { return pyramid_.top_level(); }
  float easy_height(ivec2 node) const {
    return field_.visit([&](const auto& grid) { return static_cast<float>(grid.at(node.x, node.y)); });
  }
  float easy_maximum(ivec2 block, int level) const {
    if (level == 0) {
      ++cells_;
      return max(max(easy_height(block), easy_height(block + ivec2(1, 0))),
                 max(easy_height(block + ivec2(0, 1)), easy_height(block + ivec2(1, 1))));
    }
    const double maximum = pyramid_.maximum(level, block.x, block.y);
    const float rounded = static_cast<float>(maximum);
    return static_cast<double>(rounded) < maximum ? std::nextafter(rounded, std::numeric_limits<float>::infinity())
                                                  : rounded;
  }

  /// Number of maxima of level 0 so far, each of the four heights of a cell.
  std::uint32_t cells() const { return cells_; }

// The shader source defines a struct, constants and functions.
#define MAX_MIP_EASY_HOST
#include "scarp/march/height/max_mip_easy.glsl.h"

 private:
  const HeightField& field_;
  const MaxPyramid& pyramid_;
  mutable std::uint32_t cells_ = 0;
};

}  // namespace scarp::easy
