// SPDX-License-Identifier: MIT
// The look comanche, water, fog, flights and composites on the command line.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "cli/program.h"
#include "full_disk.h"
#include "output/read_png.h"
#include "scarp/output/png.h"
#ifdef SCARP_OPENEXR
#include "scarp/output/exr.h"
#include "scarp/source/raster/exr_raster.h"
#endif

namespace scarp {
namespace {

// 9 x 9 samples of a hill, 0 to 80 m, ESRI's ASCII grid, cells of 10 m.
std::string hill(const test::Scratch& scratch) {
  std::string text = "ncols 9\nnrows 9\nxllcenter 500000\nyllcenter 4000000\ncellsize 10\n";
  for (int row = 0; row < 9; ++row) {
    for (int col = 0; col < 9; ++col) {
      const int away = std::max(std::abs(row - 4), std::abs(col - 4));
      text += std::to_string(80 - 20 * away) + " ";
    }
    text += "\n";
  }
  return scratch.write("hill.asc", text);
}

bool is_one_line(const std::string& err) { return std::count(err.begin(), err.end(), '\n') == 1 && err.back() == '\n'; }

TEST(Comanche, ReportsBadInputInOneLineWithoutOutput) {
  const test::Scratch scratch;
  const std::string dem = hill(scratch), out = scratch.path("out.png");
  scratch.write("gap.cpt", "0 0 0 0 10 255 255 255\n20 0 0 0 30 255 255 255\n");
  scratch.write("down.cpt", "10 0 0 0 5 255 255 255\n");
  scratch.write("empty.csv", "x,y,z,tx,ty,tz\n");
  scratch.write("words.csv", "x,y,z,tx,ty,tz\n1,2,three,4,5,6\n");
  const std::vector<std::uint8_t> pixels(12, 200);
  write_png(scratch.path("unplaced.png"), {pixels.data(), 2, 2});
  write_png(scratch.path("elsewhere.png"), {pixels.data(), 2, 2});
  scratch.write("elsewhere.pgw", "1\n0\n0\n-1\n100.5\n200.5\n");
  const std::vector<std::string> before = scratch.files();
  struct Case {
    std::vector<std::string> options;
    std::string says;
  };
  const std::vector<Case> cases{
      {{"--look", "comanchee"},
       "--look 'comanchee': expected shaded, hillshade, height, steps, cost, error, comanche, slope, aspect, "
       "multidirectional or level:N"},
      {{"--look", "comanche", "--size", "640x480"}, "--lowres WIDTHxHEIGHT and --pixel-size PX"},
      {{"--look", "steps", "--lowres", "64x48"},
       "applies to the looks shaded, height and comanche, not to 'steps' (other"},
      {{"--look", "height", "--lowres", "64x48", "--size", "64x48"}, "--lowres cannot be combined with --size"},
      {{"--look", "level:x"}, "--look 'level:x': expected level:N, N a whole number, 0 or more"},
      {{"--look", "level:-1"}, "--look 'level:-1': expected level:N"},
      {{"--look", "level:4"}, "there is no level 4 (the pyramid over 8 x 8 cells has levels 0 to 3)"},
      {{"--look", "steps", "--steps-range", "9,5"},
       "--steps-range '9,5': expected 0 <= LOW, and HIGH at least 1 above it"},
      {{"--look", "steps", "--steps-range", "9"}, "--steps-range '9': expected LOW,HIGH"},
      {{"--detail", "1", "--detail-texture", scratch.path("none.png")}, "none.png: does not exist"},
      {{"--unlit", "--samples", "4"}, "--unlit cannot be combined with --samples"},
      {{"--look", "comanche", "--lowres", "64"}, "expected WIDTHxHEIGHT"},
      {{"--look", "comanche", "--pixel-size", "0"}, "--pixel-size '0': expected a whole number from 1 to 64"},
      {{"--look", "comanche", "--steps", "0"}, "--steps '0': expected a whole number from 1 to 65536"},
      {{"--look", "comanche", "--reach", "-5"}, "--reach '-5': expected a finite number above 0"},
      {{"--look", "steps", "--water", "10"}, "applies to the looks shaded and comanche"},
      {{"--water", "10", "--waves", "3"}, "--waves '3': expected a number from 0 to 0.5"},
      {{"--water", "10", "--water-colour", "blue"}, "--water-colour 'blue': expected RRGGBB"},
      {{"--water", "90000"}, "is not below the eye"},
      {{"--fog", "mist"}, "--fog 'mist': expected none, distance, height or iterations"},
      {{"--fog", "iterations"}, "--fog iterations needs --look comanche --march fixed-step"},
      {{"--look", "comanche", "--fog", "iterations"}, "--fog iterations needs --look comanche --march fixed-step"},
      {{"--look", "comanche", "--march", "fixed-step", "--refine", "bisect"}, "--fixed-step-interpolate instead"},
      {{"--look", "comanche", "--shells"}, "--shells has no effect without --march fixed-step"},
      {{"--detail-texture", scratch.path("unplaced.png"), "--detail", "0"}, "has no effect with --detail 0"},
      {{"--pixel-size", "2"}, "--pixel-size needs --lowres WIDTHxHEIGHT without --look comanche"},
      {{"--fog", "distance", "--visibility", "0"}, "--visibility '0': expected a finite number above 0"},
      {{"--ground", "lava"}, "--ground 'lava': expected ramp or natural"},
      {{"--ramp", scratch.path("gap.cpt")}, "line 2: begins at 20, but the previous line ends at 10"},
      {{"--ramp", scratch.path("down.cpt")}, "line 1: 10 to 5 does not ascend"},
      {{"--ramp", "path.csv"}, "--ramp 'path.csv': expected viridis, "},
      {{"--ramp", "path.csv"}, "or a .cpt, .txt, .clr or .png file"},
      {{"--ramp", scratch.path("none.cpt")}, "none.cpt: cannot be opened"},
      {{"--ramp", scratch.path("none.png")}, "none.png: does not exist"},
      {{"--overlay", scratch.path("unplaced.png")}, "overlay is not georeferenced, but the raster is"},
      {{"--overlay", scratch.path("elsewhere.png")}, "overlay does not overlap the raster"},
      {{"--path", scratch.path("empty.csv")}, "frames need a place for their number"},
      {{"--path", scratch.path("empty.csv"), "--turntable"}, "--turntable cannot be combined with --path"},
      {{"--frames", "3"}, "--frames has no effect without --path FILE, --turntable or --animate"},
      {{"--depth-range", "1,100"}, "name the output *.exr"},
      {{"--depth-range", "auto"}, "name the output *.exr"},
      {{"--depth-reversed"}, "--depth-reversed needs an EXR picture"},
      {{"--depth-range", "near"}, "NEAR,FAR in metres, for example 1,50000, or auto"},
  };
  for (const Case& one : cases) {
    std::vector<std::string> arguments{"render", dem, "-o", out};
    arguments.insert(arguments.end(), one.options.begin(), one.options.end());
    const auto result = test::run(arguments);
    EXPECT_TRUE(result.status == 1 || result.status == 2) << one.says << "\n" << result.err;
    EXPECT_NE(result.err.find(one.says), std::string::npos) << one.says << "\n" << result.err;
    EXPECT_TRUE(is_one_line(result.err)) << result.err;
  }
  for (const auto& [path, says] :
       {std::pair("empty.csv", "has no rows"), {"words.csv", "line 2 (camera 0)"}, {"none.csv", "none.csv"}}) {
    const auto result = test::run({"render", dem, "-o", scratch.path("f##.png"), "--path", scratch.path(path)});
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.err.find(says), std::string::npos) << result.err;
  }
  EXPECT_EQ(scratch.files(), before) << "nothing is left behind";
}

TEST(Comanche, ScalesByWholeFactors) {
  const test::Scratch scratch;
  const std::string dem = hill(scratch), out = scratch.path("out.png");
  const auto result = test::run({"render", dem, "-o", out, "--look", "comanche", "--wrap", "mirror", "--lowres",
                                 "40x30", "--pixel-size", "4", "--water", "20", "--fog", "height"});
  ASSERT_EQ(result.status, 0) << result.err;
  const test::Rgb picture = test::read_png(out);
  ASSERT_EQ(picture.width, 160);
  ASSERT_EQ(picture.height, 120);
  const auto at = [&](int x, int y) { return picture.bytes.data() + 3 * (y * 160 + x); };
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 160; ++x) EXPECT_TRUE(std::equal(at(x, y), at(x, y) + 3, at(x / 4 * 4, y / 4 * 4)));
  }
}

