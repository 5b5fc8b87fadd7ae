// SPDX-License-Identifier: MIT
// Recordings of the window and the pictures that they end with (recordings/): six in each run, all of them under
// SCARP_LONG_TESTS. SCARP_NEW_GOLDEN=1 SCARP_LONG_TESTS=1 recordings_test rewrites all pictures.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

#include "output/golden.h"
#include "viewer/window_case.h"

namespace scarp::test {
namespace {

namespace fs = std::filesystem;

struct Recorded {
  const char* name;
  const char* arguments;  // SCENES stands for examples/scenes
  enum class Run { always, under_long_tests } run = Run::under_long_tests;
};

void PrintTo(const Recorded& recorded, std::ostream* out) { *out << recorded.name; }

constexpr Recorded kRecordings[] = {
    {"orbit", "dem.tif --exaggeration 2", Recorded::Run::always},
    {"walk", "dem.tif --exaggeration 2 --samples 4", Recorded::Run::always},
    {"measure", "dem.tif --exaggeration 3 --look height", Recorded::Run::always},
    {"viewshed", "dem.tif --exaggeration 2", Recorded::Run::always},
    {"sun-and-horizon", "dem.tif --exaggeration 2"},
    {"voxels", "SCENES/church.vox --samples 4", Recorded::Run::always},
    {"steps", "--function hills --march naive --look steps", Recorded::Run::always},
    {"compare", "dem.tif --exaggeration 3", Recorded::Run::always},
    {"map", "dem.tif --ramp viridis --contours 100"},
    {"bookmarks", "dem.tif --haze 0.5"},
    {"error", "dem.tif --march naive --look error --exaggeration 3"},
    {"low-sun", "dem.tif --sun 120,8 --samples 8 --exaggeration 2"},
    {"relaxed", "dem.tif --march relaxed --look steps"},
    {"village", "SCENES/village.json --samples 2"},
    {"sea", "SCENES/torus-at-sea.json"},
    {"house", "SCENES/house.vox --no-shadows"},
    {"walk-in-function", "--function island --aa 1"},
    {"lake", "dem.tif --water 60 --fog height --exaggeration 2"},
    {"endless", "dem.tif --wrap mirror --exaggeration 2"},
    {"measure-on-map", "dem.tif --look height"},
    {"help", "dem.tif --view 200,25"},
    {"path", "dem.tif --solid"},
    {"hillshade", "dem.tif --look hillshade --exaggeration 2"},
};

// Two pictures of a window, one of them with a panel, differ only in the panel: all sides of the rectangle that
// contains the differences are the panel's border.
void expect_differences_in_panel(const Rgb& window, const Rgb& film) {
  ASSERT_TRUE(window.width == film.width && window.height == film.height);
  const auto differs = [&](int x, int y) {
    return !std::equal(window.pixel(x, y), window.pixel(x, y) + 3, film.pixel(x, y));
  };
  int left = window.width, right = -1, top = window.height, bottom = -1;
  for (int y = 0; y < window.height; ++y) {
    for (int x = 0; x < window.width; ++x) {
      if (!differs(x, y)) continue;
      left = std::min(left, x), right = std::max(right, x);
      top = std::min(top, y), bottom = std::max(bottom, y);
    }
  }
  ASSERT_GE(right, 0) << "there is no panel";
  for (int x = left; x <= right; ++x) {
    EXPECT_TRUE(differs(x, top)) << x << ", " << top;
    // The window may be too small for the lower end of its panel.
    EXPECT_TRUE(differs(x, bottom) || bottom + 1 == window.height) << x << ", " << bottom;
  }
  for (int y = top; y <= bottom; ++y) EXPECT_TRUE(differs(left, y) && differs(right, y)) << "row " << y;
}

// Right of the panel, the window shows the picture that P has saved.
void expect_picture_beside_panel(const Rgb& window, const Rgb& saved) {
  ASSERT_EQ(window.height, saved.height);
  ASSERT_LT(saved.width, window.width);
  const int left = window.width - saved.width;
  for (int y = 0; y < saved.height; ++y) {
    EXPECT_TRUE(
        std::equal(window.pixel(left, y), window.pixel(left, y) + std::ptrdiff_t{3} * saved.width, saved.pixel(0, y)))
        << "row " << y;
  }
}

class Recordings : public Window, public testing::WithParamInterface<Recorded> {};

TEST_P(Recordings, EndWithTheirPicture) {
  const Recorded& recorded = GetParam();
  if (recorded.run == Recorded::Run::under_long_tests && !std::getenv("SCARP_LONG_TESTS"))
    GTEST_SKIP() << "a recording for SCARP_LONG_TESTS";
  const fs::path source(SCARP_SOURCE_DIR), recordings = source / "test" / "viewer" / "recordings";
  fs::create_symlink(source / "examples" / "scenes", folder_ / "SCENES");
  const std::string name = recorded.name, recording = (recordings / (name + ".txt")).string();
  ASSERT_EQ(run("'" SCARP_VIEW "' " + std::string(recorded.arguments) + " --play '" + recording +
                "' --screenshot window.png --validation"),
            0)
      << output_;
  // Rays whose directions differ in the last bit cross the same cells, so no byte differs by more than its rounding.
  expect_golden((folder_ / "window.png").string(), recordings / (name + ".png"), kByteRounding,
                (fs::path(SCARP_WORK) / ("recording-" + name)).string());
  // Every recording ends with P.
  ASSERT_TRUE(fs::exists(folder_ / "scarp-view-1.png")) << output_;
  const Rgb window = read_png((folder_ / "window.png").string());
  const Rgb film = read_png((folder_ / "scarp-view-1.png").string());
  std::ifstream in(recording);
  const std::string events{std::istreambuf_iterator<char>(in), {}};
  const bool mapped = events.find(" key 86 1 ") != std::string::npos;
  const bool panels = events.find(" key 78 1 ") != std::string::npos;
  const bool compares = events.find(" compare ") != std::string::npos;
  if (compares) {
    expect_picture_beside_panel(window, read_png((folder_ / "scarp-view-3.png").string()));
  } else if (events.find(" key 258 1 ") != std::string::npos) {
    EXPECT_TRUE(window.bytes == film.bytes) << "without the panel, the window shows the film";
  } else if (!panels && !mapped && events.find(" key 290 1 ") == std::string::npos &&
             events.find(" key 77 1 ") == std::string::npos) {
    // There is neither the help, nor a line, nor another panel.
    expect_differences_in_panel(window, film);
  }
  if (events.find(" key 77 1 ") != std::string::npos) {
    const Rgb drawn = read_png((folder_ / "scarp-view-2.png").string());
    ASSERT_EQ(drawn.bytes.size(), film.bytes.size());
    std::size_t others = 0;
    for (std::size_t i = 0; i < film.bytes.size(); ++i) others += drawn.bytes[i] != film.bytes[i];
    EXPECT_GT(others, 0u) << "the measured line is in the second picture";
    EXPECT_LT(others, film.bytes.size() / 20) << "the panel is not";
  }
  const std::string command = printed_command("again.png"), printed = output_;
  ASSERT_EQ(run(command), 0) << output_;
  EXPECT_EQ(bytes_of("scarp-view-1.png") == bytes_of("again.png"), !mapped) << command;
  // Answers have commands of their own, which C prints.
  std::istringstream lines(printed);
  int answers = 0;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("scarp ") || line.starts_with("scarp render")) continue;
    ++answers;
    EXPECT_EQ(run("'" SCARP_PROGRAM "'" + line.substr(line.find(' '))), 0) << line << output_;
    EXPECT_TRUE(fs::exists(folder_ / line.substr(line.rfind(' ') + 1))) << line;
  }
  EXPECT_EQ(answers, mapped ? 1 : panels ? 2 : 0);
}

INSTANTIATE_TEST_SUITE_P(All, Recordings, testing::ValuesIn(kRecordings), [](const auto& recorded) {
  std::string name = recorded.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace scarp::test
