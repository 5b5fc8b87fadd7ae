// SPDX-License-Identifier: MIT
#include "scarp/output/figure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "scarp/base/error.h"

namespace scarp::test {
namespace {

using Colour = std::array<std::uint8_t, 3>;

struct Canvas {
  int width = 640, height = 480;
  std::vector<std::uint8_t> rgb = std::vector<std::uint8_t>(std::size_t{3} * 640 * 480, 90);

  Colour at(int x, int y) const {
    const std::uint8_t* p = rgb.data() + 3 * (std::size_t{1} * y * width + x);
    return {p[0], p[1], p[2]};
  }
};

TEST(Figure, NumbersAreRoundAndCoverTheRange) {
  for (const auto& [low, high] :
       {std::pair{212.0, 611.0}, {-3.7, 9.1}, {0.001, 0.0023}, {8847.9, 8848.1}, {-1e5, 3e6}}) {
    const std::vector<double> numbers = round_numbers(low, high, 6);
    ASSERT_GE(numbers.size(), 2u) << low;
    ASSERT_LE(numbers.size(), 6u) << low;
    EXPECT_GE(numbers.front(), low);
    EXPECT_LE(numbers.back(), high);
    const double step = numbers[1] - numbers[0], power = std::pow(10.0, std::floor(std::log10(step) + 1e-9));
    const double digit = step / power;
    EXPECT_TRUE(std::abs(digit - 1) < 1e-6 || std::abs(digit - 2) < 1e-6 || std::abs(digit - 5) < 1e-6) << step;
  }
}

TEST(Figure, NumbersHaveNoNegativeZero) {
  for (const double number : round_numbers(-0.5, 9, 6)) EXPECT_FALSE(number == 0 && std::signbit(number));
}

TEST(Figure, NumbersAreWholeOnRequest) {
  EXPECT_EQ(round_numbers(0, 1, 6, 1), (std::vector<double>{0, 1}));
  EXPECT_EQ(round_numbers(0, 7, 6, 1), (std::vector<double>{0, 2, 4, 6}));
  EXPECT_EQ(round_numbers(0.5, 2.5, 6, 1), (std::vector<double>{1, 2}));
  EXPECT_EQ(round_numbers(0, 1, 6).size(), 6u);
}

// The longest piece of the line of labels without a gap of some pixels: one label.
TEST(Figure, LabelsDoNotTouch) {
  const auto longest = [](const std::vector<FigureTick>& ticks) {
    Canvas canvas;
    draw_figure(canvas.rgb.data(), canvas.width, canvas.height,
                {.legend = FigureLegend{"", {{90, 90, 90}, {90, 90, 90}}, ticks}});
    const int low = canvas.height - 31, high = canvas.height - 20;
    int most = 0, begin = -1, end = -1;
    for (int x = 0; x < canvas.width; ++x) {
      bool ink = false;
      for (int y = low; y < high; ++y) ink |= canvas.at(x, y)[0] < 120;
      if (!ink) continue;
      if (begin < 0 || x - end > 4) begin = x;
      end = x;
      most = std::max(most, end - begin + 1);
    }
    return most;
  };
  std::vector<FigureTick> ticks;
  for (int i = 0; i < 6; ++i) ticks.push_back({0.2 * i, "8847.925"});
  const int one = longest({ticks.back()});
  EXPECT_GT(one, 30);
  EXPECT_LE(longest(ticks), one + 2) << "rounded to whole pixels";
}

TEST(Figure, TheBarAndTheLegendDoNotOverlap) {
  Canvas canvas;
  const FigureLegend legend{"steps", {{1, 2, 3}}, {{0, "0"}, {1, "1"}}};
  const auto draw = [&](double pixels) {
    draw_figure(canvas.rgb.data(), canvas.width, canvas.height,
                {.legend = legend, .scale = FigureScale{pixels, "", {{0, ""}, {1, ""}}}});
  };
  draw(200);
  const std::vector<std::uint8_t> before = canvas.rgb;
  EXPECT_THROW(draw(450), Error);
  EXPECT_EQ(canvas.rgb, before);
}

TEST(Figure, TheBarIsAsLongAsSaid) {
  Canvas canvas;
  draw_figure(canvas.rgb.data(), canvas.width, canvas.height, {.scale = FigureScale{200, "", {{0, ""}, {1, ""}}}});
  // One piece, black: the longest run of black pixels in any row, the outline's half a line at either end included.
  int longest = 0;
  for (int y = 0; y < canvas.height; ++y) {
    int run = 0;
    for (int x = 0; x < canvas.width; ++x) {
      run = canvas.at(x, y) == Colour{0, 0, 0} ? run + 1 : 0;
      longest = std::max(longest, run);
    }
  }
  EXPECT_NEAR(longest, 200, 1);
  EXPECT_EQ(canvas.at(canvas.width / 2 + 50, canvas.height / 4), (Colour{90, 90, 90}));
}

TEST(Figure, TheLegendHasTheColoursItExplains) {
  Canvas canvas;
  const std::vector<Colour> colours{{200, 10, 20}, {30, 210, 40}, {50, 60, 220}};
  draw_figure(canvas.rgb.data(), canvas.width, canvas.height,
              {.legend = FigureLegend{"height, m", colours, {{0, "0"}, {1, "1000"}}}});
  std::array<int, 3> first{}, counts{};
  for (int y = canvas.height - 1; y >= 0; --y) {
    for (int x = canvas.width - 1; x >= 0; --x) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (canvas.at(x, y) == colours[k]) first[k] = x, ++counts[k];
      }
    }
  }
  EXPECT_LT(first[0], first[1]);
  EXPECT_LT(first[1], first[2]);
  EXPECT_GT(counts[1], 100);
  EXPECT_NEAR(counts[0], counts[2], 0.2 * counts[1]);  // but for the outline
  EXPECT_GT(first[0], canvas.width / 3);               // on the right
}

TEST(Figure, NeedsRoom) {
  std::vector<std::uint8_t> rgb(std::size_t{3} * 64 * 48);
  EXPECT_THROW(draw_figure(rgb.data(), 64, 48, {.scale = FigureScale{100, "", {{0, "0"}, {1, "1 km"}}}}), Error);
  EXPECT_EQ(std::set<std::uint8_t>(rgb.begin(), rgb.end()).size(), 1u);
}

}  // namespace
}  // namespace scarp::test
