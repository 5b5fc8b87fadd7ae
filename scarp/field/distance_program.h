// SPDX-License-Identifier: MIT
// A shape as a flat list of instructions: what CPU and GPU evaluate, and what bounds are computed by.
//
// There are registers for positions, each in the frame of the solids that read it, and for values, each with the
// material that it comes from. Constants lie in one array; an instruction knows where its own begin. Every length is
// already in metres of the world: scales are folded into the constants.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "scarp/field/distance_node.h"

namespace scarp {

enum class DistanceOp : std::uint8_t {
  // Positions: into position register `out`, from position register `a`.
  turn,       ///< M (p - c): 3 numbers of c, 9 of M row by row
  fold,       ///< into the nearest copy's frame: p - c, its periods, its counts (0: no end): 9 numbers
  neighbour,  ///< from a fold into the frame of a copy next to it: its axes as bits of `mask`; numbers of the fold
  // Solids: value register `out`, position register `a`; numbers begin with the centre c, then as told.
  sphere,           ///< radius
  box,              ///< half x, y, z without the rounding; rounding
  plane,            ///< unit normal; height (c is not used: 0)
  capsule,          ///< half length, along z; radius
  cylinder,         ///< radius, half height
  cone,             ///< radius below, radius above, half height; cosine and sine of the side's normal
  torus,            ///< radius, tube
  ellipsoid,        ///< radii; smallest radius
  function_ground,  ///< scale; shrink; `index` into functions
  field_ground,     ///< scale; shrink; slope; `index` into fields
  // Values: value register `out`, from value registers `a` and `b`.
  unite,         ///< the smaller
  intersect,     ///< the larger
  subtract,      ///< the larger of a and -b
  smooth_unite,  ///< likewise with a radius: 1 number
  smooth_intersect,
  smooth_subtract,
  clamp,      ///< the larger of `a` and the distance to a box, position register `b`: low, high: 6 numbers
  rest_bound  ///< the smaller of `a` and the distance to all but the nearest copies, position register `b`, a fold:
              ///< numbers of the fold, then the box's largest coordinate along each axis
};

struct DistanceInstruction {
  DistanceOp op = DistanceOp::sphere;
  std::uint8_t out = 0, a = 0, b = 0;
  std::uint8_t mask = 0;
  std::uint16_t material = 0;
  std::uint32_t number = 0;  ///< where its constants begin
  std::uint32_t index = 0;
};

/// Registers there are; position register 0 holds the position when the program begins.
inline constexpr int kDistancePositions = 32;
inline constexpr int kDistanceValues = 32;

struct DistanceProgram {
  std::vector<DistanceInstruction> code;
  std::vector<double> numbers;
  std::vector<std::shared_ptr<const HeightFunction>> functions;
  std::vector<std::shared_ptr<const HeightField>> fields;
  double rounding = 0, rounding_per_metre = 0;  ///< see DistanceField::rounding()
};

/// Throws Error for a shape that needs more than 16384 instructions or more registers than there are.
DistanceProgram compile(const Shape& shape);

}  // namespace scarp
