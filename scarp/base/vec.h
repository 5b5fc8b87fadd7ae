// SPDX-License-Identifier: MIT
// Vectors: GLM's, in double, and whole numbers for voxels, under the names that GLSL gives them.
#pragma once

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

}  // namespace scarp
