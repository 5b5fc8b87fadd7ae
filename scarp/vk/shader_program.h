// SPDX-License-Identifier: MIT
// A shader in one specialisation: everything that a pipeline is made of. The code that owns a shader states it
// in one function, which serves pipelines and the list for `scarp-bench shaders` alike.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace scarp {

struct ShaderProgram {
  std::string_view file;                   ///< path of its text: "scarp/march/height/max_mip.comp"
  std::string variant;                     ///< the specialisation in words, "any"; empty if there is only one
  std::span<const std::uint32_t> spirv;    ///< entry point main, no bindings
  std::uint32_t push_bytes = 0;            ///< size of its push constants
  std::vector<std::uint32_t> constants{};  ///< specialisation constants 0, 1, 2, ...; floats by bit_cast
  /// Empty for a compute shader. Otherwise this is a fragment shader, which writes words into this many colours, behind
  /// this vertex shader.
  std::span<const std::uint32_t> vertex{};
  std::uint32_t colours = 0;
};

}  // namespace scarp
