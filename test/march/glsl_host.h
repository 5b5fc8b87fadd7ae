// SPDX-License-Identifier: MIT
// The shader text of the marches, compiled as C++: what it asks of its host, over a field in memory.
#pragma once

#include <cmath>
#include <cstddef>

#include "scarp/accel/max_pyramid.h"
#include "scarp/field/height_field.h"
#include "scarp/vk/glsl_cpp.h"

namespace scarp::glsl {

inline thread_local const HeightField* host_field = nullptr;
inline thread_local const MaxPyramid* host_pyramid = nullptr;

inline float scarp_sample(int col, int row) {
  return host_field->visit([&](const auto& grid) { return static_cast<float>(grid.at(col, row)); });
}
inline bool scarp_is_nodata(float sample) {
  return std::isnan(sample) || static_cast<double>(sample) == host_field->settings().nodata;
}
inline float scarp_maximum(int level, int col, int row) {
  const MaxPyramid::Level& at = host_pyramid->levels()[static_cast<std::size_t>(level - 1)];
  return host_pyramid->maxima()[at.begin + static_cast<std::ptrdiff_t>(row) * at.cols + col];
}
inline float scarp_minimum(int level, int col, int row) {
  const MaxPyramid::Level& at = host_pyramid->levels()[static_cast<std::size_t>(level - 1)];
  return host_pyramid->minima()[at.begin + static_cast<std::ptrdiff_t>(row) * at.cols + col];
}

}  // namespace scarp::glsl
