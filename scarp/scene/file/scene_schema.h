// SPDX-License-Identifier: MIT
// Parses a scene file to JSON that conforms to the schema (scene.schema.json).
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace scarp {

/// Maximum nesting depth of a scene file.
inline constexpr std::size_t kDeepestScene = 1000;

/// Returns the text of a JSON file. Throws Error without its name if it is a folder, missing or not readable; `what`
/// names the expected content, for example "a scene".
std::string json_text_of(const std::string& path, std::string_view what);

/// Throws Error naming the line if the text is not JSON, or naming the position as a JSON pointer for a duplicate key
/// or more than kDeepestScene levels.
nlohmann::json parse_scene_text(std::string_view text);

/// Throws Error naming the first position that does not conform to the schema, and the expected value. The contents of
/// "function", "functions", "shape" and "settings" are checked by their own readers.
void check_scene_schema(const nlohmann::json& scene);

/// The schema itself.
std::string_view scene_schema_text();

}  // namespace scarp
