// SPDX-License-Identifier: MIT
// The controls of the panel, without a window: generated from the declared options, and the effects of option changes
// on the pictures.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "app/cli/commands.h"
#include "app/viewer/controls.h"
#include "app/viewer/navigation.h"
#include "app/viewer/reading.h"
#include "app/viewer/subject.h"
#include "app/viewer/view_output.h"
#include "scarp/base/error.h"

namespace scarp::viewer {
namespace {

struct WindowOptions : testing::Test {
  std::string file =
      std::filesystem::temp_directory_path() / ("scarp-window-options-" + std::to_string(::getpid()) + ".npy");

  WindowOptions() {
    // Waves of 24 m over 65 x 65 samples.
    std::vector<float> samples;
    for (int row = 0; row < 65; ++row) {
      for (int col = 0; col < 65; ++col)
        samples.push_back(static_cast<float>(12 + 12 * std::sin(0.3 * col) * std::cos(0.25 * row)));
    }
    std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (65, 65), }";
    header.resize(117, ' ');
    std::ofstream out(file, std::ios::binary);
    out.write("\x93NUMPY\x01\x00\x76\x00", 10);
    out << header << '\n';
    out.write(reinterpret_cast<const char*>(samples.data()), static_cast<std::streamsize>(4 * samples.size()));
  }
  ~WindowOptions() override { std::filesystem::remove(file); }

