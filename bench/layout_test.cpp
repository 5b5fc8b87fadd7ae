// SPDX-License-Identifier: MIT
// What gpu_raster.cpp pushes lies where grid_mesh.vert reads it.
#include <gtest/gtest.h>

#include "bench/grid_mesh.glsl.h"
#include "test/vk/spirv_layout.h"

namespace scarp::bench {
namespace {

constexpr std::uint32_t kShader[] = {
#include "bench/grid_mesh.vert.inc"
};

TEST(GridMeshLayout, MatchesTheShader) { EXPECT_TRUE(test::is_laid_out_like<glsl::GridMeshPush>(kShader)); }

}  // namespace
}  // namespace scarp::bench
