// SPDX-License-Identifier: MIT
// `scarp render --device`: a picture on any available device, and errors.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "test/cli/program.h"
#include "test/output/read_png.h"

namespace scarp::test {
namespace {

namespace fs = std::filesystem;

class RenderOnDevice : public testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(run({"generate", "--size", "65", "-o", dem_}).status, 0); }

  Result render(std::vector<std::string> more) const {
    std::vector<std::string> arguments{"render", dem_, "-o", picture_, "--size", "60x40"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_on_device(std::move(arguments));
  }
  // One line that contains `what`, and no file.
  void expect_refusal(const Result& result, const std::string& what) const {
    EXPECT_NE(result.status, 0);
    EXPECT_EQ(lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(what), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(picture_));
  }

  Scratch scratch_;
  const std::string dem_ = scratch_.path("dem.tif"), picture_ = scratch_.path("picture.png");
};

TEST_F(RenderOnDevice, RendersAndNamesTheDevice) {
  const auto devices = nlohmann::json::parse(run_on_device({"devices", "--json"}).out);
  if (devices["devices"].empty()) GTEST_SKIP() << std::string(devices["why_none"]);
  const auto cpu = render({"--look", "error"});
  ASSERT_EQ(cpu.status, 0) << cpu.err;
  const auto device = render({"--look", "error", "--device", "auto"});
  ASSERT_EQ(device.status, 0) << device.err;
  EXPECT_EQ(cpu.out.find(", on "), std::string::npos) << cpu.out;
  bool named = false;
  for (const auto& one : devices["devices"]) {
    named |= device.out.find(", on " + std::string(one["name"]) + "\n") != std::string::npos;
  }
  EXPECT_TRUE(named) << device.out;
  // Both pictures are exact by the same judge.
  for (const char* wrong : {"lost        red        0\n", "false       magenta    0\n", "late        orange     0\n"}) {
    EXPECT_NE(device.out.find(wrong), std::string::npos) << device.out;
  }
  EXPECT_EQ(read_png(picture_).width, 60);
}

TEST_F(RenderOnDevice, RendersFunctionsAndScenes) {
  const auto devices = nlohmann::json::parse(run_on_device({"devices", "--json"}).out);
  if (devices["devices"].empty()) GTEST_SKIP() << std::string(devices["why_none"]);
  const std::string plain = scratch_.write("plain.json", R"({"type": "fbm", "octaves": 2})");
  const std::string scene = scratch_.write("scene.json", R"({
    "camera": {"eye": [0, -3000, 900], "target": [0, 0, 0]},
    "objects": [{"function": {"type": "fbm", "octaves": 2}}, {"shape": {"torus": {"radius": 400, "tube": 90}}, "at": [0, 0, 300]}]})");
  // Grounds as solids: a function, and the elevation model with a hole in it.
  std::string holed = "ncols 6\nnrows 5\nxllcorner 0\nyllcorner 0\ncellsize 300\nNODATA_value -9999\n";
  for (int i = 0; i < 30; ++i) holed += i == 14 ? "-9999 " : std::to_string(100 + (i * 37) % 150) + " ";
  scratch_.write("holed.asc", holed);
  const std::string cut = scratch_.write("cut.json", R"({
    "fields": {"hills": {"function": {"type": "fbm", "octaves": 2}}, "dem": {"heights": {"file": "holed.asc", "centred": true}}},
    "camera": {"eye": [0, -3000, 1500], "target": [0, 0, 0]},
    "objects": [{"shape": {"subtract": [{"ground": "hills"}, {"sphere": {"radius": 700, "at": [0, -300, 200]}}]}},
                {"shape": {"ground": "dem"}, "at": [0, 0, 400]}]})");
  for (const std::vector<std::string>& what : {std::vector<std::string>{"--function", plain}, {scene}, {cut}}) {
    std::vector<std::string> arguments{"render", "-o", picture_, "--size", "60x40", "--aa", "1"};
    arguments.insert(arguments.end(), what.begin(), what.end());
    const auto cpu = run_on_device(arguments);
    ASSERT_EQ(cpu.status, 0) << cpu.err;
    const auto expected = read_png(picture_);
    arguments.insert(arguments.end(), {"--device", "auto"});
    const auto device = run_on_device(arguments);
    ASSERT_EQ(device.status, 0) << device.err;
    EXPECT_NE(device.out.find(", on "), std::string::npos) << device.out;
    // Points of the ground move by millimetres over some kilometres: below a colour's last bit except where light and
    // shade, or ground and sky, meet.
    const auto picture = read_png(picture_);
    int unlike = 0;
    for (std::size_t i = 0; i < picture.bytes.size(); i += 3) {
      for (std::size_t k = i; k < i + 3; ++k) {
        if (std::abs(picture.bytes[k] - expected.bytes[k]) > 2) {
          ++unlike;
          break;
        }
      }
    }
    EXPECT_LE(unlike, 60 * 40 / 100);
    EXPECT_EQ(fs::remove(picture_), true);
  }
}

