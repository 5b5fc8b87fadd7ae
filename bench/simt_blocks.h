// SPDX-License-Identifier: MIT
// Blocks of the marches' shaders, as SCARP_COUNT (vk/glsl_cpp.h) names them in the source, and the cost of each for a
// bundle of rays: instructions of the compiled shader.
//
// bench/simt_blocks.csv keeps the counts: Mesa's RADV for navi21, rays in wavefronts of 64, float32 samples, no holes,
// walls, wraps or triangles. A row is one block of one shader, with the basic blocks of the disassembly that belong to
// it. Every basic block belongs to one block, so the counts add up to the shader's instructions. A basic block is
// counted with the source block whose lanes execute it; code that joins two branches counts with the block around them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace scarp::bench {

enum class SimtBlock : std::uint8_t {
  begin,  ///< once: code that is the same for all rays
  frame,  ///< the ray is read and a frame starts at its current position; also the end of a frame, after the inner loop
  walk,   ///< max-mip: an iteration of the walk
  cell,   ///< the surface in a cell
  probe,  ///< sampling marches: an iteration
  hit,    ///< where a march ends at a point
  answer,  ///< the answer is written: in the shader's main, which is not compiled as C++
  end,     ///< once
  unused,  ///< code for settings that are not counted, and for rays that are left to the second pass

  // Voxel marches: their walk is an iteration of the march, and their frame is a node of the hierarchy over the
  // objects.
  object,  ///< the ray is quantised in an object's box
  turned,  ///< the ray's direction is quantised, for objects rotated differently from the previous one
  cross,   ///< one plane is crossed
  skip,    ///< planes up to the end of empty space
  sector,  ///< a sector is read, around an empty brick
};
inline constexpr std::size_t kSimtBlocks = 14;
inline constexpr std::array<std::string_view, kSimtBlocks> kSimtBlockNames = {
    "begin", "frame",  "walk",   "cell",   "probe", "hit",  "answer",
    "end",   "unused", "object", "turned", "cross", "skip", "sector"};

/// Loops around a block, and whether it is the first block of the innermost one.
struct SimtNesting {
  int depth;
  bool head;
};
constexpr SimtNesting nesting(SimtBlock block) {
  switch (block) {
    case SimtBlock::frame:
      return {1, true};
    case SimtBlock::hit:
    case SimtBlock::answer:
    case SimtBlock::object:
    case SimtBlock::turned:
      return {1, false};
    case SimtBlock::walk:
    case SimtBlock::probe:
      return {2, true};
    case SimtBlock::cell:
    case SimtBlock::cross:
    case SimtBlock::skip:
    case SimtBlock::sector:
      return {2, false};
    default:
      return {0, false};
  }
}

/// Cost for a bundle each time that one of its rays enters the block.
struct SimtCost {
  int instructions = 0;  ///< all, memory instructions included
  int vector = 0;        ///< arithmetic on the rays' own values
  int memory = 0;        ///< loads and stores at the rays' own addresses

  bool operator==(const SimtCost&) const = default;
};

/// The blocks of one shader in one specialisation.
struct SimtShader {
  std::string name;  ///< "max-mip", "max-mip any", "naive"
  int instructions;  ///< of the whole shader, as the driver reports it; inner loops multiplied by their iterations
  std::array<SimtCost, kSimtBlocks> costs{};
  /// Numbers in the disassembly, "5 24-35"; "24-35*3": an inner loop with three iterations. Empty: the shader has no
  /// such block.
  std::array<std::string, kSimtBlocks> basic_blocks{};

  const SimtCost& operator[](SimtBlock block) const { return costs[static_cast<std::size_t>(block)]; }
};

struct SimtShaders {
  std::string compilers;  ///< names and versions
  std::vector<SimtShader> shaders;

  /// Throws Error if there is no shader with this name.
  SimtShader& find(std::string_view name);
};

/// Reads a table in the format of write_simt_shaders(). Throws Error if it cannot be read, or if the blocks of a shader
/// do not add up to its instructions.
SimtShaders read_simt_shaders(const std::string& file);
/// Throws Error if the file cannot be written.
void write_simt_shaders(const std::string& file, const SimtShaders& shaders);

/// `simt --voxels`.
struct SimtOptions;
struct ReportOptions;
void run_simt_voxels(const SimtOptions& options, SimtShaders shaders, const ReportOptions& report);

/// Recounts the blocks of a shader, by its basic blocks, in RADV's disassembly of it. Throws Error naming the basic
/// blocks that belong to no block or to several, or that the disassembly lacks.
SimtShader count_blocks(const SimtShader& shader, std::string_view disassembly);

}  // namespace scarp::bench