TEST(Flight, ResumesWhereItStopped) {
  const test::Scratch scratch;
  const std::string dem = hill(scratch), frames = scratch.path("f-###.png");
  const std::vector<std::string> arguments{"render", dem,     "-o",   frames, "--turntable", "--frames", "4",
                                           "--size", "32x24", "--aa", "1"};
  auto result = test::run(arguments);
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("4 frames, 4 made now"), std::string::npos) << result.out;
  const std::string second = test::text_of(scratch.path("f-002.png"));
  EXPECT_NE(second, test::text_of(scratch.path("f-000.png")));
  std::filesystem::remove(scratch.path("f-002.png"));
  scratch.write("f-001.png", "mine");
  result = test::run(arguments);
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("4 frames, 1 made now, 3 kept"), std::string::npos) << result.out;
  EXPECT_EQ(test::text_of(scratch.path("f-002.png")), second);
  EXPECT_EQ(test::text_of(scratch.path("f-001.png")), "mine");
  std::vector<std::string> anew = arguments;
  anew.push_back("--overwrite");
  EXPECT_EQ(test::run(anew).status, 0);
  EXPECT_NE(test::text_of(scratch.path("f-001.png")), "mine");
}

// The PNG of the noise is larger than those of the haze.
TEST(Flight, FullDiskKeepsEarlierFrames) {
  const test::Scratch scratch;
  const std::string dem = hill(scratch);
  scratch.write(
      "path.csv",
      "x,y,z,tx,ty,tz\n40,-50,60,40,-500,5000\n40,-50,70,40,-500,5000\n40,-50,150,40,40,40\n40,-50,60,40,-500,5000\n");
  const auto result = [&] {
    const test::FullDisk disk(2500);
    return test::Program({"render", dem, "-o", scratch.path("f#.png"), "--path", scratch.path("path.csv"), "--size",
                          "160x120", "--aa", "1", "--no-plinth", "--detail", "1", "--detail-size", "4"})
        .result();
  }();
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("f2.png"), std::string::npos) << result.err;
  EXPECT_TRUE(is_one_line(result.err)) << result.err;
  EXPECT_EQ(scratch.files(), (std::vector<std::string>{"f0.png", "f1.png", "hill.asc", "path.csv"}));
  EXPECT_EQ(test::read_png(scratch.path("f1.png")).width, 160);
}

