// SPDX-License-Identifier: MIT
// Colours of surfaces from their materials (scene/material.h).
#pragma once

#include <span>
#include <vector>

#include "scarp/render/surface/ramp.h"
#include "scarp/scene/material.h"
#include "scarp/scene/scene.h"

namespace scarp {

class SurfaceColours {
 public:
  /// Throws Error naming the material for an unknown ramp, an invalid range, or a blend of materials that do not
  /// precede it.
  explicit SurfaceColours(std::span<const Material> materials);

  /// In linear light. Surfaces whose material is beyond the list have the field's own colours.
  vec3 operator()(const SceneSurface& surface) const;

 private:
  vec3 colour(std::size_t material, const SceneSurface& surface) const;

  std::vector<Material> materials_;
  std::vector<std::optional<Ramp>> ramps_;  // by material; nullopt without a ramp
};

}  // namespace scarp
