// SPDX-License-Identifier: MIT
// A terrain function as shaders interpret it, and how far their heights may be from the true ones.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scarp/accel/function_buffers.glsl.h"
#include "scarp/field/height_function.h"

namespace scarp {

/// One program of a function.
std::vector<glsl::ScarpInstruction> function_words(const FunctionProgram& program);

/// What is in it: 1 << op, 1 << (kScarpNoiseBit + kind).
std::uint32_t function_parts(const FunctionProgram& program);

/// What heights of one program as shaders compute them are off by, by where they are.
class SingleRounding {
 public:
  /// Throws Error for a function whose numbers do not fit into floats.
  explicit SingleRounding(const FunctionProgram& program);

  /// Metres, at positions up to `reach` from the origin along each axis; reach at most kFunctionReach.
  double at(double reach) const;

 private:
  std::array<double, 31> off_;  // within 2^i
};

}  // namespace scarp
