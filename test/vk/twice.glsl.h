// SPDX-License-Identifier: MIT
// Shared by twice.comp and the tests.
#ifndef TEST_VK_TWICE_GLSL_H
#define TEST_VK_TWICE_GLSL_H

#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

struct TwicePush {
  Address from;
  Address to;
  uint count;
  uint rounds;  // number of repetitions
};

SCARP_FN uint twice(uint x) { return 2u * x; }

SCARP_GLSL_END

#endif