  static Opening with(Opening opening, const std::vector<OptionChange>& changes) {
    for (const OptionChange& change : changes) opening = changed(opening, change);
    return opening;
  }
  static std::string words_of(const Opening& opening) { return opening.command().typed_words({"IN"}); }
  static Control control(const std::vector<Control>& controls, std::string_view option) {
    const auto found =
        std::find_if(controls.begin(), controls.end(), [&](const Control& c) { return c.option == option; });
    if (found == controls.end()) throw Error("no control for " + std::string(option));
    return *found;
  }
  static bool has_control(const std::vector<Control>& controls, std::string_view option) {
    return std::any_of(controls.begin(), controls.end(), [&](const Control& c) { return c.option == option; });
  }
  static std::vector<std::uint8_t> picture_of(const Subject& subject, std::size_t side = 0, int width = 64,
                                              int height = 48) {
    const PictureSide of = subject.sides(width, height)[side];
    PictureSettings settings = of.settings;
    settings.aa = 1;
    return of.render(subject.first_camera(), settings, [](double) { return true; }).image.rgb;
  }
};

TEST_F(WindowOptions, AreSuspendedWithoutEffect) {
  const Opening plain = opening_of({file});
  EXPECT_EQ(words_of(plain), "");
  const Opening wavy = with(plain, {{"--water", "10"}, {"--waves", "0.1"}});
  EXPECT_EQ(words_of(wavy), " --water=10 --waves=0.1");
  // Without water there are no waves; with water, they are back.
  const Opening dry = with(wavy, {{"--water", {}}});
  EXPECT_EQ(words_of(dry), "");
  EXPECT_FALSE(dry.options->picture.water_level);
  EXPECT_EQ(words_of(with(dry, {{"--water", "12"}})), " --waves=0.1 --water=12");
  const Opening counted = with(wavy, {{"--look", "steps"}});
  EXPECT_EQ(words_of(counted), " --look=steps");
  EXPECT_EQ(words_of(with(counted, {{"--look", {}}})), " --water=10 --waves=0.1");
  // Options that cannot be combined: the newer one counts.
  const Opening unlit = with(plain, {{"--samples", "4"}, {"--unlit", "true"}});
  EXPECT_EQ(words_of(unlit), " --unlit");
  EXPECT_EQ(words_of(with(unlit, {{"--samples", "8"}})), " --samples=8");
}

TEST_F(WindowOptions, ReportErrors) {
  const Opening plain = opening_of({file});
  EXPECT_THROW(changed(plain, {"--nothing", "1"}), cli::WrongUsage);
  EXPECT_THROW(changed(plain, {"--samples", "-1"}), cli::WrongUsage);
  EXPECT_THROW(changed(plain, {"--waves", "0.1"}), Error);  // there is no water
  EXPECT_THROW(changed(plain, {"--sun", "high"}), Error);
  // Changes without effect in the window.
  Subject subject(plain, 64, 48);
  for (const OptionChange& change :
       {OptionChange{"--top", "true"}, {"--fov", "30"}, {"--size", "80x60"}, {"--eye", {}}})
    EXPECT_THROW(subject.change(change), cli::WrongUsage) << change.option;
}

TEST_F(WindowOptions, ScreenshotsAreNamedPng) {
  const Opening played = with(opening_of({file}), {{"--play", "events"}});
  EXPECT_NO_THROW(changed(played, {"--screenshot", "window.PNG"}));
  for (const char* name : {"window.bmp", "window", "png"})
    EXPECT_THROW(changed(played, {"--screenshot", name}), Error) << name;
}

TEST_F(WindowOptions, ControlsShowTheDeclaredOptions) {
  Subject subject(opening_of({file}), 64, 48);
  std::vector<Control> controls = subject.controls({});
  const Control samples = control(controls, "--samples");
  EXPECT_EQ(samples.kind, ControlKind::number);
  EXPECT_TRUE(samples.whole && samples.common);
  EXPECT_EQ(samples.most, 4096);
  EXPECT_EQ(control(controls, "--exaggeration").numbers[0], 1);
  EXPECT_EQ(control(controls, "--no-shadows").label, "shadows");
  EXPECT_TRUE(control(controls, "--no-shadows").on);
  EXPECT_EQ(control(controls, "--march").choice, "max-mip");
  EXPECT_EQ(control(controls, "--sun").numbers[0], 315);
  EXPECT_EQ(control(controls, "--haze").numbers[0], 0.1);
  const Control water = control(controls, "--water");
  EXPECT_TRUE(water.may_rest && water.rests);
  EXPECT_NEAR(water.least, 0, 0.1);
  EXPECT_NEAR(water.most, 30, 0.2);
  // Options that need others, or affect others, have no control.
  EXPECT_FALSE(has_control(controls, "--waves"));
  EXPECT_FALSE(has_control(controls, "--naive-step-factor"));
  EXPECT_FALSE(has_control(controls, "--frame"));
  subject.change({"--water", "7"});
  subject.change({"--march", "naive"});
  controls = subject.controls({});
  EXPECT_FALSE(control(controls, "--water").rests);
  EXPECT_EQ(control(controls, "--water").numbers[0], 7);
  EXPECT_TRUE(has_control(controls, "--waves"));
  EXPECT_EQ(control(controls, "--naive-step-factor").numbers[0], 0.7);
  subject.change({"--look", "steps"});
  controls = subject.controls(StepScale{3, 40});
  EXPECT_EQ(control(controls, "--steps-range").numbers[1], 40);
  EXPECT_FALSE(has_control(controls, "--water"));
}

TEST_F(WindowOptions, ControlsShowWhatIsInForce) {
  const Subject steps(with(opening_of({file}), {{"--look", "steps"}}), 16, 12);
  EXPECT_EQ(control(steps.controls({}), "--ramp").choice, "viridis");
  const Subject own(with(opening_of({file}), {{"--look", "steps"}, {"--ramp", "grey"}}), 16, 12);
  EXPECT_EQ(control(own.controls({}), "--ramp").choice, "grey");
  // A scene's own water can be drained.
  const std::string scene = file + ".json";
  std::ofstream(scene) << R"({"water": {"level": 15}, "objects": [{"heights": {"file": ")"
                       << std::filesystem::path(file).filename().string() << "\"}}]}";
  Subject lake(opening_of({scene}), 64, 48);
  Control water = control(lake.controls({}), "--water");
  EXPECT_FALSE(water.rests);
  EXPECT_EQ(water.numbers[0], 15);
  EXPECT_EQ(water.unit, "m");
  const std::vector<std::uint8_t> wet = picture_of(lake);
  water.rests = true;
  lake.change(change_of(water));
  EXPECT_TRUE(control(lake.controls({}), "--water").rests);
  EXPECT_NE(picture_of(lake), wet);
  EXPECT_EQ(words_of(lake.opening()), " --no-water");
  water.rests = false;
  lake.change(change_of(water));
  EXPECT_EQ(picture_of(lake), wet);
  std::filesystem::remove(scene);
}

