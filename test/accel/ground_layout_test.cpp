// SPDX-License-Identifier: MIT
// C++ and the shaders agree on the layout of shared structs.
#include <gtest/gtest.h>

#include <cstddef>

#include "scarp/accel/ground_buffers.glsl.h"
#include "scarp/accel/max_pyramid.glsl.h"
#include "scarp/field/height_field.h"
#include "test/vk/spirv_layout.h"

namespace scarp {
namespace {

using glsl::GroundBuffers, glsl::GroundLevel, glsl::PyramidPush;

constexpr std::uint32_t kShader[] = {
#include "scarp/accel/max_pyramid.comp.inc"
};

TEST(GroundLayout, MatchesTheShaders) {
  EXPECT_TRUE(
      test::has_struct(kShader, {offsetof(GroundBuffers, samples),        offsetof(GroundBuffers, pyramid),
                                 offsetof(GroundBuffers, quads),          offsetof(GroundBuffers, quad_cols),
                                 offsetof(GroundBuffers, quad_rows),      offsetof(GroundBuffers, quad_stride),
                                 offsetof(GroundBuffers, cols),           offsetof(GroundBuffers, rows),
                                 offsetof(GroundBuffers, cell_cols),      offsetof(GroundBuffers, cell_rows),
                                 offsetof(GroundBuffers, sample_words),   offsetof(GroundBuffers, sample_type),
                                 offsetof(GroundBuffers, has_holes),      offsetof(GroundBuffers, hole),
                                 offsetof(GroundBuffers, triangles),      offsetof(GroundBuffers, wrap),
                                 offsetof(GroundBuffers, solid),          offsetof(GroundBuffers, top_level),
                                 offsetof(GroundBuffers, code_base),      offsetof(GroundBuffers, code_base_low),
                                 offsetof(GroundBuffers, code_step),      offsetof(GroundBuffers, code_step_low),
                                 offsetof(GroundBuffers, code_per_step),  offsetof(GroundBuffers, code_over),
                                 offsetof(GroundBuffers, min_sample),     offsetof(GroundBuffers, max_sample),
                                 offsetof(GroundBuffers, spread),         offsetof(GroundBuffers, cell_x),
                                 offsetof(GroundBuffers, cell_y),         offsetof(GroundBuffers, metres_per_sample),
                                 offsetof(GroundBuffers, metres_at_zero), offsetof(GroundBuffers, levels)}));
  EXPECT_TRUE(test::has_struct(
      kShader, {offsetof(GroundLevel, begin), offsetof(GroundLevel, cols), offsetof(GroundLevel, rows)}));
  EXPECT_TRUE(test::has_array_stride(kShader, sizeof(GroundLevel)));
  EXPECT_TRUE(test::has_struct(
      kShader, {offsetof(PyramidPush, ground), offsetof(PyramidPush, codes), offsetof(PyramidPush, level),
                offsetof(PyramidPush, col_begin), offsetof(PyramidPush, row_begin), offsetof(PyramidPush, col_end),
                offsetof(PyramidPush, row_end)}));
}

TEST(GroundLayout, ConstantsMatchTheShaders) {
  EXPECT_EQ(glsl::kGroundInt16, static_cast<std::uint32_t>(SampleType::int16));
  EXPECT_EQ(glsl::kGroundUint16, static_cast<std::uint32_t>(SampleType::uint16));
  EXPECT_EQ(glsl::kGroundFloat32, static_cast<std::uint32_t>(SampleType::float32));
  EXPECT_EQ(glsl::kGroundWrapNone, static_cast<std::uint32_t>(Wrap::none));
  EXPECT_EQ(glsl::kGroundWrapPeriodic, static_cast<std::uint32_t>(Wrap::periodic));
  EXPECT_EQ(glsl::kGroundWrapSharedBorder, static_cast<std::uint32_t>(Wrap::shared_border));
}

}  // namespace
}  // namespace scarp
