// SPDX-License-Identifier: MIT
// Where an object of a scene file stands: one place, many, or scattered over ground.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "scarp/scene/placement.h"
#include "scarp/scene/scene_field.h"

namespace scarp {

/// An object on whose surface others stand. It must not be tilted, so that up is up.
struct SceneGround {
  const SceneField* field;
  Placement placement;
  std::string name;

  /// World z at a world position. Throws Error, `at` being the place in the file, where it has none.
  double height(double x, double y, const std::string& at) const;
  /// The same; nothing where it has none.
  std::optional<double> height(double x, double y) const;
};

/// The ground of a name that is asked for at a place of the file; throws Error.
using GroundByName = std::function<SceneGround(const std::string& name, const std::string& at)>;

using ScenePlaces = std::vector<Placement>;

/// Reads at, turn and scale of an object that conforms to the schema.
Placement placement_from_json(const nlohmann::json& json);

/// From at, turn, scale, on, places and scatter of an object that keeps to the schema. Throws Error naming the place in
/// the file: no ground there, ground that is tilted, too little of it for what is scattered.
ScenePlaces places_from_json(const nlohmann::json& object, const std::string& path, const GroundByName& grounds);

}  // namespace scarp
