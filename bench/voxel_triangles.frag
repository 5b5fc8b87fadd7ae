// SPDX-License-Identifier: MIT
// Writes the index of the face.
#version 450

layout(location = 0) flat in uvec2 seen;
layout(location = 0) out uvec4 words;

void main() { words = uvec4(seen, 0u, 0u); }
