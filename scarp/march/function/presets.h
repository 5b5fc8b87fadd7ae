// SPDX-License-Identifier: MIT
// Marches of well-known terrain shaders: a technique of the table and its numbers. Only numbers; the shaders' code is
// not included. Lengths are metres; for a shader with other units, the text states the conversion. `scarp-bench
// functions
// --presets` measures what each of them misses; doc/user/from-height-to-distance.md shows it.
#pragma once

#include <span>
#include <string_view>

#include "scarp/march/march_settings.h"

namespace scarp {

/// A named march with its settings and source.
struct MarchPreset {
  std::string_view name;
  std::string_view march;     ///< of function_marches(); height_marches() has it, too
  MarchSettings settings;     ///< defaults, except for the shader's own
  std::string_view numbers;   ///< the shader's numbers, one line
  std::string_view left_out;  ///< other features of its march, one line; empty: none
  std::string_view source;    ///< author, title, year
};

std::span<const MarchPreset> march_presets();
/// Throws Error listing the names if the preset is unknown.
const MarchPreset& find_march_preset(std::string_view name);

}  // namespace scarp
