// SPDX-License-Identifier: MIT
// Parts of a scene file, each from JSON that conforms to the schema. `path` is its position in the file, as a JSON
// pointer; errors begin with it.
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

/// Context of fields: the names that they may refer to, and the notes about them.
struct FieldSurroundings {
  std::string folder;        ///< that paths are relative to
  FunctionByName functions;  ///< named ones
  /// Look up a name that is used at a position: the number of a shape's material, from 1, and the JSON of a field with
  /// its position. Both throw Error.
  std::function<int(const std::string& name, const std::string& path)> material;
  std::function<std::pair<const nlohmann::json*, std::string>(const std::string& name, const std::string& path)> field;
  std::vector<std::string>* notes;  ///< notes of the readers
  std::vector<std::string>* files;  ///< files that have been read
  Progress progress;
};

struct FieldWithPlace {
  SceneFieldPtr field;
  dvec3 shift{0.0};  ///< of the field in its own space; not zero for centred fields
};

/// Reads heights, a function, a shape, voxels or a mesh, with its march and settings.
FieldWithPlace field_from_json(const nlohmann::json& json, const std::string& path, const FieldSurroundings& around);

/// Reads `voxels` for a march of voxel_marches(); empty: see file_voxel_march().
FieldWithPlace voxels_from_json(const nlohmann::json& json, const std::string& path, const FieldSurroundings& around,
                                std::string_view march);

/// Returns the path of a file given relative to the scene's folder.
std::string resolved(const FieldSurroundings& around, const nlohmann::json& file);

/// Appends the materials to `all`, ordered so that they refer only to earlier ones, and returns the index of each name.
std::map<std::string, std::uint32_t> materials_from_json(const nlohmann::json& json, const std::string& path,
                                                         std::vector<Material>& all);

/// "#rrggbb" as sRGB, 0..1.
vec3 colour_from_json(const nlohmann::json& json);

/// The sun, the sky, the water and the fog of a scene.
SceneSun sun_from_json(const nlohmann::json& scene);
SceneSky sky_from_json(const nlohmann::json& scene);
std::optional<SceneWater> water_from_json(const nlohmann::json& scene);
std::optional<SceneFog> fog_from_json(const nlohmann::json& scene);

/// Settings of all marches. Their names are those of the command-line options, with underscores.
MarchSettings march_settings_from_json(const nlohmann::json& json, const std::string& path);

/// Rethrows the current Error, prefixed with the position.
[[noreturn]] void rethrow_at(const std::string& path);

}  // namespace scarp
