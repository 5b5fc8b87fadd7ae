// SPDX-License-Identifier: MIT
// The window on a display without a screen: recordings are played, the picture of the window is compared, and the
// picture saved by P is, byte for byte, that of the printed `scarp render` command.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cases.h"
#include "output/read_png.h"
#include "viewer/window_case.h"

namespace scarp::test {
namespace {

namespace fs = std::filesystem;

// The panel, which hides most of so small a window, is hidden by the key Tab.
constexpr const char* kDrag =
    "0.05 key 258 1 0\n0.1 move 200 120\n0.2 button 0 1 0\n0.3 move 230 130\n0.4 move 260 125\n0.5 button 0 0 0\n0.6 "
    "wheel 0 2\n";
constexpr const char* kSave = "1.0 key 80 1 0\n1.1 key 80 0 0\n";

TEST_F(Window, SavesThePictureOfRender) {
  ASSERT_EQ(view(std::string(kDrag) + kSave, "dem.tif --exaggeration 2 --samples 2"), 0) << output_;
  ASSERT_TRUE(output_.starts_with("scarp-view-1.png: scarp render dem.tif --exaggeration=2 ")) << output_;
  expect_saved_again(1);
}

TEST_F(Window, SavesThePictureOfRenderWithItsSettings) {
  // Water, fog and colours; reopened ground; a look with its scale; a part of a map; a dragged sun.
  const std::string kSettings[] = {
      "0.7 option --water 300\n0.7 option --fog height\n0.7 option --visibility 9000\n0.7 option --ramp viridis\n",
      "0.7 option --exaggeration 3\n0.7 option --no-plinth true\n0.7 option --haze 0.3\n",
      "0.7 option --look steps\n0.7 option --steps-range 2,30\n0.7 option --march naive\n"
      "0.7 option --naive-step-factor 0.3\n",
      "0.7 key 84 1 0\n0.72 wheel 0 5\n0.74 button 1 1 0\n0.76 move 100 180\n0.78 button 1 0 0\n",
      "0.7 button 0 1 2\n0.72 move 200 150\n0.74 button 0 0 2\n"};
  for (const std::string& settings : kSettings) {
    ASSERT_EQ(view(kDrag + settings + kSave, "dem.tif"), 0) << output_;
    expect_saved_again(1);
    std::istringstream lines(settings);
    for (std::string word; lines >> word;) {
      if (!word.starts_with("--")) continue;
      EXPECT_NE(output_.find(word), std::string::npos) << word << ": " << output_;
    }
    fs::remove(folder_ / "scarp-view-1.png");
  }
  EXPECT_NE(output_.find("--sun="), std::string::npos) << output_;
}

TEST_F(Window, SavesThePictureOfRenderWithLargePixels) {
  const std::string kArguments[] = {"dem.tif --look comanche", "dem.tif --look comanche --pixel-size 7",
                                    "dem.tif --look height --lowres 30x20 --march fixed-step --shells"};
  for (const std::string& arguments : kArguments) {
    ASSERT_EQ(view(std::string(kDrag) + kSave, arguments + " --screenshot window.png"), 0) << output_;
    expect_saved_again(1);
    // The window shows the saved picture, stretched from whole large pixels to 320 x 240, with sharp edges.
    const Rgb window = read_png((folder_ / "window.png").string());
    const Rgb saved = read_png((folder_ / "scarp-view-1.png").string());
    ASSERT_TRUE(window.width == 320 && window.height == 240);
    EXPECT_LE(std::abs(saved.width - 320), 3) << arguments;
    EXPECT_LE(std::abs(saved.height - 240), 3) << arguments;
    int others = 0;
    for (int y = 0; y < 240; ++y) {
      for (int x = 0; x < 320; ++x) {
        const std::uint8_t* nearest = saved.pixel((2 * x + 1) * saved.width / 640, (2 * y + 1) * saved.height / 480);
        others += !std::equal(nearest, nearest + 3, window.pixel(x, y));
      }
    }
    EXPECT_EQ(others, 0) << arguments;
    fs::remove(folder_ / "scarp-view-1.png");
  }
}

TEST_F(Window, SavesLargePixelsAndTheOtherLook) {
  ASSERT_EQ(view(std::string(kDrag) + "0.7 compare look steps\n" + kSave, "dem.tif --look comanche"), 0) << output_;
  expect_saved_again(1);
  expect_saved_again(2);
}

TEST_F(Window, LowResolutionSetsTheWindowSize) {
  ASSERT_EQ(use("dem.tif --look comanche --lowres 100x70 --pixel-size 4 --record events",
                "xdotool key c sleep 0.1 key Escape"),
            0)
      << output_;
  EXPECT_TRUE(bytes_of("events").starts_with("scarp-view 400x280\n"));
  EXPECT_NE(output_.find(" --pixel-size=4 -o picture.png --lowres 100x70 "), std::string::npos) << output_;
}

TEST_F(Window, SavesBothSides) {
  ASSERT_EQ(view(std::string(kDrag) + "0.7 compare march fixed-step\n0.8 key 67 1 0\n" + kSave, "dem.tif"), 0)
      << output_;
  EXPECT_TRUE(output_.starts_with("scarp render dem.tif -o left.png ")) << output_;
  EXPECT_NE(output_.find("\nscarp render dem.tif --march=fixed-step -o right.png "), std::string::npos) << output_;
  expect_saved_again(1);
  expect_saved_again(2);
  EXPECT_FALSE(bytes_of("scarp-view-1.png") == bytes_of("scarp-view-2.png"));
  // The third picture shows one beside the other, with their names at the bottom.
  const auto picture = [&](int number) {
    return read_png((folder_ / ("scarp-view-" + std::to_string(number) + ".png")).string());
  };
  const Rgb left = picture(1), right = picture(2), both = picture(3);
  ASSERT_TRUE(both.width == 320 && both.height == 240);
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 320; ++x) {
      if (std::abs(x - 160) <= 3) continue;  // the line between them
      const Rgb& side = x < 160 ? left : right;
      ASSERT_TRUE(std::equal(both.pixel(x, y), both.pixel(x, y) + 3, side.pixel(x, y))) << x << ", " << y;
    }
  }
  for (const auto& [from, side] : {std::pair{20, &left}, {165, &right}}) {
    int others = 0;
    for (int y = 215; y < 235; ++y) {
      for (int x = from; x < from + 130; ++x)
        others += !std::equal(both.pixel(x, y), both.pixel(x, y) + 3, side->pixel(x, y));
    }
    EXPECT_GT(others, 500) << "the name is missing";
  }
}

