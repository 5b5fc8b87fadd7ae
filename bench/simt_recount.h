// SPDX-License-Identifier: MIT
// Counts the blocks of shaders as this build compiles them.
#pragma once

#include <string>

#include "bench/simt_blocks.h"

namespace scarp::bench {

/// Recounts the blocks of all shaders of a table, by its basic blocks, with RADV for navi21. `folder`, if not empty,
/// gets the disassemblies, SHADER.s, which help when basic blocks no longer match. The environment is as for
/// shader_compilers(); throws Error as shader_compilers() and count_blocks() do.
SimtShaders recount(const SimtShaders& shaders, const std::string& folder = {});

}  // namespace scarp::bench
