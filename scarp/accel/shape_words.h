// SPDX-License-Identifier: MIT
// Encodes distance fields for shaders and bounds the error of values computed there.
#pragma once

#include <cstdint>
#include <vector>

#include "scarp/accel/shape_buffers.glsl.h"
#include "scarp/field/distance_field.h"

namespace scarp {

/// Instructions and constants of a shape for shaders.
struct ShapeWords {
  std::vector<glsl::ScarpShapeInstruction> code;
  std::vector<float> numbers;
};

ShapeWords shape_words(const DistanceProgram& program);
/// Returns the operations in a program as bits: 1 << op.
std::uint32_t shape_parts(const DistanceProgram& program);
/// Returns the contents of the program's function grounds, as function_parts() does.
std::uint32_t shape_function_parts(const DistanceProgram& program);

/// Error bound of values as computed by shaders, in metres: a value at the origin, plus a rate per metre of distance
/// from it. Throws Error if a constant of a function does not fit in single precision.
class ShapeSingleRounding {
 public:
  explicit ShapeSingleRounding(const DistanceField& shape);

  double at(double reach) const { return at_origin_ + per_metre_ * reach; }
  double per_metre() const { return per_metre_; }

 private:
  double at_origin_, per_metre_;
};

}  // namespace scarp
