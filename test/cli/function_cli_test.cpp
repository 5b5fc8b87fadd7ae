// SPDX-License-Identifier: MIT
// Terrain functions on the command line: pictures, layers, info, and elevation models.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/program.h"
#include "output/read_png.h"
#ifdef SCARP_OPENEXR
#include "output/read_exr.h"
#endif

namespace scarp {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class Functions : public testing::Test {
 protected:
  // A ramp that rises by half a metre per metre eastwards.
  std::string ramp() const {
    return scratch_.write("ramp.json", R"({"type": "plane", "height": 7, "slope": [0.5, 0]})");
  }
  std::string out(const char* name) const { return scratch_.path(name); }
  // One line that contains `what`, and no file.
  void expect_refusal(std::vector<std::string> arguments, const std::string& what) const {
    const auto result = test::run(std::move(arguments));
    EXPECT_NE(result.status, 0);
    EXPECT_EQ(test::lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(what), std::string::npos) << result.err;
  }

  test::Scratch scratch_;
};

TEST_F(Functions, AreColouredByHeight) {
  const std::string picture = out("a.png");
  const auto result = test::run({"render", "--function", ramp(), "--look", "height", "--extent", "100", "--eye",
                                 "-200,0,60", "--target", "0,0,0", "--size", "40x30", "-o", picture});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("(grey 1)"), std::string::npos) << result.out;
  const test::Rgb image = test::read_png(picture);
  std::uint8_t least = 255, most = 0;
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) {
      const std::uint8_t* p = image.pixel(x, y);
      EXPECT_TRUE(p[0] == p[1] && p[1] == p[2]);
      if (p[0] > 0) least = std::min(least, p[0]), most = std::max(most, p[0]);
      // The ramp rises away from the eye: in a column it gets brighter upwards, and there is no sky below it.
      if (y > 0 && image.pixel(x, y - 1)[0] > 0) {
        EXPECT_GE(image.pixel(x, y - 1)[0], p[0]);
      }
    }
  }
  EXPECT_EQ(least, 1);
  EXPECT_EQ(most, 255);
}

TEST_F(Functions, RenderIterationsUnderAWhiteSky) {
  const std::string picture = out("a.png");
  const auto result =
      test::run({"render", "--function", ramp(), "--look", "comanche", "--march", "fixed-step", "--iterations",
                 "--lowres", "16x12", "--pixel-size", "1", "--eye", "200,0,160", "--target", "0,0,120", "-o", picture});
  ASSERT_EQ(result.status, 0) << result.err;
  const test::Rgb image = test::read_png(picture);
  EXPECT_EQ(image.pixel(8, 0)[0], 255);
  EXPECT_LT(image.pixel(8, 11)[0], 255);
}

#ifdef SCARP_OPENEXR
TEST_F(Functions, WriteLayers) {
  const std::string layers = out("a.exr");
  const auto result = test::run({"render", "--function", ramp(), "--extent", "100", "--eye", "-200,0,60", "--target",
                                 "0,0,0", "--size", "40x30", "--depth-range", "1,10000", "-o", layers});
  ASSERT_EQ(result.status, 0) << result.err;
  const test::Exr exr = test::read_exr(layers);
  const auto values = [&](const char* name) { return exr.channels.at(name).values; };
  const auto x = values("P.X"), z = values("P.Z"), depth = values("Z"), normal = values("N.X");
  EXPECT_EQ(exr.channels.count("depth"), 1u);
  int hits = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(depth[i])) continue;
    ++hits;
    EXPECT_NEAR(z[i], 7 + 0.5 * x[i], 1e-4 * (1 + std::abs(x[i])));
    EXPECT_NEAR(normal[i], -0.5 / std::sqrt(1.25), 1e-6);
  }
  EXPECT_GT(hits, 40 * 30 / 2);
}
#endif

TEST_F(Functions, AcceptColourRamps) {
  const std::string picture = out("ramped.png"), table = scratch_.write("table.cpt", "0 255 0 0 100 0 0 255\n");
  const auto rendered = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"render", "--function", ramp(),   "--extent", "100",
                                       "-o",     picture,      "--size", "32x24"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const auto result = test::run(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    return test::text_of(picture);
  };
  const std::string plain = rendered({});
  EXPECT_NE(rendered({"--ramp", table}), plain);
  EXPECT_NE(rendered({"--ramp", "grey"}), plain);
}

