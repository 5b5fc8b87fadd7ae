// SPDX-License-Identifier: MIT
// A corner of a voxel's face: two triangles per face, an instance per object. Back faces collapse to a point.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "bench/voxel_triangles.glsl.h"

layout(push_constant, scalar) uniform Push { VoxelTrianglesPush push; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Faces { uint of[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Objects { vec3 of[]; };

layout(location = 0) flat out uvec2 seen;

void main() {
  uint face = Faces(push.faces).of[gl_VertexIndex / 6];
  uint axis = face >> 25, outward = face >> 24 & 1u, index = uint(gl_VertexIndex) % 6u;
  uint at = index < 3u ? index : index == 3u ? 2u : index == 4u ? 1u : 3u;
  vec3 corner = vec3(face & 255u, face >> 8 & 255u, face >> 16 & 255u);
  corner[axis] += float(outward);
  corner[(axis + 1u) % 3u] += float(at & 1u);
  corner[(axis + 2u) % 3u] += float(at >> 1);
  vec3 place = Objects(push.objects).of[gl_InstanceIndex] + push.side * corner;
  float ahead = push.parallel != 0u ? push.forward[axis] : place[axis];
  seen = uvec2(gl_InstanceIndex + 1, face);
  gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
  if (outward != 0u ? ahead >= 0.0 : ahead <= 0.0) return;
  vec4 p = vec4(place, 1.0);
  float depth = push.parallel != 0u ? 1.0 - dot(push.forward, place) / push.near : push.near;
  gl_Position = vec4(dot(push.x, p), dot(push.y, p), depth, dot(push.w, p));
}
