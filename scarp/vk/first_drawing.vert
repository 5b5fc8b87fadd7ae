// SPDX-License-Identifier: MIT
// A triangle that covers half of the picture.
#version 450

void main() { gl_Position = vec4(gl_VertexIndex == 1 ? 1.0 : -1.0, gl_VertexIndex == 2 ? 1.0 : -1.0, 0.5, 1.0); }
