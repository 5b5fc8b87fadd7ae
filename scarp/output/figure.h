// SPDX-License-Identifier: MIT
// Draws a legend and a scale bar over an image.
//
//     +---------------------------+                    +-----------------------------+
//     |  [####]----[####]----     |                    |  height, m                  |
//     |  0        2        4 km   |                    |  [ramp from low to high ]   |
//     +---------------------------+                    |  200      400       600     |
//      lower left: the scale bar                       +-----------------------------+
//                                                       lower right: the legend
//
// Text height is 1/40 of the image's shorter side, at least 10 pixels. Drawn with Cairo in the system's "sans" font.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace scarp {

/// A labelled position along a bar.
struct FigureTick {
  double share = 0;  ///< position as a fraction of the bar's length, 0..1
  std::string text;
};

/// Legend of a colour ramp.
struct FigureLegend {
  std::string title;
  std::vector<std::array<std::uint8_t, 3>> colours;  ///< sRGB, evenly spaced from left to right; not empty
  std::vector<FigureTick> ticks;
};

/// Legend of colour classes.
struct FigureKey {
  /// A colour and its label.
  struct Entry {
    std::array<std::uint8_t, 3> colour;  ///< sRGB
    std::string text;
  };
  std::string title;
  std::vector<Entry> entries;
};

/// A scale bar, black and white in turn between its ticks.
struct FigureScale {
  double pixels = 0;    ///< length in pixels, > 0
  std::string title{};  ///< may be empty
  std::vector<FigureTick> ticks;
};

/// A legend or key, and a scale bar.
struct Figure {
  std::optional<FigureLegend> legend{};
  std::optional<FigureKey> key{};  ///< replaces the legend
  std::optional<FigureScale> scale{};
};

/// Returns tick values in [low, high]: multiples of 1, 2 or 5 times a power of ten that is not below `least_step`, at
/// most `most`, and at least two wherever two exist. low < high, most >= 2.
std::vector<double> round_numbers(double low, double high, int most, double least_step = 0);

/// Draws over an image of 3 bytes per pixel, rows from the top. Omits labels that would touch, but never that
/// of the last tick. Throws Error if the image is too small for the figure.
void draw_figure(std::uint8_t* rgb, int width, int height, const Figure& figure);

}  // namespace scarp
