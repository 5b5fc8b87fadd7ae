// SPDX-License-Identifier: MIT
// States of interrupted marches of a batch (ray_batch.glsl.h), one struct per ray. C++ (for the structs) and GLSL,
// which must define what cell_surface.glsl.h and max_mip.glsl.h require before it includes this file.
#ifndef SCARP_MARCH_BATCH_STATES_GLSL_H
#define SCARP_MARCH_BATCH_STATES_GLSL_H

#ifdef __cplusplus
#include "scarp/march/height/march_host.h"
#endif
#include "scarp/march/height/max_mip.glsl.h"
#include "scarp/march/march_state.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// State of `max-mip`.
struct BatchWalk {
  ScarpHit hit;
  ScarpWalk walk;
  float z;  ///< height of the ray, with which a walk from the surface starts
  float z_low;
};

/// State of the other marches.
struct BatchMarch {
  ScarpHit hit;
  ScarpMarchState state;
};

#ifndef __cplusplus

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer BatchWalks { BatchWalk of[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer BatchMarches { BatchMarch of[]; };

#endif

SCARP_GLSL_END

#endif
