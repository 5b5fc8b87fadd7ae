// SPDX-License-Identifier: MIT
// Placements of an object in a scene file: one, many, or scattered over ground.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "scarp/scene/placement.h"
#include "scarp/scene/scene_field.h"

namespace scarp {

/// An object on whose surface others are placed. It must not be tilted.
struct SceneGround {
  const SceneField* field;
  Placement placement;
  std::string name;

  /// World z at a world position. Throws Error naming `at`, the position in the file, if there is no ground.
  double height(double x, double y, const std::string& at) const;
  /// The same, but returns nullopt if there is no ground.
  std::optional<double> height(double x, double y) const;
};

/// Returns the ground with this name, which is used at a position in the file. Throws Error if there is none.
using GroundByName = std::function<SceneGround(const std::string& name, const std::string& at)>;

using ScenePlaces = std::vector<Placement>;

/// Reads at, turn and scale of an object that conforms to the schema.
Placement placement_from_json(const nlohmann::json& json);

/// Reads at, turn, scale, on, places and scatter of an object that conforms to the schema. Throws Error naming the
/// position in the file if there is no ground there, the ground is tilted, or it is too small for the scattered
/// objects.
ScenePlaces places_from_json(const nlohmann::json& object, const std::string& path, const GroundByName& grounds);

}  // namespace scarp
