// SPDX-License-Identifier: MIT
// Small pictures against approved ones: the demo, each row of the look comanche, the example scenes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "cli/program.h"
#include "output/golden.h"

namespace scarp {
namespace {

namespace fs = std::filesystem;
using test::kAnyDifference, test::kMaxDifference;

// Compares the picture with the golden file `name`.png; `where` names its origin.
void expect_golden(const std::string& picture, const std::string& name, int most, const std::string& where = "") {
  if (!where.empty() && std::getenv("SCARP_NEW_GOLDEN")) return;  // the golden pictures are the CPU's
  test::expect_golden(picture, fs::path(SCARP_SOURCE_DIR) / "test" / "golden" / (name + ".png"), most,
                      (fs::path(SCARP_FAILED_IMAGES) / (name + where)).string());
}

constexpr const char* kJacksboro = "/usr/share/matplotlib/mpl-data/sample_data/jacksboro_fault_dem.npz";

struct Golden {
  const char* name;
  std::vector<std::string> options;
  int max_difference;
};

void PrintTo(const Golden& golden, std::ostream* out) { *out << golden.name; }

std::vector<Golden> goldens() {
  const std::vector<std::string> low{"--look", "comanche", "--lowres", "160x120",        "--pixel-size",
                                     "1",      "--wrap",   "mirror",   "--exaggeration", "2"};
  std::vector<Golden> all;
  all.push_back({"jacksboro",
                 {"--size", "480x270", "--exaggeration", "2", "--view", "195,30", "--sun", "300,30"},
                 kMaxDifference});
  const auto add = [&](const char* name, const std::vector<std::string>& options) {
    std::vector<std::string> full = low;
    full.insert(full.end(), options.begin(), options.end());
    // Here a pixel has one sample.
    all.push_back({name, full, kAnyDifference});
  };
  add("comanche-plain",
      {"--march", "fixed-step", "--fixed-step-interpolate", "false", "--water", "330", "--fog", "iterations"});
  add("comanche-interpolated", {"--march", "fixed-step", "--water", "330", "--fog", "iterations", "--detail", "0.5"});
  add("comanche-by-view", {"--march", "fixed-step", "--step-by-view", "--fixed-step-interpolate", "false"});
  add("comanche-shells", {"--march", "fixed-step", "--shells", "--fixed-step-interpolate", "false", "--steps", "48"});
  add("comanche-iterations", {"--march", "fixed-step", "--iterations"});
  add("comanche-exact", {"--water", "330", "--fog", "distance"});
  add("comanche-natural", {"--water", "330", "--fog", "height", "--ground", "natural", "--contours", "50"});
  all.push_back({"lake",
                 {"--size", "240x135", "--exaggeration", "2", "--water", "330", "--view", "200,25", "--fog", "height"},
                 kMaxDifference});
  return all;
}

// The pictures in doc/user are what their commands render.
TEST(DocumentPictures, MatchTheirCommands) {
  if (!fs::exists(kJacksboro))
    GTEST_SKIP() << "'" << kJacksboro << "' is missing; it comes with Debian's package python-matplotlib-data";
  const test::Scratch scratch;
  const fs::path root = SCARP_SOURCE_DIR, folder = scratch.path("images");
  fs::create_directory(folder);
  const std::string command = fmt::format("cd '{}' && '{}/doc/gallery.sh' '" SCARP_PROGRAM "' '{}' quick >log 2>&1",
                                          folder.string(), root.string(), kJacksboro);
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
  int pictures = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".png") continue;
    ++pictures;
    SCOPED_TRACE(entry.path().filename().string());
    test::expect_golden(entry.path().string(), root / "doc" / "images" / entry.path().filename(), kAnyDifference,
                        (fs::path(SCARP_FAILED_IMAGES) / entry.path().stem()).string());
  }
  EXPECT_GE(pictures, 35);
}

class GoldenPicture : public testing::TestWithParam<Golden> {};

std::vector<std::string> arguments_of(const Golden& wanted, const std::string& picture) {
  std::vector<std::string> arguments{
      "render", kJacksboro,  "-o",
      picture,  "--key",     "elevation",
      "--crs",  "EPSG:4326", "--bounds=-84.41375,36.44625,-84.07791666666667,36.73291666666667"};
  arguments.insert(arguments.end(), wanted.options.begin(), wanted.options.end());
  return arguments;
}

TEST_P(GoldenPicture, IsUnchanged) {
  const Golden& wanted = GetParam();
  if (!fs::exists(kJacksboro))
    GTEST_SKIP() << "'" << kJacksboro << "' is missing; it comes with Debian's package python-matplotlib-data";
  const test::Scratch scratch;
  const std::string picture = scratch.path("picture.png");
  const auto result = test::run(arguments_of(wanted, picture));
  ASSERT_EQ(result.status, 0) << result.err;
  expect_golden(picture, wanted.name, wanted.max_difference);
}