// The picture beside the panel is that of a window as wide as what the panel leaves free, and so are clicks on it.
TEST_F(Window, PictureIsBesideThePanel) {
  const auto play = [&](const char* size, const std::string& events) {
    std::ofstream(folder_ / "beside") << "scarp-view " << size << '\n' << events;
    return run("'" SCARP_VIEW "' dem.tif --exaggeration 2 --play beside --screenshot window.png");
  };
  ASSERT_EQ(play("800x300",
                 "0.1 move 610 160\n0.2 button 0 1 0\n0.3 button 0 0 0\n0.4 button 0 1 0\n0.5 button 0 0 0\n"
                 "0.6 wheel 0 2\n0.7 key 82 1 0\n0.8 key 80 1 0\n"),
            0)
      << output_;
  const std::string place = output_.substr(0, output_.find('\n'));
  EXPECT_NE(place.find("lon,lat"), std::string::npos) << output_;
  EXPECT_NE(output_.find(" --size 440x300"), std::string::npos) << output_;
  const Rgb window = read_png((folder_ / "window.png").string()),
            saved = read_png((folder_ / "scarp-view-1.png").string());
  ASSERT_EQ(saved.width, 440);
  for (int y = 0; y < 300; ++y) {
    EXPECT_TRUE(std::equal(saved.pixel(0, y), saved.pixel(0, y) + 3 * 440, window.pixel(360, y))) << "row " << y;
  }
  ASSERT_EQ(play("440x300",
                 "0.05 key 258 1 0\n0.1 move 250 160\n0.2 button 0 1 0\n0.3 button 0 0 0\n0.4 button 0 1 0\n"
                 "0.5 button 0 0 0\n0.6 wheel 0 2\n0.7 key 82 1 0\n0.8 key 80 1 0\n"),
            0)
      << output_;
  EXPECT_EQ(output_.substr(0, output_.find('\n')), place);
  EXPECT_TRUE(bytes_of("scarp-view-1.png") == bytes_of("scarp-view-2.png"));
}

