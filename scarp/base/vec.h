// SPDX-License-Identifier: MIT
// GLM vectors and functions in namespace scarp: double precision, and integers for voxels, with their GLSL names.
#pragma once

#include <array>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace scarp {

using glm::cross;
using glm::dot;
using glm::length;
using glm::normalize;

// Packed, also under GLM_FORCE_DEFAULT_ALIGNED_GENTYPES, which gives glm::dvec3 another layout than that of the
// compiled library. Without it, these are glm::dvec3 and so on; with it, both convert to each other.
using dvec2 = glm::vec<2, double, glm::packed_highp>;
using dvec3 = glm::vec<3, double, glm::packed_highp>;
using ivec3 = glm::vec<3, int, glm::packed_highp>;
using vec3 = glm::vec<3, float, glm::packed_highp>;
using dmat3 = glm::mat<3, 3, double, glm::packed_highp>;  // <glm/mat3x3.hpp>
using dmat4 = glm::mat<4, 4, double, glm::packed_highp>;  // <glm/mat4x4.hpp>

/// The corners of a triangle.
using Triangle = std::array<dvec3, 3>;

}  // namespace scarp
