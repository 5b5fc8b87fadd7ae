// SPDX-License-Identifier: MIT
// A terrain function compiled to a flat list of instructions, one program per purpose, for evaluation on CPU, SIMD and
// GPU and for bounds.
#pragma once

#include <cstdint>
#include <vector>

#include "scarp/field/function_node.h"

namespace scarp {

/// Purpose of heights: selects the number of octaves.
enum class FunctionUse : std::uint8_t { march, shadow, normal };

/// Operations of instructions.
enum class FunctionOp : std::uint8_t {
  constant,        ///< k0
  combine,         ///< k0 * a + k1 * b + k2
  turn,            ///< rotated position: k0 * a - k1 * b, and k1 * a + k0 * b into out_x
  multiply,        ///< a * b
  square,          ///< a * a
  absolute,        ///< |a|
  clamp,           ///< a clamped to [k0, k1]
  sine,            ///< sin(a)
  minimum,         ///< the smaller of a and b
  maximum,         ///< the larger of a and b
  smooth_minimum,  ///< of a and b, radius k0
  reciprocal,      ///< 1 / a, a >= 1
  noise,           ///< noise at (a, b)
  noise_slope,     ///< noise, and its gradient into out_x and out_y
  terrace,         ///< a in steps of k0, rising in the last k1 of each
  radial,          ///< mask at (a, b) about (k0, k1): 1 within k2, 0 beyond k3
};

/// One instruction of a terrain function.
struct FunctionInstruction {
  FunctionOp op = FunctionOp::constant;
  NoiseKind kind = NoiseKind::value;
  std::uint8_t out = 0, out_x = 0, out_y = 0;  ///< registers written
  std::uint8_t a = 0, b = 0;                   ///< registers read
  std::uint32_t seed = 0;
  double k0 = 0, k1 = 0, k2 = 0, k3 = 0;

  bool operator==(const FunctionInstruction&) const = default;
};

/// Number of registers. Registers 0 and 1 hold x and y at the start of the program.
inline constexpr int kFunctionRegisters = 64;

/// Instructions of a terrain function and the register of its result.
struct FunctionProgram {
  std::vector<FunctionInstruction> code;
  std::uint8_t result = 0;

  bool operator==(const FunctionProgram&) const = default;
};

/// Throws Error for a function that needs more than 4096 instructions or kFunctionRegisters registers.
FunctionProgram compile(const Function& function, FunctionUse use);

}  // namespace scarp
