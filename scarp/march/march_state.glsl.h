// SPDX-License-Identifier: MIT
// Result statuses and the state of interrupted single-precision marches, for all kinds of field.
//
// Compiles as C++ and GLSL, including GLSL ES 3.0.
#ifndef SCARP_MARCH_MARCH_STATE_GLSL_H
#define SCARP_MARCH_MARCH_STATE_GLSL_H

#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

const int kScarpMiss = 0;
const int kScarpHit = 1;
const int kScarpBelow = 2;      ///< started or entered below the surface, and hit nothing
const int kScarpExhausted = 3;  ///< a limit was reached: nothing is known beyond the time
const int kScarpWall = 4;       ///< a hit, of the wall under a border or a hole's rim
const int kScarpDoubtful = -1;  ///< of a first pass: to be marched by the second

/// Later than any time.
const float kScarpNever = 1.0e30f;

/// State of an interrupted march. For a ray that has not started, steps and phase are 0.
struct ScarpMarchState {
  float s;       ///< time
  float before;  ///< this and h_before depend on the march
  float h_before;
  int steps;  ///< taken so far
  uint phase;
};

SCARP_GLSL_END

#endif
