// SPDX-License-Identifier: MIT
// Scenes on the command line: printed output, accepted options, written files.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "cli/program.h"
#include "output/read_png.h"

namespace scarp {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kScene = R"({
  "picture": {"size": [64, 40], "aa": 1},
  "camera": {"eye": [0, -20, 3], "target": [0, 0, 2]},
  "sun": {"azimuth": 180, "altitude": 40},
  "materials": {"red": {"colour": "#ff0000"}},
  "objects": [
    {"name": "ground", "function": 0},
    {"name": "ball", "shape": {"sphere": {"radius": 3}}, "material": "red", "at": [0, 0, 2]}
  ]
})";

class Scenes : public testing::Test {
 protected:
  Scenes() { std::ofstream(path_) << kScene; }

  test::Scratch scratch_;
  const std::string path_ = scratch_.path("scene.json"), picture_ = scratch_.path("out.png");
};

TEST_F(Scenes, RenderWithTheirFileSettings) {
  const auto result = test::run({"render", path_, "-o", picture_});
  ASSERT_EQ(result.status, 0) << result.err;
  const test::Rgb image = test::read_png(picture_);
  ASSERT_EQ(image.width, 64);
  ASSERT_EQ(image.height, 40);
  // Red in the middle, where the ball is; blue sky above, earth below.
  const auto pixel = [&](int x, int y) { return &image.bytes[static_cast<std::size_t>(3 * (y * 64 + x))]; };
  EXPECT_GT(pixel(32, 20)[0], 4 * pixel(32, 20)[1]);
  EXPECT_GT(pixel(32, 0)[2], pixel(32, 0)[0]);
  EXPECT_GT(pixel(32, 39)[0], pixel(32, 39)[2]);
}

TEST_F(Scenes, AreOverriddenByOptions) {
  ASSERT_EQ(test::run({"render", path_, "-o", picture_, "--size", "16x8", "--view", "0,90", "--look", "steps"}).status,
            0);
  EXPECT_EQ(test::read_png(picture_).width, 16);
  const auto refused = test::run({"render", path_, "-o", picture_, "--march", "naive"});
  EXPECT_NE(refused.status, 0);
  EXPECT_NE(refused.err.find(
                "--march applies to terrain, voxels and functions only (a scene file describes its own content)"),
            std::string::npos)
      << refused.err;
  EXPECT_NE(test::run({"render", path_, path_, "-o", picture_}).err.find("stands alone"), std::string::npos);
}

