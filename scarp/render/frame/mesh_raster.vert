// SPDX-License-Identifier: MIT
// Corners of a mesh as the camera sees them.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "scarp/render/frame/mesh_view.glsl.h"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer View { MeshView is; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Corners { MeshVertex corners[]; };
layout(push_constant, scalar) uniform Push { MeshPush push; };

layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec3 colour;
layout(location = 3) flat out vec3 plane_normal;

void main() {
  View view = View(push.view);
  MeshVertex corner = Corners(view.is.corners).corners[gl_VertexIndex];
  position = corner.position;
  normal = corner.normal;
  colour = corner.colour;
  plane_normal = corner.plane;
  vec4 at = vec4(corner.position, 1.0);
  gl_Position =
      vec4(dot(view.is.clip_x, at), dot(view.is.clip_y, at), dot(view.is.clip_z, at), dot(view.is.clip_w, at));
}
