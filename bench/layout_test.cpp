// SPDX-License-Identifier: MIT
// The push constants of gpu_raster.cpp have the layout of grid_mesh.vert.
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
