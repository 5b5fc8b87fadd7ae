// SPDX-License-Identifier: MIT
// What makes a picture a figure: a legend of its colours, a bar of known length.
//
//     +---------------------------+                    +-----------------------------+
//     |  [####]----[####]----     |                    |  height, m                  |
//     |  0        2        4 km   |                    |  [ramp from low to high ]   |
//     +---------------------------+                    |  200      400       600     |
//      lower left: the scale bar                       +-----------------------------+
//                                                       lower right: the legend
//
// Sizes follow the picture's: text is a fortieth of its shorter side, 10 pixels at least. Drawn with Cairo, in the
// font "sans" of the system.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace scarp {

/// A place along a bar and what is written there.
struct FigureTick {
  double share = 0;  ///< of the bar's length, 0..1
  std::string text;
};

/// What the colours of a ramp mean.
struct FigureLegend {
  std::string title;
  std::vector<std::array<std::uint8_t, 3>>
      colours;  ///< sRGB, evenly spaced from the bar's left to its right; not empty
  std::vector<FigureTick> ticks;
};

/// What the colours of classes mean.
struct FigureKey {
  struct Entry {
    std::array<std::uint8_t, 3> colour;  ///< sRGB
    std::string text;
  };
  std::string title;
  std::vector<Entry> entries;
};

/// A bar of `pixels` pixels, black and white in turn between its ticks.
struct FigureScale {
  double pixels = 0;    ///< > 0
  std::string title{};  ///< may be empty
  std::vector<FigureTick> ticks;
};

struct Figure {
  std::optional<FigureLegend> legend{};
  std::optional<FigureKey> key{};  ///< in the place of the legend
  std::optional<FigureScale> scale{};
};

/// Numbers from low to high that end in 1, 2 or 5 times a power of ten, `most` at most and at least two wherever there
/// are two. low < high, most >= 2.
std::vector<double> round_numbers(double low, double high, int most);

/// Draws over a picture of 3 bytes a pixel, rows from the top. Throws Error when the picture is too small: what is
/// drawn must fit into it.
void draw_figure(std::uint8_t* rgb, int width, int height, const Figure& figure);

}  // namespace scarp