// F6 gives the keyboard to the panel: Tab goes to the field of view, in which Enter types a number, and on to the check
// box of shadows, which Space unticks. Arrows do not turn the view meanwhile; after Esc they do.
TEST_F(Window, ControlsAreReachedByKeys) {
  double time = 0.1;
  std::string events;
  const auto press = [&](int key, int times = 1) {
    for (int i = 0; i < times; ++i) {
      for (const int down : {1, 0}) {
        events += std::to_string(time) + " key " + std::to_string(key) + ' ' + std::to_string(down) + " 0\n";
        time += 0.03;
      }
    }
  };
  constexpr int kF6 = 295, kTab = 258, kSpace = 32, kEnter = 257, kDown = 264, kEscape = 256, kC = 67;
  press(kF6);      // the first button
  press(kTab, 7);  // buttons, modes, field of view
  press(kEnter);
  events += std::to_string(time += 0.1) + " text 55\n";
  time += 0.1;
  press(kEnter);
  press(kTab, 5);  // look, sun, sky, shadows
  press(kSpace);
  press(kDown);
  press(kC);
  press(kEscape);
  press(kDown);
  press(kC);
  ASSERT_EQ(view(events, "dem.tif --eye 1000,-3000,3000 --target 1000,1000,0"), 0) << output_;
  const std::size_t second = output_.find('\n');
  const std::string in_panel = output_.substr(0, second), after = output_.substr(second);
  EXPECT_TRUE(in_panel.starts_with("scarp render dem.tif --no-shadows -o picture.png")) << output_;
  EXPECT_NE(in_panel.find(" --eye=1000,-3000,3000 "), std::string::npos) << output_;
  EXPECT_NE(in_panel.find(" --fov 55"), std::string::npos) << output_;
  EXPECT_EQ(after.find(" --eye=1000,-3000,3000 "), std::string::npos) << output_;
}

// On a map, P saves the measured line as a vector, and prints the command that draws it.
TEST_F(Window, SavesTheMeasuredLineOfAMap) {
  const std::string click = " button 0 1 0\n", up = " button 0 0 0\n";
  ASSERT_EQ(view("0.05 key 258 1 0\n0.1 key 84 1 0\n0.2 key 77 1 0\n0.3 move 100 120\n0.4" + click + "0.5" + up +
                     "0.6 move 220 120\n1.2" + click + "1.3" + up + "1.5 key 80 1 0\n",
                 "dem.tif --look height"),
            0)
      << output_;
  const std::string begin = "scarp-line-1.geojson: scarp ";
  const std::size_t at = output_.find(begin);
  ASSERT_NE(at, std::string::npos) << output_;
  const std::string command = output_.substr(at + begin.size(), output_.find('\n', at) - at - begin.size());
  EXPECT_NE(command.find(" --draw scarp-line-1.geojson"), std::string::npos) << command;
  ASSERT_EQ(run("'" SCARP_PROGRAM "' " + command), 0) << output_;
  // Between the clicks, and only there, the map is red.
  const Rgb map = read_png((folder_ / "map.png").string());
  ASSERT_EQ(map.width, 320);
  const auto is_red = [&](int x) {
    bool red = false;
    for (int y = 117; y < 123; ++y) red |= map.pixel(x, y)[0] > map.pixel(x, y)[1] + 60;
    return red;
  };
  for (int x = 103; x < 218; ++x) EXPECT_TRUE(is_red(x)) << x;
  EXPECT_FALSE(is_red(95) || is_red(225));
}

// A size of text is that of the panel, too; it is kept.
TEST_F(Window, TextHasItsSize) {
  std::ofstream(folder_ / "large") << "scarp-view 1300x400\n0.1 key 61 1 2\n0.2 key 80 1 0\n";
  ASSERT_EQ(run("'" SCARP_VIEW "' dem.tif --play large"), 0) << output_;
  EXPECT_NE(output_.find(" --size " + std::to_string(1300 - (360 * 16 + 6) / 13) + "x400"), std::string::npos)
      << output_;
  ASSERT_EQ(use("dem.tif --size 300x200",
                "xdotool key ctrl+plus sleep 0.3 key ctrl+plus sleep 0.3 key ctrl+minus "
                "sleep 0.3 key Escape"),
            0)
      << output_;
  EXPECT_NE(bytes_of("settings/scarp/view").find("text 1.25\n"), std::string::npos) << bytes_of("settings/scarp/view");
}