TEST(TypedNumbers, HaveAPointOrAComma) {
  const std::pair<const char*, double> kGood[] = {{"1.5", 1.5}, {"1,5", 1.5},    {" 12 ", 12}, {"-3,25", -3.25},
                                                  {"+4", 4},    {"1e3", 1000.0}, {",5", 0.5}};
  for (const auto& [text, number] : kGood) EXPECT_EQ(typed_number(text), number) << text;
  for (const char* text : {"", " ", "1,234.5", "1.234,5", "1,2,3", "1.5.2", "1.5 m", "nan", "inf", "--1", "one", "1 5"})
    EXPECT_FALSE(typed_number(text)) << text;
}

TEST_F(WindowOptions, ChangesAreTakenBack) {
  Subject subject(opening_of({file}), 16, 12);
  EXPECT_FALSE(subject.undo() || subject.redo());
  subject.change({"--water", "7"});
  subject.change({"--sun", "300,20"});
  subject.change({"--sun", "301,20"}, true);
  subject.change({"--exaggeration", "3"});
  const std::string all = words_of(subject.opening());
  EXPECT_EQ(subject.undo(), true) << "the heights are read again";
  EXPECT_EQ(words_of(subject.opening()), " --water=7 --sun=301,20");
  EXPECT_EQ(subject.undo(), false);
  EXPECT_EQ(words_of(subject.opening()), " --water=7");
  EXPECT_EQ(subject.redo(), false);
  EXPECT_EQ(subject.redo(), true);
  EXPECT_EQ(words_of(subject.opening()), all);
  EXPECT_FALSE(subject.redo());
  EXPECT_TRUE(subject.undo());
  subject.change({"--water", "8"});
  EXPECT_FALSE(subject.redo()) << "another change replaces those that were taken back";
  EXPECT_THROW(subject.change({"--water", "high"}), Error);
  EXPECT_TRUE(subject.undo());
  EXPECT_EQ(words_of(subject.opening()), " --water=7 --sun=301,20") << "a change that failed is none";
}

// As arguments of a command.
TEST_F(WindowOptions, SeveralFilesAreOneInput) {
  const std::string other = file + ".npy";
  std::filesystem::copy_file(file, other);
  EXPECT_EQ(opening_of({file, other}).options->inputs, (std::vector<std::string>{file, other}));
  std::filesystem::remove(other);
}

// Every change of a control is an option with a value in range, and the control then shows it.
TEST_F(WindowOptions, EveryControlChangesItsOption) {
  for (const char* look : {"shaded", "steps", "height", "error", "hillshade"}) {
    Subject subject(with(opening_of({file}), {{"--look", look}}), 16, 12);
    for (Control moved : subject.controls({})) {
      if (moved.option == "--march" || moved.option == "--look") continue;
      moved.rests = false;
      if (moved.kind == ControlKind::flag) moved.on = !moved.on;
      if (!moved.choices.empty()) moved.choice = moved.choices.back();
      if (moved.kind == ControlKind::number) moved.numbers[0] = moved.least + 0.3 * (moved.most - moved.least);
      // The fog of steps is for the look comanche.
      if (moved.option == "--fog") moved.choice = "height";
      const OptionChange change = change_of(moved);
      ASSERT_NO_THROW(subject.change(change)) << change.option << ' ' << change.text.value_or("");
      const std::vector<Control> after = subject.controls({});
      if (!has_control(after, moved.option)) continue;
      const Control shown = control(after, moved.option);
      EXPECT_EQ(shown.on, moved.on) << moved.option;
      EXPECT_EQ(shown.choice, moved.choice) << moved.option;
      EXPECT_FALSE(shown.rests) << moved.option;
      for (std::size_t i = 0; i < 3; ++i) {
        // As many digits as its text has.
        const double tolerance = moved.kind == ControlKind::colour ? 0.5 / 255 : std::max(1e-3 * moved.numbers[i], 0.5);
        EXPECT_NEAR(shown.numbers[i], moved.numbers[i], tolerance) << moved.option;
      }
      EXPECT_NO_THROW(picture_of(subject, 0, 16, 12)) << moved.option;
      subject.change({moved.option, {}});
    }
  }
}

