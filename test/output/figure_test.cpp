// SPDX-License-Identifier: MIT
#include "scarp/output/figure.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

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
  RgbView view() const { return {rgb.data(), width, height}; }
  void draw(const Figure& figure) {
    FigureImage drawn = draw_figure(view(), figure);
    width = drawn.width, height = drawn.height;
    rgb = std::move(drawn.rgb);
  }
  // The box around the pixels that differ from the colour.
  std::array<int, 4> box_of_others(Colour colour, int x0 = 0, int y0 = 0, int x1 = 1 << 20, int y1 = 1 << 20) const {
    std::array<int, 4> box{width, height, -1, -1};
    for (int y = y0; y < std::min(y1, height); ++y) {
      for (int x = x0; x < std::min(x1, width); ++x) {
        if (at(x, y) == colour) continue;
        box = {std::min(box[0], x), std::min(box[1], y), std::max(box[2], x), std::max(box[3], y)};
      }
    }
    return box;
  }
};

constexpr Colour kGround{90, 90, 90}, kPaper{255, 255, 255};

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
TEST(Figure, LabelsDoNotOverlap) {
  const auto longest = [](const std::vector<FigureTick>& ticks) {
    Canvas canvas;
    canvas.draw({.legend = FigureLegend{"", {{90, 90, 90}, {90, 90, 90}}, ticks}});
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

TEST(Figure, ScaleBarAndLegendDoNotOverlap) {
  Canvas canvas;
  const FigureLegend legend{"steps", {{1, 2, 3}}, {{0, "0"}, {1, "1"}}};
  const auto draw = [&](double pixels) {
    canvas.draw({.legend = legend, .scale = FigureScale{pixels, "", {{0, ""}, {1, ""}}}});
  };
  draw(200);
  const std::vector<std::uint8_t> before = canvas.rgb;
  EXPECT_THROW(draw(450), Error);
  EXPECT_EQ(canvas.rgb, before);
}

TEST(Figure, ScaleBarHasItsStatedLength) {
  Canvas canvas;
  canvas.draw({.scale = FigureScale{200, "", {{0, ""}, {1, ""}}}});
  // One piece, black: the longest run of black pixels in any row, including half an outline at either end.
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

TEST(Figure, LegendShowsItsColours) {
  Canvas canvas;
  const std::vector<Colour> colours{{200, 10, 20}, {30, 210, 40}, {50, 60, 220}};
  canvas.draw({.legend = FigureLegend{"height, m", colours, {{0, "0"}, {1, "1000"}}}});
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
  EXPECT_NEAR(counts[0], counts[2], 0.2 * counts[1]);  // except for the outline
  EXPECT_GT(first[0], canvas.width / 3);               // on the right
}

TEST(Figure, RejectsPicturesThatAreTooSmall) {
  std::vector<std::uint8_t> rgb(std::size_t{3} * 64 * 48);
  const Figure figure{.scale = FigureScale{100, "", {{0, "0"}, {1, "1 km"}}}};
  EXPECT_THROW(draw_figure({rgb.data(), 64, 48}, figure), Error);
}

Figure whole_figure(FigureLayout layout) {
  Figure figure;
  figure.title = "Heights of the Jacksboro fault";
  figure.legend = FigureLegend{"height, m", {{200, 10, 20}, {30, 210, 40}}, {{0, "0"}, {1, "1000"}}};
  figure.scale = FigureScale{100, "", {{0, "0"}, {1, "1 km"}}};
  figure.north = 0;
  figure.graticule = {{{{-10, 200}, {700, 200}}, "36°30'N", false}, {{{320, 500}, {320, -20}}, "84°W", true}};
  figure.layout = layout;
  return figure;
}

TEST(Figure, BesideLayoutKeepsThePicture) {
  Figure figure = whole_figure(FigureLayout::beside);
  figure.graticule.clear();
  Canvas canvas;
  canvas.draw(figure);
  EXPECT_GT(canvas.width, 640);
  EXPECT_GT(canvas.height, 480 + 50);
  // The frame is a line around the picture; everything inside is the picture.
  int left = 0, top = 0;
  while (canvas.at(left, 200) != kGround) ++left;
  while (canvas.at(left, top) != kGround) ++top;
  EXPECT_EQ(canvas.box_of_others(kGround, left, top, left + 640, top + 480)[2], -1);
  EXPECT_NE(canvas.at(left - 1, top), kGround);
  // The title is above, everything else below, and nothing is cut off.
  EXPECT_LT(canvas.box_of_others(kPaper, 0, 0, 1 << 20, top - 3)[3], top);
  EXPECT_GT(canvas.box_of_others(kPaper, 0, top + 484)[2], canvas.width / 2);
  const auto all = canvas.box_of_others(kPaper);
  EXPECT_GE(all[0], 2);
  EXPECT_GE(all[1], 2);
  EXPECT_LE(all[2], canvas.width - 3);
  EXPECT_LE(all[3], canvas.height - 3);
}

// A meridian at either border: half of its label is outside the border.
TEST(Figure, BesideLayoutKeepsGraticuleLabelsWhole) {
  for (const double x : {1.0, 639.0}) {
    Canvas canvas;
    canvas.draw({.graticule = {{{{x, -5}, {x, 500}}, "122°07'12\"W", true}}, .layout = FigureLayout::beside});
    const auto all = canvas.box_of_others(kPaper);
    EXPECT_GE(all[0], 2) << x;
    EXPECT_GE(all[1], 2) << x;
    EXPECT_LE(all[2], canvas.width - 3) << x;
  }
}

TEST(Figure, BesideLayoutFitsTinyPictures) {
  Canvas canvas;
  canvas.width = canvas.height = 30;
  canvas.rgb.resize(3 * 30 * 30);
  Figure figure = whole_figure(FigureLayout::beside);
  figure.title = "Heights";
  canvas.draw(figure);
  const auto all = canvas.box_of_others(kPaper);
  EXPECT_GE(all[0], 2);
  EXPECT_LE(all[2], canvas.width - 3);
  EXPECT_LE(all[3], canvas.height - 3);
}

TEST(Figure, ArrowPointsNorth) {
  // The arrow's left half is black: the picture's mean of black pixels is on the left of the direction.
  for (const double north : {0.0, 1.5707963267948966}) {
    Canvas canvas;
    canvas.draw({.north = north});
    double x = 0, y = 0, count = 0;
    for (int j = 0; j < 80; ++j) {
      for (int i = 540; i < 640; ++i) {
        if (canvas.at(i, j) != Colour{0, 0, 0}) continue;
        x += i, y += j, ++count;
      }
    }
    const auto box = canvas.box_of_others(kGround);
    const double to_left = x / count - (box[0] + box[2]) / 2.0, down = y / count - (box[1] + box[3]) / 2.0;
    if (north == 0) {
      EXPECT_LT(to_left, -1);
    } else {
      EXPECT_LT(down, -1);
    }
  }
}

TEST(Figure, LabelsAvoidEachOtherAndThePanels) {
  const FigureLabel label{{320, 240}, 0, "1500"};
  Canvas one, three, covered;
  one.draw({.labels = {label}});
  FigureLabel near = label, other = label;
  near.centre.x += 60;
  other.text = "1600";
  other.centre.y += 5;
  three.draw({.labels = {label, near, other}});
  EXPECT_EQ(one.rgb, three.rgb);
  EXPECT_NE(one.rgb, covered.rgb);
  Figure figure{.north = 0};
  Canvas arrow, same;
  arrow.draw(figure);
  figure.labels = {{{620, 30}, 0.5, "1500"}};
  same.draw(figure);
  EXPECT_EQ(arrow.rgb, same.rgb);
}

TEST(Figure, TitlesWrapOrAreRejected) {
  std::string title = "word";
  for (int i = 0; i < 12; ++i) title += " another";
  Canvas canvas;
  EXPECT_NO_THROW(canvas.draw({.title = title}));
  for (int i = 0; i < 100; ++i) title += " another";
  EXPECT_THROW(canvas.draw({.title = title}), Error);
  EXPECT_THROW(canvas.draw({.title = std::string(200, 'x')}), Error);
  EXPECT_TRUE(is_figure_text("Größe: 5 °C"));
  EXPECT_FALSE(is_figure_text("\xff\xfe"));
}

// Content of the page: its size in points, and labels as text in the system's font.
TEST(Pdf, HasThePageSizeAndText) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("scarp-figure-" + std::to_string(::getpid()) + ".pdf");
  const Canvas canvas;
  ReplaceFile file(path.string());
  write_pdf(file, path.string(), canvas.view(), whole_figure(FigureLayout::on), 150);
  std::ifstream in(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  std::filesystem::remove(path);
  EXPECT_TRUE(bytes.starts_with("%PDF-"));
  EXPECT_NE(bytes.find("/MediaBox [ 0 0 307.2 230.4"), std::string::npos);
  EXPECT_NE(bytes.find("/ToUnicode"), std::string::npos);
  EXPECT_NE(bytes.find("/Width 640"), std::string::npos);
}

}  // namespace
}  // namespace scarp::test