TEST(Reach, EndlessGroundIsVisibleFromAbove) {
  const test::Scratch scratch;
  const std::string dem = hill(scratch), out = scratch.path("out.png");
  for (const std::string wrap : {"mirror", "periodic"}) {
    const auto result =
        test::run({"render", dem, "-o", out, "--top", "--wrap", wrap, "--look", "height", "--size", "40x40"});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto bytes = test::read_png(out).bytes;
    EXPECT_GT(*std::max_element(bytes.begin(), bytes.end()) - *std::min_element(bytes.begin(), bytes.end()), 100)
        << wrap;
  }
}

TEST(Overlay, IsPlacedByItsGeoreference) {
  const test::Scratch scratch;
  const std::string dem = hill(scratch);
  // Red over the western half of the ground; the eastern half has the ramp's grey.
  std::vector<std::uint8_t> red(3 * 40 * 80);
  for (std::size_t i = 0; i < red.size(); i += 3) red[i] = 255;
  write_png(scratch.path("red.png"), {red.data(), 40, 80});
  scratch.write("red.pgw", "1\n0\n0\n-1\n500000.5\n4000079.5\n");
  const auto result = test::run({"render", dem, "-o", scratch.path("out.png"), "--top", "--size", "80x80", "--ramp",
                                 "grey", "--overlay", scratch.path("red.png"), "--haze", "0", "--no-plinth"});
  ASSERT_EQ(result.status, 0) << result.err;
  const test::Rgb picture = test::read_png(scratch.path("out.png"));
  for (int y = 2; y < 78; y += 5) {
    for (int x = 2; x < 78; x += 5) {
      const auto* p = picture.bytes.data() + 3 * (y * 80 + x);
      // At its border, colours are mixed within a pixel, first by the warper and then by the lookup.
      if (x >= 38 && x <= 42) continue;
      EXPECT_EQ(p[1] == 0 && p[2] == 0, x < 40) << x << ", " << y;
    }
  }
}

