// SPDX-License-Identifier: MIT
// Pictures, small, against those that were looked at and found good: the demo, each row of the look comanche, the
// example scenes. After a change that is meant to be seen: look at the new picture, which a failing test leaves in the
// build folder, and copy it to test/golden/.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "cli/program.h"
#include "output/read_png.h"
#include "scarp/output/png.h"

namespace scarp {
namespace {

namespace fs = std::filesystem;

// A byte may round the other way where the mathematical library's pow, exp, sin or cos differs in its last bit.
constexpr int kByteRounding = 2;
// And a ray may pass the other side of a crest or a shadow's edge: that changes one of a pixel's four samples, at most
// from white to black, and does so in few pixels. Of one sample per pixel it changes all.
constexpr int kMaxDifference = 140, kAnyDifference = 255;
constexpr double kMaxShare = 0.001;

// The picture as a file of the tests, `name`.png, against the golden one; `where` tells who has made it.
void expect_golden(const std::string& picture, const std::string& name, int most, const std::string& where = "") {
  const test::Rgb now = test::read_png(picture);
  const fs::path kept = fs::path(SCARP_FAILED_IMAGES) / (name + where + "_now.png");
  const std::string golden_path = (fs::path(SCARP_SOURCE_DIR) / "test" / "golden" / (name + ".png")).string();
  fs::copy_file(picture, kept, fs::copy_options::overwrite_existing);
  ASSERT_TRUE(fs::exists(golden_path)) << "the picture is " << kept;
  const test::Rgb golden = test::read_png(golden_path);
  ASSERT_EQ(now.width, golden.width);
  ASSERT_EQ(now.height, golden.height);

  int largest = 0;
  std::int64_t differing = 0;
  std::vector<std::uint8_t> difference(now.bytes.size());
  for (std::size_t pixel = 0; pixel < now.bytes.size(); pixel += 3) {
    int here = 0;
    for (std::size_t i = pixel; i < pixel + 3; ++i) here = std::max(here, std::abs(now.bytes[i] - golden.bytes[i]));
    largest = std::max(largest, here);
    differing += here > kByteRounding;
    // Amplified, so that one sees it.
    std::fill_n(difference.begin() + static_cast<std::ptrdiff_t>(pixel), 3,
                static_cast<std::uint8_t>(std::min(255, 8 * here)));
  }
  const double share = static_cast<double>(differing) / (static_cast<double>(now.width) * now.height);
  EXPECT_LE(largest, most);
  EXPECT_LE(share, kMaxShare);
  if (testing::Test::HasFailure()) {
    const std::string shown = (fs::path(SCARP_FAILED_IMAGES) / (name + where + "_difference.png")).string();
    write_png(shown, {difference.data(), now.width, now.height});
    ADD_FAILURE() << "differences, 8 times as bright: " << shown << "; the picture itself: " << kept;
  } else {
    fs::remove(kept);
  }
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

class GoldenPicture : public testing::TestWithParam<Golden> {};

std::vector<std::string> arguments_of(const Golden& wanted, const std::string& picture) {
  std::vector<std::string> arguments{
      "render", kJacksboro,  "-o",
      picture,  "--key",     "elevation",
      "--crs",  "EPSG:4326", "--bounds=-84.41375,36.44625,-84.07791666666667,36.73291666666667"};
  arguments.insert(arguments.end(), wanted.options.begin(), wanted.options.end());
  return arguments;
}

TEST_P(GoldenPicture, IsAsItWas) {
  const Golden& wanted = GetParam();
  if (!fs::exists(kJacksboro))
    GTEST_SKIP() << "'" << kJacksboro << "' is missing; it comes with Debian's package python-matplotlib-data";
  const test::Scratch scratch;
  const std::string picture = scratch.path("picture.png");
  const auto result = test::run(arguments_of(wanted, picture));
  ASSERT_EQ(result.status, 0) << result.err;
  expect_golden(picture, wanted.name, wanted.max_difference);
}

#ifdef SCARP_VULKAN
// The very pictures of the CPU.
TEST_P(GoldenPicture, IsTheSameOnADevice) {
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
// Drawn and asked on a CPU device, which is the same everywhere.
TEST(GoldenMesh, AsItWasLookedAt) {
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

// One sample in the middle of each of few pixels. With sanitizers functions are slow: two scenes must do there.
TEST_P(GoldenScene, AsItWasLookedAt) {
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
