// SPDX-License-Identifier: MIT
// Draws the annotations of a picture: title, legend, scale bar, north arrow, graticule, labels of contour lines,
// points, lines and areas, strips.
//
//     +-----------------------------------------+     A title
//     |               A title              N    |        84°W    83°W
//     |                                    ^    |     +----------------------+
//     |      the picture                        |  37°N   the picture        |
//     |                                         |     +----------------------+
//     | [##]--[##]--    [ramp, low to high]     |     [##]--[##]--    N   [ramp, low to high]
//     | 0    2    4 km  200    400    600       |     0    2    4 km  ^   200    400    600
//     +-----------------------------------------+
//      FigureLayout::on                               FigureLayout::beside
//
// Text height is 1/40 of the picture's shorter side, at least 10 pixels; labels of contour lines are smaller. Drawn
// with Cairo in the system's "sans" font: the functions require a build with Cairo (SCARP_CAIRO).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scarp/base/replace_file.h"
#include "scarp/output/rgb_view.h"

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

/// A scale bar that alternates between black and white at its ticks.
struct FigureScale {
  double pixels = 0;    ///< length in pixels, > 0
  std::string title{};  ///< may be empty
  std::vector<FigureTick> ticks;
};

/// A position in the picture, in pixels: (0, 0) is the upper left corner, y counts down.
struct FigurePoint {
  double x = 0, y = 0;
};

/// A line of a graticule. It is labelled where it leaves the picture: meridians at the top, parallels on the left.
struct FigureLine {
  std::vector<FigurePoint> points{};
  std::string text{};
  bool meridian = false;
};

/// A text label in the picture.
struct FigureLabel {
  FigurePoint centre{};
  double angle = 0;  ///< radians clockwise from horizontal text
  std::string text{};
};

enum class FigureShapeKind : std::uint8_t { point, line, area };

/// A point, line or area drawn on the picture, with a label.
struct FigureShape {
  FigureShapeKind kind = FigureShapeKind::point;
  /// A point: one part of one point. Lines. Rings of an area; what an odd number of them encloses is inside. Not empty.
  std::vector<std::vector<FigurePoint>> parts{};
  std::string text{};                    ///< UTF-8; empty: no label
  std::array<std::uint8_t, 3> colour{};  ///< sRGB
};

/// A picture made of vertical strips of equal width: dividers between them, and a label at the top of each.
struct FigureStrip {
  std::vector<std::string> lines{};  ///< of its label
};

/// Position of title, legend, scale bar, north arrow and labels of the graticule.
enum class FigureLayout : std::uint8_t {
  on,      ///< on the picture
  beside,  ///< on white margins around the picture; only lines and contour labels are drawn over its pixels
};

struct Figure {
  std::string title{};  ///< UTF-8; empty: none. wrapped between words into at most three lines
  std::optional<FigureLegend> legend{};
  std::optional<FigureKey> key{};  ///< replaces the legend
  std::optional<FigureScale> scale{};
  std::optional<double> north{};  ///< direction of the north arrow, radians clockwise from up; nullopt: none
  std::vector<FigureLine> graticule{};
  /// In order of preference: labels that would touch anything drawn before, or repeat a text within twenty times its
  /// height, are omitted.
  std::vector<FigureLabel> labels{};
  std::vector<FigureShape> shapes{};  ///< labels that would touch anything drawn before are omitted
  std::vector<FigureStrip> strips{};  ///< from left to right; their labels are on the picture in every layout
  FigureLayout layout = FigureLayout::on;
};

/// A picture with its figure.
struct FigureImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  ///< as RgbView
};

/// Returns tick values in [low, high]: multiples of a step that is 1, 2 or 5 times a power of ten and not below
/// `least_step`. At most `most` values, and at least two where two exist. low < high, most >= 2.
std::vector<double> round_numbers(double low, double high, int most, double least_step = 0);

/// Return the height in pixels of text on a picture, and of Figure::labels.
double figure_text_height(int width, int height);
double figure_label_height(int width, int height);

/// Returns whether the text can be written: valid UTF-8.
bool is_figure_text(const std::string& text);

/// Throws Error if a picture of this size is too small for the figure.
void require_room(const Figure& figure, int width, int height);

/// Draws a figure. The result has the size of the picture if the layout is `on`. Omits tick labels that would overlap,
/// but never the last one. Throws Error if the picture is too small for the figure.
FigureImage draw_figure(const RgbView& picture, const Figure& figure);

/// Writes a PDF of one page: the picture at `dots_per_inch`, > 0, and the figure as lines and text. Writes to the
/// temporary file of `file`, and commits it; `path` is only used in messages. Throws Error as above, and if writing
/// fails (disk full); then no file remains once `file` is destroyed.
void write_pdf(ReplaceFile& file, const std::string& path, const RgbView& picture, const Figure& figure,
               double dots_per_inch);

}  // namespace scarp
