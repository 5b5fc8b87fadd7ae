// SPDX-License-Identifier: MIT
// What textures_vk.comp and its test agree upon.
#ifndef TEST_MARCH_TEXTURES_VK_GLSL_H
#define TEST_MARCH_TEXTURES_VK_GLSL_H

#include "scarp/march/height/ray_frame.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

// The specialisation constant of the march.
const int kTexturesMaxMip = 0;
const int kTexturesNaive = 1;
const int kTexturesFixedStep = 2;
const int kTexturesRelaxed = 3;
const int kTexturesLipschitz = 4;

// Settings as RayBatch has them.
struct TexturesPush {
  Address rays;
  Address hits;
  ScarpField field;
  float nodata;
  uint count;
  float step;
  float min_step;
  float tolerance;
  int max_steps;
  int interpolate;
};

SCARP_GLSL_END

#endif
