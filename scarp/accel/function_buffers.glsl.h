// SPDX-License-Identifier: MIT
// Layout of a terrain function in device memory: the instructions of its program (field/function_program.h), 64 bytes
// each. DeviceFunction (device_function.h) writes it; the shader interpreter (march/function/function_heights.glsl.h)
// reads it.
#ifndef SCARP_ACCEL_FUNCTION_BUFFERS_GLSL_H
#define SCARP_ACCEL_FUNCTION_BUFFERS_GLSL_H

#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// Values of ScarpInstruction::op, equal to FunctionOp.
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

/// Bits that describe the contents of a program: 1 << op, and 1 << (kScarpNoiseBit + kind) for noise.
const uint kScarpNoiseBit = 16u;

/// Number of registers. Registers 0 and 1 hold x and y at the start of the program.
const int kScarpRegisters = 64;

/// FunctionInstruction with each constant as the sum of two floats.
struct ScarpInstruction {
  uint op;
  uint kind;  ///< NoiseKind, for noise
  uint to;    ///< registers written: `to`, and to_x and to_y by some operations
  uint to_x;
  uint to_y;
  uint a;  ///< registers read
  uint b;
  uint seed;
  float k0, k0_low;
  float k1, k1_low;
  float k2, k2_low;  ///< 1 / k0 for kScarpTerrace
  float k3, k3_low;
};

SCARP_GLSL_END

#endif
