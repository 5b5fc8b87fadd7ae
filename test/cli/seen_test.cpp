// SPDX-License-Identifier: MIT
// A picture that shows nothing comes with a warning that says why.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "cli/program.h"

namespace scarp {
namespace {

using test::Names;

class Seen : public testing::Test {
 protected:
  static constexpr int kSide = 24;

  // Hills of 100 to 300 m over 2.3 km; `sample` replaces the height of some.
  template <class F>
  std::string grid(const std::string& name, double cell, const F& sample) const {
    std::string text = fmt::format(
        "ncols {0}\nnrows {0}\nxllcorner 500000\nyllcorner 4000000\ncellsize {1}\n"
        "NODATA_value -1\n",
        kSide, cell);
    for (int i = 0; i < kSide * kSide; ++i) text += fmt::format("{}\n", sample(i % kSide, i / kSide));
    return scratch_.write(name, text);
  }
  static double hill(int col, int row) { return std::round(200 + 100 * std::sin(col * 0.5) * std::cos(row * 0.4)); }
  std::string hills() const { return grid("hills.asc", 100, hill); }

  // The warning of a run, or an empty string; the run must succeed.
  std::string warning(const std::string& input, Names options, const std::string& output = "out.png") const {
    Names arguments{"render", input, "-o", scratch_.path(output), "--size", "48x27"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const auto result = test::run(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    const std::size_t at = result.err.find("warning: ");
    if (at == std::string::npos) return {};
    EXPECT_EQ(result.err.find("warning: ", at + 1), std::string::npos) << "one for each run: " << result.err;
    return result.err.substr(at, result.err.find('\n', at) - at);
  }
  void expect_warning(const std::string& part, const std::string& input, const Names& options,
                      const std::string& output = "out.png") const {
    const std::string found = warning(input, options, output);
    EXPECT_NE(found.find(part), std::string::npos) << "expected '" << part << "' in: '" << found << "'";
  }

  test::Scratch scratch_;
};

TEST_F(Seen, VisiblePicturesGiveNoWarning) {
  const std::string file = hills();
  for (const Names& options :
       {Names{}, {"--top"}, {"--water", "200"}, {"--look", "error", "--top"}, {"--fog", "distance"}})
    EXPECT_EQ(warning(file, options), "");
  EXPECT_EQ(warning(file, {}, "out.exr"), "");
  EXPECT_EQ(warning(file, {"--turntable", "--frames", "2"}, "frame-##.png"), "");
}

TEST_F(Seen, WarnsAboutTheEyePosition) {
  const std::string file = hills();
  expect_warning("m below the ground", file, {"--eye", "1000,1000,-500", "--target", "1000,1000,-900"});
  expect_warning("is behind the eye", file, {"--eye", "1000,-500,900", "--target", "1000,-900,800"});
  expect_warning("looks past the scene", file, {"--eye", "1000,-500,900", "--target", "9000,-400,900"});
  expect_warning("m away and 2300 m wide", file, {"--view", "205,35,60"});
  expect_warning(": --area is beside the scene", file, {"--top", "--area", "5000,5000,6000,6000"});
  expect_warning(": --area has little of the scene in it", file, {"--top", "--area", "-90000,-90000,90000,90000"});
}

TEST_F(Seen, WarnsAboutObstruction) {
  const std::string file = hills();
  const Names above{"--eye", "1000,-1000,9000", "--target", "1000,1000,0"};
  const auto from_above = [&](Names options) {
    options.insert(options.end(), above.begin(), above.end());
    return options;
  };
  expect_warning("--water 5000 is above all ground, whose highest is 300 m", file, from_above({"--water", "5000"}));
  expect_warning("fog with a visibility of 10 m hides", file, from_above({"--fog", "distance", "--visibility", "10"}));
  expect_warning("fog with a visibility of 10 m hides", file,
                 from_above({"--fog", "height", "--visibility", "10", "--fog-base", "300"}));
  expect_warning("rays end after 100 m (--reach)", file, from_above({"--wrap", "periodic", "--reach", "100"}));
  const auto low = test::run({"render", file, "-o", scratch_.path("low.png"), "--size", "48x27", "--water", "10"});
  EXPECT_NE(low.err.find("note: --water 10 is below all ground, whose lowest is 10"), std::string::npos) << low.err;
}

TEST_F(Seen, WarnsAboutTheSamples) {
  expect_warning("heights span 200 m (100 to 300) over 0.023 m of ground", grid("thin.asc", 0.001, hill),
                 {"--crs", "none"});
  expect_warning("99.3056 % of the samples are holes",
                 grid("holes.asc", 100, [](int col, int row) { return col < 2 && row < 2 ? 5.0 : -1.0; }),
                 {"--eye", "1150,1150,5000", "--target", "1150,1160,0"});
  const std::string flat = grid("flat.asc", 100, [](int, int) { return 7.0; });
  expect_warning("all pixels have one colour: the terrain is flat, all heights are 7 m", flat,
                 {"--eye", "1150,1150,500", "--target", "1150,1150,0", "--look", "hillshade"});
}

TEST_F(Seen, CountsBlankFramesAndChecksOtherFormats) {
  const std::string file = hills();
  const std::string path = scratch_.write("path.csv",
                                          "x,y,z,dx,dy,dz\n1000,1000,900,0,0.1,-1\n1000,1000,900,0,0.1,1\n"
                                          "1000,1000,950,0,0.1,1\n");
  expect_warning("2 of 3 frames are blank, first " + scratch_.path("frame-01.png"), file, {"--path", path},
                 "frame-##.png");
#ifdef SCARP_OPENEXR
  expect_warning("is behind the eye", file, {"--eye", "1000,-500,900", "--target", "1000,-900,800"}, "out.exr");
#endif
  const auto sky = test::run({"render", "--function", "hills", "-o", scratch_.path("sky.png"), "--size", "48x27",
                              "--eye", "0,0,9000", "--target", "0,10,9100"});
  EXPECT_NE(sky.err.find("the camera looks at the sky"), std::string::npos) << sky.err;
}

}  // namespace
}  // namespace scarp