// Four columns and two rows of pixels over 80 x 80 samples: red in the west, blue in the east.
TEST(Overlay, IsStretchedFromBorderToBorder) {
  const test::Scratch scratch;
  const std::string dem = hill(scratch), plain = scratch.path("plain.png"), placed = scratch.path("placed.png"),
                    out = scratch.path("out.png");
  std::vector<std::uint8_t> halves(3 * 4 * 2);
  for (std::size_t i = 0; i < 8; ++i) halves[3 * i + (i % 4 < 2 ? 0 : 2)] = 255;
  for (const std::string& name : {plain, placed}) write_png(name, {halves.data(), 4, 2});
  scratch.write("placed.pgw", "1\n0\n0\n-1\n500000.5\n4000079.5\n");  // a corner of 4 x 2 m
  for (const std::string& image : {plain, placed}) {
    const auto result = test::run({"render", dem, "-o", out, "--top", "--size", "80x80", "--haze", "0", "--no-plinth",
                                   "--unlit", "--overlay", image, "--overlay-fit"});
    ASSERT_EQ(result.status, 0) << result.err;
    const test::Rgb picture = test::read_png(out);
    for (int y = 2; y < 78; y += 5) {
      for (const int x : {1, 15, 27, 52, 65, 78}) {
        EXPECT_EQ(picture.pixel(x, y)[0], x < 40 ? 255 : 0) << image << ": " << x << ", " << y;
        EXPECT_EQ(picture.pixel(x, y)[2], x < 40 ? 0 : 255) << image << ": " << x << ", " << y;
      }
    }
  }
  const auto alone = test::run({"render", dem, "-o", out, "--overlay-fit"});
  EXPECT_NE(alone.err.find("--overlay-fit has no effect without --overlay FILE"), std::string::npos) << alone.err;
  const auto without = test::run({"render", dem, "-o", out, "--overlay", plain});
  EXPECT_NE(without.err.find("stretch it over the raster with --overlay-fit"), std::string::npos) << without.err;
}

// The mirror image of the red half is next to it, across the border.
TEST(Overlay, IsMirroredWithTheGround) {
  const test::Scratch scratch;
  const std::string dem = hill(scratch), image = scratch.path("red.png");
  std::vector<std::uint8_t> red(3 * 80 * 80);
  for (std::size_t i = 0; i < red.size(); i += 3) red[i] = i / 3 % 80 < 40 ? 255 : 0;
  write_png(image, {red.data(), 80, 80});
  scratch.write("red.pgw", "1\n0\n0\n-1\n500000.5\n4000079.5\n");
  const auto map_with = [&](const std::vector<std::string>& options) {
    std::vector<std::string> words{"render", dem,         "-o", scratch.path("out.png"), "--wrap", "mirror",
                                   "--top",  "--overlay", image};
    words.insert(words.end(), options.begin(), options.end());
    const auto result = test::run(words);
    EXPECT_EQ(result.status, 0) << result.err;
    return test::read_png(scratch.path("out.png"));
  };
  const test::Rgb picture = map_with({"--size", "160x160", "--haze", "0", "--no-shadows"});
  const test::Rgb unlit = map_with({"--look", "comanche", "--unlit", "--lowres", "160x160", "--pixel-size", "1"});
  for (int y = 5; y < 160; y += 10) {
    for (int x = 5; x < 160; x += 10) {
      if (std::abs(x - 40) < 4 || std::abs(x - 120) < 4) continue;
      EXPECT_EQ(picture.pixel(x, y)[0] > 40, x < 40 || x > 120) << x << ", " << y;
      EXPECT_EQ(unlit.pixel(x, y)[0], x < 40 || x > 120 ? 255 : 0) << x << ", " << y;
    }
  }
}

