// SPDX-License-Identifier: MIT
#include "scarp/accel/shape_words.h"

#include <algorithm>

#include "scarp/base/error.h"

namespace scarp {

ShapeWords shape_words(const DistanceProgram& program) {
  if (!program.functions.empty() || !program.fields.empty()) {
    throw Error(
        "shape: a ground of a function or a height field is among its parts, which does not run on Vulkan devices; "
        "place the ground beside the shape, or ask the CPU");
  }
  ShapeWords words;
  for (const DistanceInstruction& in : program.code)
    words.code.push_back({static_cast<std::uint32_t>(in.op), in.out, in.a, in.b, in.mask, in.number, in.index, 0});
  const double endless{glsl::kScarpEndless};
  for (const double number : program.numbers)
    words.numbers.push_back(static_cast<float>(std::clamp(number, -endless, endless)));
  // Solids are read with the numbers that the longest of them has.
  words.numbers.resize(words.numbers.size() + 8);
  return words;
}

std::uint32_t shape_parts(const DistanceProgram& program) {
  std::uint32_t parts = 0;
  for (const DistanceInstruction& in : program.code) parts |= 1u << static_cast<unsigned>(in.op);
  return parts;
}

// The counts of doubles (distance_program.cpp), at 2^-24 instead of 2^-53, and half as many again: numbers are rounded
// to floats, and roots and divisions of devices are right to 2.5 units.
double single_rounding(const DistanceField& shape, double reach) { return 0x1.8p29 * shape.rounding(reach); }

}  // namespace scarp
