// SPDX-License-Identifier: MIT
// Stores the hits of marched rays, one invocation per ray: a stage of terrain_frame.glsl.h.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "scarp/render/frame/terrain_frame_stage.glsl.h"
// The next file reads the ground through the stage.
#include "scarp/march/height/ray_blocks.glsl.h"
#include "scarp/march/height/surface_normal.glsl.h"

layout(constant_id = 4) const bool of_light = false;
layout(constant_id = 5) const bool lists_ground = true;

void take_light(uint i, bool met) {
  if (met) return;
  FrameSeen lit = Seens(push.seens).of[i];
  if (goes_to_sun())
    Seens(push.seens).of[i].sun_cosine = lit.sun_cosine + lit.weight;
  else
    Seens(push.seens).of[i].sky = lit.sky + 1.0;
}

void main() {
  uint at = gl_GlobalInvocationID.x;
  if (at >= push.threads) return;
  ScarpHit hit = hit_of_block(HitBlockAt(ray_block_address(push.hits, at, kHitBlockBytes)), at % kRayBlock);
  uint i = Indices(push.owners).of[at];
  bool met = hit.status == kScarpHit || hit.status == kScarpWall;
  if (of_light) {
    take_light(i, met);
    return;
  }
  Seens(push.seens).of[i].steps = stepped ? min(hit.steps, uint(settings().is.steps)) : hit.steps;
  if (!met) return;
  FrameSeen seen = Seens(push.seens).of[i];
  ScarpSent sent;
  sent.begin = seen.t;
  sent.per_time = seen.per_time;
  Seens(push.seens).of[i].t = scarp_sent_time(sent, hit);
  Seens(push.seens).of[i].cell = hit.cell;
  Seens(push.seens).of[i].place = hit.place;
  bool ground = hit.status == kScarpHit;
  Seens(push.seens).of[i].kind = ground ? kFrameGround : kFrameWall;
  if (!ground) return;
  Seens(push.seens).of[i].sun_cosine = 0.0;
  Seens(push.seens).of[i].sky = 0.0;
  Seens(push.seens).of[i].normal = normal_of(scarp_shading_slope(shown_field(), hit.cell, hit.place));
  if (lists_ground) list_ground(i);
}
