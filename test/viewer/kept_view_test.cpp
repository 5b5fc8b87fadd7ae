// SPDX-License-Identifier: MIT
// Views of inputs are read as kept, and files that are written are noticed.
#include "app/viewer/kept_view.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "app/viewer/file_watch.h"
#include "scratch.h"

namespace scarp::viewer {
namespace {

using test::Scratch;

Pose some_pose(MoveMode mode) {
  Pose pose;
  pose.mode = mode;
  pose.eye = {1234.5678901234567, -0.1, 1e-9};
  pose.azimuth = 1.0 / 3, pose.altitude = -0.25, pose.distance = 17, pose.fov_deg = 61.5, pose.map_width = 1e5;
  return pose;
}

bool same(const Pose& a, const Pose& b) {
  return a.mode == b.mode && a.eye == b.eye && a.azimuth == b.azimuth && a.altitude == b.altitude &&
         a.distance == b.distance && a.fov_deg == b.fov_deg && a.map_width == b.map_width;
}

TEST(KeptViews, RoundTrip) {
  const Scratch scratch;
  const std::string file = scratch.path("scarp/views/dem");
  for (const MoveMode mode : {MoveMode::orbit, MoveMode::fly, MoveMode::walk, MoveMode::top}) {
    KeptView view;
    view.pose = some_pose(mode);
    view.bookmarks[8] = some_pose(MoveMode::top);
    view.line = {{1, 2, 1.0 / 3}, {4, 5, 6}};
    ASSERT_TRUE(write_view(file, view));
    const KeptView read = read_view(file);
    ASSERT_TRUE(read.pose && read.bookmarks[8] && read.line);
    EXPECT_TRUE(same(*read.pose, *view.pose) && same(*read.bookmarks[8], *view.bookmarks[8]));
    EXPECT_EQ(read.line, view.line);
    EXPECT_FALSE(read.bookmarks[0]);
  }
  EXPECT_FALSE(write_view("", {}));
}

TEST(KeptViews, WrongLinesHaveNoEffect) {
  const Scratch scratch;
  const std::string file = scratch.write(
      "view",
      "view sail 1 2 3 4 5 6 7 8\nbookmark 0 fly 1 2 3 0 0 6 30 8\nbookmark 10 fly 1 2 3 0 0 6 30 8\n"
      "bookmark 1 fly nan 2 3 0 0 6 30 8\nbookmark 2 fly 1 2 3 0 0 -6 30 8\nbookmark 3 fly 1 2 3 0 0 6 300 8\n"
      "line 1 2\nbookmark 4 fly 1 2 3 0 0 6 30 8\n\n\xff\n");
  const KeptView view = read_view(file);
  EXPECT_FALSE(view.pose || view.line);
  for (std::size_t i = 0; i < view.bookmarks.size(); ++i) EXPECT_EQ(view.bookmarks[i].has_value(), i == 3) << i;
  EXPECT_FALSE(read_view(scratch.path("none")).pose);
}

TEST(KeptViews, EachInputHasItsOwn) {
  const Scratch scratch;
  const std::string settings = scratch.path("scarp/view");
  std::filesystem::create_directories(scratch.path("a"));
  const std::string one = scratch.write("dem.tif", ""), other = scratch.write("a/dem.tif", "");
  EXPECT_NE(view_file(settings, {one}), view_file(settings, {other}));
  EXPECT_NE(view_file(settings, {one}), view_file(settings, {one, other}));
  EXPECT_EQ(view_file(settings, {other}), view_file(settings, {scratch.path("a/../a/dem.tif")}));
  EXPECT_EQ(view_file(settings, {}), "");
  EXPECT_EQ(view_file(settings, {scratch.path("none.tif")}), "");
  EXPECT_EQ(view_file("", {one}), "");
}

TEST(FileWatch, NoticesFilesThatWereWritten) {
  const Scratch scratch;
  const std::string file = scratch.write("dem.tif", "1");
  FileWatch watch({file});
  EXPECT_FALSE(watch.changed());
  scratch.write("dem.tif", "12");
  EXPECT_FALSE(watch.changed()) << "still written, perhaps";
  EXPECT_TRUE(watch.changed());
  EXPECT_FALSE(watch.changed());
  std::filesystem::remove(file);
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(watch.changed()) << "gone";
  scratch.write("dem.tif", "123");
  EXPECT_FALSE(watch.changed());
  EXPECT_TRUE(watch.changed());
}

}  // namespace
}  // namespace scarp::viewer
