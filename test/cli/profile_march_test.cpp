// SPDX-License-Identifier: MIT
// The legend of `scarp profile --march`.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "cli/program.h"
#include "output/read_png.h"

namespace scarp {
namespace {

// Balls of lipschitz are called free of ground only if the slope proves it.
TEST(ProfileMarch, LegendDistinguishesUnprovenSteps) {
  const test::Scratch scratch;
  std::string text = "ncols 9\nnrows 9\nxllcorner 0\nyllcorner 0\ncellsize 10\n";
  for (int i = 0; i < 81; ++i) text += std::to_string(i % 9 < 5 ? 0 : 20) + " ";
  const std::string dem = scratch.write("step.asc", text), out = scratch.path("p.png");
  // The bottom of the figure; `proven`: whether the steepest slope, 2, proves the factor.
  const auto legend = [&](const std::string& shrink, bool proven) {
    const auto result = test::run({"profile", dem, "--ray", "0,40,30,1,0,-0.2", "--march", "lipschitz", "--shrink",
                                   shrink, "--size", "700x300", "-o", out});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.out.find("is approximate") == std::string::npos, proven) << result.out;
    const test::Rgb picture = test::read_png(out);
    return std::vector<std::uint8_t>(picture.bytes.end() - 30 * 3 * picture.width, picture.bytes.end());
  };
  const auto proven = legend("0.3", true);
  EXPECT_EQ(legend("0.2", true), proven);
  EXPECT_NE(legend("0.9", false), proven);
}

}  // namespace
}  // namespace scarp
