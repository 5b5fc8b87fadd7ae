// SPDX-License-Identifier: MIT
// `scarp render --mesh`: a mesh on terrain, and errors.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "test/cli/program.h"
#include "test/output/read_png.h"

namespace scarp::test {
namespace {

namespace fs = std::filesystem;

// A roof of two triangles, 20 units wide, red.
constexpr const char* kRoof =
    "mtllib roof.mtl\nv -10 0 -10\nv 10 0 -10\nv 10 0 10\nv -10 0 10\nusemtl red\nf 1 2 3 4\n";

class MeshOption : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(run({"generate", "--size", "65", "-o", dem_}).status, 0);
    scratch_.write("roof.mtl", "newmtl red\nKd 0.8 0.02 0.02\n");
  }

  Result render(const std::vector<std::string>& more, bool device = true) const {
    std::vector<std::string> arguments{"render", dem_, "-o", picture_, "--size", "64x64", "--top"};
    // Pictures of the look shaded.
    if (std::find(more.begin(), more.end(), "--look") == more.end()) arguments.insert(arguments.end(), {"--aa", "1"});
    if (device) arguments.insert(arguments.end(), {"--device", "auto"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_on_device(arguments);
  }
  void expect_refusal(const std::vector<std::string>& more, const std::string& what, bool device = true) const {
    const auto result = render(more, device);
    EXPECT_NE(result.status, 0) << what;
    EXPECT_EQ(lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(what), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(picture_));
  }
  bool has_device() const {
    return !nlohmann::json::parse(run_on_device({"devices", "--json"}).out)["devices"].empty();
  }

  Scratch scratch_;
  const std::string dem_ = scratch_.path("dem.tif"), picture_ = scratch_.path("picture.png"),
                    roof_ = scratch_.write("roof.obj", kRoof);
};

TEST_F(MeshOption, StandsAtMeshAt) {
  if (!has_device()) GTEST_SKIP() << "no Vulkan device";
  // 64 pixels for 64 cells of 30 m: a roof of 300 m in the middle, 100 m above the highest ground, or to the west.
  const auto reds = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"--mesh", roof_, "--mesh-scale", "15"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = render(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    const Rgb picture = read_png(picture_);
    std::vector<int> red(3);  // count, and the middle
    for (int i = 0; i < 64 * 64; ++i) {
      const std::uint8_t* rgb = picture.bytes.data() + 3 * i;
      if (rgb[0] < 2 * rgb[1] || rgb[0] < 100) continue;
      ++red[0];
      red[1] += i % 64;
      red[2] += i / 64;
    }
    for (int i : {1, 2}) red[i] /= std::max(1, red[0]);
    return red;
  };
  const auto info = run({"info", dem_}).out;
  const std::vector<int> middle = reds({"--mesh-at", "960,960,9000"});
  EXPECT_NEAR(middle[0], 100, 25) << info;
  EXPECT_NEAR(middle[1], 32, 2);
  EXPECT_NEAR(middle[2], 32, 2);
  const std::vector<int> north_west = reds({"--mesh-at", "480,1440,9000"});
  EXPECT_NEAR(north_west[1], 16, 2);
  EXPECT_NEAR(north_west[2], 16, 2);
  // On the ground in the middle, where hills hide part of the level roof.
  const std::vector<int> on_ground = reds({});
  EXPECT_GT(on_ground[0], 5);
  EXPECT_LT(on_ground[0], 100);
  EXPECT_EQ(reds({"--mesh-at", "-480,480,9000", "--coords", "map"}), north_west);
  // Inside the ground.
  EXPECT_EQ(reds({"--mesh-at", "960,960,-9000"})[0], 0);
}

TEST_F(MeshOption, UnseenMeshesGetANote) {
  const auto note = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render", dem_, "-o", picture_, "--size", "64x64", "--mesh", roof_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = run(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    const std::size_t at = result.err.find("note: --mesh ");
    return at == std::string::npos ? "" : result.err.substr(at, result.err.find('\n', at) - at);
  };
  const auto expect = [&](const std::string& part, const std::vector<std::string>& more) {
    const std::string text = note(more);
    EXPECT_NE(text.find(part), std::string::npos) << "expected '" << part << "' in '" << text << "'";
  };
  // 64 cells of 30 m, a pixel each, and a roof of 20 m, or 300 m.
  expect("is smaller than a pixel: 20 m wide, ", {"--top", "--mesh-at", "960,960,9000"});
  EXPECT_EQ(note({"--top", "--mesh-at", "960,960,9000", "--mesh-scale", "15"}), "");
  expect("is hidden", {"--top", "--mesh-at", "960,960,-9000", "--mesh-scale", "15"});
  expect("is outside the picture",
         {"--top", "--area", "0,0,1900,1900", "--mesh-at", "-5000,960,0", "--mesh-scale", "15"});
  expect("is behind the eye",
         {"--eye", "960,0,5000", "--target", "960,960,0", "--mesh-at", "960,-9000,9000", "--mesh-scale", "15"});
  expect("is hidden", {"--top", "--look", "height", "--mesh-at", "960,960,-9000", "--mesh-scale", "15"});
  EXPECT_EQ(note({"--mesh-at", "960,960,1000", "--mesh-scale", "15"}), "");
}

TEST_F(MeshOption, OpenMeshesCannotBeVoxelised) {
  const auto refusal = [&](const std::string& mesh, const std::string& voxel) {
    const auto result = run({"voxelise", mesh, "--voxel", voxel, "-o", scratch_.path("v.binvox")});
    EXPECT_NE(result.status, 0);
    EXPECT_EQ(lines(result.err), 1) << result.err;
    return result.err;
  };
  EXPECT_NE(refusal(roof_, "1").find("roof.obj': the mesh is open and has no inside: 4 of 5 edges"), std::string::npos);
  const std::string closed =
      scratch_.write("closed.obj", "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  EXPECT_NE(refusal(closed, "100").find("no voxel of 100 m has its middle inside"), std::string::npos);
  EXPECT_EQ(run({"voxelise", closed, "--voxel", "1", "-o", scratch_.path("v.binvox")}).status, 0);
}

TEST_F(MeshOption, ReportsErrorsInOneLine) {
  expect_refusal({"--mesh-at", "1,2"}, "--mesh-at has no effect without --mesh FILE");
  expect_refusal({"--mesh", roof_, "--mesh-up", "x"}, "--mesh-up 'x': expected y or z");
  expect_refusal({"--mesh", roof_, "--mesh-scale", "0"}, "--mesh-scale '0': expected a finite number above 0");
  expect_refusal({"--mesh", roof_, "--mesh-rotate", "nan"}, "--mesh-rotate 'nan': expected a finite number");
  if (!has_device()) GTEST_SKIP() << "no Vulkan device";
  expect_refusal({"--mesh", roof_, "--mesh-at", "here"}, "--mesh-at 'here': expected X,Y or X,Y,Z");
  expect_refusal({"--mesh", roof_, "--mesh-at", "-500,0"}, "--mesh-at: there is no ground at -500,0");
  expect_refusal({"--mesh", scratch_.path("none.obj")}, "none.obj: cannot be opened");
  expect_refusal({"--mesh", scratch_.write("nan.obj", "v 0 nan 0\n")}, "line 1: 'v 0 nan 0' (expected finite numbers)");
  expect_refusal({"--mesh", scratch_.write("far.obj", "v 0 0 0\nv 1 0 0\nf 1 2 5\n")}, "face refers to vertex 5");
  expect_refusal({"--mesh", scratch_.write("empty.gltf", R"({"asset": {"version": "2.0"}})")}, "no triangles");
}

}  // namespace
}  // namespace scarp::test