// Without rereading the input, the picture is the same as after rereading it.
TEST_F(WindowOptions, ImmediateChangesMatchAReload) {
  const std::vector<OptionChange> changes = {{"--water", "8"},      {"--fog", "height"}, {"--fog-base", "4"},
                                             {"--ramp", "viridis"}, {"--sun", "100,20"}, {"--sky", "scattering"},
                                             {"--haze", "0.4"},     {"--contours", "3"}, {"--look", "height"}};
  Subject subject(opening_of({file}), 64, 48);
  Opening opening = opening_of({file});
  std::vector<std::uint8_t> before = picture_of(subject);
  for (const OptionChange& change : changes) {
    if (change.option == "--haze") {
      subject.change({"--fog", {}});
      opening = changed(opening, {"--fog", {}});
    }
    EXPECT_FALSE(subject.change(change)) << change.option;
    opening = changed(opening, change);
    const Subject again(opening, 64, 48);
    const std::vector<std::uint8_t> picture = picture_of(subject);
    EXPECT_TRUE(picture == picture_of(again)) << change.option;
    EXPECT_FALSE(picture == before) << change.option;
    before = picture;
  }
  EXPECT_TRUE(subject.change({"--exaggeration", "3"}));
  EXPECT_EQ(subject.prepared().exaggeration(), 3);
}

// Sliders of these options take effect when the mouse is released.
TEST_F(WindowOptions, ReopenIfTheInputDependsOnThem) {
  const Subject ground(opening_of({file}), 16, 12), holes(with(opening_of({file}), {{"--nodata", "nan"}}), 16, 12),
      large(with(opening_of({file}), {{"--look", "comanche"}}), 16, 12);
  for (const OptionChange& change : {OptionChange{"--samples", "8"},
                                     {"--water", "7"},
                                     {"--contours", "3"},
                                     {"--look", "steps"},
                                     {"--full", "true"},
                                     {"--haze", "0.3"}}) {
    EXPECT_FALSE(ground.reopens(change)) << change.option;
    EXPECT_FALSE(holes.reopens(change)) << change.option;
  }
  EXPECT_FALSE(large.reopens({"--pixel-size", "5"}));
  EXPECT_FALSE(large.reopens({"--reach", "50"}));
  for (const OptionChange& change : {OptionChange{"--exaggeration", "2"},
                                     {"--no-plinth", "true"},
                                     {"--solid", "true"},
                                     {"--march", "naive"},
                                     {"--nodata", "3"},
                                     {"--crs", "none"},
                                     {"--overlay", "image.png"}})
    EXPECT_TRUE(ground.reopens(change)) << change.option;
  EXPECT_TRUE(holes.reopens({"--nodata", {}}));
  EXPECT_THROW(ground.reopens({"--samples", "-1"}), cli::WrongUsage);

  // Rays over functions end where haze hides everything, unless their reach is given.
  auto program = std::make_shared<cli::Program>(cli::about_scarp());
  auto options = std::make_shared<cli::ViewOptions>();
  cli::Command& command = declare_view(*program, *options);
  command.runs([] {});
  command.run({{command.find("--function"), {"hills"}}});
  const Opening opening = settle_opening(program, options, command);
  const Subject hills(opening, 16, 12), near(with(opening, {{"--function-reach", "9000"}}), 16, 12);
  EXPECT_TRUE(hills.reopens({"--haze", "0.3"}));
  EXPECT_FALSE(near.reopens({"--haze", "0.3"}));
  EXPECT_TRUE(hills.reopens({"--extent", "3000"}));
  for (const OptionChange& change : {OptionChange{"--ramp", "viridis"}, {"--contours", "30"}, {"--ground", "natural"}})
    EXPECT_FALSE(hills.reopens(change)) << change.option;
}