// Hits on voxels match those of the CPU to the bit, and therefore pictures and tables match, too.
TEST_F(RenderOnDevice, RendersVoxelsAsTheCpu) {
  const auto devices = nlohmann::json::parse(run_on_device({"devices", "--json"}).out);
  if (devices["devices"].empty()) GTEST_SKIP() << std::string(devices["why_none"]);
  const std::string model = scratch_.path("hills.vox"), there = scratch_.path("there.png");
  ASSERT_EQ(run({"voxelise", dem_, "-o", model, "--count", "24"}).status, 0);
  const auto on_both = [&](std::vector<std::string> arguments, const std::string& cpu, const std::string& device) {
    arguments.insert(arguments.end(), {"-o", cpu});
    const Result first = run(arguments);
    ASSERT_EQ(first.status, 0) << first.err;
    arguments.back() = device;
    arguments.insert(arguments.end(), {"--device", "auto"});
    const Result second = run_on_device(arguments);
    ASSERT_EQ(second.status, 0) << second.err;
    EXPECT_EQ(text_of(cpu), text_of(device)) << arguments[4];
  };
  const std::vector<std::string> render{"render", model, "--size", "60x40"};
  for (const std::vector<std::string>& more : {std::vector<std::string>{"--march", "voxel-planes"},
                                               {"--march", "voxel-spheres", "--look", "hillshade"},
                                               {"--look", "steps"},
                                               {"--normals", "smooth", "--samples", "2"},
                                               {"--march", "voxel-bricks", "--corner-ao"}}) {
    std::vector<std::string> arguments = render;
    arguments.insert(arguments.end(), more.begin(), more.end());
    on_both(arguments, picture_, there);
  }
  // Camera rays are answered by drawing boxes, all others by compute; with and without perspective.
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--corner-ao"}, {"--top"}, {"--look", "hillshade"}}) {
    std::vector<std::string> arguments = render;
    arguments.insert(arguments.end(), more.begin(), more.end());
    arguments.insert(arguments.end(), {"-o", picture_});
    ASSERT_EQ(run(arguments).status, 0);
    arguments.back() = there;
    arguments.insert(arguments.end(), {"--device", "auto", "--voxel-drawing", "proxies"});
    const Result drawn = run_on_device(arguments);
    ASSERT_EQ(drawn.status, 0) << drawn.err;
    EXPECT_EQ(text_of(picture_), text_of(there)) << more[0];
    const std::size_t end = drawn.out.rfind(" rays by drawing\n");
    ASSERT_NE(end, std::string::npos) << drawn.out;
    // All samples of the picture, at least.
    const std::size_t begin = drawn.out.rfind(' ', end - 1) + 1;
    EXPECT_GE(std::stoi(drawn.out.substr(begin, end - begin)), more[0] == "--look" ? 2400 : 9600) << drawn.out;
  }
  const Result alone = run({"render", model, "-o", there, "--voxel-drawing", "proxies"});
  EXPECT_NE(alone.status, 0);
  EXPECT_NE(alone.err.find("--voxel-drawing"), std::string::npos) << alone.err;
  std::string table = "x,y,z,tx,ty,tz\n";
  for (int i = 0; i < 60; ++i)
    table += fmt::format("{},{},{},{},{},{}\n", i % 7, i % 5, 90 - i, 30 - i % 11, i % 13, i % 3);
  const std::string rays = scratch_.write("rays.csv", table);
  on_both({"cast", model, "--rays", rays}, scratch_.path("a.csv"), scratch_.path("b.csv"));
  EXPECT_NE(text_of(scratch_.path("a.csv")).find("hit"), std::string::npos);
  for (const std::vector<std::string>& refused :
       {std::vector<std::string>{"--march", "voxel-exhaustive"}, {"--rounded", "0.2"}}) {
    std::vector<std::string> arguments{"render", model, "-o", scratch_.path("none.png"), "--device", "auto"};
    arguments.insert(arguments.end(), refused.begin(), refused.end());
    const Result result = run_on_device(arguments);
    EXPECT_NE(result.status, 0);
    EXPECT_EQ(lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find("does not run on Vulkan devices"), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(scratch_.path("none.png")));
  }
}

TEST_F(RenderOnDevice, RejectsMarchesWithoutDeviceSupport) {
  expect_refusal(render({"--device", "auto", "--march", "exhaustive"}),
                 "--device auto: march 'exhaustive' does not run on Vulkan devices (available: max-mip, ");
}

TEST_F(RenderOnDevice, ComancheStepsSupportSoftLight) {
  const auto devices = nlohmann::json::parse(run_on_device({"devices", "--json"}).out);
  if (devices["devices"].empty()) GTEST_SKIP() << std::string(devices["why_none"]);
  const std::vector<std::string> arguments{"render",   dem_,    "-o",      picture_,     "--look",   "comanche",
                                           "--lowres", "24x16", "--march", "fixed-step", "--device", "auto"};
  const auto made = run_on_device(arguments);
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_NE(made.out.find(", on "), std::string::npos) << made.out;
  EXPECT_EQ(read_png(picture_).width, 72);
  const auto hard = read_png(picture_).bytes;
  std::vector<std::string> soft = arguments;
  soft.insert(soft.end(), {"--samples", "4"});
  const auto made_soft = run_on_device(soft);
  ASSERT_EQ(made_soft.status, 0) << made_soft.err;
  EXPECT_NE(read_png(picture_).bytes, hard);
}

TEST_F(RenderOnDevice, RejectsUnknownDevices) {
  expect_refusal(render({"--device", "no such card"}), "'no such card'");
  expect_refusal(render({"--device", ""}), "--device");
  ::setenv("VK_DRIVER_FILES", "/nonexistent", 1);
  ::setenv("VK_ICD_FILENAMES", "/nonexistent", 1);
  expect_refusal(render({"--device", "auto"}), "Vulkan: no ");
  ::unsetenv("VK_DRIVER_FILES");
  ::unsetenv("VK_ICD_FILENAMES");
}

}  // namespace
}  // namespace scarp::test
