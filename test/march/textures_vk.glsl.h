// SPDX-License-Identifier: MIT
// What textures_vk.comp and its test agree upon.
#ifndef TEST_MARCH_TEXTURES_VK_GLSL_H
#define TEST_MARCH_TEXTURES_VK_GLSL_H

#include "scarp/march/ray_frame.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

struct TexturesPush {
  Address rays;
  Address hits;
  ScarpField field;
  float nodata;
  uint count;
};

SCARP_GLSL_END

#endif
