// SPDX-License-Identifier: MIT
// The check of layouts itself; those of a station's shaders are checked beside their tests.
#include <gtest/gtest.h>

#include <cstddef>

#include "test/vk/spirv_layout.h"
#include "test/vk/twice.glsl.h"

namespace scarp {
namespace {

constexpr std::uint32_t kTwice[] = {
#include "test/vk/twice.comp.inc"
};

TEST(ShaderLayout, IsThatOfTheSharedStruct) {
  using glsl::TwicePush;
  EXPECT_TRUE(test::has_struct(kTwice, {offsetof(TwicePush, from), offsetof(TwicePush, to), offsetof(TwicePush, count),
                                        offsetof(TwicePush, rounds)}));
  EXPECT_FALSE(test::has_struct(kTwice, {0, 8, 12, 16}));
  EXPECT_FALSE(test::has_struct(kTwice, {0, 8, 16}));
  EXPECT_TRUE(test::has_array_stride(kTwice, 4));
  EXPECT_FALSE(test::has_array_stride(kTwice, 12));
}

}  // namespace
}  // namespace scarp
