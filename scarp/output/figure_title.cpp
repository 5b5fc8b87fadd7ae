// SPDX-License-Identifier: MIT
// Title and north arrow.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scarp/base/error.h"
#include "scarp/output/figure_panels.h"

namespace scarp {
namespace {

constexpr double kTitleText = 1.4;  // text heights
constexpr std::size_t kMostLines = 3;
constexpr std::size_t kShown = 40;  // bytes of a title in messages

// In text heights: side of the arrow's square; distance from its middle to its tip and to the middle of the letter N;
// half its width; depth of the notch in its lower end.
constexpr double kArrowSide = 4.2, kTip = 1.0, kLetter = 1.6, kHalfWidth = 0.55, kNotch = 0.35;

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words(1);
  for (const char c : text) {
    if (c != ' ' && c != '\t' && c != '\n' && c != '\r') {
      words.back() += c;
    } else if (!words.back().empty()) {
      words.emplace_back();
    }
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

}  // namespace

FigurePanel title_panel(const FigurePen& measure, const std::string& title, double most_width) {
  const FigurePen large(measure.cr(), kTitleText * measure.text());
  std::vector<std::string> lines;
  for (const std::string& word : words_of(title)) {
    if (!lines.empty() && large.width_of(lines.back() + " " + word) <= most_width) {
      lines.back() += " " + word;
    } else {
      lines.push_back(word);
    }
  }
  if (lines.size() > kMostLines) {
    // Does not cut within a UTF-8 character.
    std::size_t cut = std::min(kShown, title.size());
    while (cut > 0 && cut < title.size() && (static_cast<unsigned char>(title[cut]) & 0xc0) == 0x80) --cut;
    throw Error(
        fmt::format("figure: the title '{}{}' needs {} lines of {:.0f} pixels, at most {} are drawn (shorten it, "
                    "or enlarge the image)",
                    title.substr(0, cut), cut < title.size() ? "..." : "", lines.size(), most_width, kMostLines));
  }
  FigurePanel panel{"the title"};
  for (const std::string& line : lines) panel.width = std::max(panel.width, large.width_of(line));
  panel.height = static_cast<double>(lines.size()) * large.line_height();
  // Restores the context's font, which the last pen has set.
  const FigurePen restored(measure.cr(), measure.text());
  panel.draw = [lines, width = panel.width](const FigurePen& pen, double x, double y) {
    const FigurePen letters(pen.cr(), kTitleText * pen.text());
    for (const std::string& line : lines) {
      letters.write(x + (width - letters.width_of(line)) / 2, y + letters.ascent(), line);
      y += letters.line_height();
    }
    const FigurePen back(pen.cr(), pen.text());
  };
  return panel;
}

FigurePanel arrow_panel(const FigurePen& measure, double north) {
  FigurePanel panel{"the north arrow", kArrowSide * measure.text(), kArrowSide * measure.text()};
  panel.draw = [north](const FigurePen& pen, double x, double y) {
    cairo_t* cr = pen.cr();
    const double unit = pen.text(), middle = kArrowSide / 2 * unit;
    // The letter is beyond the tip; both are centred together.
    const double back = (kLetter + 0.5 - kTip) / 2 * unit;
    cairo_save(cr);
    cairo_translate(cr, x + middle - back * std::sin(north), y + middle + back * std::cos(north));
    cairo_save(cr);
    cairo_rotate(cr, north);
    cairo_set_line_width(cr, unit / 12);
    for (const double side : {-1.0, 1.0}) {
      cairo_move_to(cr, 0, -kTip * unit);
      cairo_line_to(cr, side * kHalfWidth * unit, kTip * unit);
      cairo_line_to(cr, 0, (kTip - kNotch) * unit);
      cairo_close_path(cr);
      const double grey = side < 0 ? 0 : 1;
      cairo_set_source_rgb(cr, grey, grey, grey);
      cairo_fill_preserve(cr);
      cairo_set_source_rgb(cr, 0, 0, 0);
      cairo_stroke(cr);
    }
    cairo_restore(cr);
    cairo_text_extents_t letter;
    cairo_text_extents(cr, "N", &letter);
    pen.write(kLetter * unit * std::sin(north) - letter.x_bearing - letter.width / 2,
              -kLetter * unit * std::cos(north) - letter.y_bearing - letter.height / 2, "N");
    cairo_restore(cr);
  };
  return panel;
}

}  // namespace scarp
