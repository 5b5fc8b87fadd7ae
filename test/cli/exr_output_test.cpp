// SPDX-License-Identifier: MIT
// `scarp render -o OUT.exr` from outside.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "cli/program.h"
#include "cli/spike.h"
#include "output/read_exr.h"

namespace scarp {
namespace {

class ExrOutput : public testing::Test {
 protected:
  // The plane z = 100 + x / 10 - y / 5 over 3 x 2 cells of 10 m.
  std::string plane() const {
    return scratch_.write("plane.asc",
                          "ncols 4\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 10\n"
                          "96 97 98 99\n98 99 100 101\n100 101 102 103\n");
  }
  std::string out() const { return scratch_.path("out.exr"); }

  test::Scratch scratch_;
};

TEST_F(ExrOutput, HasTheChannelsCompositorsExpect) {
  const auto result = test::run({"render", plane(), "-o", out(), "--size", "40x30"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(test::lines(result.out), 1) << result.out;
  const test::Exr exr = test::read_exr(out());
  EXPECT_EQ(exr.width, 40);
  EXPECT_EQ(exr.height, 30);
  std::set<std::string> names;
  for (const auto& [name, channel] : exr.channels) {
    names.insert(name);
    const bool colour = name == "R" || name == "G" || name == "B";
    EXPECT_EQ(channel.type, colour ? Imf::HALF : name == "steps" ? Imf::UINT : Imf::FLOAT) << name;
  }
  EXPECT_EQ(names, (std::set<std::string>{"B", "G", "N.X", "N.Y", "N.Z", "P.X", "P.Y", "P.Z", "R", "Z", "steps"}));
}

TEST_F(ExrOutput, PositionsMatchTheMatrices) {
  for (const std::vector<std::string>& from :
       {std::vector<std::string>{"--view", "200,50"}, {"--top"}, {"--eye", "-3,-20,160", "--target", "15,10,99"}}) {
    std::vector<std::string> arguments{"render", plane(), "-o", out(), "--size", "40x30", "--no-plinth"};
    arguments.insert(arguments.end(), from.begin(), from.end());
    const auto result = test::run(arguments);
    ASSERT_EQ(result.status, 0) << result.err;
    const test::Exr exr = test::read_exr(out());
    const auto values = [&](const char* name) { return exr.channels.at(name).values; };
    const auto x = values("P.X"), y = values("P.Y"), z = values("P.Z"), depth = values("Z");
    // Positions and matrices are floats of some 100 m, and products of them are summed.
    constexpr double kRounding = 200 * 8 * 6e-8;
    int hits = 0;
    for (int j = 0; j < exr.height; ++j) {
      for (int i = 0; i < exr.width; ++i) {
        const auto k = static_cast<std::size_t>(j * exr.width + i);
        if (std::isinf(depth[k])) continue;
        ++hits;
        EXPECT_NEAR(z[k], 100 + x[k] / 10 - y[k] / 5, kRounding);
        const Imath::V3d position(x[k], y[k], z[k]);
        Imath::V3d in_camera, in_picture;
        Imath::M44d(exr.matrices.at("worldToCamera")).multVecMatrix(position, in_camera);
        EXPECT_NEAR(in_camera.z, depth[k], kRounding);
        Imath::M44d(exr.matrices.at("worldToNDC")).multVecMatrix(position, in_picture);
        // A pixel covers more than a metre here.
        EXPECT_NEAR((in_picture.x + 1) / 2 * exr.width, i + 0.5, exr.width * kRounding);
        EXPECT_NEAR((1 - in_picture.y) / 2 * exr.height, j + 0.5, exr.height * kRounding);
      }
    }
    EXPECT_GT(hits, exr.width * exr.height / 10) << from.front();
  }
}

// Errors in metres, judged by the positions of two marches' own pictures.
TEST_F(ExrOutput, HasTheErrorsOfAMarchInMetres) {
  const std::string dem = test::spike_dem(scratch_);
  const Imath::V3d eye(16, -10, 12);
  const auto render = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"render", dem, "-o", out(), "--size", "64x64", "--no-plinth", "--eye", "16,-10,12",
                                     "--target", "16,16,6"});
    return test::run(options);
  };
  // Distances from the eye; infinite for misses.
  const auto distances = [&](const std::vector<std::string>& march) {
    const auto result = render(march);
    EXPECT_EQ(result.status, 0) << result.err;
    const test::Exr exr = test::read_exr(out());
    const auto values = [&](const char* name) { return exr.channels.at(name).values; };
    const auto x = values("P.X"), y = values("P.Y"), z = values("P.Z"), depth = values("Z");
    std::vector<double> all;
    for (std::size_t i = 0; i < x.size(); ++i)
      all.push_back(std::isinf(depth[i]) ? depth[i] : (Imath::V3d(x[i], y[i], z[i]) - eye).length());
    return all;
  };
  const std::vector<double> truth = distances({});
  const auto check = [&](std::vector<std::string> march, const std::vector<const char*>& wrong) {
    const std::vector<double> answer = distances(march);
    march.insert(march.end(), {"--look", "error", "--json"});
    const auto result = render(march);
    ASSERT_EQ(result.status, 0) << result.err;
    const test::Exr exr = test::read_exr(out());
    std::set<std::string> names;
    for (const auto& [name, channel] : exr.channels) names.insert(name);
    EXPECT_EQ(names, (std::set<std::string>{"B", "G", "R", "early", "false", "late", "lost"}));
    // Two positions, whose three coordinates below 64 m are rounded by 2^-19 m, and the stored metres.
    constexpr double kRounding = 2 * 1.7320509 * 0x1p-19 + 0x1p-19, kTolerance = 0.1;
    std::map<std::string, std::vector<double>> expected;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const auto pixel = [&](const char* name) { return exr.channels.at(name).values[i]; };
      const double early = truth[i] - answer[i], off = std::abs(early);
      if (std::abs(off - kTolerance) < kRounding) continue;
      const bool lost = std::isfinite(truth[i]) && std::isinf(answer[i]);
      const bool false_hit = std::isinf(truth[i]) && std::isfinite(answer[i]);
      const bool both = std::isfinite(off);
      EXPECT_NEAR(pixel("early"), both && early > kTolerance ? early : 0, kRounding) << i;
      EXPECT_NEAR(pixel("late"), both && -early > kTolerance ? -early : 0, kRounding) << i;
      EXPECT_NEAR(pixel("lost"), lost ? truth[i] : 0, kRounding) << i;
      EXPECT_NEAR(pixel("false"), false_hit ? answer[i] : 0, kRounding) << i;
      for (const char* name : {"early", "late", "lost", "false"}) {
        if (pixel(name) > 0) expected[name].push_back(pixel(name));
      }
    }
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json["march"], march[1]);
    EXPECT_EQ(json["errors"]["judge"], "exhaustive");
    for (const char* name : wrong) {
      std::vector<double>& all = expected[name];
      ASSERT_GT(all.size(), 10u) << name;
      // The same sum: floats in the order of pixels.
      const double mean = std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size());
      std::sort(all.begin(), all.end());
      const auto& found = json["errors"][name];
      EXPECT_EQ(found["pixels"], all.size()) << name;
      EXPECT_EQ(found["mean_m"], mean) << name;
      EXPECT_EQ(found["p99_m"], all[(99 * all.size() + 99) / 100 - 1]) << name;
      EXPECT_EQ(found["most_m"], all.back()) << name;
    }
  };
  check({"--march", "naive", "--naive-min-step", "0.2"}, {"late", "lost"});
  // A ray that gives up is not lost.
  check({"--march", "relaxed", "--relaxed-tolerance", "0.02", "--relaxed-max-steps", "100000"}, {"early"});
}

TEST_F(ExrOutput, ReportsErrorsInOneLineWithoutOutput) {
  const std::string input = plane();
  std::filesystem::create_symlink("/dev/full", scratch_.path("full.exr"));
  const auto before = scratch_.files();
  const struct {
    std::vector<std::string> arguments;
    std::string fragment;
  } cases[] = {
      {{"-o", out(), "--look", "steps"}, "channels"},
      {{"-o", out(), "--look", "error", "--depth-range", "1,9"},
       "--depth-range applies to the looks shaded and comanche"},
      {{"-o", scratch_.path("no/folder/out.exr")}, "folder"},
      {{"-o", "/proc/out.exr"}, "/proc"},
      {{"-o", scratch_.path("full.exr")}, "device"},
      {{"-o", scratch_.path("out.bmp")}, ".exr"},
  };
  for (const auto& c : cases) {
    std::vector<std::string> arguments{"render", input, "--size", "8x8"};
    arguments.insert(arguments.end(), c.arguments.begin(), c.arguments.end());
    const auto result = test::run(arguments);
    EXPECT_EQ(result.status, 1) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(test::lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(c.fragment), std::string::npos) << result.err;
    EXPECT_EQ(scratch_.files(), before);
  }
}

}  // namespace
}  // namespace scarp