TEST_F(WindowOptions, SidesDifferInOneOption) {
  Subject subject(opening_of({file}), 64, 48);
  const auto with = subject.comparisons();
  EXPECT_NE(std::find(with.begin(), with.end(), "march fixed-step"), with.end());
  EXPECT_NE(std::find(with.begin(), with.end(), "look steps"), with.end());
  // Settings of a march have no effect while another one is in use.
  for (const OptionChange& change : {OptionChange{"--march", "fixed-step"}, {"--fixed-step", "30"}, {"--march", {}}})
    subject.change(change);
  EXPECT_EQ(words_of(subject.opening()), "");
  subject.compare("march fixed-step");
  ASSERT_EQ(subject.sides(64, 48).size(), 2u);
  EXPECT_EQ(words_of(*subject.openings()[1]), " --fixed-step=30 --march=fixed-step");
  EXPECT_FALSE(picture_of(subject, 0) == picture_of(subject, 1));
  // Both sides take over changes.
  subject.change({"--water", "9"});
  EXPECT_EQ(words_of(*subject.openings()[0]), " --water=9");
  EXPECT_EQ(words_of(*subject.openings()[1]), " --fixed-step=30 --water=9 --march=fixed-step");
  // An exact march is never wrong; a long step is.
  subject.change({"--exaggeration", "20"});
  const Camera camera = subject.first_camera();
  const auto sides = subject.sides(64, 48);
  const auto wrong = [&](std::size_t side) {
    const auto judged = sides[side].judge(camera, {});
    int rays = 0;
    for (const Verdict verdict : {Verdict::lost, Verdict::false_hit, Verdict::early, Verdict::late, Verdict::gave_up})
      rays += (*judged)[verdict];
    EXPECT_GT(judged->mean_steps, 0);
    return rays;
  };
  EXPECT_EQ(wrong(0), 0);
  EXPECT_GT(wrong(1), 0);
  subject.compare("look steps");
  EXPECT_EQ(words_of(*subject.openings()[1]), " --exaggeration=20 --look=steps");
  EXPECT_THROW(subject.compare("march nothing"), Error);
  EXPECT_EQ(subject.compared(), "look steps");
  subject.compare("");
  EXPECT_EQ(subject.sides(64, 48).size(), 1u);
}

TEST_F(WindowOptions, CommandContainsTheSettings) {
  const Opening opening = with(opening_of({file}), {{"--sun", "100,20"}, {"--no-shadows", "true"}, {"--top", "true"}});
  const cli::Places local({}, Coordinates::local, 1);
  Pose pose;
  pose.mode = MoveMode::top;
  pose.eye = {10, 20, 5}, pose.map_width = 8;
  EXPECT_EQ(render_command(opening, local, pose, 80, 40, "a.png"),
            "scarp render " + file + " --sun=100,20 --no-shadows -o a.png --size 80x40 --top --area=6,18,14,22");
  pose.mode = MoveMode::orbit;
  EXPECT_TRUE(render_command(opening, local, pose, 80, 40, "a.png")
                  .starts_with("scarp render " + file +
                               " --sun=100,20 --no-shadows -o a.png --size 80x40 --eye=10,20,5 --target="));
}

// The CPU finds the ground below the eye and under the cursor.
TEST_F(WindowOptions, SingleRaysUseTheCpu) {
  // Never deleted: memory kept by a driver has no symbol once the driver is unloaded, and libraries.lsan needs the
  // symbol.
  static const Subject* subject = nullptr;
  try {
    subject = new Subject(with(opening_of({file}), {{"--device", "auto"}}), 64, 48);
  } catch (const Error& error) {
    if (!std::string_view(error.what()).starts_with("Vulkan: no ")) throw;
    GTEST_SKIP() << error.what();
  }
  const Camera camera = subject->first_camera();
  const Scene& scene = subject->prepared().given_scene();
  Navigator navigator(scene, camera, 50, 64);
  Pose pose;
  pose.mode = MoveMode::walk, pose.eye = {32, 32, 100};
  navigator.set_pose(pose);
  // A hit 100 m below takes a few roundings of numbers below 128, by 2^-46 each.
  constexpr double kRoundings = 8 * 0x1p-46;
  EXPECT_NEAR(navigator.pose().eye.z, *scene.height(32, 32) + Navigator::kEyeHeight, kRoundings);
  EXPECT_TRUE(read_under(scene, camera, {32, 24}, ReadingFrames({}), 1));
  EXPECT_FALSE(picture_of(*subject).empty());
}

