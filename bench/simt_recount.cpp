// SPDX-License-Identifier: MIT
#include "bench/simt_recount.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "bench/shader_compilation.h"
#include "scarp/base/error.h"
#include "scarp/march/height/queries_vk.h"
#include "scarp/march/voxel/voxel_queries_vk.h"

namespace scarp::bench {
namespace {

constexpr const char* kFamily = "navi21";

// Passes over the second pass of a march, which has the name of the first and follows it.
ShaderProgram program_of(std::string_view name) {
  for (const auto& programs : {height_query_shaders(), voxel_query_shaders()}) {
    for (const ShaderProgram& program : programs) {
      if (program.variant == name) return program;
    }
  }
  throw Error(fmt::format("shader '{}': is not one of the library's", name));
}

}  // namespace

SimtShaders recount(const SimtShaders& shaders, const std::string& folder) {
  SimtShaders counted;
  counted.compilers = shader_compilers(kFamily);
  for (const SimtShader& shader : shaders.shaders) {
    const std::string text = shader_disassembly(program_of(shader.name), kFamily);
    if (!folder.empty()) {
      const std::string file = fmt::format("{}/{}.s", folder, shader.name);
      std::ofstream out(file);
      out << text;
      out.close();
      if (!out) throw Error(fmt::format("'{}': cannot be written", file));
    }
    counted.shaders.push_back(count_blocks(shader, text));
  }
  return counted;
}

}  // namespace scarp::bench
