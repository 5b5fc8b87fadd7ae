// SPDX-License-Identifier: MIT
#include "scarp/output/figure_shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace scarp {
namespace {

constexpr double kDotRadius = 0.35, kStroke = 0.16,
                 kRimWidth = 0.12;  // text heights: radius, width, width of light rims
constexpr double kAreaOpacity = 0.22, kRimOpacity = 0.85;

void set_colour(const FigurePen& pen, const std::array<std::uint8_t, 3>& colour, double opacity) {
  cairo_set_source_rgba(pen.cr(), colour[0] / 255.0, colour[1] / 255.0, colour[2] / 255.0, opacity);
}

void trace(const FigurePen& pen, const FigureShape& shape) {
  cairo_new_path(pen.cr());
  for (const auto& part : shape.parts) {
    cairo_new_sub_path(pen.cr());
    for (const FigurePoint& p : part) cairo_line_to(pen.cr(), p.x, p.y);
    if (shape.kind == FigureShapeKind::area) cairo_close_path(pen.cr());
  }
}

void stroke(const FigurePen& pen, const FigureShape& shape) {
  trace(pen, shape);
  cairo_set_line_join(pen.cr(), CAIRO_LINE_JOIN_ROUND);
  cairo_set_source_rgba(pen.cr(), 1, 1, 1, kRimOpacity);
  cairo_set_line_width(pen.cr(), (kStroke + 2 * kRimWidth) * pen.text());
  cairo_stroke_preserve(pen.cr());
  set_colour(pen, shape.colour, 1);
  cairo_set_line_width(pen.cr(), kStroke * pen.text());
  cairo_stroke(pen.cr());
}

void fill(const FigurePen& pen, const FigureShape& shape) {
  trace(pen, shape);
  cairo_set_fill_rule(pen.cr(), CAIRO_FILL_RULE_EVEN_ODD);
  set_colour(pen, shape.colour, kAreaOpacity);
  cairo_fill(pen.cr());
}

void dot(const FigurePen& pen, const FigureShape& shape, const FigurePoint& at) {
  cairo_new_path(pen.cr());
  cairo_arc(pen.cr(), at.x, at.y, kDotRadius * pen.text(), 0, 2 * std::numbers::pi);
  set_colour(pen, shape.colour, 1);
  cairo_fill_preserve(pen.cr());
  cairo_set_source_rgba(pen.cr(), 1, 1, 1, 1);
  cairo_set_line_width(pen.cr(), 2 * kRimWidth * pen.text());
  cairo_stroke_preserve(pen.cr());
  cairo_set_source_rgba(pen.cr(), 0, 0, 0, 1);
  cairo_set_line_width(pen.cr(), kRimWidth / 2 * pen.text());
  cairo_stroke(pen.cr());
}

bool is_inside(const FigurePoint& p, const FigureRect& frame) {
  return p.x >= 0 && p.y >= 0 && p.x <= frame.width && p.y <= frame.height;
}

// The middle of a line's part inside the picture, by vertices and middles of segments; the centre of an area's bounds.
std::optional<FigurePoint> middle_of(const FigureShape& shape, const FigureRect& frame) {
  std::vector<FigurePoint> inside;
  for (const auto& part : shape.parts) {
    for (std::size_t i = 0; i < part.size(); ++i) {
      if (is_inside(part[i], frame)) inside.push_back(part[i]);
      if (i + 1 == part.size()) continue;
      const FigurePoint half{(part[i].x + part[i + 1].x) / 2, (part[i].y + part[i + 1].y) / 2};
      if (is_inside(half, frame)) inside.push_back(half);
    }
  }
  if (inside.empty()) return std::nullopt;
  if (shape.kind == FigureShapeKind::line) return inside[inside.size() / 2];
  FigurePoint low = inside.front(), high = low;
  for (const FigurePoint& p : inside) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  return FigurePoint{(low.x + high.x) / 2, (low.y + high.y) / 2};
}

// The positions of a label's centre, in order of preference.
std::vector<FigurePoint> places_of(const FigurePen& pen, const FigureShape& shape, const FigureRect& frame) {
  if (shape.kind != FigureShapeKind::point) {
    const auto middle = middle_of(shape, frame);
    return middle ? std::vector{*middle} : std::vector<FigurePoint>();
  }
  const FigurePoint at = shape.parts.front().front();
  if (!is_inside(at, frame)) return {};
  const double aside = (kDotRadius + 0.5) * pen.text() + pen.width_of(shape.text) / 2,
               above = (kDotRadius + 0.8) * pen.text();
  return {{at.x + aside, at.y}, {at.x - aside, at.y}, {at.x, at.y - above}, {at.x, at.y + above}};
}

}  // namespace

void draw_shapes(const FigurePen& pen, const Figure& figure, const FigureRect& frame, std::vector<FigureRect>& taken) {
  cairo_save(pen.cr());
  cairo_rectangle(pen.cr(), frame.x, frame.y, frame.width, frame.height);
  cairo_clip(pen.cr());
  cairo_translate(pen.cr(), frame.x, frame.y);
  const auto each = [&](FigureShapeKind kind, const auto& draw) {
    for (const FigureShape& shape : figure.shapes)
      if (shape.kind == kind) draw(shape);
  };
  each(FigureShapeKind::area, [&](const FigureShape& shape) { fill(pen, shape), stroke(pen, shape); });
  each(FigureShapeKind::line, [&](const FigureShape& shape) { stroke(pen, shape); });
  each(FigureShapeKind::point, [&](const FigureShape& shape) {
    const FigurePoint& at = shape.parts.front().front();
    dot(pen, shape, at);
    const double side = 2 * (kDotRadius + kRimWidth) * pen.text();
    taken.push_back({frame.x + at.x - side / 2, frame.y + at.y - side / 2, side, side});
  });
  cairo_restore(pen.cr());
}

void draw_shape_labels(const FigurePen& pen, const Figure& figure, const FigureRect& frame,
                       std::vector<FigureRect>& taken) {
  for (const FigureShape& shape : figure.shapes) {
    if (shape.text.empty()) continue;
    for (const FigurePoint& at : places_of(pen, shape, frame)) {
      const double wide = pen.width_of(shape.text), high = pen.line_height();
      const FigureRect rect{frame.x + at.x - wide / 2, frame.y + at.y - high / 2, wide, high};
      const bool free =
          std::none_of(taken.begin(), taken.end(), [&](const auto& other) { return rect.touches(other); });
      if (!free || rect.x < frame.x || rect.y < frame.y || rect.x + wide > frame.x + frame.width ||
          rect.y + high > frame.y + frame.height)
        continue;
      taken.push_back(rect);
      pen.write_on_picture({frame.x + at.x, frame.y + at.y}, 0, shape.text);
      break;
    }
  }
}

}  // namespace scarp
