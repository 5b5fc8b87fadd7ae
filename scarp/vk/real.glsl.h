// SPDX-License-Identifier: MIT
// Number types for formulas that run in double on the CPU and in single precision on devices.
//
//   real, real2, real3   double, dvec2, dvec3 in C++; float, vec2, vec3 in GLSL; literals are real(0.1)
//   vec3                 colours, single precision on both sides
#ifndef SCARP_RENDER_REAL_GLSL_H
#define SCARP_RENDER_REAL_GLSL_H

#include "scarp/vk/glsl_cpp.h"

#ifdef __cplusplus

#include <glm/geometric.hpp>

#include "scarp/base/vec.h"

namespace scarp::glsl {

using real = double;
using real2 = dvec2;
using real3 = dvec3;
using glm::dot, glm::length, glm::normalize;
using std::acos, std::cos, std::exp, std::pow, std::sin;

}  // namespace scarp::glsl

#else

#define real float
#define real2 vec2
#define real3 vec3

#endif

#endif
