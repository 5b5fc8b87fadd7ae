// SPDX-License-Identifier: MIT
// Lit ground, without the air in front of it: a stage of terrain_frame.glsl.h.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "scarp/render/frame/terrain_frame_stage.glsl.h"
// The following files use its definitions of ground and directions.
#include "scarp/march/function/noise.glsl.h"
#include "scarp/march/height/surface_normal.glsl.h"
#include "scarp/render/frame/terrain_frame_ground.glsl.h"

void main() {
  uint at = gl_GlobalInvocationID.x;
  if (at >= push.threads) return;
  uint i = Indices(push.grounds).of[at];
  FrameSeen seen = Seens(push.seens).of[i];
  Settings s = settings();
  vec3 colour = ground_colour(shown_field(), seen, direction_of(seen.line));
  if (s.is.unlit == 0) {
    float sun_cosine = has_shadows ? seen.sun_cosine : max(0.0, dot(seen.normal, s.is.to_sun));
    if (has_shadows && has_samples) sun_cosine /= float(s.is.sun_rays);
    float sky = has_samples && s.is.sky_rays > 0 ? seen.sky / float(s.is.sky_rays) : 1.0;
    colour *= scarp_light(seen.normal, s.is.sky_side, s.is.skylight, s.is.sun, sun_cosine, sky);
  }
  Seens(push.seens).of[i].light = colour;
}
