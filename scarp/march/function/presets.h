// SPDX-License-Identifier: MIT
// The marches of well-known terrain shaders, each as a technique from the table and its numbers. The shaders' code is
// not included. Lengths are in metres; for a shader with other units, `numbers` states the conversion. `scarp-bench
// functions --presets` measures what each preset misses; doc/user/from-height-to-distance.md shows the results.
#pragma once

#include <span>
#include <string_view>

#include "scarp/march/march_settings.h"

namespace scarp {

/// A named march with its settings and source.
struct MarchPreset {
  std::string_view name;
  std::string_view march;     ///< name in function_marches() and height_marches()
  MarchSettings settings;     ///< defaults, except for the shader's own
  std::string_view numbers;   ///< the shader's numbers, one line
  std::string_view left_out;  ///< features of its march that are left out, one line; empty: none
  std::string_view source;    ///< author, title, year
};

std::span<const MarchPreset> march_presets();
/// Throws Error listing the names if the preset is unknown.
const MarchPreset& find_march_preset(std::string_view name);

}  // namespace scarp