// On a dense screen, the first window has more pixels, but no more than the screen.
TEST_F(Window, FirstWindowFitsTheScreen) {
  if (run("command -v xprop") != 0) GTEST_SKIP() << "xprop is missing (Debian: x11-utils)";
  // Desktops set it for all programs. It is lost when the last program leaves the screen, so it is set until another
  // one is there.
  std::ofstream(folder_ / "dense.sh") << "xprop -root -spy >/dev/null & other=$!\n"
                                         "until xprop -root RESOURCE_MANAGER | grep -q 'dpi: 120'; do\n"
                                         "  xprop -root -f RESOURCE_MANAGER 8s -set RESOURCE_MANAGER 'Xft.dpi: 120'\n"
                                         "  sleep 0.1\n"
                                         "done\n"
                                         "bash use.sh; result=$?\n"
                                         "xprop -root -remove RESOURCE_MANAGER\nkill $other\nexit $result\n";
  EXPECT_EQ(use("dem.tif --march naive --record events", "xdotool key Escape", "dense.sh"), 0) << output_;
  // 1.25 times 1280 x 720 is more than the screen of 1024 x 768, and 720 is not.
  EXPECT_TRUE(bytes_of("events").starts_with("scarp-view 1024x768\n")) << bytes_of("events");
}

// Whether two pictures are the same where neither the line between two sides nor their names are drawn.
bool same_beside_line(const Rgb& a, const Rgb& b) {
  for (int y = 0; y < 200; ++y) {
    for (int x = 5; x < 315; ++x) {
      for (int c = 0; c < 3; ++c) {
        const auto at = static_cast<std::size_t>(3 * (y * 320 + x) + c);
        if (a.bytes.at(at) != b.bytes.at(at)) return false;
      }
    }
  }
  return true;
}

// Reopening the input keeps the observer. Without one, the picture has no map and C copies its own command.
TEST_F(Window, ObserversStayUntilEscape) {
  const std::string stand = "0.1 move 200 120\n0.2 key 86 1 0\n0.4 key 67 1 0\n0.5 option --exaggeration 3\n";
  ASSERT_EQ(view(stand + "0.9 key 67 1 0\n1 key 256 1 0\n1.2 key 67 1 0\n1.3 key 80 1 0\n", "dem.tif"), 0) << output_;
  std::istringstream lines(output_);
  std::string before, after, picture;
  std::getline(lines, before), std::getline(lines, after), std::getline(lines, picture);
  EXPECT_TRUE(before.starts_with("scarp viewshed dem.tif --observer=")) << output_;
  EXPECT_EQ(after, before);
  EXPECT_TRUE(picture.starts_with("scarp render dem.tif --exaggeration=3 ")) << output_;
  expect_saved_again(1);
}

TEST_F(Window, SplitLineCanBeDragged) {
  // To the edges of the window, so that only one side is visible.
  for (const int side : {1, 2}) {
    ASSERT_EQ(view(std::string(kDrag) + "0.7 compare look height\n0.8 move 160 30\n0.9 button 0 1 0\n1.0 move " +
                       (side == 1 ? "500" : "-50") + " 30\n1.1 button 0 0 0\n1.2 key 80 1 0\n",
                   "dem.tif --screenshot window.png"),
              0)
        << output_;
    const auto picture = [&](const char* name) { return read_png((folder_ / name).string()); };
    const Rgb window = picture("window.png");
    EXPECT_EQ(same_beside_line(window, picture("scarp-view-1.png")), side == 1);
    EXPECT_EQ(same_beside_line(window, picture("scarp-view-2.png")), side == 2);
    for (const char* name : {"window.png", "scarp-view-1.png", "scarp-view-2.png"}) fs::remove(folder_ / name);
  }
}

TEST_F(Window, RecordingStopsAtAFailingLine) {
  const std::pair<const char*, const char*> kLines[] = {
      {"option --samples -1", "--samples '-1': expected a whole number"},
      {"option --waves 0.1", "--waves has no effect without --water M"},
      {"option --nothing 1", "unknown option '--nothing'"},
      {"option --no-shadows no", "--no-shadows 'no': takes no value"},
      {"option --top true", "--top: takes effect only when the window opens"},
      {"option --overlay nothing.tif", "nothing.tif"},
      {"compare march none", "none"},
      {"compare foo bar", "expected "}};
  for (const auto& [line, why] : kLines) {
    EXPECT_EQ(view("0.1 key 258 1 0\n0.2 " + std::string(line) + '\n' + kSave, "dem.tif"), 1) << line;
    EXPECT_TRUE(output_.starts_with("scarp: error: 'events', line 3: ")) << output_;
    EXPECT_NE(output_.find(why), std::string::npos) << output_;
    EXPECT_EQ(std::count(output_.begin(), output_.end(), '\n'), 1) << output_;
    EXPECT_FALSE(fs::exists(folder_ / "scarp-view-1.png")) << line;
  }
}

