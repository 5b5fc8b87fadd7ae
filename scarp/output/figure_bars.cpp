// SPDX-License-Identifier: MIT
// Legend, key and scale bar.
#include <algorithm>
#include <cmath>

#include "scarp/output/figure_panels.h"

namespace scarp {
namespace {

constexpr double kLegendLength = 18;  // text heights

// How far labels extend beyond the ends of a bar.
struct Sides {
  double left = 0, right = 0;
};

Sides overhang(const FigurePen& pen, double length, const std::vector<FigureTick>& ticks) {
  Sides sides;
  for (const FigureTick& tick : ticks) {
    const double half = pen.width_of(tick.text) / 2;
    sides.left = std::max(sides.left, half - tick.share * length);
    sides.right = std::max(sides.right, half - (1 - tick.share) * length);
  }
  return sides;
}

// Returns the smallest n such that every n-th label, counted from the last, does not touch the next one.
std::size_t label_stride(const FigurePen& pen, double length, const std::vector<FigureTick>& ticks) {
  const auto touch = [&](const FigureTick& a, const FigureTick& b) {
    const double middles = (b.share - a.share) * length;
    return middles < (pen.width_of(a.text) + pen.width_of(b.text)) / 2 + pen.gap();
  };
  for (std::size_t stride = 1;; ++stride) {
    bool fits = true;
    for (std::size_t i = ticks.size(); i > stride; i -= stride) fits &= !touch(ticks[i - 1 - stride], ticks[i - 1]);
    if (fits) return stride;
  }
}

// Writes labels below a bar whose lower edge is at y.
void write_ticks(const FigurePen& pen, double x, double y, double length, const std::vector<FigureTick>& ticks) {
  const std::size_t stride = label_stride(pen, length, ticks);
  for (std::size_t left = ticks.size(); const FigureTick& tick : ticks) {
    const double at = x + tick.share * length;
    cairo_set_source_rgb(pen.cr(), 0, 0, 0);
    cairo_set_line_width(pen.cr(), pen.text() / 12);
    cairo_move_to(pen.cr(), at, y - pen.bar() / 3);
    cairo_line_to(pen.cr(), at, y + pen.gap() / 2);
    cairo_stroke(pen.cr());
    if (--left % stride == 0) pen.write(at - pen.width_of(tick.text) / 2, y + pen.gap() + pen.ascent(), tick.text);
  }
}

// Draws the frame of a bar, on whole pixels.
void outline(const FigurePen& pen, double x, double y, double width) {
  pen.frame({x, std::floor(y), width, std::ceil(pen.bar())}, pen.text() / 12);
}

}  // namespace

FigurePanel scale_panel(const FigurePen& measure, const FigureScale& scale) {
  const Sides sides = overhang(measure, scale.pixels, scale.ticks);
  const double title = scale.title.empty() ? 0 : measure.line_height() + measure.gap();
  FigurePanel panel{"the scale bar"};
  panel.width = std::max(sides.left + scale.pixels + sides.right, measure.width_of(scale.title));
  panel.height = title + measure.bar() + measure.gap() + measure.line_height();
  panel.draw = [&scale, sides, title](const FigurePen& pen, double left, double top) {
    pen.write(left, top + pen.ascent(), scale.title);
    const double x = left + sides.left, y = top + title;
    for (std::size_t i = 0; i + 1 < scale.ticks.size(); ++i) {
      const double from = x + scale.ticks[i].share * scale.pixels, to = x + scale.ticks[i + 1].share * scale.pixels;
      const std::uint8_t grey = i % 2 ? 255 : 0;
      pen.fill({from, y, to - from, pen.bar()}, {grey, grey, grey});
    }
    outline(pen, x, y, scale.pixels);
    write_ticks(pen, x, y + pen.bar(), scale.pixels, scale.ticks);
  };
  return panel;
}

FigurePanel legend_panel(const FigurePen& measure, const FigureLegend& legend, double most_width) {
  const double length = std::min(kLegendLength * measure.text(), most_width);
  const Sides sides = overhang(measure, length, legend.ticks);
  FigurePanel panel{"the legend"};
  panel.width = std::max(sides.left + length + sides.right, measure.width_of(legend.title));
  panel.height = 2 * measure.line_height() + measure.bar() + 2 * measure.gap();
  panel.draw = [&legend, sides, length](const FigurePen& pen, double left, double top) {
    const double x = std::floor(left + sides.left), y = top + pen.line_height() + pen.gap();
    pen.write(left, top + pen.ascent(), legend.title);
    // Draws one pixel column at a time, in the colour at its centre.
    const int columns = static_cast<int>(length);
    for (int i = 0; i < columns; ++i) {
      const double share = (i + 0.5) / columns * static_cast<double>(legend.colours.size());
      pen.fill({x + i, std::floor(y), 1, std::ceil(pen.bar())},
               legend.colours[std::min(legend.colours.size() - 1, static_cast<std::size_t>(share))]);
    }
    outline(pen, x, y, columns);
    write_ticks(pen, x, y + pen.bar(), columns, legend.ticks);
  };
  return panel;
}

FigurePanel key_panel(const FigurePen& measure, const FigureKey& key) {
  FigurePanel panel{"the legend", measure.width_of(key.title)};
  const auto lines = static_cast<double>(key.entries.size());
  panel.height = measure.line_height() + lines * (measure.line_height() + measure.gap());
  for (const FigureKey::Entry& entry : key.entries)
    panel.width = std::max(panel.width, 1.5 * measure.bar() + measure.gap() + measure.width_of(entry.text));
  panel.draw = [&key](const FigurePen& pen, double left, double y) {
    pen.write(left, y + pen.ascent(), key.title);
    for (const FigureKey::Entry& entry : key.entries) {
      y += pen.line_height() + pen.gap();
      const FigureRect patch{left, y, 1.5 * pen.bar(), pen.bar()};
      pen.fill(patch, entry.colour);
      pen.frame(patch, pen.text() / 16);
      pen.write(left + patch.width + pen.gap(), y + pen.ascent(), entry.text);
    }
  };
  return panel;
}

}  // namespace scarp
