// SPDX-License-Identifier: MIT
// Corners of a mesh as the sun sees them: the nearest has the largest depth.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "scarp/render/frame/mesh_view.glsl.h"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer View { MeshView is; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Corners { MeshVertex corners[]; };
layout(push_constant, scalar) uniform Push { MeshPush push; };

void main() {
  View view = View(push.view);
  SunMap map = view.is.sun_map;
  vec3 from_low = Corners(view.is.corners).corners[gl_VertexIndex].position - map.low;
  float side = float(map.side) * map.texel;
  gl_Position = vec4(2.0 * dot(from_low, map.across) / side - 1.0, 2.0 * dot(from_low, map.up) / side - 1.0,
                     dot(from_low, map.to_sun) / map.range, 1.0);
}
