// SPDX-License-Identifier: MIT
// Parts of a scene file, each from JSON that keeps to the schema. `path` is where it stands in the file, as a JSON
// pointer, with which errors begin.
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scarp/base/progress.h"
#include "scarp/scene/file/function_json.h"
#include "scarp/scene/file/scene_file.h"
#include "scarp/scene/material.h"
#include "scarp/scene/scene_field.h"

namespace scarp {

/// What fields may refer to, and what is said about them.
struct FieldSurroundings {
  std::string folder;        ///< that paths count from
  FunctionByName functions;  ///< named ones
  /// A material's number for shapes, from 1; and the JSON of a field and where it stands: of a name that is asked for
  /// at a place. Both throw Error.
  std::function<int(const std::string& name, const std::string& path)> material;
  std::function<std::pair<const nlohmann::json*, std::string>(const std::string& name, const std::string& path)> field;
  std::vector<std::string>* notes;  ///< of readers
  std::vector<std::string>* files;  ///< that have been read
  Progress progress;
};

struct FieldWithPlace {
  SceneFieldPtr field;
  dvec3 shift{0.0};  ///< of the field in its own space: centred ones are moved
};

/// One of heights, function, shape, voxels, mesh, with march and settings.
FieldWithPlace field_from_json(const nlohmann::json& json, const std::string& path, const FieldSurroundings& around);

/// The field of `voxels`, for a march of voxel_marches(); empty: see file_voxel_march().
FieldWithPlace voxels_from_json(const nlohmann::json& json, const std::string& path, const FieldSurroundings& around,
                                std::string_view march);

/// Returns the path of a file given relative to the scene's folder.
std::string resolved(const FieldSurroundings& around, const nlohmann::json& file);

/// Materials by name, appended to `all` in an order in which they refer to earlier ones alone; the index of each.
std::map<std::string, std::uint32_t> materials_from_json(const nlohmann::json& json, const std::string& path,
                                                         std::vector<Material>& all);

/// "#rrggbb" as sRGB, 0..1.
vec3 colour_from_json(const nlohmann::json& json);

/// The sun, the sky, the water and the fog of a scene.
SceneSun sun_from_json(const nlohmann::json& scene);
SceneSky sky_from_json(const nlohmann::json& scene);
std::optional<SceneWater> water_from_json(const nlohmann::json& scene);
std::optional<SceneFog> fog_from_json(const nlohmann::json& scene);

/// Settings of all marches, by the names that the command line has, with underscores.
MarchSettings march_settings_from_json(const nlohmann::json& json, const std::string& path);

/// Rethrows the current Error with the place before it.
[[noreturn]] void rethrow_at(const std::string& path);

}  // namespace scarp
