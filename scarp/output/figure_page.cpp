// SPDX-License-Identifier: MIT
#include "scarp/output/figure_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/output/figure_lines.h"
#include "scarp/output/figure_shapes.h"

namespace scarp {
namespace {

constexpr double kFrameLine = 1;    // pixels, around the picture on a page
constexpr double kLeastTitle = 24;  // text heights: a tiny picture gets a wider page
constexpr double kDivider = 0.2;    // text heights, between strips

}  // namespace

FigurePage::FigurePage(const Figure& figure, int width, int height)
    : figure_(figure),
      text_(figure_text_height(width, height)),
      label_text_(figure_label_height(width, height)),
      width_(width),
      height_(height),
      frame_{0, 0, static_cast<double>(width), static_cast<double>(height)} {
  const CairoSurface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, 1, 1));
  const CairoContext context(cairo_create(surface.get()));
  const FigurePen pen(context.get(), text_);
  if (figure.layout == FigureLayout::on) {
    place_on(pen, width, height);
  } else {
    place_beside(pen, width, height);
  }
  require_good(surface.get(), context.get());
}

void FigurePage::place(FigurePanel panel, double x, double y, double pad) {
  const FigureRect rect{x, y, panel.width + 2 * pad, panel.height + 2 * pad};
  placed_.push_back({std::move(panel), rect});
}

void FigurePage::place_on(const FigurePen& pen, int width, int height) {
  const double pad = pen.pad();
  const auto bottom = [&](const FigurePanel& panel) { return height - 3 * pad - panel.height; };
  const auto right = [&](const FigurePanel& panel) { return width - 3 * pad - panel.width; };
  double free_width = width - 4 * pad, top = pad;
  if (figure_.scale) {
    FigurePanel panel = scale_panel(pen, *figure_.scale);
    const double y = bottom(panel);
    place(std::move(panel), pad, y, pad);
  }
  if (figure_.key || figure_.legend) {
    FigurePanel panel =
        figure_.key ? key_panel(pen, *figure_.key) : legend_panel(pen, *figure_.legend, width - 6 * pad);
    const double x = right(panel), y = bottom(panel);
    place(std::move(panel), x, y, pad);
  }
  if (figure_.north) {
    FigurePanel panel = arrow_panel(pen, *figure_.north);
    const double x = right(panel) + 2 * pad;  // the arrow's square includes padding
    free_width -= 2 * (panel.width + pad);    // on both sides: the title is centred
    place(std::move(panel), x, pad, 0);
  }
  if (!figure_.title.empty()) {
    FigurePanel panel = title_panel(pen, figure_.title, free_width);
    const double x = (width - panel.width) / 2 - pad;
    top += panel.height + 3 * pad;
    place(std::move(panel), x, pad, pad);
  }
  place_strips(pen, top);
  require_fit();
}

// Labels are in the middle of their strips; `top` is their upper edge in the picture.
void FigurePage::place_strips(const FigurePen& pen, double top) {
  const double wide = frame_.width / static_cast<double>(std::max<std::size_t>(figure_.strips.size(), 1));
  for (std::size_t i = 0; i < figure_.strips.size(); ++i) {
    FigurePanel panel = strip_panel(pen, figure_.strips[i]);
    const double needed = panel.width + 2 * pen.pad();
    if (needed > wide) {
      throw Error(fmt::format("figure: {} needs {:.0f} pixels, its strip is {:.0f} wide (enlarge the image)",
                              panel.name, needed, wide));
    }
    const double x = frame_.x + static_cast<double>(i) * wide + (wide - needed) / 2;
    place(std::move(panel), x, frame_.y + top, pen.pad());
  }
}

// Panels on the picture.
void FigurePage::require_fit() const {
  const int width = width_, height = height_;
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    const FigureRect& rect = placed_[i].rect;
    if (rect.x < 0 || rect.y < 0 || rect.x + rect.width > width || rect.y + rect.height > height) {
      throw Error(fmt::format(
          "figure: {} needs {:.0f} x {:.0f} pixels, too large for the image of {} x {} (enlarge the image, or place it "
          "beside)",
          placed_[i].panel.name, rect.width, rect.height, width, height));
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (!rect.touches(placed_[j].rect)) continue;
      throw Error(fmt::format(
          "figure: {} and {} overlap, the image of {} x {} is too small for both (enlarge the image, leave one out, or "
          "place them beside)",
          placed_[j].panel.name, placed_[i].panel.name, width, height));
    }
  }
}

