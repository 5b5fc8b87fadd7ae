// SPDX-License-Identifier: MIT
// Two pictures in one window, and the text of a verdict.
#include "app/viewer/split.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "app/viewer/verdict_text.h"

namespace scarp::viewer {
namespace {

Image plain(int width, int height, std::uint8_t grey) {
  Image image(width, height);
  std::fill(image.rgb.begin(), image.rgb.end(), grey);
  return image;
}

TEST(Split, ShowsEachPictureOnItsSide) {
  const Image left = plain(7, 3, 10), right = plain(7, 3, 200);
  for (int column = 0; column <= 7; ++column) {
    const Image both = split_image(left, right, column);
    for (int y = 0; y < 3; ++y) {
      for (int x = 0; x < 7; ++x) EXPECT_EQ(both.pixel(x, y)[2], x < column ? 10 : 200) << x << ' ' << y;
    }
  }
}

TEST(Split, ScalesByNearestPixel) {
  Image image(3, 2);
  for (int i = 0; i < 6; ++i) std::fill_n(image.pixel(i % 3, i / 3), 3, static_cast<std::uint8_t>(10 * i));
  // Centres of 7 pixels mapped to 3 columns, and of 4 mapped to 2 rows.
  constexpr int kColumns[] = {0, 0, 1, 1, 1, 2, 2}, kRows[] = {0, 0, 1, 1};
  const Image to = stretched(image, 7, 4);
  ASSERT_EQ(to.width, 7);
  ASSERT_EQ(to.height, 4);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 7; ++x) EXPECT_EQ(to.pixel(x, y)[1], 10 * (3 * kRows[y] + kColumns[x])) << x << ' ' << y;
  }
  EXPECT_EQ(stretched(image, 3, 2).rgb, image.rgb);
  EXPECT_EQ(stretched(image, 1, 1).rgb, (std::vector<std::uint8_t>{40, 40, 40}));
}

TEST(Split, LineCanBeDragged) {
  SplitLine line;
  EXPECT_EQ(line.column(640), 320);
  EXPECT_TRUE(line.is_at({322, 10}, {640, 480}));
  EXPECT_FALSE(line.is_at({340, 10}, {640, 480}));
  line.drag_to(160, 640);
  EXPECT_EQ(line.column(640), 160);
  // The line is at the same relative position in pictures of other sizes.
  EXPECT_EQ(line.column(64), 16);
  line.drag_to(-50, 640);
  EXPECT_EQ(line.column(640), 0);
  line.drag_to(10'000, 640);
  EXPECT_EQ(line.column(640), 640);
}

TEST(VerdictText, CountsErrors) {
  EXPECT_EQ(verdict_text({}), "");
  JudgedRays judged;
  judged.mean_steps = 23.44;
  const auto set = [&](Verdict verdict, int rays) { judged.rays[static_cast<std::size_t>(verdict)] = rays; };
  set(Verdict::right_hit, 900), set(Verdict::right_miss, 90), set(Verdict::not_judged, 7);
  EXPECT_EQ(verdict_text(judged), "23.4 steps per ray; 0 of 997 sampled rays wrong");
  set(Verdict::lost, 2), set(Verdict::early, 1);
  EXPECT_EQ(verdict_text(judged), "23.4 steps per ray; 3 of 1000 sampled rays wrong: 2 lost, 1 early");
}

}  // namespace
}  // namespace scarp::viewer
