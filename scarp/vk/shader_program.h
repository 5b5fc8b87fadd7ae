// SPDX-License-Identifier: MIT
// A shader in one specialisation: everything that a pipeline needs. The code that owns a shader defines this in one
// function, for both pipelines and the list of `scarp-bench shaders`.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace scarp {

struct ShaderProgram {
  std::string_view file;                   ///< path of its source: "scarp/march/height/max_mip.comp"
  std::string variant;                     ///< the specialisation in words, "any"; empty if there is only one
  std::span<const std::uint32_t> spirv;    ///< entry point main, no bindings
  std::uint32_t push_bytes = 0;            ///< size of its push constants
  std::vector<std::uint32_t> constants{};  ///< specialisation constants 0, 1, 2, ...; floats by bit_cast
  /// Vertex shader; empty for a compute shader. Otherwise `spirv` is a fragment shader that writes words into `colours`
  /// images.
  std::span<const std::uint32_t> vertex{};
  std::uint32_t colours = 0;
};

}  // namespace scarp
