// SPDX-License-Identifier: MIT
// Options of the command line in general: numbers are finite and in their range, help is complete, and options without
// effect are refused.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/options/animation.h"
#include "app/options/help.h"
#include "base/refusal.h"
#include "cli/program.h"
#include "scarp/base/error.h"
#include "scarp/march/function/function_table.h"
#include "scarp/march/height/height_table.h"
#include "scarp/render/frame/picture.h"
#include "scarp/source/voxel/vox_file.h"

namespace scarp {
namespace {

using test::Names;
using test::run;

// The declarations of the program.
const cli::Program& declared() {
  static const cli::Program program = cli::scarp_program();
  return program;
}

TEST(Options, RejectNonFiniteNumbers) {
  std::size_t found = 0;
  for (const cli::Command* command : declared().commands()) {
    for (const cli::Declared& option : command->options()) {
      if (!std::holds_alternative<double*>(option.to) && !std::holds_alternative<std::optional<double>*>(option.to))
        continue;
      ++found;
      for (const char* text : {"nan", "inf", "1e999", "x", ""}) {
        const std::string what = test::refusal([&] { cli::set_value(option, text); });
        EXPECT_EQ(what.find(fmt::format("{} '{}': expected a ", option.name, text)), 0u)
            << command->name() << ": " << what;
        EXPECT_LT(what.size(), 120u) << what;
      }
    }
  }
  EXPECT_GT(found, 50u);
}

// Every option of numbers can be animated, without a list of them.
TEST(Options, CanBeAnimated) {
  const cli::Command& render = *declared().find("render");
  int animated = 0;
  for (const cli::Declared& option : render.options()) {
    if (option.positional()) continue;
    const std::string text = option.name.substr(2) + "=1..2";
    const bool number = std::holds_alternative<double*>(option.to) || std::holds_alternative<int*>(option.to) ||
                        std::holds_alternative<std::optional<double>*>(option.to) ||
                        std::holds_alternative<std::optional<int>*>(option.to);
    if (number && option.option.topic != cli::Topic::flight) {
      ++animated;
      EXPECT_NO_THROW(cli::Animation(render, text)) << option.name;
    }
    if (option.flag()) {
      EXPECT_THROW(cli::Animation(render, text), cli::WrongUsage) << option.name;
    }
  }
  EXPECT_GT(animated, 50);
}

// Topics, looks, marches and other options that a declaration names exist.
TEST(Options, ReferToExistingNames) {
  for (const cli::Command* command : declared().commands()) {
    for (const cli::Declared& option : command->options()) {
      const std::string what = command->name() + " " + option.name;
      EXPECT_FALSE(option.option.help.empty()) << what;
      EXPECT_FALSE(option.option.help.ends_with('.') || option.meaning().find(",,") != std::string::npos) << what;
      for (const std::string_view look : cli::words_of(option.option.looks.names))
        EXPECT_NO_THROW(find_look(look)) << what;
      for (const std::string_view march : cli::words_of(option.option.marches)) {
        const auto is = [&](const MarchEntry& entry) { return entry.name == march; };
        EXPECT_TRUE(std::any_of(height_marches().begin(), height_marches().end(), is) ||
                    std::any_of(function_marches().begin(), function_marches().end(), is))
            << what << ": " << march;
      }
      Names others = option.option.excludes;
      for (const cli::Rule& rule : option.option.rules) {
        for (const std::string_view word : cli::words_of(rule.text)) {
          if (word.starts_with("--")) others.emplace_back(word.substr(0, word.find(',')));
        }
      }
      for (const std::string& other : others) {
        EXPECT_NE(command->find(other), nullptr) << what << ": " << other;
      }
    }
  }
}

TEST(Help, FitsOnAScreen) {
  for (const cli::Command* command : declared().commands()) {
    for (const std::string topic : {"", "all"}) {
      const std::string text = cli::help_text(*command, topic);
      for (std::size_t begin = 0, end = 0; begin < text.size(); begin = end + 1) {
        end = text.find('\n', begin);
        EXPECT_LE(end - begin, 100u) << text.substr(begin, end - begin);
      }
    }
    EXPECT_LE(test::lines(cli::help_text(*command, "")), 60) << command->name();
  }
}

TEST(Help, ListsEveryOptionAndTopic) {
  const cli::Command& render = *declared().find("render");
  const std::string common = run({"render", "--help"}).out, all = run({"render", "--help", "all"}).out;
  EXPECT_NE(common.find("\nExamples:\n  scarp render "), std::string::npos) << common;
  EXPECT_EQ(common.find("--turbidity"), std::string::npos) << common;
  for (const cli::Declared& option : render.options())
    EXPECT_NE(all.find("\n  " + option.synopsis()), std::string::npos);
  for (const auto& [topic, options] : cli::options_by_topic(render)) {
    const auto result = run({"render", "--help", std::string(name_of(topic))});
    EXPECT_EQ(result.status, 0) << result.err;
    for (const cli::Declared* option : options)
      EXPECT_NE(result.out.find("\n  " + option->synopsis()), std::string::npos) << result.out;
  }
  EXPECT_NE(run({"render", "--help", "water"}).out.find("F >= 0 (0.04)"), std::string::npos);
  const auto unknown = run({"render", "--help", "wather"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_EQ(test::lines(unknown.err), 1);
  EXPECT_EQ(unknown.err.find("scarp: error: --help 'wather': unknown topic of 'scarp render' (topics: all, general, "),
            0u)
      << unknown.err;
  // Regardless of other options.
  EXPECT_EQ(run({"render", "--watr", "3", "--fov", "x", "--help", "fog"}).status, 0);
  EXPECT_EQ(run({"--help", "cast"}).out, run({"cast", "--help"}).out);
}

// Forms, such as those of the plugin of QGIS, are built from this.
TEST(Options, AreDescribedAsJson) {
  const auto all = nlohmann::json::parse(run({"options", "--json"}).out);
  ASSERT_EQ(all["subcommands"].size(), declared().commands().size());
  std::map<std::string, int> kinds;
  for (std::size_t i = 0; i < declared().commands().size(); ++i) {
    const cli::Command& command = *declared().commands()[i];
    const auto& described = all["subcommands"][i];
    EXPECT_EQ(described["name"], command.name());
    ASSERT_EQ(described["options"].size(), command.options().size());
    for (const auto& one : described["options"]) {
      const cli::Declared& option = *command.find(std::string(one["name"]));
      EXPECT_EQ(one["help"], option.meaning());
      EXPECT_EQ(one["default"], option.default_text);
      EXPECT_EQ(one["restrictions"], option.restrictions());
      EXPECT_EQ(one["kind"] == "flag", option.flag()) << option.name;
      ++kinds[std::string(one["kind"])];
      // A value that is accepted as a number is in the range described.
      const bool number = one["kind"] == "number" || one["kind"] == "integer";
      for (const char* bound : {"least", "most"}) {
        if (!number || !one["range"].contains(bound)) continue;
        const double limit = one["range"][bound];
        const std::string beyond = fmt::format("{}", limit + (*bound == 'l' ? -1 : 1));
        EXPECT_THROW(cli::set_value(option, beyond), cli::WrongUsage) << option.name << " " << beyond;
      }
      // Every output is a file that is written, and no input is.
      if (option.name == "--output" || option.name == "--preview") {
        EXPECT_TRUE(one["writes"]) << command.name();
      } else if (option.positional() || option.name == "--observers") {
        EXPECT_FALSE(one["writes"]) << command.name();
      }
    }
  }
  for (const char* kind : {"flag", "integer", "number", "text"}) EXPECT_GT(kinds[kind], 10) << kind;
}

// No value is dropped in favour of another: an option of each type of variable.
TEST(Options, AreRejectedIfRepeated) {
  cli::Program program = cli::scarp_program();
  std::set<std::size_t> types;
  for (const cli::Command* command : declared().commands()) {
    for (const cli::Declared& option : command->options()) {
      const bool several = option.option.repeats || std::holds_alternative<std::vector<std::string>*>(option.to);
      if (option.positional() || option.flag() || several || !types.insert(option.to.index()).second) continue;
      Names words{"scarp", command->name(), option.name, "1", option.name, "2"};
      std::vector<char*> argv;
      for (std::string& word : words) argv.push_back(word.data());
      EXPECT_EQ(test::refusal([&] { program.run(static_cast<int>(argv.size()), argv.data()); }),
                option.name + " was given 2 times; expected once");
    }
  }
  EXPECT_GT(types.size(), 8U);
}

TEST(Options, RejectNumbersOutOfRange) {
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
      {{"generate", "--feature-size", "1"}, "--feature-size '1': expected a finite number, 2 or more"},
      {{"info", "--extent", "2e9"}, "--extent '2e9': expected a number above 0 and at most 1073741824"},
  };
  for (const auto& c : cases) {
    const auto result = run(c.arguments);
    EXPECT_EQ(result.status, 2);
    EXPECT_NE(result.err.find(c.fragment), std::string::npos) << result.err;
  }
}

// The message does not depend on the order of the options.
TEST(Options, AreCheckedInTheOrderTyped) {
  const Names first{"--fov", "0"}, second{"--waves", "2"};
  const auto message = [](const Names& a, const Names& b) {
    Names arguments{"render", "dem.tif", "-o", "out.png"};
    arguments.insert(arguments.end(), a.begin(), a.end());
    arguments.insert(arguments.end(), b.begin(), b.end());
    return run(arguments).err;
  };
  EXPECT_NE(message(first, second).find("--fov '0'"), std::string::npos);
  EXPECT_NE(message(second, first).find("--waves '2'"), std::string::npos);
  // --each needs --rounded, which is named first.
  for (const Names& arguments : {Names{"--each", "--rounded", "0.2"}, {"--rounded", "0.2", "--each"}}) {
    Names all{"render", "--function", "hills", "-o", "out.png"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    EXPECT_EQ(run(all).err.find("scarp: error: --rounded applies to voxels only"), 0u);
  }
}

// A preset is applied before typed settings, in any order on the command line.
TEST(Options, OverrideAPreset) {
  test::Scratch scratch;
  const std::string out = scratch.path("out.png");
  const Names render{"render", "--function", "hills", "-o", out, "--size", "16x12", "--look", "steps"};
  const auto picture = [&](const Names& options) {
    Names arguments = render;
    arguments.insert(arguments.end(), options.begin(), options.end());
    const auto result = run(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    return test::text_of(out);
  };
  const Names step{"--relaxed-step-factor", "0.1"}, preset{"--preset", "elevated"};
  EXPECT_EQ(picture({step[0], step[1], preset[0], preset[1]}), picture({preset[0], preset[1], step[0], step[1]}));
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
    EXPECT_EQ(result.err.find("scarp: error: " + options.front() + " "), 0u) << what;
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

TEST_F(WithoutEffect, IsRejectedForVoxels) {
  const Names render{"render", vox_, "-o", out_}, info{"info", vox_}, make{"voxelise", vox_, "-o", out_ + ".vox"};
  for (const Names& options : {Names{"--exaggeration", "2"},
                               {"--solid"},
                               {"--surface", "triangles"},
                               {"--nodata", "5"},
                               {"--band", "1"},
                               {"--crs", "EPSG:4326"},
                               {"--scale", "2"}}) {
    expect_refused(render, options, "applies to terrain only");
    expect_refused(make, options, "applies to terrain only");
  }
  expect_refused(render, {"--wrap", "none"}, "applies to terrain only");
  expect_refused(info, {"--nodata", "5"}, "applies to terrain only");
  expect_refused(info, {"--extent", "5"}, "applies to functions only");
  expect_refused(make, {"--ramp", "grey"}, "terrain");
  expect_refused(render, {"--no-plinth"}, "applies to terrain only");
  expect_refused(render, {"--function-step", "5"}, "applies to functions only");
  expect_refused(render, {"--ramp", "viridis"}, "--volume or --look steps or cost");
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

TEST_F(WithoutEffect, IsRejectedForTerrain) {
  const Names render{"render", dem_, "-o", out_}, cast{"cast", dem_, "--rays", scratch_.path("rays.csv")};
  for (const Names& options : {Names{"--frame", "0"}, {"--hidden"}, {"--up", "z"}, {"--normals", "flat"}}) {
    expect_refused(render, options, "applies to voxels only");
  }
  expect_refused({"info", dem_}, {"--surface-colours"}, "applies to voxels only");
  expect_refused(render, {"--coarse-voxels"}, "applies to voxels and scenes only");
  expect_refused(render, {"--extent", "5"}, "applies to functions only");
  expect_refused({"info", dem_}, {"--extent", "5"}, "applies to functions only");
  expect_refused(cast, {"--function-reach", "5"}, "applies to functions only");
  expect_refused(cast, {"--naive-tolerance", "0.1"}, "--march naive");
  expect_refused(render, {"--shrink", "0.5"}, "--march lipschitz");
  expect_refused(render, {"--refine", "secant"}, "--march naive");
  expect_refused(render, {"--bisect-halvings", "5", "--march", "naive"}, "--march max-mip-bisect");
  expect_refused(render, {"--turbidity", "1"}, "--water M");
  expect_refused(render, {"--visibility", "1"}, "--fog KIND");
  expect_refused(render, {"--fog-falloff", "1", "--fog", "distance"}, "--fog height");
  expect_refused(render, {"--snow-line", "1"}, "--ground natural");
  expect_refused(render, {"--detail-size", "1"}, "--detail F");
  expect_refused(render, {"--steps", "9"}, "applies to the looks height and comanche");
  expect_refused(render, {"--steps", "9", "--look", "comanche"}, "--march fixed-step");
  const Names function{"render", "--function", "hills", "-o", out_};
  for (const char* option : {"--fixed-step", "--fixed-step-max-steps"})
    expect_refused(render, {option, "2", "--march", "fixed-step", "--look", "comanche"}, "whose rays take --steps N");
  expect_refused(function, {"--steps", "9", "--march", "fixed-step", "--look", "comanche"}, "applies to terrain only");
  expect_refused(function, {"--shells", "--march", "fixed-step", "--look", "comanche"}, "step by --function-step M");
  expect_refused(function, {"--fixed-step", "2", "--march", "fixed-step"}, "functions have --function-step M");
  expect_refused(render, {"--pixel-size", "2", "--look", "height"},
                 "needs --lowres WIDTHxHEIGHT without --look comanche");
  expect_refused(render, {"--sun", "1,30", "--unlit"}, "has no effect with --unlit");
  expect_refused(render, {"--error-tolerance", "1"}, "applies to the look error");
  expect_refused(render, {"--sun-size", "1"}, "--samples N");
  expect_refused(render, {"--mesh-up", "y"}, "--mesh FILE");
  const Names flight{"render", dem_, "-o", scratch_.path("out-##.png"), "--turntable"};
  expect_refused(flight, {"--eye", "1,2,3"}, "define their own cameras");
  expect_refused(flight, {"--top"}, "define their own cameras");
  expect_refused({"render", dem_, "-o", scratch_.path("out-##.png"), "--path", "p.csv"}, {"--view", "1,2"}, "table");
}

TEST_F(WithoutEffect, IsRejectedForScenesAndFunctions) {
  const Names render{"render", scene_, "-o", out_}, info{"info", scene_}, make{"voxelise", scene_, "-o", out_ + ".vox"};
  for (const Names& options : {Names{"--nodata", "5"}, {"--hidden"}}) {
    expect_refused(render, options, "a scene file describes its own content");
    expect_refused(info, options, "a scene file describes its own content");
    expect_refused(make, options, "a scene file describes its own content");
  }
  expect_refused(make, {"--ramp", "grey"}, "terrain");
  expect_refused(render, {"--no-plinth"}, "applies to terrain only (only a raster alone is shown on a plinth)");
  const Names function{"render", "--function", "hills", "-o", out_};
  for (const Names& options : {Names{"--exaggeration", "2"}, {"--no-plinth"}}) {
    expect_refused(function, options, "applies to terrain only");
  }
  expect_refused(function, {"--top"}, "applies to terrain, voxels, scenes and meshes only");
  expect_refused(function, {"--rounded", "0.1"}, "applies to voxels only");
  expect_refused(function, {"--refine", "secant"}, "--march naive");
  expect_refused(function, {"--refine-halvings", "3", "--march", "naive"}, "--refine bisect");
}

// Each option of a picture is rejected by the looks that do not read it, and changes the picture with those that do.
TEST_F(WithoutEffect, IsRejectedForLooks) {
  struct Case {
    Names options;     // the option, and its value
    Names looks;       // that read it
    Names others{};    // that it requires
    bool seen = true;  // in a picture as small as this one
  };
  const Names soft{"--samples", "4"}, fog{"--fog", "height"}, lake{"--water", "30"}, lit{"shaded", "comanche"},
      steps{"--march", "fixed-step", "--reach", "200", "--lowres", "24x18"};
  const std::vector<Case> cases = {
      {{"--ramp", "magma"}, {"shaded", "steps", "cost", "comanche", "slope"}},
      {{"--ramp-range", "20,30"}, {"shaded", "height", "comanche", "level"}},
      {{"--sun", "100,20"}, {"shaded", "hillshade", "comanche"}},
      {{"--sky", "scattering"}, lit},
      {{"--sky-turbidity", "9"}, lit, {"--sky", "scattering"}},
      {{"--no-tone-curve"}, lit},
      {{"--no-shadows"}, {"shaded"}},
      {{"--unlit"}, lit},
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
      {{"--detail-texture", SCARP_SOURCE_DIR "/test/golden/lake.png"}, lit},
      {{"--contours", "7"}, lit},
      {{"--steps-range", "0,900"}, {"steps", "cost"}},
      {{"--overlay", path("overlay.asc")}, lit, {}, false},
      {{"--overlay-fit"}, lit, {"--overlay", path("overlay.asc")}, false},
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
      {{"--pixel-size", "2"}, {"shaded", "height", "comanche"}, {"--lowres", "24x18"}},
      {{"--steps", "3"}, {"height", "comanche"}, steps},
      {{"--shells"}, {"height", "comanche"}, steps, false},
      {{"--step-by-view"}, {"height", "comanche"}, steps, false},
      {{"--iterations"}, {"comanche"}},
  };
  const std::string rough = scratch_.write(
      "rough.asc",
      "ncols 4\nnrows 4\nxllcorner 0\nyllcorner 0\ncellsize 10\n1 70 3 40\n9 2 60 30\n5 50 8 20\n90 4 10 6\n");
  const auto picture = [&](const std::string& look, const Names& options, const Names& others) {
    Names arguments{"render", rough,       "-o",       out_,      "--look", look == "level" ? "level:1" : look,
                    "--eye",  "15,-20,90", "--target", "15,15,20"};
    if (std::find(others.begin(), others.end(), "--lowres") == others.end())
      arguments.insert(arguments.end(), {look == "comanche" ? "--lowres" : "--size", "24x18"});
    if (look == "error") arguments.insert(arguments.end(), {"--march", "naive"});
    arguments.insert(arguments.end(), others.begin(), others.end());
    arguments.insert(arguments.end(), options.begin(), options.end());
    const auto result = run(arguments);
    EXPECT_EQ(result.status, 0) << fmt::format("{}: {}", fmt::join(arguments, " "), result.err);
    return test::text_of(out_);
  };
  const cli::Command& render = *declared().find("render");
  std::map<Names, std::string> without;
  for (const Case& c : cases) {
    for (const std::string look : {"shaded", "hillshade", "height", "steps", "cost", "error", "comanche", "level",
                                   "slope", "aspect", "multidirectional"}) {
      const std::string what = fmt::format("{} with {}", fmt::join(c.options, " "), look);
      if (std::find(c.looks.begin(), c.looks.end(), look) == c.looks.end()) {
        const std::string form = c.looks.size() == 1 ? "applies to the look " : "applies to the looks ";
        const std::string text = test::refusal([&] {
          cli::require_effect(*render.find(c.options.front()), {cli::InputKind::terrain, look});
        });
        EXPECT_EQ(text.find(c.options.front() + " " + form + c.looks.front()), 0u) << what << ": " << text;
        continue;
      }
      if (!c.seen) continue;
      Names key = c.others;
      key.push_back(look);
      if (!without.contains(key)) without[key] = picture(look, {}, c.others);
      EXPECT_TRUE(picture(look, c.options, c.others) != without[key]) << what;
    }
  }
  // A new option must be listed above with the looks that read it, or here: of all looks, or of scene files only.
  const Names of_all = {"--size", "--look", "--no-plinth", "--lowres", "--reach", "--no-water"};
  using cli::Topic;
  for (const auto& [topic, options] : cli::options_by_topic(render)) {
    const Topic all[] = {Topic::picture, Topic::light, Topic::ground, Topic::water, Topic::fog, Topic::comanche};
    if (std::find(std::begin(all), std::end(all), topic) == std::end(all)) continue;
    for (const cli::Declared* one : options) {
      const auto is = [&](const std::string& name) { return name == one->name; };
      EXPECT_TRUE(
          std::any_of(of_all.begin(), of_all.end(), is) ||
          std::any_of(cases.begin(), cases.end(), [&](const Case& c) { return c.options.front() == one->name; }))
          << one->name;
    }
  }
  expect_refused({"render", rough, "-o", out_ + ".png"}, {"--sun", "1,30", "--look", "height"},
                 "applies to the looks shaded, hillshade and comanche, not to 'height'");
  for (const std::string look : {"height", "steps"}) {
    expect_refused({"render", vox_, "-o", out_}, {"--normals", "smooth", "--look", look}, "applies to the look shaded");
    expect_refused({"render", vox_, "-o", out_}, {"--corner-ao", "--look", look}, "applies to the look shaded");
  }
}

TEST_F(WithoutEffect, DoesNotIncludeFovForFunctions) {
  const auto picture = [&](const Names& options) {
    Names arguments{"render", "--function", "hills", "-o", out_, "--size", "16x12"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    EXPECT_EQ(run(arguments).status, 0);
    return test::text_of(out_);
  };
  EXPECT_NE(picture({"--fov", "100"}), picture({}));
}

TEST_F(WithoutEffect, DoesNotIncludeDepthForScenes) {
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
