// SPDX-License-Identifier: MIT
// Marches over terrain as well-known shaders have them: a technique of the table and its numbers. Numbers only; the
// shaders' texts are not here. Lengths are in metres; where a shader has a unit of its own, it says what was taken
// for it. What each of them misses is measured by `scarp-bench functions --presets`, and shown in
// doc/user/from-height-to-distance.md.
#pragma once

#include <span>
#include <string_view>

#include "scarp/march/march_settings.h"

namespace scarp {

struct MarchPreset {
  std::string_view name;
  std::string_view march;     ///< of function_marches(); height_marches() has it, too
  MarchSettings settings;     ///< defaults, but for what the shader says
  std::string_view numbers;   ///< what it says, one line
  std::string_view left_out;  ///< what else its march does, one line; empty: nothing
  std::string_view source;    ///< who, what, when
};

std::span<const MarchPreset> march_presets();
/// Throws Error listing the names when there is no such preset.
const MarchPreset& find_march_preset(std::string_view name);

}  // namespace scarp