TEST_F(Window, RecordingsAreReproducible) {
  const char* kFlight = "0.7 key 70 1 0\n0.8 key 87 1 0\n1.0 key 87 0 0\n1.1 key 84 1 0\n1.2 wheel 0 1\n";
  for (const char* name : {"one.png", "two.png"}) {
    ASSERT_EQ(view(std::string(kDrag) + kFlight, std::string("dem.tif --screenshot ") + name), 0) << output_;
  }
  EXPECT_GT(bytes_of("one.png").size(), 1000u);
  EXPECT_TRUE(bytes_of("one.png") == bytes_of("two.png"));
}

TEST_F(Window, ShowsTheRenderedPicture) {
  // Without the panel, the window shows the film, and nothing else.
  ASSERT_EQ(view(std::string(kDrag) + kSave, "dem.tif --screenshot window.png"), 0) << output_;
  ASSERT_TRUE(fs::exists(folder_ / "scarp-view-1.png"));
  EXPECT_TRUE(bytes_of("window.png") == bytes_of("scarp-view-1.png"));
  // The panel is on top of it.
  ASSERT_EQ(view(std::string(kDrag) + "0.7 key 258 1 0\n", "dem.tif --screenshot panel.png"), 0) << output_;
  EXPECT_FALSE(bytes_of("panel.png") == bytes_of("window.png"));
}

TEST_F(Window, ReportsErrors) {
  EXPECT_EQ(view("", "nothing.tif"), 1);
  EXPECT_NE(output_.find("scarp: error: nothing.tif: "), std::string::npos) << output_;
  EXPECT_EQ(run("env -u DISPLAY -u WAYLAND_DISPLAY '" SCARP_VIEW "' dem.tif"), 1);
  EXPECT_NE(output_.find("there is no display"), std::string::npos) << output_;
  EXPECT_EQ(view("0.1 jump\n", "dem.tif"), 1);
  EXPECT_NE(output_.find("'events', line 2: expected"), std::string::npos) << output_;
  EXPECT_EQ(view("", "dem.tif --window-device nosuch"), 1);
  EXPECT_NE(output_.find("--window-device 'nosuch': no such device"), std::string::npos) << output_;
  fs::create_symlink("/dev/full", folder_ / "full.png");
  EXPECT_EQ(view("", "dem.tif --screenshot full.png"), 1) << output_;
  EXPECT_EQ(view("", "dem.tif --screenshot window.bmp"), 1) << output_;
  EXPECT_NE(output_.find("--screenshot 'window.bmp': is written as PNG (let the name end in .png)"), std::string::npos)
      << output_;
  EXPECT_FALSE(fs::exists(folder_ / "window.bmp"));
}

TEST_F(Window, HandlesRealPressesAndDrags) {
  ASSERT_EQ(
      use("dem.tif --size 320x240 --record events",
          "xdotool mousemove 280 200 sleep 0.1 mousedown 1 sleep 0.1 mousemove_relative 30 5 sleep 0.1 mouseup 1\n"
          "xdotool click 4 sleep 0.1 keydown c sleep 0.1 keyup c sleep 0.1 key Escape"),
      0)
      << output_;
  EXPECT_TRUE(output_.starts_with("scarp render dem.tif -o picture.png --size 320x240 --eye=")) << output_;
  const std::string events = bytes_of("events");
  for (const char* event : {"button 0 1 0", "button 0 0 0", "wheel 0 1", "key 67 1 0", "key 256 1 0"})
    EXPECT_NE(events.find(event), std::string::npos) << event << '\n' << events;
}

