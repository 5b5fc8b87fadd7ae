// SPDX-License-Identifier: MIT
// A distance field as it lies in a device's memory: the instructions of its program (field/distance_program.h), 32
// bytes each, their numbers as floats, and where its grounds are. DeviceShape (march/shape/shape_queries_vk.h) makes
// it; the interpreter of shaders (march/shape/shape_distance.glsl.h) reads it.
#ifndef SCARP_ACCEL_SHAPE_BUFFERS_GLSL_H
#define SCARP_ACCEL_SHAPE_BUFFERS_GLSL_H

#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// Of ScarpShapeInstruction::op, the values of DistanceOp.
const uint kScarpShapeTurn = 0u;
const uint kScarpShapeFold = 1u;
const uint kScarpShapeNeighbour = 2u;
const uint kScarpShapeSphere = 3u;
const uint kScarpShapeBox = 4u;
const uint kScarpShapePlane = 5u;
const uint kScarpShapeCapsule = 6u;
const uint kScarpShapeCylinder = 7u;
const uint kScarpShapeCone = 8u;
const uint kScarpShapeTorus = 9u;
const uint kScarpShapeEllipsoid = 10u;
const uint kScarpShapeFunctionGround = 11u;
const uint kScarpShapeFieldGround = 12u;
const uint kScarpShapeUnite = 13u;
const uint kScarpShapeIntersect = 14u;
const uint kScarpShapeSubtract = 15u;
const uint kScarpShapeSmoothUnite = 16u;
const uint kScarpShapeSmoothIntersect = 17u;
const uint kScarpShapeSmoothSubtract = 18u;
const uint kScarpShapeClamp = 19u;
const uint kScarpShapeRestBound = 20u;
const uint kScarpShapeSkipFar = 21u;
const uint kScarpShapeSkipCopy = 22u;

/// Registers there are, of positions and of values; position 0 holds the position when the program begins, value 0 the
/// result when it ends.
const int kScarpShapeRegisters = 32;
/// In the place of infinity.
const float kScarpEndless = 1.0e30f;

/// DistanceInstruction without its material, which hosts look up in double.
struct ScarpShapeInstruction {
  uint op;
  uint to;  ///< register written
  uint a;   ///< registers read
  uint b;
  uint mask;
  uint number;  ///< where its constants begin
  uint index;   ///< of grounds: functions first, fields behind them
  uint none;
};

/// A ground among a shape's parts.
struct ScarpShapeGround {
  Address data;   ///< of a function its instructions, of a field its GroundBuffers
  Address holes;  ///< GroundBuffers of the field whose holes it has
  uint count;     ///< of a function: of its instructions
  uint result;    ///< of a function: register
  uint has_holes;
  uint none;
};

SCARP_GLSL_END

#endif