// Sky, water and fog of the file, and options that change them.
TEST_F(Scenes, ApplyTheirEnvironment) {
  const auto scene = [&](const std::string& environment) {
    std::ofstream(path_)
        << R"({"picture": {"size": [48, 32], "aa": 1}, "camera": {"eye": [0, -20, 5], "target": [0, 0, 0]},)"
        << environment << R"("objects": [{"function": -2}, {"shape": {"sphere": {"radius": 3}}, "at": [0, 0, 1]}]})";
  };
  const auto picture = [&](std::vector<std::string> options = {}) {
    options.insert(options.begin(), {"render", path_, "-o", picture_});
    const auto result = test::run(options);
    EXPECT_EQ(result.status, 0) << result.err;
    return test::text_of(picture_);
  };
  const auto refused = [&](std::vector<std::string> options, const std::string& fragment) {
    fs::remove(picture_);
    options.insert(options.begin(), {"render", path_, "-o", picture_});
    const auto result = test::run(options);
    EXPECT_NE(result.status, 0) << fragment;
    EXPECT_EQ(test::lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(fragment), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(picture_));
  };
  scene("");
  const std::string dry = picture(), wet = picture({"--water", "0", "--turbidity", "2"}),
                    foggy = picture({"--fog", "height", "--visibility", "30", "--fog-base", "0", "--fog-falloff", "4"});
  EXPECT_NE(dry, wet);
  EXPECT_NE(dry, foggy);
  refused({"--turbidity", "2"}, "--turbidity has no effect without --water M, or water in the scene file");
  refused({"--sun-tint", "0"}, "--sun-tint has no effect without --fog KIND, or fog in the scene file");
  refused({"--seed", "2"}, "--seed has no effect without --samples N, or samples in the scene file");
  refused({"--fog", "height", "--haze", "0.5"}, "--haze has no effect with --fog, which replaces it");

  scene(R"("water": {"level": 0, "turbidity": 2},)");
  EXPECT_EQ(picture(), wet);
  EXPECT_NE(picture({"--water-colour", "ff0000"}), wet);
  EXPECT_NE(picture({"--water", "-1"}), wet);
  scene(R"("water": {"level": 0, "turbidity": 2, "reflection": false, "refraction": false, "colour": "#ff0000"},)");
  EXPECT_EQ(picture({"--turbidity", "2"}), picture());
  EXPECT_NE(picture(), wet);

  scene(R"("fog": {"kind": "height", "visibility": 30, "base": 0, "falloff": 4},)");
  EXPECT_EQ(picture(), foggy);
  EXPECT_EQ(picture({"--fog", "none"}), dry);
  EXPECT_NE(picture({"--visibility", "9"}), foggy);
  scene(R"("fog": {"kind": "distance"},)");
  refused({"--haze", "0.5"}, "--haze has no effect with the fog of the scene file");
  EXPECT_NE(picture({"--fog", "none", "--haze", "0.5"}), dry);
  refused({"--fog-base", "1"}, "--fog-base has no effect without --fog height, or such fog in the scene file");

  scene(R"("sky": {"kind": "scattering", "turbidity": 5},)");
  const std::string clear = picture();
  EXPECT_NE(clear, dry);
  EXPECT_NE(picture({"--sky-turbidity", "2"}), clear);
  EXPECT_EQ(picture({"--sky", "plain"}), dry);
  refused({"--fog", "distance", "--sun-tint", "1"}, "--sun-tint has no effect with a scattering sky");
  scene("");
  EXPECT_EQ(picture({"--sky", "scattering", "--sky-turbidity", "5"}), clear);
  refused({"--sky-turbidity", "5"}, "--sky-turbidity has no effect without --sky scattering, or such a sky");
  scene(R"("sky": {"kind": "plain", "turbidity": 5},)");
  refused({}, "/sky/turbidity: only valid for the sky kind 'scattering'");
  scene(R"("sky": {"kind": "scattering"}, "fog": {"kind": "distance", "sun_tint": 1},)");
  refused({}, "/fog/sun_tint: not valid together with a scattering sky");

  scene(R"("water": {"waves": 0.1},)");
  refused({}, "/water");
  scene(R"("water": {"level": 0, "waves": 0.9},)");
  refused({}, "/water/waves");
  scene(R"("fog": {"kind": "iterations"},)");
  refused({}, "/fog/kind");
  scene(R"("fog": {"kind": "distance", "falloff": 3},)");
  refused({}, "/fog/falloff: only valid for the fog kind 'height'");
  scene(R"("fog": {"kind": "distance"}, "haze": {"distance": 100},)");
  refused({}, "/haze: not valid together with fog");
}

// The look comanche flies over terrain by itself, but not where the file has a camera.
TEST_F(Scenes, UseTheirCameraInEveryLook) {
  const auto picture = [&](const std::string& camera) {
    std::ofstream(path_) << "{" << camera
                         << R"("objects": [{"heights": {"generate": {"size": [33, 33], "cell": 4}}}]})";
    const auto result =
        test::run({"render", path_, "-o", picture_, "--look", "comanche", "--lowres", "32x24", "--pixel-size", "1"});
    EXPECT_EQ(result.status, 0) << result.err;
    return test::text_of(picture_);
  };
  const std::string south = picture(R"("camera": {"azimuth": 180, "elevation": 40},)");
  EXPECT_NE(picture(R"("camera": {"azimuth": 90, "elevation": 40},)"), south);
  EXPECT_NE(picture(""), south);
}

#ifdef SCARP_CAIRO
// Colours of one ramp over heights.
TEST_F(Scenes, ShowALegendWhenColouredByARamp) {
  const auto rendered = [&](const std::string& materials) {
    std::ofstream(path_) << R"({"camera": {"eye": [0, -20, 5], "target": [0, 0, 0]}, "materials": {)" << materials
                         << R"(}, "objects": [{"function": 0, "material": "low"}]})";
    return test::run({"render", path_, "-o", picture_, "--size", "320x240", "--aa", "1", "--legend"});
  };
  const std::string ramp = R"({"ramp": {"name": "viridis", "heights": [0, 9]}})", plain = R"({"colour": "#ff0000"})";
  const auto one = rendered("\"low\": " + ramp + ", \"other\": " + plain);
  EXPECT_EQ(one.status, 0) << one.err;
  EXPECT_NE(rendered("\"low\": " + plain).err.find("do not depend on height"), std::string::npos);
  EXPECT_NE(rendered("\"low\": " + ramp + ", \"other\": " + ramp).err.find("several scales"), std::string::npos);
}
#endif

TEST_F(Scenes, AreDescribedByInfo) {
  const auto result = test::run({"info", path_, "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json info = Json::parse(result.out);
  EXPECT_EQ(info["objects"].size(), 2u);
  EXPECT_EQ(info["objects"][1]["name"], "ball");
  EXPECT_EQ(info["objects"][1]["fields"][0]["march"], "sphere-trace");
  EXPECT_EQ(info["endless"], true);
  // Boxes of shapes are padded by 2^-49 of their coordinates (distance_node.cpp), and boxes of placed objects by a few
  // more roundings: fewer than 64 units in the last place of the 5 m that the ball reaches from the origin.
  EXPECT_NEAR(info["low_m"][2].get<double>(), -1, 64 * 5 * 0x1p-53);
  EXPECT_LE(info["low_m"][2].get<double>(), -1);
  EXPECT_NE(test::run({"info", path_}).out.find("1 ball: 1 x shape by sphere-trace"), std::string::npos);
  EXPECT_EQ(info["objects"][1]["first"], 1) << "as the object of scarp cast";
  std::ofstream(path_) << R"({"objects": [{"heights": {"generate": {"size": [9, 8]}}}]})";
  EXPECT_EQ(Json::parse(test::run({"info", path_, "--json"}).out)["objects"][0]["fields"][0]["samples"], 72);
}

// A million levels: one line with the position, and no stack overflow.
TEST_F(Scenes, RejectDeepNesting) {
  // A recursive parser would need more than the usual stack of 8 MiB, at 32 bytes or more per call.
  constexpr int kLevels = 1 << 18;
  const auto nested = [&](const std::string& before, const std::string& level, const std::string& core,
                          const std::string& after, const std::string& last) {
    std::string text = before;
    for (int i = 0; i < kLevels; ++i) text += level;
    text += core;
    for (int i = 0; i < kLevels; ++i) text += after;
    std::ofstream(path_) << text + last;
    return test::run({"render", path_, "-o", picture_});
  };
  for (const auto& [result, where] :
       {std::pair(nested(R"({"objects":[{"shape":)", R"({"scale":1,"of":)", R"({"sphere":{}})", "}", "}]}"),
                  "/objects/0/shape/of/of/"),
        std::pair(nested(R"({"objects":[{"shape":)", R"({"union":[)", R"({"sphere":{}})", "]}", "}]}"),
                  "/objects/0/shape/union/0/union/0/"),
        std::pair(nested(R"({"objects":[{"function":)", R"({"type":"terraces","base":)", "1", "}", "}]}"),
                  "/objects/0/function/base/base/"),
        std::pair(nested(R"({"objects":)", "[", "", "]", "}"), "/objects/0/0/")}) {
    EXPECT_NE(result.status, 0);
    EXPECT_EQ(test::lines(result.err), 1);
    EXPECT_NE(result.err.find(where), std::string::npos) << result.err.substr(0, 200);
    EXPECT_LT(result.err.size(), 300u);
    EXPECT_FALSE(fs::exists(picture_));
  }
}

TEST_F(Scenes, LeaveNoOutputOnErrors) {
  std::ofstream(path_) << R"({"objects": [{"shape": {"sphere": {"radius": -1}}}]})";
  const auto result = test::run({"render", path_, "-o", picture_});
  EXPECT_NE(result.status, 0);
  EXPECT_NE(result.err.find("/objects/0/shape/sphere/radius"), std::string::npos) << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  EXPECT_FALSE(fs::exists(picture_));
}

}  // namespace
}  // namespace scarp
