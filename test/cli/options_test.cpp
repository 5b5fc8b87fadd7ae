// SPDX-License-Identifier: MIT
// Options of the command line as such: numbers are finite and in their range, and what would have no effect is refused.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "app/cli/input_kind.h"
#include "base/refusal.h"
#include "cli/program.h"
#include "scarp/base/error.h"
#include "scarp/source/vox_file.h"

namespace scarp {
namespace {

using test::run;
using Names = std::vector<std::string>;

const Names kCommands = {"render", "cast", "info", "generate", "voxelise", "section", "composite"};

// What the help lists: the long names of options that match.
Names options_of(const std::string& command, const std::string& type) {
  const std::string help = run({command, "--help"}).out;
  const std::regex form("\n  (?:-[a-z],)?(--[a-z-]+)" + type);
  Names names;
  for (std::sregex_iterator at(help.begin(), help.end(), form), end; at != end; ++at) names.push_back((*at)[1]);
  return names;
}

TEST(Options, AllFloatingPointNumbersAreFinite) {
  std::size_t found = 0;
  for (const std::string& command : kCommands) {
    for (const std::string& option : options_of(command, " FLOAT")) {
      ++found;
      if (option == "--nodata") continue;  // holes may be marked by NaN
      // All have the same check or none: what else it refuses is tested below.
      const auto result = run({command, option, "nan"});
      EXPECT_EQ(result.status, 2) << command << ' ' << option;
      EXPECT_EQ(test::lines(result.err), 1) << result.err;
      EXPECT_NE(result.err.find(option + " 'nan': expected a "), std::string::npos) << result.err;
      EXPECT_LT(result.err.size(), 200u) << result.err;
    }
  }
  EXPECT_GT(found, 50u) << "the help has another form";
}

TEST(Options, NumbersAreInTheirRange) {
  const struct {
    Names arguments;
    std::string fragment;
  } cases[] = {
      {{"voxelise", "--voxel", "0"}, "--voxel '0': expected a finite number above 0"},
      {{"voxelise", "--voxel", "x"}, "--voxel 'x': expected a finite number above 0"},
      {{"voxelise", "--voxel", "inf"}, "--voxel 'inf': expected a finite number above 0"},
      {{"voxelise", "--voxel", "1e999"}, "--voxel '1e999': expected a finite number above 0"},
      {{"info", "--solid-from=-inf"}, "--solid-from '-inf': expected a finite number"},
      {{"render", "--turbidity", "-1"}, "--turbidity '-1': expected a finite number, 0 or more"},
      {{"render", "--waves", "0.6"}, "--waves '0.6': expected a number from 0 to 0.5"},
      {{"render", "--naive-min-step", "1.5"}, "--naive-min-step '1.5': expected a number above 0 and at most 1"},
      {{"render", "--rounded", "0.6"}, "--rounded '0.6': expected a number from 0 to 0.5"},
      {{"generate", "--wavelength", "1"}, "--wavelength '1': expected a finite number, 2 or more"},
      {{"info", "--extent", "2e9"}, "--extent '2e9': expected a number above 0 and at most 1073741824"},
  };
  for (const auto& c : cases) {
    const auto result = run(c.arguments);
    EXPECT_EQ(result.status, 2);
    EXPECT_NE(result.err.find(c.fragment), std::string::npos) << result.err;
  }
}

TEST(Options, EachGoesWithAnInput) {
  // These have one kind of input, or none.
  const Names elsewhere = {"--help"};
  std::size_t found = 0;
  for (const std::string command : {"render", "cast", "info", "voxelise"}) {
    for (const std::string& option : options_of(command, "")) {
      if (std::find(elsewhere.begin(), elsewhere.end(), option) != elsewhere.end()) continue;
      ++found;
      int kinds = 0;
      using cli::InputKind;
      for (const auto kind : {InputKind::terrain, InputKind::voxels, InputKind::scene, InputKind::function}) {
        try {
          cli::require_options_of(kind, {option});
          ++kinds;
        } catch (const Error&) {
        }
      }
      EXPECT_GT(kinds, 0) << command << ' ' << option << ": in no row of app/cli/input_kind.cpp";
    }
  }
  EXPECT_GT(found, 150u) << "the help has another form";
}

class WithoutEffect : public testing::Test {
 protected:
  WithoutEffect() {
    VoxFile file;
    file.version = 150;
    file.models = {{{1, 1, 1}, {{0, 0, 0, 1}}}};
    write_vox(vox_, file);
  }

