// SPDX-License-Identifier: MIT
// Which face it is.
#version 450

layout(location = 0) flat in uvec2 seen;
layout(location = 0) out uvec4 words;

void main() { words = uvec4(seen, 0u, 0u); }