// The picture that ./dev demo has just made in a clean clone (./dev test names it), against the one that the README
// shows.
TEST(GoldenDemo, MatchesTheReadme) {
  const char* picture = std::getenv("SCARP_DEMO_PICTURE");
  if (!picture || !*picture) GTEST_SKIP() << "SCARP_DEMO_PICTURE names no picture; ./dev test sets it";
  test::expect_golden(picture, fs::path(SCARP_SOURCE_DIR) / "doc" / "images" / "jacksboro.png", kMaxDifference,
                      (fs::path(SCARP_FAILED_IMAGES) / "demo").string());
}

#ifdef SCARP_VULKAN
// Exactly the pictures of the CPU.
TEST_P(GoldenPicture, MatchesOnADevice) {
  const Golden& wanted = GetParam();
  if (!fs::exists(kJacksboro))
    GTEST_SKIP() << "'" << kJacksboro << "' is missing; it comes with Debian's package python-matplotlib-data";
  const auto devices = nlohmann::json::parse(test::run_on_device({"devices", "--json"}).out);
  if (devices["devices"].empty()) GTEST_SKIP() << std::string(devices["why_none"]);
  const test::Scratch scratch;
  const std::string picture = scratch.path("picture.png");
  std::vector<std::string> arguments = arguments_of(wanted, picture);
  arguments.insert(arguments.end(), {"--device", "auto"});
  const auto result = test::run_on_device(arguments);
  ASSERT_EQ(result.status, 0) << result.err;
  expect_golden(picture, wanted.name, wanted.max_difference, "_on_device");
}
#endif

#ifdef SCARP_MESH_ON_DEVICE
// Drawn and computed on a CPU device, whose results are the same everywhere.
TEST(GoldenMesh, MatchesTheReviewedPicture) {
  if (!fs::exists(kJacksboro))
    GTEST_SKIP() << "'" << kJacksboro << "' is missing; it comes with Debian's package python-matplotlib-data";
  const test::Scratch scratch;
  const std::string picture = scratch.path("picture.png");
  const fs::path mesh = fs::path(SCARP_SOURCE_DIR) / "examples" / "meshes" / "balloons.obj";
  std::vector<std::string> arguments{
      "render", kJacksboro,  "-o",
      picture,  "--key",     "elevation",
      "--crs",  "EPSG:4326", "--bounds=-84.41375,36.44625,-84.07791666666667,36.73291666666667"};
  for (const char* more : {"--exaggeration",
                           "2",
                           "--no-plinth",
                           "--sun",
                           "240,45",
                           "--size",
                           "240x135",
                           "--eye",
                           "9000,1000,3600",
                           "--target",
                           "17000,14000,1300",
                           "--fov",
                           "35",
                           "--mesh-at",
                           "15000,9500,700",
                           "--mesh-scale",
                           "60",
                           "--device",
                           "cpu",
                           "--mesh"})
    arguments.emplace_back(more);
  arguments.push_back(mesh.string());
  const auto result = test::run_on_device(arguments);
  if (result.err.find("Vulkan") != std::string::npos) GTEST_SKIP() << result.err;
  ASSERT_EQ(result.status, 0) << result.err;
  expect_golden(picture, "mesh-balloons", kMaxDifference);
}
#endif

class GoldenScene : public testing::TestWithParam<const char*> {};

// Few pixels, each with one sample in its middle. Functions are slow with sanitizers: there, two scenes must suffice.
TEST_P(GoldenScene, MatchesTheReviewedPicture) {
  const std::string name = GetParam();
#ifndef SCARP_MESHES_IN_SCENES
  if (name == "balloons" || name == "lake") GTEST_SKIP() << "built without SCARP_EMBREE or SCARP_MESH";
#endif
#ifndef NDEBUG
  if (name != "torus-at-sea" && name != "village") GTEST_SKIP() << "too slow without optimisation";
#endif
  if ((name == "quarry" || name == "mix") && !fs::exists(kJacksboro))
    GTEST_SKIP() << "'" << kJacksboro << "' is missing; it comes with Debian's package python-matplotlib-data";
  const test::Scratch scratch;
  const std::string picture = scratch.path(name + ".png");
  const fs::path scene = fs::path(SCARP_SOURCE_DIR) / "examples" / "scenes" / (name + ".json");
  const auto result =
      test::run({"render", scene.string(), "-o", picture, "--size", "160x90", "--aa", "1", "--samples", "0"});
  ASSERT_EQ(result.status, 0) << result.err;
  expect_golden(picture, "scene-" + name, kAnyDifference);
}

INSTANTIATE_TEST_SUITE_P(Examples, GoldenScene,
                         testing::Values("balloons", "cutaway", "endless", "lake", "mix", "quarry", "standing-in-noise",
                                         "torus-at-sea", "village"),
                         [](const auto& scene) {
                           std::string name = scene.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

INSTANTIATE_TEST_SUITE_P(All, GoldenPicture, testing::ValuesIn(goldens()),
                         [](const testing::TestParamInfo<Golden>& golden) {
                           std::string name = golden.param.name;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace scarp
