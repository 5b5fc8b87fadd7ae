// SPDX-License-Identifier: MIT
// A terrain function as it lies in a device's memory: the instructions of its program (field/function_program.h), one
// after the other, 64 bytes each. DeviceFunction (device_function.h) makes it; the interpreter of shaders
// (march/function/function_heights.glsl.h) reads it.
#ifndef SCARP_ACCEL_FUNCTION_BUFFERS_GLSL_H
#define SCARP_ACCEL_FUNCTION_BUFFERS_GLSL_H

#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// Of ScarpInstruction::op, the values of FunctionOp.
const uint kScarpConstant = 0u;
const uint kScarpCombine = 1u;
const uint kScarpTurn = 2u;
const uint kScarpMultiply = 3u;
const uint kScarpSquare = 4u;
const uint kScarpAbsolute = 5u;
const uint kScarpClamp = 6u;
const uint kScarpSine = 7u;
const uint kScarpMinimum = 8u;
const uint kScarpMaximum = 9u;
const uint kScarpSmoothMinimum = 10u;
const uint kScarpReciprocal = 11u;
const uint kScarpNoiseOp = 12u;
const uint kScarpNoiseSlope = 13u;
const uint kScarpTerrace = 14u;
const uint kScarpRadial = 15u;

/// What a program has, as bits: 1 << op, and of noise 1 << (kScarpNoiseBit + kind).
const uint kScarpNoiseBit = 16u;

/// Registers there are; 0 and 1 hold x and y when the program begins.
const int kScarpRegisters = 64;

/// FunctionInstruction, its numbers as sums of two floats.
struct ScarpInstruction {
  uint op;
  uint kind;  ///< of noise: NoiseKind
  uint to;    ///< registers written: to, and of some to_x and to_y
  uint to_x;
  uint to_y;
  uint a;  ///< registers read
  uint b;
  uint seed;
  float k0, k0_low;
  float k1, k1_low;
  float k2, k2_low;  ///< of kScarpTerrace 1 / k0
  float k3, k3_low;
};

SCARP_GLSL_END

#endif
