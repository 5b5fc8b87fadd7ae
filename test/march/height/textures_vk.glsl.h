// SPDX-License-Identifier: MIT
// Shared by textures_vk.comp and its test.
#ifndef TEST_MARCH_TEXTURES_VK_GLSL_H
#define TEST_MARCH_TEXTURES_VK_GLSL_H

#include "scarp/march/height/ray_frame.glsl.h"
#include "scarp/march/sampling/sampling.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

// The specialisation constant that selects max-mip or the sampling marches; ScarpSampling::march selects one of the
// latter.
const int kTexturesSampled = 0;
const int kTexturesMaxMip = 1;

struct TexturesPush {
  Address rays;
  Address hits;
  ScarpField field;
  float nodata;
  uint count;
  ScarpSampling settings;  // for all marches except max-mip
};

SCARP_GLSL_END

#endif
