// SPDX-License-Identifier: MIT
// A shape compiled to a flat list of instructions, for evaluation on CPU and GPU and for bounds.
//
// Each position register is in the frame of the solids that read it; each value register also carries the material of
// its solid. All constants are in one array. All lengths are in world metres: scales are folded into the constants.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "scarp/field/distance_node.h"

namespace scarp {

enum class DistanceOp : std::uint8_t {
  // Positions: compute position register `out` from position register `a`.
  turn,       ///< M (p - c): the 3 numbers of c, then the 9 of M in row-major order
  fold,       ///< to the frame of the nearest copy: 12 numbers, see below
  neighbour,  ///< to the frame of the adjacent copy along the axes in `mask`: the same 12 numbers
  // Solids: compute value register `out` from position register `a`; the constants are the centre, then those listed.
  sphere,           ///< radius
  box,              ///< half x, y, z without the rounding; rounding radius
  plane,            ///< unit normal; height (no centre)
  capsule,          ///< half length, along z; radius
  cylinder,         ///< radius, half height
  cone,             ///< bottom radius, top radius, half height
  torus,            ///< radius, tube
  ellipsoid,        ///< radii; the smallest radius
  function_ground,  ///< scale, shrink; `index` of a function
  field_ground,     ///< scale, shrink, slope; `index` of a field
  // Values: compute value register `out` from value registers `a` and `b`.
  unite,         ///< minimum
  intersect,     ///< maximum
  subtract,      ///< max(a, -b)
  smooth_unite,  ///< as above, with a blend radius
  smooth_intersect,
  smooth_subtract,
  clamp,       ///< maximum of `a` and the distance from position `b` to a box: low, high
  rest_bound,  ///< minimum of `a` and a lower bound at position `b` for copies that are not evaluated: 12 numbers;
               ///< with mask 1 it can be smaller only over segments, not at a position
  // Skips: omit the next `index` instructions if they cannot change value `a` at position `b`.
  skip_far,   ///< they unite (mask 0) or subtract (mask 1) a part within a box: low, high, blend radius
  skip_copy,  ///< they unite an adjacent copy (axes in `mask`): 12 numbers
};
// The 12 numbers of copies: centre of the shape's box, period (0: none), copies on each side (0: unlimited), half the
// box's size, possibly infinite; each along x, y, z.

/// One instruction of a shape.
struct DistanceInstruction {
  DistanceOp op = DistanceOp::sphere;
  std::uint8_t out = 0, a = 0, b = 0;
  std::uint8_t mask = 0;
  std::uint16_t material = 0;
  std::uint32_t number = 0;  ///< index of its first constant
  std::uint32_t index = 0;
};

/// Number of registers. Position 0 holds the position at the start of the program; value 0 is the result.
inline constexpr int kDistancePositions = 32;
inline constexpr int kDistanceValues = 32;

/// Instructions, constants and grounds of a shape.
struct DistanceProgram {
  std::vector<DistanceInstruction> code;
  std::vector<double> numbers;
  std::vector<std::shared_ptr<const HeightFunction>> functions;
  std::vector<double> function_away;  ///< maximum offset of each function's frame from a position, in metres
  std::vector<std::shared_ptr<const HeightField>> fields;
  std::vector<std::shared_ptr<const HeightField>> holes;  ///< for each field: the field that defines its holes, or null
  double rounding = 0,
         rounding_per_metre = 0;  ///< rounding error of values: at the origin, and per metre of distance from it
  std::array<double, 32> ground_rounding{};  ///< of ground heights, at positions within 2^i
};

/// Throws Error for a shape that needs more than 16384 instructions or too many registers.
DistanceProgram compile(const Shape& shape);

}  // namespace scarp
