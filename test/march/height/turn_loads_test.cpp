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
  constexpr std::uint32_t kMemberDecorate = 72, kOffset = 35, kTypeStruct = 30, kTypePointer = 32, kConstant = 43,
                          kLoad = 61, kAccessChain = 65, kInBoundsAccessChain = 66, kLoopMerge = 246, kLabel = 248,
                          kHeaderWords = 5;
  std::map<std::uint32_t, Offsets> offsets;
  std::map<std::uint32_t, std::uint32_t> constants, type_of, member_of_chain;
  std::set<std::uint32_t> blocks, pointers;
  std::multiset<std::uint32_t> loops;  // labels at which they end
  Loads loads;
  std::uint32_t levels = 0;
  for (std::size_t at = kHeaderWords; at < spirv.size(); at += spirv[at] >> 16) {
    const std::uint32_t *word = &spirv[at], operation = word[0] & 0xffff, words = word[0] >> 16;
    if (operation == kMemberDecorate && word[3] == kOffset) {
      Offsets& of = offsets[word[1]];
      of.resize(std::max<std::size_t>(of.size(), word[2] + 1));
      of[word[2]] = word[4];
    } else if (operation == kTypeStruct) {
      // GroundBuffers is recognised by its last member, the block Ground by having no other member.
      const bool is_block = words == 3 && blocks.contains(word[2]);
      const auto found = offsets.find(word[1]);
      const bool is_ground = found != offsets.end() && found->second.size() > 20 &&
                             found->second.back() == offsetof(glsl::GroundBuffers, levels);
      if (is_ground) levels = static_cast<std::uint32_t>(found->second.size()) - 1;
      if (is_block || is_ground) blocks.insert(word[1]);
    } else if (operation == kTypePointer && blocks.contains(word[3])) {
      pointers.insert(word[1]);
    } else if (operation == kConstant) {
      constants[word[2]] = word[3];
    } else if (operation == kLabel) {
      loops.erase(word[1]);
    } else if (operation == kLoopMerge) {
      loops.insert(word[1]);
    } else if ((operation == kAccessChain || operation == kInBoundsAccessChain) &&
               pointers.contains(type_of[word[3]])) {
      if (words > 5) member_of_chain[word[2]] = constants.at(word[5]);
    } else if (operation == kLoad && member_of_chain.contains(word[3]) && member_of_chain[word[3]] != levels) {
      ++(loops.empty() ? loads.elsewhere : loads.in_loops);
    }
    // Operations with a type and a result have them first; of others this means nothing.
    if (words > 2) type_of[word[2]] = word[1];
  }
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
