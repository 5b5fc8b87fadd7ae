// SPDX-License-Identifier: MIT
// What rays have found of the terrain, as a picture and its depth buffer.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "scarp/render/frame/mesh_view.glsl.h"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer View { MeshView is; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Colours { vec3 colours[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Depths { float depths[]; };
layout(push_constant, scalar) uniform Push { MeshPush push; };

layout(location = 0) out vec4 shown;  // and 1 where the mesh is seen
layout(location = 1) out vec4 facing;

void main() {
  View view = View(push.view);
  uint pixel = uint(gl_FragCoord.y) * view.is.width + uint(gl_FragCoord.x);
  shown = vec4(Colours(view.is.colours).colours[pixel], 0.0);
  facing = vec4(0.0);
  gl_FragDepth = Depths(view.is.depths).depths[pixel];
}
