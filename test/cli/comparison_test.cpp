// SPDX-License-Identifier: MIT
// `scarp render --compare`, judged by the pictures and numbers of its marches alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/program.h"
#include "cli/refused.h"
#include "cli/spike.h"
#include "output/read_png.h"

namespace scarp {
namespace {

using nlohmann::json;
using test::Names;
using test::operator+;

class Compare : public testing::Test {
 protected:
  Names arguments(const Names& options, const std::string& to = "out.png") const {
    return Names{"render",      dem_,    "-o",        scratch_.path(to), "--size", "264x76",
                 "--no-plinth", "--eye", "16,-10,12", "--target",        "16,16,6"} +
           options;
  }
  test::Result render(const Names& options, const std::string& to = "out.png") const {
    return test::run(arguments(options, to));
  }
  test::Rgb picture(const Names& options) const {
    const auto result = render(options);
    EXPECT_EQ(result.status, 0) << result.err;
    return test::read_png(scratch_.path("out.png"));
  }
  json report(Names options) const {
    options.push_back("--json");
    const auto result = render(options);
    EXPECT_EQ(result.status, 0) << result.err;
    return json::parse(result.out);
  }

  test::Scratch scratch_;
  const std::string dem_ = test::spike_dem(scratch_);
};

const Names kCoarse{"--naive-min-step", "0.2"};

TEST_F(Compare, ShowsAStripOfEachMarch) {
  for (const std::string look : {"shaded", "error"}) {
    const Names same{"--look", look};
    const test::Rgb both = picture(Names{"--compare", "naive,max-mip"} + kCoarse + same);
    const test::Rgb left = picture(Names{"--march", "naive"} + kCoarse + same), right = picture(same);
    ASSERT_EQ(both.width, 264);
    ASSERT_NE(left.bytes, right.bytes);
    // Below the labels, beside the divider.
    for (int y = 60; y < 76; ++y) {
      for (int x = 0; x < 264; ++x) {
        if (std::abs(x - 132) <= 4) continue;
        const auto i = 3 * static_cast<std::size_t>(y * 264 + x);
        ASSERT_TRUE(std::equal(&both.bytes[i], &both.bytes[i] + 3, &(x < 132 ? left : right).bytes[i]))
            << look << ": " << x << ", " << y;
      }
    }
    // The divider is black in white.
    const std::size_t middle = 3 * static_cast<std::size_t>(70 * 264 + 132);
    EXPECT_LT(both.bytes[middle], 60) << look;
  }
}

TEST_F(Compare, CountsTheWholeView) {
  const json compared = report(Names{"--compare", "naive,max-mip"} + kCoarse)["compared"];
  ASSERT_EQ(compared.size(), 2u);
  const Names marches[] = {Names{"--march", "naive"} + kCoarse, {"--march", "max-mip"}};
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(compared[i]["march"], marches[i][1]);
    EXPECT_EQ(compared[i]["errors"], report(marches[i] + Names{"--look", "error"})["errors"]) << i;
    EXPECT_EQ(compared[i]["steps"], report(marches[i] + Names{"--look", "steps"})["steps"]) << i;
  }
  EXPECT_GT(compared[0]["errors"]["lost"]["pixels"], 0);
  const auto text = render(Names{"--compare", "naive,max-mip"} + kCoarse);
  EXPECT_NE(text.out.find("\nmax-mip: "), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("pixels: lost 0, false 0, early 0, late 0, gave up 0;"), std::string::npos) << text.out;
}

// Without a range, the marches share the one from the fewest steps to the most.
TEST_F(Compare, SharesTheScaleOfSteps) {
  const json naive = report({"--march", "naive", "--look", "steps"})["steps"],
             exhaustive = report({"--march", "exhaustive", "--look", "steps"})["steps"];
  const auto range = std::to_string(std::min(naive["least"].get<int>(), exhaustive["least"].get<int>())) + "," +
                     std::to_string(std::max(naive["most"].get<int>(), exhaustive["most"].get<int>()));
  const Names compare{"--compare", "naive,exhaustive", "--look", "steps"};
  EXPECT_EQ(picture(compare).bytes, picture(compare + Names{"--steps-range", range}).bytes);
}

TEST_F(Compare, WorksForFunctionsAndVoxels) {
  const std::string out = scratch_.path("out.png"), church = SCARP_SOURCE_DIR "/examples/scenes/church.vox",
                    plain = scratch_.write("plain.json", R"({"type": "fbm", "octaves": 1})");
  for (const Names& input : {Names{"--function", plain, "--compare", "relaxed,lipschitz-local"},
                             {church, "--compare", "voxel-planes,voxel-bricks"}}) {
    const auto result = test::run(Names{"render", "-o", out, "--size", "280x70", "--json"} + input);
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(json::parse(result.out)["compared"].size(), 2u);
  }
}

TEST_F(Compare, RejectsWhatItCannotShow) {
  const struct {
    Names options;
    std::string fragment, to = "out.png";
  } cases[] = {
      {{"--compare", "naive"}, "--compare 'naive': expected two or more marches"},
      {{"--compare", "naive,naive"}, "names naive twice"},
      {{"--compare", "naive,fast"}, "--compare 'fast': expected "},
      {{"--compare", "naive,voxel-planes"}, "march 'voxel-planes': is not for terrain"},
      {{"--compare", "naive,max-mip", "--march", "naive"}, "--compare cannot be combined with --march"},
      {{"--compare", "naive,max-mip", "--shrink", "0.5"}, "--shrink needs --march lipschitz"},
      {{"--compare", "naive,max-mip"}, "name the output *.png", "out.exr"},
      {{"--compare", "naive,relaxed,fixed-step,lipschitz,max-mip"}, "its strip is 53 wide"},
  };
  for (const auto& c : cases) test::expect_refused(scratch_, arguments(c.options, c.to), c.fragment);
  test::expect_refused(scratch_,
                       {"render", dem_, "-o", scratch_.path("out-##.png"), "--turntable", "--compare", "naive,max-mip"},
                       "--compare describes one picture, without --path or --turntable");
}

}  // namespace
}  // namespace scarp