TEST_F(Functions, TheSeaIsBlue) {
  const auto blue = [&](const std::string& function) {
    const auto result = test::run({"render", "--function", function, "--unlit", "--haze", "0", "--size", "32x32",
                                   "--eye", "0,0,2500", "--target", "0,1,0", "-o", out("sea.png")});
    EXPECT_EQ(result.status, 0) << result.err;
    const test::Rgb picture = test::read_png(out("sea.png"));
    int count = 0;
    for (int i = 0; i < 32 * 32; ++i) count += picture.bytes[3 * i + 2] > picture.bytes[3 * i] + 20;
    return count;
  };
  EXPECT_GT(blue("sea"), 32 * 32 * 95 / 100);
  EXPECT_LT(blue("hills"), 32 * 32 / 100);
}

TEST_F(Functions, AreDescribedByInfo) {
  const auto result = test::run({"info", "--function", "island", "--extent", "4000", "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json info = Json::parse(result.out);
  EXPECT_EQ(info["octaves"]["march"], 9);
  EXPECT_EQ(info["octaves"]["normal"], 12);
  const auto number = [&](const char* of, const char* key) { return info[of][key].get<double>(); };
  EXPECT_LE(number("everywhere", "low_m"), number("within", "low_m"));
  EXPECT_LE(number("within", "low_m"), number("seen", "low_m"));
  EXPECT_GE(number("within", "high_m"), number("seen", "high_m"));
  EXPECT_GE(number("within", "slope"), number("seen", "slope"));
  ASSERT_EQ(info["tightness"].size(), 4u);
  for (const Json& at : info["tightness"]) {
    EXPECT_GE(at["range"].get<double>(), 1);
    EXPECT_GE(at["slope"].get<double>(), 1);
  }
  // For a ramp everything is known except for rounding.
  const Json plane = Json::parse(test::run({"info", "--function", ramp(), "--json"}).out);
  for (const Json& at : plane["tightness"]) {
    EXPECT_NEAR(at["range"].get<double>(), 1, 1e-9);
    EXPECT_NEAR(at["slope"].get<double>(), 1, 1e-9);
  }
  EXPECT_NE(test::run({"info", "--function", "sea"}).out.find("certified"), std::string::npos);
}

TEST_F(Functions, CanBeSampledIntoAnElevationModel) {
  const std::string dem = out("ramp.tif");
  const auto result = test::run({"generate", "--function", ramp(), "--size", "33x17", "--cell", "10", "-o", dem});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json info = Json::parse(test::run({"info", dem, "--json", "--statistics"}).out);
  EXPECT_EQ(info["cols"], 33);
  EXPECT_EQ(info["rows"], 17);
  EXPECT_NEAR(info["min_m"].get<double>(), 7 - 0.5 * 160, 1e-9);
  EXPECT_NEAR(info["max_m"].get<double>(), 7 + 0.5 * 160, 1e-9);
  // Cell sizes are measured on the ellipsoid, by differences.
  EXPECT_NEAR(info["slope_bound"].get<double>(), 0.5, 1e-6);
}

TEST_F(Functions, ReportErrorsInOneLine) {
  expect_refusal({"info", "--function", "moon"}, "neither a file that can be read nor one of hills");
  expect_refusal({"render", "--function", "hills", "--march", "max-mip", "-o", out("a.png")},
                 "march 'max-mip': is not for functions (available: ");
  expect_refusal({"render", "--function", "hills", "--march", "quick", "-o", out("a.png")}, "march 'quick': unknown");
  expect_refusal({"info", "--function", "hills", "--extent", "-1"}, "--extent '-1': expected a number above 0");
  expect_refusal({"info", "--function", "hills", "--band", "2"}, "--band applies to terrain only");
  expect_refusal({"info", "--function", "hills", "a.tif"}, "'a.tif': --function replaces files");
  expect_refusal({"info"}, "IN (or --function NAME)");
  expect_refusal({"generate", "--function", "hills", "--seed", "3", "--size", "9", "-o", out("a.tif")}, "--seed");
  expect_refusal({"generate", "--function", "moon", "--size", "9", "-o", out("a.tif")}, "moon");
  expect_refusal({"generate", "--function", "hills", "--size", "65536", "--cell", "1000000", "-o", out("a.tif")},
                 "beyond 2^30 metres");
  expect_refusal({"render", "--function", "hills", "--depth-range", "1,2", "-o", out("a.png")}, "--depth-range");
  EXPECT_FALSE(fs::exists(out("a.tif")) || fs::exists(out("a.png")));
}

}  // namespace
}  // namespace scarp
