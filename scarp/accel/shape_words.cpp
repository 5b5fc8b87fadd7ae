// SPDX-License-Identifier: MIT
#include "scarp/accel/shape_words.h"

#include <algorithm>

#include "scarp/accel/function_words.h"

namespace scarp {

ShapeWords shape_words(const DistanceProgram& program) {
  ShapeWords words;
  const auto functions = static_cast<std::uint32_t>(program.functions.size());
  for (const DistanceInstruction& in : program.code) {
    const std::uint32_t index = in.index + (in.op == DistanceOp::field_ground ? functions : 0);
    words.code.push_back({static_cast<std::uint32_t>(in.op), in.out, in.a, in.b, in.mask, in.number, index, 0});
  }
  const double endless{glsl::kScarpEndless};
  for (const double number : program.numbers)
    words.numbers.push_back(static_cast<float>(std::clamp(number, -endless, endless)));
  // For every solid, shaders read the number of constants that the longest solid has.
  words.numbers.resize(words.numbers.size() + 8);
  return words;
}

std::uint32_t shape_parts(const DistanceProgram& program) {
  std::uint32_t parts = 0;
  for (const DistanceInstruction& in : program.code) parts |= 1u << static_cast<unsigned>(in.op);
  return parts;
}

std::uint32_t shape_function_parts(const DistanceProgram& program) {
  std::uint32_t parts = 0;
  for (const auto& function : program.functions) parts |= function_parts(function->program(FunctionUse::march));
  return parts;
}

// The rounding counts for doubles (distance_program.cpp), with 2^-24 instead of 2^-53, times 1.5: constants are rounded
// to floats, and square roots and divisions on devices are accurate to 2.5 units. Functions have their own bounds,
// which grow in steps; the linear bound computed here is above these steps.
ShapeSingleRounding::ShapeSingleRounding(const DistanceField& shape) {
  const DistanceProgram& program = shape.program();
  at_origin_ = 0x1.8p29 * program.rounding;
  per_metre_ = 0x1.8p29 * program.rounding_per_metre;
  double at_origin = 0, per_metre = 0;
  for (const DistanceInstruction& in : program.code) {
    if (in.op != DistanceOp::function_ground) continue;
    const double scale = program.numbers[in.number + 3], factor = program.numbers[in.number + 4] * scale;
    const SingleRounding heights(program.functions[in.index]->program(FunctionUse::march));
    const double away = program.function_away[in.index];
    const double least = factor * heights.at(away / scale);
    at_origin = std::max(at_origin, least);
    // A step at 2^i metres of the function starts at `begin` metres of the shape.
    for (double reach = 1; reach < kFunctionReach; reach *= 2) {
      const double begin = reach * scale - away;
      if (begin > 0) per_metre = std::max(per_metre, (factor * heights.at(2 * reach) - least) / begin);
    }
  }
  at_origin_ += at_origin;
  per_metre_ += per_metre;
}

}  // namespace scarp
