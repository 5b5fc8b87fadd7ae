// SPDX-License-Identifier: MIT
// For C++ that needs only the structs in the marches' GLSL code (cell_surface.glsl.h, max_mip.glsl.h), not its
// functions: the functions that this code requires of its host are declared, but not defined.
#pragma once

#include "scarp/vk/glsl_cpp.h"

namespace scarp::glsl {

float scarp_sample(int col, int row);
vec4 scarp_corners(int col, int row);
bool scarp_is_nodata(float value);
float scarp_maximum(int level, int col, int row);
float scarp_minimum(int level, int col, int row);

}  // namespace scarp::glsl
