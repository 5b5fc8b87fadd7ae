// SPDX-License-Identifier: MIT
// Computes colours seen through fog, by the formulas of fog.h.
#pragma once

#include "scarp/base/ray.h"
#include "scarp/render/light/fog.h"
#include "scarp/render/light/sky_model.h"

namespace scarp {

class Fog {
 public:
  /// Refers to the sky. The settings must be valid.
  Fog(const FogSettings& settings, const Sky& sky);

  FogKind kind() const { return settings_.kind; }
  /// Colour of the fog in linear light along a unit vector.
  vec3 colour(const dvec3& direction) const;
  double per_metre() const { return per_metre_; }
  const FogSettings& settings() const { return settings_; }
  /// A colour in linear light, seen through the fog.
  vec3 operator()(const Ray& ray, double t, vec3 behind) const;
  /// The same for `iterations`: `share` is the fraction of the maximum steps, 0..1.
  vec3 by_share(const Ray& ray, double share, vec3 behind) const;

 private:
  FogSettings settings_;
  double per_metre_;
  const Sky& sky_;
};

}  // namespace scarp
