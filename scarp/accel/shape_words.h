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

ShapeWords shape_words(const DistanceProgram& program);
/// What is in it: 1 << op.
std::uint32_t shape_parts(const DistanceProgram& program);
/// What its grounds that are functions have, as function_parts().
std::uint32_t shape_function_parts(const DistanceProgram& program);

/// What values as shaders compute them are off by, metres: so much at the origin, and so much more per metre that the
/// position is away from it. Throws Error for a function whose numbers do not fit into floats.
class ShapeSingleRounding {
 public:
  explicit ShapeSingleRounding(const DistanceField& shape);

  double at(double reach) const { return at_origin_ + per_metre_ * reach; }
  double per_metre() const { return per_metre_; }

 private:
  double at_origin_, per_metre_;
};

}  // namespace scarp
