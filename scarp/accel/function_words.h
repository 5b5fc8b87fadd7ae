// SPDX-License-Identifier: MIT
// Encodes terrain functions for shaders and bounds the error of heights computed there.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scarp/accel/function_buffers.glsl.h"
#include "scarp/field/height_function.h"

namespace scarp {

/// Returns the encoded instructions of one program.
std::vector<glsl::ScarpInstruction> function_words(const FunctionProgram& program);

/// Returns the contents of a program as bits: 1 << op, 1 << (kScarpNoiseBit + kind).
std::uint32_t function_parts(const FunctionProgram& program);

/// Error bound of one program's heights as computed by shaders, depending on position.
class SingleRounding {
 public:
  /// Throws Error if a constant does not fit in single precision.
  explicit SingleRounding(const FunctionProgram& program);

  /// Returns the bound in metres for positions up to `reach` (<= kFunctionReach) from the origin along each axis.
  double at(double reach) const;

 private:
  std::array<double, 31> off_;  // within 2^i
};

}  // namespace scarp
