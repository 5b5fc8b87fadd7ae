// SPDX-License-Identifier: MIT
#include "scarp/accel/function_words.h"

#include <cmath>

#include "scarp/base/error.h"
#include "scarp/base/two_floats.h"
#include "scarp/field/function_single.h"

namespace scarp {

std::vector<glsl::ScarpInstruction> function_words(const FunctionProgram& program) {
  std::vector<glsl::ScarpInstruction> words;
  words.reserve(program.code.size());
  for (const FunctionInstruction& in : program.code) {
    glsl::ScarpInstruction& out = words.emplace_back();
    out.op = static_cast<std::uint32_t>(in.op);
    out.kind = static_cast<std::uint32_t>(in.kind);
    out.to = in.out, out.to_x = in.out_x, out.to_y = in.out_y;
    out.a = in.a, out.b = in.b;
    out.seed = in.seed;
    split(in.k0, out.k0, out.k0_low);
    split(in.k1, out.k1, out.k1_low);
    split(in.op == FunctionOp::terrace ? 1 / in.k0 : in.k2, out.k2, out.k2_low);
    split(in.k3, out.k3, out.k3_low);
  }
  return words;
}

std::uint32_t function_parts(const FunctionProgram& program) {
  std::uint32_t parts = 0;
  for (const FunctionInstruction& in : program.code) {
    parts |= 1u << static_cast<unsigned>(in.op);
    if (in.op == FunctionOp::noise || in.op == FunctionOp::noise_slope)
      parts |= 1u << (glsl::kScarpNoiseBit + static_cast<unsigned>(in.kind));
  }
  return parts;
}

SingleRounding::SingleRounding(const FunctionProgram& program) {
  for (std::size_t i = 0; i < off_.size(); ++i) {
    const function::Single height = function::single_height(program, std::exp2(static_cast<double>(i)));
    if (!height.fits) {
      throw Error("terrain function: numbers beyond 2^60 do not fit in single precision (use the CPU)");
    }
    off_[i] = height.error;
  }
}

double SingleRounding::at(double reach) const {
  std::size_t i = 0;
  while (i + 1 < off_.size() && std::exp2(static_cast<double>(i)) < reach) ++i;
  return off_[i];
}

}  // namespace scarp
