// SPDX-License-Identifier: MIT
// The places of panel and picture, and the verdict on one pixel.
#include "app/viewer/layout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "app/viewer/verdict_text.h"

namespace scarp::viewer {
namespace {

TEST(Layout, PictureIsBesideThePanelInWideWindows) {
  for (const int width : {800, 1280, 3840}) {
    const WindowLayout layout = layout_of(width, 600, true, 1);
    EXPECT_TRUE(layout.beside) << width;
    EXPECT_EQ(layout.left, 360);
    EXPECT_EQ(layout.width, width - 360);
    EXPECT_EQ(layout.height, 600);
    // The middle of the picture is that of what the panel leaves free.
    const dvec2 middle = layout.in_picture({360 + (width - 360) / 2.0, 300});
    EXPECT_EQ(middle.x, layout.width / 2.0);
    EXPECT_FALSE(layout.contains({359, 10}));
    EXPECT_TRUE(layout.contains({360, 10}));
    EXPECT_FALSE(layout.contains({360, 600}));
  }
}

TEST(Layout, PictureFillsOtherWindows) {
  for (const auto& [width, panel, scale] :
       {std::tuple{779, true, 1.0}, {1280, false, 1.0}, {1280, true, 2.0}, {1, true, 1.0}}) {
    const WindowLayout layout = layout_of(width, 480, panel, scale);
    EXPECT_FALSE(layout.beside) << width;
    EXPECT_EQ(layout.left, 0);
    EXPECT_EQ(layout.width, width);
    EXPECT_LE(layout.panel_width, std::max(width, 1)) << width;
  }
}

TEST(Layout, ScalesThePanel) {
  EXPECT_EQ(layout_of(2560, 1440, true, 2).left, 720);
  EXPECT_EQ(layout_of(2560, 1440, true, 1.5).left, 540);
}

TEST(PixelText, SaysStepsAndError) {
  EXPECT_EQ(pixel_text({.steps = 12}), "12 steps here");
  EXPECT_EQ(pixel_text({.steps = 1, .verdict = Verdict::right_hit}), "1 step here: right hit");
  EXPECT_EQ(pixel_text({.steps = 7, .verdict = Verdict::early, .error_m = 3.214}), "7 steps here: early by 3.21 m");
}

}  // namespace
}  // namespace scarp::viewer