TEST_F(Window, TypedNumbersMayHaveAComma) {
  // Into the first slider of the panel, the field of view, after Ctrl and a click; 257 is Enter.
  const auto typed = [&](const std::string& text) {
    EXPECT_EQ(view("0.1 move 60 118\n0.2 key 341 1 2\n0.3 button 0 1 2\n0.4 button 0 0 2\n0.5 key 341 0 0\n0.7 text " +
                       text + "\n0.9 key 257 1 0\n1 key 257 0 0\n1.2 key 67 1 0\n",
                   "dem.tif --screenshot window.png"),
              0)
        << output_;
    const std::size_t at = output_.find(" --fov ");
    return at == std::string::npos ? output_ : output_.substr(at + 7, output_.find('\n', at) - at - 7);
  };
  EXPECT_EQ(typed("45.5"), "45.5");
  EXPECT_EQ(typed("45,5"), "45.5");
  const std::string usual = typed("4,5.5");
  EXPECT_EQ(typed("many"), usual);
  EXPECT_NE(usual, "45.5");
}

TEST_F(Window, KeysFollowTheLayout) {
  ASSERT_EQ(use("dem.tif --size 320x240 --record events",
                "setxkbmap fr\n"
                "xdotool key m sleep 0.1 key z sleep 0.1 key m sleep 0.1 key Escape\n"
                "setxkbmap us"),
            0)
      << output_;
  const std::string events = bytes_of("events");
  // M is right of L, and Z where W is on a US keyboard.
  for (const char* event : {" key 59 1 0 77\n", " key 87 1 0 90\n"})
    EXPECT_NE(events.find(event), std::string::npos) << event << events;
}

TEST_F(Window, WorkIsNotClosedByMistake) {
  ASSERT_EQ(use("dem.tif --size 320x240",
                "xdotool key ctrl+2 sleep 0.2 key Escape sleep 0.5\n"
                "kill -0 $pid || exit 7\n"
                "xdotool key ctrl+q"),
            0)
      << output_;
  // Esc closes a list first: that of the looks.
  ASSERT_EQ(use("dem.tif --size 320x240",
                "xdotool mousemove 100 141 sleep 0.2 click 1 sleep 0.5 key Escape sleep 0.5\n"
                "kill -0 $pid || exit 7\n"
                "xdotool key Escape"),
            0)
      << output_;
}

TEST_F(Window, ViewsComeBack) {
  ASSERT_EQ(use("dem.tif --size 320x240",
                "xdotool key Tab mousemove 280 200 sleep 0.1 mousedown 1 sleep 0.1 mousemove_relative 30 5 sleep 0.1 "
                "mouseup 1\n"
                "xdotool key c sleep 0.2 key Escape"),
            0)
      << output_;
  const std::string command = output_;
  ASSERT_EQ(use("dem.tif --size 320x240", "xdotool key c sleep 0.2 key h sleep 0.2 key c sleep 0.2 key Escape"), 0);
  EXPECT_TRUE(output_.starts_with(command)) << command << output_;
  EXPECT_FALSE(output_.ends_with(command)) << "H is the first view";
  // A view that is asked for counts.
  ASSERT_EQ(use("dem.tif --size 320x240 --view 200,25", "xdotool key c sleep 0.2 key Escape"), 0);
  EXPECT_NE(output_, command);
}

TEST_F(Window, ChangedFilesAreOpenedAgain) {
  ASSERT_EQ(use("dem.tif --size 320x240",
                "xdotool key p; until [[ -e scarp-view-1.png ]]; do kill -0 $pid || exit 9; sleep 0.05; done\n"
                "'" SCARP_PROGRAM "' generate --size 129 --seed 2 -o dem.tif; sleep 2\n"
                "xdotool key p; until [[ -e scarp-view-2.png ]]; do kill -0 $pid || exit 9; sleep 0.05; done\n"
                "xdotool key Escape"),
            0)
      << output_;
  EXPECT_NE(bytes_of("scarp-view-1.png"), bytes_of("scarp-view-2.png"));
}

TEST_F(Window, EachInputHasItsOwnPath) {
  for (int i = 0; i < 2; ++i) ASSERT_EQ(view("1 key 75 1 0\n1.1 key 75 0 0\n1.2 key 75 1 0\n", "dem.tif"), 0);
  for (const char* name : {"scarp-path-1.csv", "scarp-path-2.csv"}) {
    const std::string text = bytes_of(name);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3) << text;
  }
  // A map is an eye that looks straight down.
  ASSERT_EQ(view("1 key 84 1 0\n1.1 key 84 0 0\n1.2 key 75 1 0\n", "dem.tif"), 0) << output_;
  std::istringstream row(bytes_of("scarp-path-3.csv").substr(std::string("x,y,z,tx,ty,tz\n").size()));
  double place[6];
  for (double& number : place) row >> number, row.get();
  EXPECT_TRUE(place[0] == place[3] && place[1] == place[4] && place[2] == place[5] + 1);
}

