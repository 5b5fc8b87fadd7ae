// SPDX-License-Identifier: MIT
// Checks the loads in the loops of march shaders, from their SPIR-V: drivers do not hoist loads through an address out
// of loops, so the ground's description must be read before them.
#include <gtest/gtest.h>

#include <cstddef>
#include <map>
#include <set>
#include <span>
#include <string>

#include "scarp/accel/ground_buffers.glsl.h"
#include "scarp/march/height/device_march_vk.h"
#include "test/vk/spirv_layout.h"

namespace scarp::test {
namespace {

struct Loads {
  int in_loops = 0;
  int elsewhere = 0;
};

// Loads of members of GroundBuffers, except its table of levels, which a march indexes by level.
Loads loads_of_ground(std::span<const std::uint32_t> spirv) {
  std::map<std::uint32_t, Offsets> offsets;
  std::map<std::uint32_t, std::uint32_t> constants, type_of, member_of_chain;
  std::set<std::uint32_t> blocks, pointers;
  std::multiset<std::uint32_t> loops;  // labels at which they end
  Loads loads;
  std::uint32_t levels = 0;
  each_operation(spirv, [&](std::uint32_t code, std::span<const std::uint32_t> words) {
    using namespace spirv_op;
    add_offset(code, words, offsets);
    if (code == kTypeStruct) {
      // GroundBuffers is recognised by its last member, the block Ground by having no other member.
      const bool is_block = words.size() == 3 && blocks.contains(words[2]);
      const auto found = offsets.find(words[1]);
      const bool is_ground = found != offsets.end() && found->second.size() > 20 &&
                             found->second.back() == offsetof(glsl::GroundBuffers, levels);
      if (is_ground) levels = static_cast<std::uint32_t>(found->second.size()) - 1;
      if (is_block || is_ground) blocks.insert(words[1]);
    } else if (code == kTypePointer && blocks.contains(words[3])) {
      pointers.insert(words[1]);
    } else if (code == kConstant) {
      constants[words[2]] = words[3];
    } else if (code == kLabel) {
      loops.erase(words[1]);
    } else if (code == kLoopMerge) {
      loops.insert(words[1]);
    } else if ((code == kAccessChain || code == kInBoundsAccessChain) && pointers.contains(type_of[words[3]])) {
      if (words.size() > 5) member_of_chain[words[2]] = constants.at(words[5]);
    } else if (code == kLoad && member_of_chain.contains(words[3]) && member_of_chain[words[3]] != levels) {
      ++(loops.empty() ? loads.elsewhere : loads.in_loops);
    }
    // Operations with a result type and a result have these first; for others these words mean nothing.
    if (words.size() > 2) type_of[words[2]] = words[1];
  });
  return loads;
}

TEST(TurnLoads, MarchesLoadTheGroundOutsideLoops) {
  for (const ShaderProgram& shader : DeviceHeightMarch::shaders()) {
    const Loads loads = loads_of_ground(shader.spirv);
    EXPECT_EQ(loads.in_loops, 0) << shader.file << ", " << shader.variant;
    EXPECT_GT(loads.elsewhere, 10) << shader.file << ", " << shader.variant;
  }
}

}  // namespace
}  // namespace scarp::test
