// SPDX-License-Identifier: MIT
// Failures in the window: surface, device, driver, disk and files. It continues with its last picture, or exits with
// one line and status 1.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "viewer/window_case.h"

namespace scarp::test {
namespace {

namespace fs = std::filesystem;

class WindowFaults : public Window {
 protected:
  // Plays a drag while Vulkan calls fail, as described in lost_surface.cpp.
  int lose(const std::string& plan, const std::string& screenshot) {
    std::ofstream(folder_ / "events") << "scarp-view 320x240\n0.1 key 258 1 0\n0.1 key 258 0 0\n0.2 move 200 120\n"
                                         "0.2 button 0 1 0\n0.25 move 260 125\n0.3 button 0 0 0\n";
    return run("env LD_PRELOAD='" LOST_SURFACE "' LOSE=" + plan +
               " '" SCARP_VIEW "' dem.tif --play events --validation --screenshot " + screenshot);
  }
  bool is_one_line(const std::string& text) const {
    return output_.find("scarp: error: ") != std::string::npos && output_.find(text) != std::string::npos &&
           std::count(output_.begin(), output_.end(), '\n') == 1;
  }
  int files_like(const std::string& part) const {
    int count = 0;
    for (const auto& entry : fs::directory_iterator(folder_))
      count += entry.path().filename().string().find(part) != std::string::npos;
    return count;
  }
};

TEST_F(WindowFaults, ReopensALostSurface) {
  ASSERT_EQ(lose("acquire:suboptimal:0:0", "whole.png"), 0) << output_;
  ASSERT_EQ(output_, "");
  for (const std::string place : {"acquire", "present"}) {
    for (const std::string what : {"out-of-date", "suboptimal", "surface"}) {
      // The first call fails, or more calls in a row than one frame retries.
      for (const std::string when : {":1:1", ":10:12"}) {
        const std::string plan = place + ":" + what + when;
        ASSERT_EQ(lose(plan, "now.png"), 0) << plan << '\n' << output_;
        EXPECT_NE(output_.find("lost: " + what), std::string::npos) << plan;
        EXPECT_EQ(output_.find("lost: destroyed") != std::string::npos, what == "surface") << plan;
        EXPECT_EQ(output_.find("validation"), std::string::npos) << plan << '\n' << output_;
        EXPECT_TRUE(bytes_of("now.png") == bytes_of("whole.png")) << plan;
      }
    }
  }
}

TEST_F(WindowFaults, ReportsALostDevice) {
  for (const std::string plan : {"acquire:device:1:1", "acquire:device:20:1", "present:device:20:1"}) {
    EXPECT_EQ(lose(plan, "now.png"), 1) << plan << '\n' << output_;
    output_.erase(0, std::string("lost: device\n").size());
    EXPECT_TRUE(is_one_line("the device was lost")) << plan << '\n' << output_;
  }
}

TEST_F(WindowFaults, ReportsMissingOrInvalidInputInOneLine) {
  EXPECT_EQ(run("env VK_ICD_FILENAMES=/nonexistent VK_DRIVER_FILES=/nonexistent '" SCARP_VIEW "' dem.tif"), 1);
  EXPECT_TRUE(is_one_line("Vulkan")) << output_;
  EXPECT_EQ(run("env DISPLAY=:9999 WAYLAND_DISPLAY= '" SCARP_VIEW "' dem.tif"), 1);
  EXPECT_TRUE(is_one_line("display")) << output_;
  std::ofstream(folder_ / "empty.tif");
  std::ofstream(folder_ / "wrong.json") << "{\"objects\": [{\"height\": 3}]}";
  fs::create_directory(folder_ / "nothing");
  for (const char* input : {"nothing", "empty.tif", "wrong.json", "/dev/null"}) {
    EXPECT_EQ(run("timeout 60 '" SCARP_VIEW "' " + std::string(input)), 1) << input << '\n' << output_;
    EXPECT_TRUE(is_one_line(": ")) << input << '\n' << output_;
  }
  const std::string dem = bytes_of("dem.tif");
  fs::copy_file(folder_ / "dem.tif", folder_ / "dem.png");
  for (const char* arguments : {"dem.tif --timings dem.tif", "dem.png --screenshot dem.png"}) {
    EXPECT_EQ(view("", arguments), 1) << arguments;
    EXPECT_TRUE(is_one_line("is the input")) << output_;
  }
  EXPECT_TRUE(bytes_of("dem.tif") == dem && bytes_of("dem.png") == dem);
}

TEST_F(WindowFaults, FullDiskLeavesNoPartialPicture) {
  // A limit on the size of files, in KiB, simulates a full disk: writing fails in the same way.
  ASSERT_EQ(use("dem.tif --size 320x240",
                "prlimit --fsize=1024: --pid $pid\n"
                "for i in {1..20}; do xdotool key k sleep 0.1; done\n"
                "xdotool key p sleep 0.5 key c sleep 0.2\n"
                "prlimit --fsize=unlimited: --pid $pid\n"
                "xdotool key p sleep 0.5 key Escape"),
            0)
      << output_;
  const std::string path = bytes_of("scarp-path-1.csv");
  EXPECT_TRUE(path.starts_with("x,y,z,tx,ty,tz\n") && path.ends_with('\n')) << path;
  EXPECT_TRUE(path.size() > 700 && path.size() <= 1024) << path.size();
  // The first picture that could be saved has the first name, and no other file is left.
  EXPECT_EQ(files_like("scarp-view"), 1);
  EXPECT_EQ(files_like(".png"), 1);
  EXPECT_EQ(files_like("scarp-path"), 1);
  EXPECT_TRUE(output_.starts_with("scarp render ")) << output_;
  EXPECT_NE(output_.find("scarp-view-1.png: scarp render"), std::string::npos) << output_;
  ASSERT_EQ(run("cp scarp-view-1.png saved.png && " + printed_command("again.png")), 0) << output_;
  EXPECT_TRUE(bytes_of("saved.png") == bytes_of("again.png"));
}

TEST_F(WindowFaults, MissingFileKeepsTheLastPicture) {
  // F5 opens the input again. Errors show the panel, which was hidden by Tab.
  ASSERT_EQ(
      use("dem.tif --size 320x240 --record events",
          "save() { xdotool key p; until [[ -e scarp-view-$1.png ]]; do kill -0 $pid || exit 9; sleep 0.05; done; }\n"
          "again() { xdotool key F5 sleep 0.5; }\n"
          "xdotool key Tab sleep 0.1; save 1\n"
          "mv dem.tif away.tif; again; save 2\n"
          "head -c 2000 away.tif >dem.tif; again; save 3\n"
          "mv away.tif dem.tif; again; save 4\n"
          "'" SCARP_PROGRAM "' generate --size 129 --seed 2 -o dem.tif; again; save 5\n"
          "xdotool key Escape"),
      0)
      << output_;
  EXPECT_EQ(bytes_of("settings/scarp/view"), "size 320 240\npanel 0\ntext 1\n");
  const std::string first = bytes_of("scarp-view-1.png");
  EXPECT_TRUE(bytes_of("scarp-view-2.png") == first) << "without the file";
  EXPECT_TRUE(bytes_of("scarp-view-3.png") == first) << "with half of the file";
  EXPECT_TRUE(bytes_of("scarp-view-4.png") == first) << "with the file again";
  EXPECT_FALSE(bytes_of("scarp-view-5.png") == first) << "with another file";
  ASSERT_EQ(run(printed_command("again.png")), 0) << output_;
  EXPECT_TRUE(bytes_of("scarp-view-5.png") == bytes_of("again.png"));
}

TEST_F(WindowFaults, SceneErrorKeepsTheLastPicture) {
  const std::string scene = R"({"camera": {"eye": [0, -9, 3], "target": [0, 0, 0]},
                                "objects": [{"shape": {"sphere": {"radius": 2}}}]})";
  std::ofstream(folder_ / "scene.json") << scene;
  ASSERT_EQ(use("scene.json --size 320x240",
                "xdotool key Tab sleep 0.1\n"
                "sed -i s/radius/rade/ scene.json; xdotool key F5 sleep 0.5 key p sleep 0.5 key Escape"),
            0)
      << output_;
  EXPECT_EQ(bytes_of("settings/scarp/view"), "size 320 240\npanel 0\ntext 1\n");
  std::ofstream(folder_ / "scene.json") << scene;
  ASSERT_EQ(run(printed_command("again.png")), 0) << output_;
  EXPECT_TRUE(bytes_of("scarp-view-1.png") == bytes_of("again.png"));
}

TEST_F(WindowFaults, CtrlCClosesTheWindowWhileConverging) {
  // A picture that takes minutes. The window skips passes that were replaced before it could show them, the full one
  // too. Shells start background jobs with this signal ignored.
  std::ofstream(folder_ / "end.sh")
      << "env --default-signal=INT '" SCARP_VIEW
         "' dem.tif --size 320x240 --samples 1024 --aa 16 --timings times.csv &\n"
         "pid=$!\n"
         "until grep -qsE 'full|refining' times.csv; do kill -0 $pid || exit 9; sleep 0.05; done\n"
         "kill -INT $pid; wait $pid\n";
  EXPECT_EQ(run("timeout 120 bash end.sh"), 128 + SIGINT) << output_;
  EXPECT_EQ(output_, "scarp: interrupted\n");
}

}  // namespace
}  // namespace scarp::test
