// SPDX-License-Identifier: MIT
// Combines scenes into one: terrain, voxels, shapes and functions, each in any number of placements.
//
//   const scarp::Scene scene = scarp::combine({{terrain}, {tower, {.scale = 0.5, .origin = {300, 200, 120}}}});
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scarp/scene/scene.h"

namespace scarp {

/// A scene (a Terrain, Voxels, a field, or a combined scene) and its placement.
struct ScenePart {
  Scene scene;
  Placement placement{};                    ///< rotation, scale and origin; identity by default
  std::optional<std::uint32_t> material{};  ///< index into PictureSettings::materials; nullopt: as in `scene`
  std::optional<std::uint32_t> mask{};      ///< SceneObject::mask of its objects; nullopt: as in `scene`
};

/// Returns a scene of all objects of all parts, in order. Hit::object is the index of an object, from 0; if every part
/// has one object, it is the index of the part. Fields are shared, not copied. Throws Error naming the object if a
/// placement is not a rotation with a finite origin and a scale above 0. Throws Error naming the part if it is on a
/// device: combine first, then call scene_on().
Scene combine(const std::vector<ScenePart>& parts);

}  // namespace scarp
