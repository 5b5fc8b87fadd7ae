// SPDX-License-Identifier: MIT
// Tests the check of layouts itself; the tests of each station check the layouts of its shaders.
#include <gtest/gtest.h>

#include <cstddef>
#include <iterator>
#include <vector>

#include "test/vk/spirv_layout.h"
#include "test/vk/twice.glsl.h"

namespace scarp {
namespace {

constexpr std::uint32_t kTwiceWords[] = {
#include "test/vk/twice.comp.inc"
};

TEST(ShaderLayout, MatchesTheSharedStruct) {
  using glsl::TwicePush;
  EXPECT_TRUE(test::has_struct(kTwiceWords, {offsetof(TwicePush, from), offsetof(TwicePush, to),
                                             offsetof(TwicePush, count), offsetof(TwicePush, rounds)}));
  EXPECT_FALSE(test::has_struct(kTwiceWords, {0, 8, 12, 16}));
  EXPECT_FALSE(test::has_struct(kTwiceWords, {0, 8, 16}));
  EXPECT_TRUE(test::has_array_stride(kTwiceWords, 4));
  EXPECT_FALSE(test::has_array_stride(kTwiceWords, 12));
  EXPECT_TRUE(test::is_laid_out_like<TwicePush>(kTwiceWords));
  struct Longer {
    TwicePush push;
    float more;
  };
  EXPECT_FALSE(test::is_laid_out_like<Longer>(kTwiceWords));
  // A gap, as in layouts other than `scalar`: the second member is four bytes later.
  std::vector<std::uint32_t> gapped(std::begin(kTwiceWords), std::end(kTwiceWords));
  const auto second = [&](std::size_t at) {
    return (gapped[at] & 0xffff) == 72 && gapped[at + 2] == 1 && gapped[at + 3] == 35;  // OpMemberDecorate, Offset
  };
  std::size_t at = 5;
  while (!second(at)) at += gapped[at] >> 16;
  gapped[at + 4] += 4;
  EXPECT_FALSE(test::is_laid_out_like<TwicePush>(gapped));
}

}  // namespace
}  // namespace scarp
