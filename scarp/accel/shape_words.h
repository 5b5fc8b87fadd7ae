// SPDX-License-Identifier: MIT
// A distance field as shaders interpret it, and what their values are off by.
#pragma once

#include <cstdint>
#include <vector>

#include "scarp/accel/shape_buffers.glsl.h"
#include "scarp/field/distance_field.h"

namespace scarp {

struct ShapeWords {
  std::vector<glsl::ScarpShapeInstruction> code;
  std::vector<float> numbers;
};

/// Throws Error for a shape with a ground of a height field or function in it: these do not run on devices.
ShapeWords shape_words(const DistanceProgram& program);
/// What is in it: 1 << op.
std::uint32_t shape_parts(const DistanceProgram& program);

/// What values as shaders compute them are off by, at positions at most `reach` from the origin, metres.
double single_rounding(const DistanceField& shape, double reach);

}  // namespace scarp