  // One line that names the option, and no picture.
  void expect_refused(const Names& input, const Names& options, const std::string& fragment) {
    const Names before = scratch_.files();
    Names arguments = input;
    arguments.insert(arguments.end(), options.begin(), options.end());
    const auto result = run(arguments);
    const std::string what = fmt::format("{}: {}", fmt::join(arguments, " "), result.err);
    EXPECT_EQ(result.status, 1) << what;
    EXPECT_EQ(test::lines(result.err), 1) << what;
    EXPECT_EQ(result.err.find("scarp: " + options.front() + ": "), 0u) << what;
    EXPECT_NE(result.err.find(fragment), std::string::npos) << what;
    EXPECT_EQ(scratch_.files(), before) << what;
  }

  std::string path(const std::string& name) const { return scratch_.path(name); }

  test::Scratch scratch_;
  const std::string vox_ = scratch_.path("model.vox"), out_ = scratch_.path("out.png"),
                    dem_ = scratch_.write("dem.asc",
                                          "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\n1 2 3\n4 5 6\n"),
                    volume_ = scratch_.write("volume.raw", "\1"),
                    scene_ = scratch_.write("scene.json", R"({"objects": [{"shape": {"sphere": {"radius": 3}}}]})");
};

TEST_F(WithoutEffect, IsRefusedOfVoxels) {
  const Names render{"render", vox_, "-o", out_}, info{"info", vox_}, make{"voxelise", vox_, "-o", out_ + ".vox"};
  for (const Names& options : {Names{"--exaggeration", "2"},
                               {"--solid"},
                               {"--surface", "triangles"},
                               {"--nodata", "5"},
                               {"--band", "1"},
                               {"--crs", "EPSG:4326"},
                               {"--scale", "2"}}) {
    expect_refused(render, options, "goes with terrain; leave it out");
    expect_refused(make, options, "goes with terrain; leave it out");
  }
  expect_refused(render, {"--wrap", "none"}, "goes with terrain; leave it out");
  expect_refused(info, {"--nodata", "5"}, "goes with terrain; leave it out");
  expect_refused(info, {"--extent", "5"}, "goes with functions; leave it out");
  expect_refused(make, {"--ramp", "grey"}, "terrain");
  for (const Names& options : {Names{"--contours", "3"},
                               {"--ground", "natural"},
                               {"--detail", "1"},
                               {"--fog", "none"},
                               {"--water", "3"},
                               {"--legend"},
                               {"--turntable"},
                               {"--mesh-scale", "1"},
                               {"--no-plinth"},
                               {"--reach", "5"}}) {
    expect_refused(render, options, "goes with terrain; leave it out");
  }
  expect_refused(render, {"--haze", "0"}, "goes with terrain and functions");
  expect_refused(render, {"--device", "cpu"}, "goes with terrain, scenes and functions");
  expect_refused(render, {"--function-step", "5"}, "goes with functions");
  expect_refused(render, {"--ramp", "viridis"}, "--volume or --look steps");
  expect_refused(render, {"--normal-radius", "4"}, "--normals voxel or smooth");
  expect_refused(render, {"--seed", "4"}, "--samples N");
  for (const Names& options :
       {Names{"--look", "steps", "--ramp", "viridis"}, {"--normals", "smooth", "--normal-radius", "4"}}) {
    Names arguments = render;
    arguments.insert(arguments.end(), {"--size", "8x8"});
    arguments.insert(arguments.end(), options.begin(), options.end());
    const auto result = run(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
  }
  EXPECT_EQ(run({"render", volume_, "--volume", "1x1x1:u8", "-o", out_, "--size", "8x8", "--ramp", "viridis"}).status,
            0);
}

TEST_F(WithoutEffect, IsRefusedOfTerrain) {
  const Names render{"render", dem_, "-o", out_}, cast{"cast", dem_, "--rays", scratch_.path("rays.csv")};
  for (const Names& options : {Names{"--frame", "0"}, {"--hidden"}, {"--up", "z"}, {"--normals", "flat"}}) {
    expect_refused(render, options, "goes with files of voxels; leave it out");
  }
  expect_refused({"info", dem_}, {"--surface-colours"}, "goes with files of voxels; leave it out");
  expect_refused(render, {"--coarse-voxels"}, "goes with files of voxels and scenes");
  expect_refused(render, {"--extent", "5"}, "goes with functions");
  expect_refused({"info", dem_}, {"--extent", "5"}, "goes with functions");
  expect_refused(cast, {"--function-reach", "5"}, "goes with functions");
  expect_refused(cast, {"--naive-tolerance", "0.1"}, "--march naive");
  expect_refused(render, {"--shrink", "0.5"}, "--march lipschitz");
  expect_refused(render, {"--refine", "secant"}, "--march naive");
  expect_refused(render, {"--bisect-halvings", "5", "--march", "naive"}, "--march max-mip-bisect");
  expect_refused(render, {"--turbidity", "1"}, "--water M");
  expect_refused(render, {"--visibility", "1"}, "--fog KIND");
  expect_refused(render, {"--fog-falloff", "1", "--fog", "distance"}, "--fog height");
  expect_refused(render, {"--snow-line", "1"}, "--ground natural");
  expect_refused(render, {"--detail-size", "1"}, "--detail S");
  expect_refused(render, {"--steps", "9"}, "goes with the look comanche");
  expect_refused(render, {"--error-tolerance", "1"}, "goes with the look error");
  expect_refused(render, {"--sun-size", "1"}, "--samples N");
  expect_refused(render, {"--mesh-up", "y"}, "--mesh FILE");
  const Names flight{"render", dem_, "-o", scratch_.path("out-##.png"), "--turntable"};
  expect_refused(flight, {"--eye", "1,2,3"}, "cameras of their own");
  expect_refused(flight, {"--top"}, "cameras of their own");
  expect_refused({"render", dem_, "-o", scratch_.path("out-##.png"), "--path", "p.csv"}, {"--view", "1,2"}, "table");
}

TEST_F(WithoutEffect, IsRefusedOfScenesAndFunctions) {
  const Names render{"render", scene_, "-o", out_}, info{"info", scene_}, make{"voxelise", scene_, "-o", out_ + ".vox"};
  for (const Names& options : {Names{"--nodata", "5"}, {"--hidden"}}) {
    expect_refused(render, options, "what a scene is made of stands in its file; leave it out");
    expect_refused(info, options, "what a scene is made of stands in its file; leave it out");
    expect_refused(make, options, "what a scene is made of stands in its file; leave it out");
  }
  expect_refused(make, {"--ramp", "grey"}, "terrain");
  expect_refused(render, {"--ramp", "grey"}, "--look steps");
  expect_refused(render, {"--contours", "5"}, "goes with terrain");
  const Names function{"render", "--function", "hills", "-o", out_};
  for (const Names& options : {Names{"--exaggeration", "2"}, {"--water", "3"}, {"--no-plinth"}}) {
    expect_refused(function, options, "goes with terrain; leave it out");
  }
  expect_refused(function, {"--turntable", "--frames", "2"}, "goes with terrain; leave it out");
  expect_refused(function, {"--top"}, "goes with terrain, files of voxels and scenes");
  expect_refused(function, {"--rounded", "0.1"}, "goes with files of voxels");
  expect_refused(function, {"--refine", "secant"}, "--march naive");
  expect_refused(function, {"--refine-halvings", "3", "--march", "naive"}, "--refine bisect");
}

// Each option of a picture is refused by the looks that do not read it, and makes another picture with those that do.
TEST_F(WithoutEffect, IsRefusedOfLooks) {
  struct Case {
    Names options;     // the one that is meant, and its value
    Names looks;       // that read it
    Names others{};    // that it needs
    bool seen = true;  // in a picture as small as this one
  };
  const Names soft{"--samples", "4"}, fog{"--fog", "height"}, lake{"--water", "30"}, lit{"shaded", "comanche"},
      steps{"--march", "fixed-step", "--reach", "200"};
  const std::vector<Case> cases = {
      {{"--ramp", "magma"}, {"shaded", "steps", "comanche"}},
      {{"--sun", "100,20"}, lit},
      {{"--no-shadows"}, {"shaded"}},
      {{"--samples", "4"}, lit},
      {{"--sun-size", "60"}, {"shaded"}, soft},
      {{"--ao-distance", "1"}, lit, soft},
      {{"--seed", "7"}, lit, soft},
      {{"--aa", "3"}, {"shaded"}},
      {{"--haze", "0.9"}, {"shaded"}},
      {{"--error-tolerance", "1e-9"}, {"error"}},
      {{"--ground", "natural"}, lit},
      {{"--snow-line", "1"}, lit, {"--ground", "natural"}},
      {{"--detail", "1"}, lit},
      {{"--detail-size", "3"}, lit, {"--detail", "1"}},
      {{"--contours", "7"}, lit},
      {{"--overlay", path("overlay.asc")}, lit, {}, false},
      {{"--water", "30"}, lit},
      {{"--water-colour", "ff0000"}, lit, lake},
      {{"--turbidity", "3"}, lit, lake},
      {{"--waves", "0.4"}, lit, lake},
      {{"--wavelength", "2"}, lit, lake, false},
      {{"--no-reflection"}, lit, lake},
      {{"--no-refraction"}, lit, lake},
      {{"--fog", "distance"}, lit},
      {{"--visibility", "20"}, lit, fog},
      {{"--fog-base", "90"}, lit, fog},
      {{"--fog-falloff", "1"}, lit, fog},
      {{"--sun-tint", "1"}, lit, fog, false},
      {{"--pixel-size", "2"}, {"comanche"}},
      {{"--steps", "3"}, {"comanche"}, steps},
      {{"--shells"}, {"comanche"}, steps, false},
      {{"--step-by-view"}, {"comanche"}, steps, false},
      {{"--iterations"}, {"comanche"}},
  };
  const std::string rough = scratch_.write(
      "rough.asc",
      "ncols 4\nnrows 4\nxllcorner 0\nyllcorner 0\ncellsize 10\n1 70 3 40\n9 2 60 30\n5 50 8 20\n90 4 10 6\n");
  const auto picture = [&](const std::string& look, const Names& options, const Names& others) {
    Names arguments{
        "render", rough,   "-o",        out_,       "--look",  look, look == "comanche" ? "--lowres" : "--size",
        "24x18",  "--eye", "15,-20,90", "--target", "15,15,20"};
    if (look == "error") arguments.insert(arguments.end(), {"--march", "naive"});
    arguments.insert(arguments.end(), others.begin(), others.end());
    arguments.insert(arguments.end(), options.begin(), options.end());
    const auto result = run(arguments);
    EXPECT_EQ(result.status, 0) << fmt::format("{}: {}", fmt::join(arguments, " "), result.err);
    return test::text_of(out_);
  };
  std::map<Names, std::string> without;
  for (const Case& c : cases) {
    for (const std::string look : {"shaded", "height", "steps", "error", "comanche"}) {
      const std::string what = fmt::format("{} with {}", fmt::join(c.options, " "), look);
      if (std::find(c.looks.begin(), c.looks.end(), look) == c.looks.end()) {
        const std::string form = c.looks.size() == 1 ? "goes with the look " : "goes with the looks ";
        const std::string text =
            test::refusal([&] { cli::require_options_of_look(look, cli::InputKind::terrain, {c.options.front()}); });
        EXPECT_EQ(text.find(c.options.front() + ": " + form + c.looks.front()), 0u) << what << ": " << text;
        continue;
      }
      if (!c.seen) continue;
      Names key = c.others;
      key.push_back(look);
      if (!without.contains(key)) without[key] = picture(look, {}, c.others);
      EXPECT_TRUE(picture(look, c.options, c.others) != without[key]) << what;
    }
  }
  // Whoever adds an option says here which looks read it.
  const Names of_all = {"--help",   "--output", "--size",  "--look",   "--no-plinth", "--threads",
                        "--device", "--lowres", "--reach", "--legend", "--scale-bar"},
              of_voxels = {"--normals", "--normal-radius", "--rounded", "--each", "--corner-ao", "--coarse-voxels"};
  const std::string help = run({"render", "--help"}).out;
  for (const char* group : {"Options", "Ground", "Water", "Fog", "Look comanche", "Looks of voxels"}) {
    const auto begin = help.find(fmt::format("\n{}:\n", group));
    ASSERT_NE(begin, std::string::npos) << group;
    const std::string text = help.substr(begin, help.find("\n\n", begin + 1) - begin);
    const std::regex form("\n  (?:-[a-z],)?(--[a-z-]+)");
    for (std::sregex_iterator at(text.begin(), text.end(), form), end; at != end; ++at) {
      const std::string option = (*at)[1];
      const auto is = [&](const std::string& name) { return name == option; };
      EXPECT_TRUE(std::any_of(of_all.begin(), of_all.end(), is) ||
                  std::any_of(of_voxels.begin(), of_voxels.end(), is) ||
                  std::any_of(cases.begin(), cases.end(), [&](const Case& c) { return c.options.front() == option; }))
          << option;
    }
  }
  expect_refused({"render", rough, "-o", out_ + ".png"}, {"--sun", "1,30", "--look", "height"},
                 "goes with the looks shaded and comanche, not with 'height'; leave it out");
  for (const std::string look : {"height", "steps"}) {
    expect_refused({"render", vox_, "-o", out_}, {"--normals", "smooth", "--look", look}, "goes with the look shaded");
    expect_refused({"render", vox_, "-o", out_}, {"--corner-ao", "--look", look}, "goes with the look shaded");
  }
}

TEST_F(WithoutEffect, IsNoLongerTheAngleOfViewOfFunctions) {
  const auto picture = [&](const Names& options) {
    Names arguments{"render", "--function", "hills", "-o", out_, "--size", "16x12"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    EXPECT_EQ(run(arguments).status, 0);
    return test::text_of(out_);
  };
  EXPECT_NE(picture({"--fov", "100"}), picture({}));
}

TEST_F(WithoutEffect, DepthGoesWithScenes) {
#ifdef SCARP_OPENEXR
  const std::string exr = scratch_.path("out.exr");
  const Names arguments{"render", scene_, "-o", exr, "--size", "8x8"};
  ASSERT_EQ(run(arguments).status, 0);
  EXPECT_EQ(test::text_of(exr).find("depth"), std::string::npos);
  Names with_depth = arguments;
  with_depth.insert(with_depth.end(), {"--depth-range", "1,1000"});
  ASSERT_EQ(run(with_depth).status, 0);
  EXPECT_NE(test::text_of(exr).find("depth"), std::string::npos);
#else
  GTEST_SKIP() << "built without OpenEXR";
#endif
}

}  // namespace
}  // namespace scarp
