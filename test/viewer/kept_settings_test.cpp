// SPDX-License-Identifier: MIT
// Saved settings of the window are read as written; errors in the file have no effect.
#include "app/viewer/kept_settings.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace scarp::viewer {
namespace {

namespace fs = std::filesystem;

struct Settings : testing::Test {
  fs::path folder = fs::temp_directory_path() / ("scarp-settings-" + std::to_string(::getpid()));
  std::string file = folder / "scarp" / "view";
  ~Settings() override { fs::remove_all(folder); }
};

TEST_F(Settings, RoundTrip) {
  ASSERT_TRUE(write_settings(file, {800, 600, false, 1.5}));
  const KeptSettings read = read_settings(file);
  EXPECT_EQ(read.width, 800);
  EXPECT_EQ(read.height, 600);
  EXPECT_FALSE(read.panel);
  EXPECT_EQ(read.text, 1.5);
}

TEST(TextSize, StaysInItsTable) {
  EXPECT_EQ(text_size_after(1, 1), 1.25);
  EXPECT_EQ(text_size_after(1, -1), 1);
  EXPECT_EQ(text_size_after(2, 1), 2);
  EXPECT_EQ(text_size_after(1.4, 0), 1.5);
  EXPECT_EQ(text_size_after(9, 0), 2);
}

TEST_F(Settings, FallBackToDefaults) {
  EXPECT_EQ(read_settings(file).width, 0) << "chosen for the screen";
  fs::create_directories(folder / "scarp");
  std::ofstream(file) << "size 0 -3\npanel 0\ntext none\nsize 99999 5 nonsense";
  const KeptSettings read = read_settings(file);
  EXPECT_EQ(read.width, 0);
  EXPECT_EQ(read.height, 0);
  EXPECT_FALSE(read.panel);
  EXPECT_FALSE(write_settings("/proc/nowhere/view", {}));
  EXPECT_FALSE(write_settings("", {}));
}

TEST_F(Settings, UseTheFolderFromTheEnvironment) {
  ::setenv("XDG_CONFIG_HOME", folder.c_str(), 1);
  EXPECT_EQ(settings_file(), file);
  ::setenv("XDG_CONFIG_HOME", "relative", 1);
  ::setenv("HOME", folder.c_str(), 1);
  EXPECT_EQ(settings_file(), (folder / ".config" / "scarp" / "view").string());
}

}  // namespace
}  // namespace scarp::viewer
