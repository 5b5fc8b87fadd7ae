// SPDX-License-Identifier: MIT
// What max_pyramid.comp and the C++ that calls it agree upon.
#ifndef SCARP_ACCEL_MAX_PYRAMID_GLSL_H
#define SCARP_ACCEL_MAX_PYRAMID_GLSL_H

#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

// A workgroup makes this many entries of a level: kPyramidGroupCols x kPyramidGroupRows, no more than the 128 that
// every device has (maxComputeWorkGroupInvocations of Vulkan 1.2).
const uint kPyramidGroupCols = 32u;
const uint kPyramidGroupRows = 4u;

// Codes of float samples are looked up: ceilings[code] is the key of the greatest float that is encoded above as `code`
// or less, floors[code] the key of the least that is encoded below as `code` or more.
const uint kPyramidCodes = 65536u;

struct PyramidPush {
  Address ground;  // GroundBuffers
  Address codes;   // ceilings, then floors, kPyramidCodes words each; floats only
  uint level;      // to make; from the samples when 1, else from the level below
  uint col_begin;  // entries [col_begin, col_end) x [row_begin, row_end)
  uint row_begin;
  uint col_end;
  uint row_end;
};

// Keys order floats as whole numbers do: their bits, turned over for negative ones. No finite float has the key 0.
SCARP_FN uint float_key(uint bits) { return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u; }
SCARP_FN uint float_bits(uint key) { return (key & 0x80000000u) != 0u ? key & 0x7fffffffu : ~key; }

SCARP_GLSL_END

#endif