// A picture of endless hills in large pixels; `name` is its file.
void render_low(const test::Scratch& scratch, const std::string& name, const std::vector<std::string>& options) {
  std::vector<std::string> arguments{"render",  hill(scratch), "-o",       scratch.path(name), "--wrap", "mirror",
                                     "--eye",   "40,-40,120",  "--target", "40,60,20",         "--fov",  "40",
                                     "--reach", "400"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const auto result = test::run(arguments);
  EXPECT_EQ(result.status, 0) << name << ": " << result.err;
}

TEST(Comanche, ShellsAreNotInterpolatedByDefault) {
  const test::Scratch scratch;
  const auto picture = [&](const std::vector<std::string>& more) {
    std::vector<std::string> options{"--look", "height",  "--lowres",   "64x48",   "--pixel-size",
                                     "1",      "--march", "fixed-step", "--steps", "24"};
    options.insert(options.end(), more.begin(), more.end());
    render_low(scratch, "shells.png", options);
    return test::read_png(scratch.path("shells.png")).bytes;
  };
  const auto shells = picture({"--shells"});
  EXPECT_EQ(shells, picture({"--shells", "--fixed-step-interpolate", "false"}));
  EXPECT_NE(shells, picture({"--shells", "--fixed-step-interpolate", "true"}));
  EXPECT_EQ(picture({}), picture({"--fixed-step-interpolate", "true"}));
}

TEST(Comanche, ShadedPicturesHaveLargePixelsToo) {
  const test::Scratch scratch;
  render_low(scratch, "large.png", {"--lowres", "16x12", "--pixel-size", "3"});
  render_low(scratch, "small.png", {"--size", "16x12"});
  const test::Rgb large = test::read_png(scratch.path("large.png")), small = test::read_png(scratch.path("small.png"));
  ASSERT_EQ(large.width, 48);
  ASSERT_EQ(large.height, 36);
  for (int y = 0; y < 36; ++y) {
    for (int x = 0; x < 48; ++x) {
      for (int i = 0; i < 3; ++i) EXPECT_EQ(large.pixel(x, y)[i], small.pixel(x / 3, y / 3)[i]) << x << ", " << y;
    }
  }
}

#ifdef SCARP_OPENEXR
TEST(Comanche, WritesTheDepthOfItsSteps) {
  const test::Scratch scratch;
  const std::vector<std::string> stepped{"--look",
                                         "comanche",
                                         "--lowres",
                                         "24x18",
                                         "--pixel-size",
                                         "1",
                                         "--march",
                                         "fixed-step",
                                         "--steps",
                                         "40",
                                         "--fixed-step-interpolate",
                                         "false"};
  const auto depths = [&](const std::string& name, std::vector<std::string> options, const std::string& more = "") {
    if (!more.empty()) options.push_back(more);
    options.insert(options.end(), {"--depth-range", "1,1000"});
    render_low(scratch, name, options);
    return read_exr_channel(scratch.path(name), "Z").values;
  };
  // Hits are on planes 10 m apart: the reach by the number of steps.
  const std::vector<float> planes = depths("planes.exr", stepped);
  int hits = 0;
  for (const float z : planes) {
    if (!std::isfinite(z)) continue;
    ++hits;
    EXPECT_EQ(z, 10 * std::round(z / 10));
  }
  EXPECT_GT(hits, 100);
  // On shells it is the distance from the eye.
  depths("shells.exr", stepped, "--shells");
  std::vector<std::vector<float>> place;
  for (const char* axis : {"P.X", "P.Y", "P.Z", "Z"})
    place.push_back(read_exr_channel(scratch.path("shells.exr"), axis).values);
  constexpr double kPosition = 1.7320509 * 0x1p-16;  // three coordinates below 512 m, each rounded to float
  for (std::size_t i = 0; i < place[0].size(); ++i) {
    if (!std::isfinite(place[3][i])) continue;
    const double away = std::hypot(place[0][i] - 40, place[1][i] + 40, place[2][i] - 120);
    EXPECT_NEAR(away, 10 * std::round(away / 10), kPosition);
  }
  // Exact rays have the depth of the look shaded.
  EXPECT_EQ(depths("exact.exr", {"--look", "comanche", "--lowres", "24x18", "--pixel-size", "1"}),
            depths("shaded.exr", {"--size", "24x18"}));
  // Large pixels; the depth buffer of a projection with these planes.
  EXPECT_EQ(depths("large.exr", {"--lowres", "12x9", "--pixel-size", "2"}).size(), planes.size());
  const std::vector<float> device = read_exr_channel(scratch.path("planes.exr"), "depth").values;
  for (std::size_t i = 0; i < planes.size(); ++i)
    EXPECT_EQ(device[i],
              std::isfinite(planes[i]) ? static_cast<float>(1000.0 / 999 * (1 - 1 / double{planes[i]})) : 1.0f);
  // A plate at 105 m hides everything behind it.
  std::vector<float> zero(planes.size(), 0.0f), one(planes.size(), 1.0f), plate(planes.size(), 105.0f);
  write_exr(scratch.path("plate.exr"),
            {24, 18, {{"R", zero.data()}, {"G", one.data()}, {"B", zero.data()}, {"Z", plate.data()}}, {}});
  const auto result = test::run({"composite", scratch.path("planes.exr"), scratch.path("plate.exr"), "-o",
                                 scratch.path("both.png"), "--no-tone-curve"});
  ASSERT_EQ(result.status, 0) << result.err;
  const test::Rgb both = test::read_png(scratch.path("both.png"));
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const std::uint8_t* rgb = both.bytes.data() + 3 * i;
    EXPECT_EQ(rgb[0] == 0 && rgb[1] == 255, planes[i] > 105) << i;
  }
}

