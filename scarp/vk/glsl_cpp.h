// SPDX-License-Identifier: MIT
// Lets a `*.glsl.h` file compile as both C++ and GLSL. The rest of such a file is the common subset of both languages.
//
//   #include "scarp/vk/glsl_cpp.h"
//   SCARP_GLSL_BEGIN
//   struct Level { uint begin; uint cols; uint rows; };                         // layout(scalar) in GLSL
//   const uint kThreads = 64u;
//   SCARP_FN uint entry_of(Level level, uint col, uint row) { return level.begin + row * level.cols + col; }
//   SCARP_GLSL_END
//
// Structs contain float, int, uint, vectors of these and Address; no bool, no matrices, no 64-bit types (doubles in
// accel/voxel_buffers.glsl.h, for shaders that need float64). In C++, everything is in namespace scarp::glsl. Functions
// that also run in C++ use no swizzles. Shaders that include such a file enable GL_GOOGLE_include_directive, and
// GL_EXT_scalar_block_layout for their blocks.
#ifndef SCARP_VK_GLSL_CPP_H
#define SCARP_VK_GLSL_CPP_H

#ifdef __cplusplus

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace scarp::glsl {

using uint = std::uint32_t;
using glm::ivec2, glm::ivec3, glm::ivec4;
using glm::uvec2, glm::uvec3, glm::uvec4;
using glm::vec2, glm::vec3, glm::vec4;
using std::abs, std::ceil, std::clamp, std::floor, std::max, std::min, std::sqrt;

// Rounds twice, as devices may.
inline float fma(float a, float b, float c) { return a * b + c; }
inline uint floatBitsToUint(float value) { return std::bit_cast<uint>(value); }
inline float uintBitsToFloat(uint bits) { return std::bit_cast<float>(bits); }

/// Device address of a buffer (DeviceBuffer::address()). Low word first, so that GLSL needs no 64-bit integers.
struct Address {
  uint low = 0, high = 0;
  Address() = default;
  Address(std::uint64_t address)  // NOLINT: implicit by design
      : low(static_cast<uint>(address)), high(static_cast<uint>(address >> 32)) {}
};

}  // namespace scarp::glsl

#define SCARP_GLSL_BEGIN namespace scarp::glsl {
#define SCARP_GLSL_END }
#define SCARP_FN inline
#define SCARP_OUT(type) type&
#define SCARP_INOUT(type) type&
// No contraction and no reordering: build flags ensure it in C++; GLSL ES 3.0 has no keyword for it.
#define SCARP_PRECISE

#else

#define SCARP_GLSL_BEGIN
#define SCARP_GLSL_END
#define SCARP_FN
#define SCARP_OUT(type) out type
#define SCARP_INOUT(type) inout type
#ifdef GL_ES
#define SCARP_PRECISE
#else
#define SCARP_PRECISE precise
#endif
// Converted to a reference by SomeBuffer(address), with GL_EXT_buffer_reference_uvec2.
#define Address uvec2

#endif

// Marks the start of a block of shader code for `scarp-bench simt`, which counts executions of blocks; expands to
// nothing in all other builds.
#ifndef SCARP_COUNT
#define SCARP_COUNT(block)
#endif

#endif
