// SPDX-License-Identifier: MIT
// Scenes made of scenes: terrain, voxels, shapes, functions, each in any number of places.
//
//   const scarp::Scene scene = scarp::combine({{terrain}, {tower, {.scale = 0.5, .origin = {300, 200, 120}}}});
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scarp/scene/scene.h"

namespace scarp {

/// A scene (a Terrain, Voxels, a field, or a combined one) and where it stands.
struct ScenePart {
  Scene scene;
  Placement placement{};                    ///< rotation, scale and origin; as it is by default
  std::optional<std::uint32_t> material{};  ///< index into the materials of pictures; nullopt: that of its objects
};

/// All objects of all parts, in their order: Hit::object counts them from 0, so in a scene of single objects it is the
/// index of the part. Fields are shared, not copied. Throws Error naming the object for a placement that is not a
/// rotation with a scale above 0, and for a scene on a device: combine first, then scene_on().
Scene combine(const std::vector<ScenePart>& parts);

}  // namespace scarp