TEST_F(WindowOptions, LargePixelsFillTheWindow) {
  struct Case {
    std::vector<OptionChange> changes;
    std::string size;  // of the command
    int width, height, side;
  };
  const Case cases[] = {
      {{{"--look", "comanche"}}, " --look=comanche -o a.png --lowres 21x16 --eye=", 21, 16, 3},
      // The window is 5.3 large pixels high.
      {{{"--look", "comanche"}, {"--pixel-size", "9"}},
       " --look=comanche --pixel-size=9 -o a.png --lowres 7x5 --eye=",
       7,
       5,
       9},
      {{{"--look", "comanche"}, {"--pixel-size", "64"}},
       " --look=comanche --pixel-size=64 -o a.png --lowres 1x1 --eye=",
       1,
       1,
       64},
      // The typed value belongs to another window.
      {{{"--look", "height"}, {"--lowres", "300x200"}}, " --look=height -o a.png --lowres 21x16 --eye=", 21, 16, 3},
      {{{"--look", "height"}}, " --look=height -o a.png --size 64x48 --eye=", 64, 48, 1}};
  for (const Case& one : cases) {
    const Subject subject(with(opening_of({file}), one.changes), 64, 48);
    const PictureSettings settings = subject.sides(64, 48).front().settings;
    EXPECT_EQ(settings.width, one.width) << one.size;
    EXPECT_EQ(settings.height, one.height) << one.size;
    EXPECT_EQ(picture_of(subject).size(), static_cast<std::size_t>(3 * one.width * one.height * one.side * one.side))
        << one.size;
    const std::string command = render_command(subject.opening(), subject.prepared().places(), Pose{}, 64, 48, "a.png");
    EXPECT_TRUE(command.starts_with("scarp render " + file + one.size)) << command;
  }
}

TEST_F(WindowOptions, CompareOtherLooksWithLargePixels) {
  Subject subject(with(opening_of({file}), {{"--look", "comanche"}, {"--pixel-size", "4"}}), 64, 48);
  for (const std::string& comparison : subject.comparisons()) {
    ASSERT_NO_THROW(subject.compare(comparison)) << comparison;
    const bool look = comparison.starts_with("look");
    const PictureSettings settings = subject.sides(64, 48)[1].settings;
    EXPECT_EQ(settings.width, look ? 64 : 16) << comparison;
    EXPECT_EQ(settings.height, look ? 48 : 12) << comparison;
    const std::string command =
        render_command(*subject.openings()[1], subject.prepared().places(), Pose{}, 64, 48, "a.png");
    EXPECT_NE(command.find(look ? " -o a.png --size 64x48 " : " --pixel-size=4 "), std::string::npos) << command;
    EXPECT_EQ(command.find("--lowres 16x12") == std::string::npos, look) << command;
  }
}

TEST_F(WindowOptions, CommandContainsTheMeshPosition) {
  // Cells of 2 m, the south-west one at 1000,2000 of the map: its sample at 1001,2001.
  const std::string map = file + ".asc", mesh = file + ".obj";
  std::ofstream grid(map);
  grid << "ncols 3\nnrows 3\nxllcorner 1000\nyllcorner 2000\ncellsize 2\n0 0 0\n0 1 0\n0 0 0\n";
  grid.close();
  std::ofstream triangle(mesh);
  triangle << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  triangle.close();
  Subject subject(with(opening_of({map}), {{"--mesh", mesh}, {"--mesh-at", "1004,2002"}, {"--coords", "map"}}), 64, 48);
  const auto command = [&] {
    return render_command(subject.opening(), subject.prepared().places(), Pose{}, 80, 40, "a.png");
  };
  EXPECT_TRUE(command().starts_with("scarp render " + map + " --mesh=" + mesh + " --mesh-at=3,1 -o a.png"))
      << command();
  // Heights of the file become z of the world.
  subject.change({"--exaggeration", "4"});
  subject.change({"--mesh-at", "1004,2002,0.5"});
  EXPECT_NE(command().find(" --mesh-at=3,1,2 "), std::string::npos) << command();
  EXPECT_EQ(command().find("--coords"), std::string::npos) << command();
  std::filesystem::remove(map);
  std::filesystem::remove(mesh);
}

}  // namespace
}  // namespace scarp::viewer
