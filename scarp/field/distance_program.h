// SPDX-License-Identifier: MIT
// A shape as a flat list of instructions: what CPU and GPU evaluate, and what bounds are computed by.
//
// There are registers for positions, each in the frame of the solids that read it, and for values, each with the
// material that it comes from. Constants lie in one array; an instruction knows where its own begin. Every length is
// already in metres of the world: scales are folded into the constants.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "scarp/field/distance_node.h"

namespace scarp {

enum class DistanceOp : std::uint8_t {
  // Positions: into position register `out`, from position register `a`.
  turn,       ///< M (p - c): 3 numbers of c, 9 of M row by row
  fold,       ///< into the frame of the nearest copy: 12 numbers, see below
  neighbour,  ///< into that of the copy next to it, along the axes that are bits of `mask`: likewise
  // Solids: value register `out`, position register `a`; numbers begin with the centre, then as told.
  sphere,           ///< radius
  box,              ///< half x, y, z without the rounding; rounding
  plane,            ///< unit normal; height (there is no centre)
  capsule,          ///< half length, along z; radius
  cylinder,         ///< radius, half height
  cone,             ///< radius below, radius above, half height
  torus,            ///< radius, tube
  ellipsoid,        ///< radii; the smallest of them
  function_ground,  ///< scale, shrink; `index` of functions
  field_ground,     ///< scale, shrink, slope; `index` of fields
  // Values: value register `out`, from value registers `a` and `b`.
  unite,         ///< the smaller
  intersect,     ///< the larger
  subtract,      ///< the larger of a and -b
  smooth_unite,  ///< likewise, with a radius
  smooth_intersect,
  smooth_subtract,
  clamp,       ///< the larger of `a` and the distance of position `b` to a box: low, high
  rest_bound,  ///< the smaller of `a` and what position `b` has at least to copies that are not looked at: 12 numbers;
               ///< with mask 1 it is known not to be smaller at any single position, only over segments
  // Ways round: the next `index` instructions are left out where they cannot change value `a`, position `b`.
  skip_far,   ///< for they unite (mask 0) or subtract (mask 1) what lies in a box: low, high, radius of the operation
  skip_copy,  ///< for they unite a neighbour (axes in `mask`): 12 numbers
};
// The 12 numbers of copies: middle of the shape's box, period (0: none), copies on each side (0: without end), half of
// the box's length, perhaps infinite; each along x, y, z.

struct DistanceInstruction {
  DistanceOp op = DistanceOp::sphere;
  std::uint8_t out = 0, a = 0, b = 0;
  std::uint8_t mask = 0;
  std::uint16_t material = 0;
  std::uint32_t number = 0;  ///< where its constants begin
  std::uint32_t index = 0;
};

/// Registers there are; position register 0 holds the position when the program begins. The result is value 0.
inline constexpr int kDistancePositions = 32;
inline constexpr int kDistanceValues = 32;

struct DistanceProgram {
  std::vector<DistanceInstruction> code;
  std::vector<double> numbers;
  std::vector<std::shared_ptr<const HeightFunction>> functions;
  std::vector<double> function_away;  ///< of each: metres that its frame is from a position's, at most
  std::vector<std::shared_ptr<const HeightField>> fields;
  std::vector<std::shared_ptr<const HeightField>> holes;  ///< of each: the field whose holes it has, or null
  double rounding = 0, rounding_per_metre = 0;  ///< of values, at a position and per metre of its distance from 0
  std::array<double, 32> ground_rounding{};     ///< of the grounds' heights, at positions within 2^i
};

/// Throws Error for a shape that needs more than 16384 instructions or more registers than there are.
DistanceProgram compile(const Shape& shape);

}  // namespace scarp