TEST(Composite, ShowsTheNearerPixel) {
  const test::Scratch scratch;
  const std::string dem = hill(scratch), ours = scratch.path("ours.exr");
  ASSERT_EQ(
      test::run({"render", dem, "-o", ours, "--top", "--size", "8x8", "--aa", "1", "--depth-range", "1,1000"}).status,
      0);
  // A level green plate: seen from above, it hides everything deeper. The eye is 80 + 80 + 80 m over the middle of the
  // box; the depth is read from the file.
  std::vector<float> zero(64, 0.0f), one(64, 1.0f), z(64, 300.0f), device(64);
  const auto write = [&](const std::string& name, float plate) {
    for (std::size_t i = 0; i < 64; ++i) {
      z[i] = plate;
      device[i] = 1000.0f / 999.0f * (1 - 1 / plate);
    }
    write_exr(
        scratch.path(name),
        {8, 8, {{"R", zero.data()}, {"G", one.data()}, {"B", zero.data()}, {"Z", z.data()}, {"D", device.data()}}, {}});
  };
  const auto greens = [&](const std::vector<std::string>& more, const std::string& theirs) {
    std::vector<std::string> arguments{"composite", ours, scratch.path(theirs), "-o", scratch.path("out.png")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = test::run(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    const test::Rgb picture = test::read_png(scratch.path("out.png"));
    int count = 0;
    for (std::size_t i = 0; i < 64; ++i) {
      count += picture.bytes[3 * i] == 0 && picture.bytes[3 * i + 1] > 200 && picture.bytes[3 * i + 2] == 0;
    }
    return count;
  };
  write("far.exr", 100000);
  EXPECT_EQ(greens({}, "far.exr"), 0);
  write("near.exr", 1.5f);
  EXPECT_EQ(greens({}, "near.exr"), 64);
  // Between the summit and the foot of the hill; both kinds of depth give the same result.
  int between = 0;
  for (float plate = 100; plate < 400; plate += 40) {
    write("plate.exr", plate);
    const int by_metres = greens({}, "plate.exr");
    EXPECT_EQ(by_metres, greens({"--depth-channel", "D", "--depth-range", "1,1000"}, "plate.exr")) << plate;
    between += by_metres > 0 && by_metres < 64;
  }
  EXPECT_GE(between, 1);
  // Depths of a buffer without planes, and metres.
  const auto note = [&](const std::string& channel) {
    const auto result = test::run(
        {"composite", ours, scratch.path("plate.exr"), "-o", scratch.path("x.png"), "--depth-channel", channel});
    EXPECT_EQ(result.status, 0) << result.err;
    return result.err;
  };
  EXPECT_NE(note("D").find("note: " + scratch.path("plate.exr") + ": all depths in channel D are 0 to 1 m"),
            std::string::npos)
      << note("D");
  EXPECT_EQ(note("Z"), "");
  for (const auto& [range, says] : {std::pair{"auto", "name NEAR,FAR"}, {"near", "for example 1,50000"}}) {
    const auto result =
        test::run({"composite", ours, scratch.path("plate.exr"), "-o", scratch.path("x.png"), "--depth-range", range});
    EXPECT_NE(result.status, 0);
    EXPECT_NE(result.err.find(says), std::string::npos) << result.err;
  }
  write_exr(scratch.path("small.exr"),
            {4, 4, {{"R", zero.data()}, {"G", one.data()}, {"B", zero.data()}, {"Z", z.data()}}, {}});
  const auto result = test::run({"composite", ours, scratch.path("small.exr"), "-o", scratch.path("x.png")});
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("4 x 4 pixels"), std::string::npos) << result.err;
  const auto missing = test::run({"composite", scratch.path("a.png"), ours, "-o", scratch.path("x.png")});
  EXPECT_NE(missing.err.find("a.png': does not exist (name an EXR picture)"), std::string::npos) << missing.err;
}

// A surface beyond the planes has the depth of the plane, and none has that of the sky.
TEST(Composite, DepthsBeyondThePlanesStayInFrontOfTheSky) {
  const test::Scratch scratch;
  const std::string dem = hill(scratch), out = scratch.path("depth.exr");
  // The planes that the note on a picture names last; empty if there is none.
  const auto render = [&](const std::string& range, bool reversed) -> std::string {
    std::vector<std::string> arguments{"render",   dem,           "-o",   out, "--eye",  "40,-90,120", "--target",
                                       "40,40,40", "--no-plinth", "--aa", "1", "--size", "40x30"};
    if (!range.empty()) arguments.insert(arguments.end(), {"--depth-range", range});
    if (reversed) arguments.emplace_back("--depth-reversed");
    const auto result = test::run(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    const std::size_t at = result.err.rfind("--depth-range ");
    if (at == std::string::npos) return "";
    return result.err.substr(at + 14, result.err.find_first_of(" \n", at + 14) - at - 14);
  };
  for (const bool reversed : {false, true}) {
    const std::string fitting = render("auto", reversed);
    const std::size_t comma = fitting.find(',');
    ASSERT_NE(comma, std::string::npos) << fitting;
    const std::string middle = fmt::format("{}", (std::stod(fitting) + std::stod(fitting.substr(comma + 1))) / 2);
    EXPECT_EQ(render("1," + middle, reversed), fitting);
    EXPECT_EQ(render(middle + ",10000", reversed), fitting);
    for (const std::string& range : {"1," + middle, middle + ",10000", std::string("auto")}) {
      render(range, reversed);
      const std::vector<float> z = read_exr_channel(out, "Z").values, depth = read_exr_channel(out, "depth").values;
      std::vector<std::pair<float, float>> surfaces;
      for (std::size_t i = 0; i < z.size(); ++i) {
        if (std::isinf(z[i])) {
          EXPECT_EQ(depth[i], reversed ? 0 : 1);
        } else {
          EXPECT_TRUE(reversed ? depth[i] > 0 && depth[i] <= 1 : depth[i] >= 0 && depth[i] < 1) << range << depth[i];
          surfaces.emplace_back(z[i], reversed ? -depth[i] : depth[i]);
        }
      }
      EXPECT_GT(surfaces.size(), 20U);
      EXPECT_LT(surfaces.size(), z.size());
      // The nearer surface is in front; without planes in the way strictly, if the depths differ by more than a float's
      // rounding of 2^-24 each: far / (far - near) near / z^2 per metre.
      const double near = std::stod(fitting);
      std::sort(surfaces.begin(), surfaces.end());
      for (std::size_t i = 1; i < surfaces.size(); ++i) {
        EXPECT_LE(surfaces[i - 1].second, surfaces[i].second);
        const double z0 = surfaces[i - 1].first, z1 = surfaces[i].first;
        if (range == "auto" && near * (z1 - z0) > z0 * z1 * 0x1p-23) {
          EXPECT_LT(surfaces[i - 1].second, surfaces[i].second);
        }
      }
    }
    EXPECT_EQ(render(fitting, reversed), "");
  }
  // A buffer needs planes, metres do not.
  const std::string fitting = render("auto", true), depths = test::text_of(out);
  EXPECT_EQ(render("", true), fitting);
  EXPECT_TRUE(test::text_of(out) == depths);
  EXPECT_EQ(render("", false), "");
  EXPECT_EQ(test::text_of(out).find("depth"), std::string::npos);
}

// The sky is behind everything: a plate is visible in front of it, and another renderer's sky hides nothing.
TEST(Composite, ShowsObjectsInFrontOfTheSky) {
  constexpr int kSide = 16;
  const test::Scratch scratch;
  const std::string ours = scratch.path("ours.exr"), out = scratch.path("out.exr");
  const std::string size = fmt::format("{0}x{0}", kSide);
  // The hill fills the middle of the picture; the sky is around it.
  ASSERT_EQ(test::run({"render", hill(scratch), "-o", ours, "--view", "180,10,2", "--size", size, "--aa", "1"}).status,
            0);
  const auto write = [&](float plate) {
    const std::vector<float> zero(kSide * kSide, 0.0f), one(kSide * kSide, 1.0f), z(kSide * kSide, plate);
    write_exr(scratch.path("plate.exr"),
              {kSide, kSide, {{"R", zero.data()}, {"G", one.data()}, {"B", zero.data()}, {"Z", z.data()}}, {}});
    EXPECT_EQ(test::run({"composite", ours, scratch.path("plate.exr"), "-o", out}).status, 0);
    return read_exr_channel(out, "Z").values;
  };
  const auto count_sky = [](const std::vector<float>& depth) {
    return std::count_if(depth.begin(), depth.end(), [](float z) { return std::isinf(z); });
  };
  const auto sky = count_sky(read_exr_channel(ours, "Z").values);
  ASSERT_GT(sky, kSide);
  ASSERT_LT(sky, kSide * kSide);
  constexpr float kFar = 100000;
  const std::vector<float> far = write(kFar);
  EXPECT_EQ(count_sky(far), 0);
  EXPECT_EQ(std::count(far.begin(), far.end(), kFar), sky);
  EXPECT_EQ(count_sky(write(std::numeric_limits<float>::infinity())), sky);
  EXPECT_EQ(count_sky(write(std::numeric_limits<float>::quiet_NaN())), sky);
}
#endif

}  // namespace
}  // namespace scarp
