// SPDX-License-Identifier: MIT
// Shared by max_pyramid.comp and the C++ code that dispatches it.
#ifndef SCARP_ACCEL_MAX_PYRAMID_GLSL_H
#define SCARP_ACCEL_MAX_PYRAMID_GLSL_H

#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

// Entries per workgroup: kPyramidGroupCols x kPyramidGroupRows, within the 128 invocations that every device supports
// (maxComputeWorkGroupInvocations of Vulkan 1.2).
const uint kPyramidGroupCols = 32u;
const uint kPyramidGroupRows = 4u;

// Lookup tables for the codes of float samples: ceilings[code] is the key of the greatest float that encode_above()
// maps to `code` or less, floors[code] the key of the least float that encode_below() maps to `code` or more.
const uint kPyramidCodes = 65536u;

/// Push constants of max_pyramid.comp.
struct PyramidPush {
  Address ground;  // GroundBuffers
  Address codes;   // ceilings, then floors, kPyramidCodes words each; floats only
  uint level;      // level to build; 1 reads the samples, others the next finer level
  uint col_begin;  // entries [col_begin, col_end) x [row_begin, row_end)
  uint row_begin;
  uint col_end;
  uint row_end;
};

// Keys order floats as integers: the bits, inverted for negative floats. No finite float has key 0.
SCARP_FN uint float_key(uint bits) { return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u; }
SCARP_FN uint float_bits(uint key) { return (key & 0x80000000u) != 0u ? key & 0x7fffffffu : ~key; }

SCARP_GLSL_END

#endif