void FigurePage::place_beside(const FigurePen& pen, int width, int height) {
  const double pad = pen.pad();
  const FigureMargins labels = graticule_margins(pen, figure_.graticule, width, height);
  // Whole pixels, so that the picture is not resampled.
  frame_.x = std::ceil(pad + labels.left);
  frame_.y = std::ceil(pad + labels.top);
  double right = frame_.x + width + labels.right;  // right edge of the widest part
  if (!figure_.title.empty()) {
    FigurePanel panel = title_panel(pen, figure_.title, std::max<double>(width, kLeastTitle * text_));
    frame_.y = std::ceil(frame_.y + panel.height + pen.gap());
    const double x = std::max(pad, frame_.x + (width - panel.width) / 2);
    right = std::max(right, x + panel.width);
    place(std::move(panel), x, pad, 0);
  }
  std::vector<FigurePanel> below;
  if (figure_.scale) below.push_back(scale_panel(pen, *figure_.scale));
  if (figure_.north) below.push_back(arrow_panel(pen, *figure_.north));
  if (figure_.key) {
    below.push_back(key_panel(pen, *figure_.key));
  } else if (figure_.legend) {
    below.push_back(legend_panel(pen, *figure_.legend, std::max<double>(width, 12 * text_)));
  }
  // Rows are as wide as the picture: the first panel is on the left, the last one on the right.
  double y = frame_.y + height;
  for (std::size_t first = 0, last = 0; first < below.size(); first = last) {
    double needed = 0, high = 0;
    for (last = first; last < below.size(); ++last) {
      const double more = needed + below[last].width + (last > first ? 2 * pad : 0);
      if (last > first && more > width) break;
      needed = more;
      high = std::max(high, below[last].height);
    }
    const double slack = last - first > 1 ? std::max(0.0, width - needed) / static_cast<double>(last - first - 1) : 0;
    double x = frame_.x;
    y += pad;
    for (std::size_t i = first; i < last; ++i) {
      const double wide = below[i].width;
      right = std::max(right, x + wide);
      place(std::move(below[i]), x, y, 0);
      x += wide + 2 * pad + slack;
    }
    y += high;
  }
  strips_ = placed_.size();
  place_strips(pen, pen.pad());
  width_ = static_cast<int>(std::ceil(right + pad));
  height_ = static_cast<int>(std::ceil(y + pad));
}

void FigurePage::draw(cairo_t* cr, cairo_surface_t* picture) const {
  FigurePen pen(cr, text_);
  const bool beside = figure_.layout == FigureLayout::beside;
  if (beside) {
    pen.fill({0, 0, static_cast<double>(width_), static_cast<double>(height_)}, {255, 255, 255});
    pen.frame(
        {frame_.x - kFrameLine / 2, frame_.y - kFrameLine / 2, frame_.width + kFrameLine, frame_.height + kFrameLine},
        kFrameLine);
  }
  cairo_set_source_surface(cr, picture, frame_.x, frame_.y);
  cairo_rectangle(cr, frame_.x, frame_.y, frame_.width, frame_.height);
  cairo_fill(cr);
  std::vector<FigureRect> taken;
  for (const Placed& placed : placed_) taken.push_back(placed.rect);
  draw_graticule(pen, figure_, frame_, taken);
  const FigurePen small(cr, label_text_);
  draw_shapes(small, figure_, frame_, taken);
  draw_shape_labels(small, figure_, frame_, taken);
  draw_labels(FigurePen(cr, label_text_), figure_, frame_, taken);
  pen = FigurePen(cr, text_);  // restores the context's font, which the last pen has set
  draw_dividers(pen);
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    const auto& [panel, rect] = placed_[i];
    if (!beside || i >= strips_) pen.paper(rect);
    panel.draw(pen, rect.x + (rect.width - panel.width) / 2, rect.y + (rect.height - panel.height) / 2);
  }
}

void FigurePage::draw_dividers(const FigurePen& pen) const {
  const double thick = kDivider * text_;
  for (std::size_t i = 1; i < figure_.strips.size(); ++i) {
    const double x = frame_.x + frame_.width * static_cast<double>(i) / static_cast<double>(figure_.strips.size());
    pen.fill({x - thick, frame_.y, 2 * thick, frame_.height}, {255, 255, 255});
    pen.fill({x - thick / 2, frame_.y, thick, frame_.height}, {0, 0, 0});
  }
}

}  // namespace scarp
