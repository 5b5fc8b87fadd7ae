// SPDX-License-Identifier: MIT
// A fragment of a voxel object's box, for devices without 64-bit integers.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_control_flow_attributes : require

#include "scarp/march/voxel/voxel_proxies_march.glsl.h"

void main() { scarp_march_proxy(); }
