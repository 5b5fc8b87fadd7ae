// SPDX-License-Identifier: MIT
// Layout of a distance field in device memory: the instructions of its program (field/distance_program.h), 32 bytes
// each, its constants as floats, and its grounds. DeviceShape (march/shape/shape_queries_vk.h) writes it; the shader
// interpreter (march/shape/shape_distance.glsl.h) reads it.
#ifndef SCARP_ACCEL_SHAPE_BUFFERS_GLSL_H
#define SCARP_ACCEL_SHAPE_BUFFERS_GLSL_H

#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// Values of ScarpShapeInstruction::op, equal to DistanceOp.
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

/// Number of registers, for positions and for values. Position 0 holds the position at the start of the program, value
/// 0 the result at its end.
const int kScarpShapeRegisters = 32;
/// Stands for infinity.
const float kScarpEndless = 1.0e30f;

/// DistanceInstruction without its material, which the host evaluates in double.
struct ScarpShapeInstruction {
  uint op;
  uint to;  ///< register written
  uint a;   ///< registers read
  uint b;
  uint mask;
  uint number;  ///< index of its first constant
  uint index;   ///< index of a ground: functions first, then fields
  uint none;
};

/// A ground in a shape.
struct ScarpShapeGround {
  Address data;   ///< instructions of a function, or GroundBuffers of a field
  Address holes;  ///< GroundBuffers of the field that defines the holes
  uint count;     ///< number of instructions of a function
  uint result;    ///< result register of a function
  uint has_holes;
  uint none;
};

SCARP_GLSL_END

#endif
