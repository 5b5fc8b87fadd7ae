// SPDX-License-Identifier: MIT
// From the text of a scene file to JSON that keeps to the schema (scene.schema.json).
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace scarp {

/// Levels of a scene file within one another.
inline constexpr std::size_t kDeepestScene = 1000;

/// Throws Error naming the line: text that is no JSON; or the place as a JSON pointer: a key given twice, more than
/// kDeepestScene levels.
nlohmann::json parse_scene_text(std::string_view text);

/// Throws Error naming the first place that does not keep to the schema, and what would be right there. What stands
/// under "function", "functions", "shape" and "settings" is judged by those who read it.
void check_scene_schema(const nlohmann::json& scene);

/// The schema itself.
std::string_view scene_schema_text();

}  // namespace scarp
