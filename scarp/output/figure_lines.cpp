// SPDX-License-Identifier: MIT
#include "scarp/output/figure_lines.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace scarp {
namespace {

constexpr double kRepeat = 20;     // text heights between labels with the same text
constexpr double kLabelGap = 0.3;  // text heights around a label

bool is_free(const FigureRect& rect, const std::vector<FigureRect>& taken) {
  return std::none_of(taken.begin(), taken.end(), [&](const FigureRect& other) { return rect.touches(other); });
}

bool is_inside(const FigureRect& rect, const FigureRect& frame) {
  return rect.x >= frame.x && rect.y >= frame.y && rect.x + rect.width <= frame.x + frame.width &&
         rect.y + rect.height <= frame.y + frame.height;
}

// Position at which the line leaves a picture of this size, in pixels along the side: the top for meridians, the left
// side for parallels.
std::optional<double> place_of_label(const FigureLine& line, double width, double height) {
  for (std::size_t i = 1; i < line.points.size(); ++i) {
    FigurePoint a = line.points[i - 1], b = line.points[i];
    if (!line.meridian) std::swap(a.x, a.y), std::swap(b.x, b.y);
    if ((a.y < 0) == (b.y < 0)) continue;
    const double at = a.x + (b.x - a.x) * (0 - a.y) / (b.y - a.y);
    if (at >= 0 && at <= (line.meridian ? width : height)) return at;
  }
  return {};
}

void draw_line(const FigurePen& pen, const FigureLine& line) {
  for (const FigurePoint& p : line.points) cairo_line_to(pen.cr(), p.x, p.y);
  // A dark line with a light rim is visible on all colours.
  cairo_set_source_rgba(pen.cr(), 1, 1, 1, 0.35);
  cairo_set_line_width(pen.cr(), std::max(2.0, pen.text() / 6));
  cairo_stroke_preserve(pen.cr());
  cairo_set_source_rgba(pen.cr(), 0, 0, 0, 0.6);
  cairo_set_line_width(pen.cr(), std::max(0.8, pen.text() / 16));
  cairo_stroke(pen.cr());
}

}  // namespace

FigureMargins graticule_margins(const FigurePen& pen, const std::vector<FigureLine>& graticule, double width,
                                double height) {
  FigureMargins margins;
  for (const FigureLine& line : graticule) {
    const std::optional<double> at = place_of_label(line, width, height);
    if (!at) continue;
    const double wide = pen.width_of(line.text);
    margins.top = std::max(margins.top, pen.line_height() + pen.gap());
    if (line.meridian) {
      margins.left = std::max(margins.left, wide / 2 - *at);
      margins.right = std::max(margins.right, *at + wide / 2 - width);
    } else {
      margins.left = std::max(margins.left, wide + pen.gap());
    }
  }
  return margins;
}

void draw_graticule(const FigurePen& pen, const Figure& figure, const FigureRect& frame,
                    std::vector<FigureRect>& taken) {
  cairo_save(pen.cr());
  cairo_rectangle(pen.cr(), frame.x, frame.y, frame.width, frame.height);
  cairo_clip(pen.cr());
  cairo_translate(pen.cr(), frame.x, frame.y);
  for (const FigureLine& line : figure.graticule) draw_line(pen, line);
  cairo_restore(pen.cr());
  const bool beside = figure.layout == FigureLayout::beside;
  const double high = pen.line_height(), gap = pen.gap();
  for (const FigureLine& line : figure.graticule) {
    const std::optional<double> at = place_of_label(line, frame.width, frame.height);
    if (!at) continue;
    const double wide = pen.width_of(line.text);
    FigurePoint centre{frame.x + *at, frame.y + (beside ? -gap - high / 2 : gap + high / 2)};
    if (!line.meridian) centre = {frame.x + (beside ? -gap - wide / 2 : gap + wide / 2), frame.y + *at};
    const FigureRect rect{centre.x - wide / 2 - gap / 2, centre.y - high / 2, wide + gap, high};
    if (!is_free(rect, taken) || (!beside && !is_inside(rect, frame))) continue;
    taken.push_back(rect);
    if (beside) {
      pen.write(centre.x - wide / 2, centre.y - high / 2 + pen.ascent(), line.text);
    } else {
      pen.write_on_picture(centre, 0, line.text);
    }
  }
}

void draw_labels(const FigurePen& pen, const Figure& figure, const FigureRect& frame, std::vector<FigureRect>& taken) {
  std::vector<const FigureLabel*> drawn;
  for (const FigureLabel& label : figure.labels) {
    const auto repeats = [&](const FigureLabel* other) {
      return other->text == label.text &&
             std::hypot(other->centre.x - label.centre.x, other->centre.y - label.centre.y) < kRepeat * pen.text();
    };
    if (std::any_of(drawn.begin(), drawn.end(), repeats)) continue;
    const double wide = pen.width_of(label.text) + 2 * kLabelGap * pen.text(),
                 high = pen.text() + 2 * kLabelGap * pen.text();
    // The bounding box of the rotated text.
    const double c = std::abs(std::cos(label.angle)), s = std::abs(std::sin(label.angle));
    const FigureRect rect{frame.x + label.centre.x - (c * wide + s * high) / 2,
                          frame.y + label.centre.y - (s * wide + c * high) / 2, c * wide + s * high,
                          s * wide + c * high};
    if (!is_inside(rect, frame) || !is_free(rect, taken)) continue;
    taken.push_back(rect);
    drawn.push_back(&label);
    pen.write_on_picture({frame.x + label.centre.x, frame.y + label.centre.y}, label.angle, label.text);
  }
}

}  // namespace scarp
