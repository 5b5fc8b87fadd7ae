// SPDX-License-Identifier: MIT
// A ray as computed by a shader: start and direction in floats.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "scarp/field/height_field.h"
#include "scarp/march/height/device_ray.h"

namespace scarp::test {

struct ShaderRay {
  glsl::vec3 origin, direction;  // in grid units
  double speed = 0;              // cells along the longer axis, per t
  float end = 0;                 // in cells along that axis
  Ray ray;                       // the same in the world, except for rounding of doubles
};

/// Nullopt for a ray that is vertical in floats.
inline std::optional<ShaderRay> shader_ray(const HeightField& field, const Ray& made) {
  const GridRay local = field.grid_from_world(made);
  ShaderRay r{glsl::vec3(local.origin), glsl::vec3(local.direction), 0, 0, {}};
  r.speed = std::max(std::abs(double{r.direction.x}), std::abs(double{r.direction.y}));
  if (!(r.speed > 0)) return std::nullopt;
  r.end = static_cast<float>(std::min(made.t_max * r.speed, double{glsl::kScarpNever}));
  r.ray.origin = field.world_from_grid(r.origin.x, r.origin.y, r.origin.z);
  r.ray.direction = field.world_from_grid(r.origin.x + double{r.direction.x}, r.origin.y + double{r.direction.y},
                                          r.origin.z + double{r.direction.z}) -
                    r.ray.origin;
  r.ray.t_max = r.end < glsl::kScarpNever ? r.end / r.speed : HUGE_VAL;
  return r;
}

}  // namespace scarp::test