TEST_F(Window, SurvivesResizing) {
  ASSERT_EQ(use("dem.tif --size 320x240",
                "for size in '400 300' '100 90' '1 1' '639 31' '320 400'; do xdotool windowsize $window $size; done\n"
                "xdotool windowunmap $window sleep 0.3 windowmap $window sleep 0.3 windowsize --sync $window 333 222\n"
                "xdotool mousemove 300 200\n"
                "until grep -q 'converged,333,222' times.csv; do kill -0 $pid || exit 9; sleep 0.05; done\n"
                "xdotool key Escape"),
            0)
      << output_;
  // The next window is as large.
  EXPECT_EQ(bytes_of("settings/scarp/view"), "size 333 222\npanel 1\ntext 1\n");
  ASSERT_EQ(use("dem.tif --record events", "xdotool mousemove 300 200 sleep 0.1 key Escape"), 0) << output_;
  EXPECT_TRUE(bytes_of("events").starts_with("scarp-view 333x222\n"));
}

TEST_F(Window, ReportsFilesThatCannotBeSaved) {
  // No files can be written to a deleted folder. K writes at once, P when the picture is complete.
  const std::string where = folder_.string();
  for (const char* key : {"75", "80"}) {
    std::ofstream(folder_ / "events") << "scarp-view 320x240\n1 key " << key << " 1 0\n1.1 key " << key << " 0 0\n";
    EXPECT_EQ(run("(mkdir gone && cd gone && rmdir ../gone && '" SCARP_VIEW "' '" + where + "/dem.tif' --play '" +
                  where + "/events' --validation)"),
              1)
        << output_;
    EXPECT_TRUE(output_.starts_with("scarp: error: '" + where + "/events', line 2: ")) << output_;
    EXPECT_EQ(std::count(output_.begin(), output_.end(), '\n'), 1) << output_;
  }
}

// Random mouse and key events, ten per step of the clock, on the picture and on the panel.
std::string random_events(int count, unsigned seed) {
  std::mt19937 random(seed);
  const auto pick = [&](int least, int most) { return std::uniform_int_distribution<int>(least, most)(random); };
  std::string keys = "WASDQEOFGTHMKCPXRVNUZY123456789";
  std::ostringstream text;
  for (int i = 0; i < count; ++i) {
    text << i / 600.0 << ' ';
    const int kind = pick(0, 9);
    if (kind < 4) {
      const bool outside = pick(0, 19) == 0;
      text << "move " << (outside ? pick(-100'000, 100'000) : pick(0, 320)) << ' '
           << (outside ? pick(-100'000, 100'000) : pick(0, 240)) << '\n';
    } else if (kind < 6) {
      text << "button " << pick(0, 9) % 4 << ' ' << pick(0, 1) << ' ' << pick(0, 15) << '\n';
    } else if (kind == 8 && pick(0, 3) == 0) {
      constexpr const char* kTyped[] = {"1,5", "-2", "1e3", "nan", "4.5.6", "text", "\u00e4"};
      text << "text " << kTyped[pick(0, static_cast<int>(std::size(kTyped)) - 1)] << '\n';
    } else if (kind < 9) {
      constexpr int kOthers[] = {256, 257, 258, 259, 262, 263, 264, 265, 61, 45, 290, 294, 295, 340, 344, 32, 320};
      const int which = pick(0, static_cast<int>(keys.size() + std::size(kOthers)) - 1);
      const int code = which < static_cast<int>(keys.size()) ? keys[static_cast<std::size_t>(which)]
                                                             : kOthers[which - static_cast<int>(keys.size())];
      text << "key " << code << ' ' << pick(0, 1) << ' ' << pick(0, 15) << '\n';
    } else {
      text << "wheel 0 " << (pick(0, 9) == 0 ? pick(-1000, 1000) : pick(-3, 3)) << '\n';
    }
  }
  return text.str();
}

TEST_F(Window, SurvivesRandomEvents) {
  fs::create_symlink(fs::path(SCARP_SOURCE_DIR) / "examples" / "scenes", folder_ / "SCENES");
  unsigned seed = 0;
  for (const char* input : {"dem.tif", "--function hills", "SCENES/church.vox"})
    EXPECT_EQ(view(random_events(cases(100'000, 500, 500), ++seed), input), 0) << input << '\n' << output_;
}

}  // namespace
}  // namespace scarp::test
