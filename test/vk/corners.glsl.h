// SPDX-License-Identifier: MIT
// Shared by corners.vert, corners.frag and the tests.
#ifndef TEST_VK_CORNERS_GLSL_H
#define TEST_VK_CORNERS_GLSL_H

#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

struct CornersPush {
  Address corners;  // vec4 each, in clip coordinates
  vec4 colour;
  float right;  // offset to the right per instance
};

SCARP_GLSL_END

#endif
