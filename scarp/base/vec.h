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

using dvec2 = glm::dvec2;
using dvec3 = glm::dvec3;
using ivec3 = glm::ivec3;
using vec3 = glm::vec3;

/// The corners of a triangle.
using Triangle = std::array<dvec3, 3>;

}  // namespace scarp
