// SPDX-License-Identifier: MIT
// Compiles Scarp's shaders for graphics cards that need not be installed, with Mesa's RADV. Its null device compiles
// for any AMD card and has no memory.
//
//   library_shaders() ──SPIR-V, specialisation──▶ RADV, one family of cards after another ──▶ rows of a ShaderTable
#pragma once

#include <string>
#include <vector>

#include "bench/shader_table.h"
#include "scarp/vk/shader_program.h"

namespace scarp::bench {

/// Every shader of the library, from the lists of its components.
std::vector<ShaderProgram> library_shaders();

/// Returns the compilers of SPIR-V and of RADV for a family of cards ("navi21"), with their versions. Changes
/// environment variables of Vulkan drivers and does not restore them. Throws Error if RADV is missing or does not know
/// the family.
std::string shader_compilers(const std::string& family);

/// Returns RADV's machine code of a shader for a family of cards, as text. The environment and errors are as for
/// shader_compilers().
std::string shader_disassembly(const ShaderProgram& program, const std::string& family);

/// Compiles shaders on all threads, without shader caches; rows by shader, then by family. The
/// environment and errors are as for shader_compilers().
ShaderTable compile_shaders(const std::vector<ShaderProgram>& programs, const std::vector<std::string>& families);

}  // namespace scarp::bench
