// SPDX-License-Identifier: MIT
#include "scarp/output/figure.h"

#include <cairo.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "scarp/base/error.h"

namespace scarp {
namespace {

// Fractions of the image's shorter side and of the text height.
constexpr double kTextShare = 1.0 / 40, kLeastText = 10;
constexpr double kMargin = 0.8, kBarHeight = 0.9, kLegendLength = 18, kGap = 0.45;
constexpr double kPaper = 0.82;  // opacity of the background behind text

struct Free {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_t* context) const { cairo_destroy(context); }
};

double unit(std::uint8_t byte) { return byte / 255.0; }

class Drawing {
 public:
  Drawing(std::uint8_t* rgb, int width, int height)
      : rgb_(rgb),
        width_(width),
        height_(height),
        text_(std::max(kLeastText, kTextShare * std::min(width, height))),
        surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height)),
        context_(cairo_create(surface_.get())) {
    check();
    copy([](std::uint8_t* from, std::uint32_t& to) {
      to = static_cast<std::uint32_t>(from[0]) << 16 | static_cast<std::uint32_t>(from[1]) << 8 | from[2];
    });
    cairo_select_font_face(cr(), "sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cr(), text_);
    cairo_font_extents(cr(), &font_);
  }

  void scale(const FigureScale& scale) {
    const Sides sides = overhang(scale.pixels, scale.ticks);
    const double title_height = scale.title.empty() ? 0 : font_.height + gap();
    const double wide = std::max(sides.left + scale.pixels + sides.right, extents(scale.title).x_advance);
    const double panel_height = 2 * pad() + title_height + bar() + gap() + font_.height;
    const double left = pad(), top = height_ - pad() - panel_height;
    paper(left, top, 2 * pad() + wide, panel_height, "the scale bar");
    scale_end_ = left + 2 * pad() + wide;
    write(left + pad(), top + pad() + font_.ascent, scale.title);
    const double x = left + pad() + sides.left, y = top + pad() + title_height;
    for (std::size_t i = 0; i + 1 < scale.ticks.size(); ++i) {
      const double from = x + scale.ticks[i].share * scale.pixels, to = x + scale.ticks[i + 1].share * scale.pixels;
      fill(from, y, to - from, bar(), i % 2 ? 1.0 : 0.0);
    }
    outline(x, y, scale.pixels);
    write_ticks(x, y + bar(), scale.pixels, scale.ticks);
  }

  void legend(const FigureLegend& legend) {
    const double length = std::min(kLegendLength * text_, width_ - 6 * pad());
    const Sides sides = overhang(length, legend.ticks);
    const double wide = std::max(sides.left + length + sides.right, extents(legend.title).x_advance);
    const double panel_width = 2 * pad() + wide, panel_height = 2 * pad() + 2 * font_.height + bar() + 2 * gap();
    const double left = width_ - pad() - panel_width, top = height_ - pad() - panel_height;
    paper(left, top, panel_width, panel_height, "the legend");
    const double x = left + pad() + sides.left, y = top + pad() + font_.height + gap();
    write(left + pad(), top + pad() + font_.ascent, legend.title);
    // Draws one pixel column at a time, in the colour at its centre.
    const int columns = static_cast<int>(length);
    for (int i = 0; i < columns; ++i) {
      const double share = (i + 0.5) / columns * static_cast<double>(legend.colours.size());
      const auto& colour = legend.colours[std::min(legend.colours.size() - 1, static_cast<std::size_t>(share))];
      cairo_set_source_rgb(cr(), unit(colour[0]), unit(colour[1]), unit(colour[2]));
      cairo_rectangle(cr(), std::floor(x) + i, std::floor(y), 1, std::ceil(bar()));
      cairo_fill(cr());
    }
    outline(std::floor(x), std::floor(y), columns);
    write_ticks(std::floor(x), y + bar(), columns, legend.ticks);
  }

  void key(const FigureKey& key) {
    const double line = font_.height + gap();
    double wide = extents(key.title).x_advance;
    for (const FigureKey::Entry& entry : key.entries) {
      wide = std::max(wide, 1.5 * bar() + gap() + extents(entry.text).x_advance);
    }
    const double panel_height = 2 * pad() + font_.height + static_cast<double>(key.entries.size()) * line;
    const double left = width_ - 3 * pad() - wide, top = height_ - pad() - panel_height;
    paper(left, top, 2 * pad() + wide, panel_height, "the legend");
    double y = top + pad();
    write(left + pad(), y + font_.ascent, key.title);
    for (const FigureKey::Entry& entry : key.entries) {
      y += line;
      cairo_set_source_rgb(cr(), unit(entry.colour[0]), unit(entry.colour[1]), unit(entry.colour[2]));
      cairo_rectangle(cr(), left + pad(), y, 1.5 * bar(), bar());
      cairo_fill_preserve(cr());
      cairo_set_source_rgb(cr(), 0, 0, 0);
      cairo_set_line_width(cr(), text_ / 16);
      cairo_stroke(cr());
      write(left + pad() + 1.5 * bar() + gap(), y + font_.ascent, entry.text);
    }
  }

  // Copies the drawing back into the image.
  void finish() {
    check();
    cairo_surface_flush(surface_.get());
    copy([](std::uint8_t* to, std::uint32_t& from) {
      to[0] = static_cast<std::uint8_t>(from >> 16), to[1] = static_cast<std::uint8_t>(from >> 8);
      to[2] = static_cast<std::uint8_t>(from);
    });
  }

 private:
  // How far labels extend beyond the ends of the bar.
  struct Sides {
    double left = 0, right = 0;
  };

  cairo_t* cr() const { return context_.get(); }
  double pad() const { return kMargin * text_; }
  double bar() const { return kBarHeight * text_; }
  double gap() const { return kGap * text_; }

  void check() const {
    for (const cairo_status_t status : {cairo_surface_status(surface_.get()), cairo_status(context_.get())}) {
      if (status != CAIRO_STATUS_SUCCESS) throw Error(fmt::format("figure: {}", cairo_status_to_string(status)));
    }
  }

  template <class Copy>
  void copy(const Copy& copy) {
    auto* pixels = cairo_image_surface_get_data(surface_.get());
    const std::ptrdiff_t stride = cairo_image_surface_get_stride(surface_.get());
    for (std::ptrdiff_t y = 0; y < height_; ++y) {
      auto* row = reinterpret_cast<std::uint32_t*>(pixels + y * stride);
      for (std::ptrdiff_t x = 0; x < width_; ++x) copy(rgb_ + 3 * (y * width_ + x), row[x]);
    }
    cairo_surface_mark_dirty(surface_.get());
  }

  cairo_text_extents_t extents(const std::string& text) const {
    cairo_text_extents_t e;
    cairo_text_extents(cr(), text.c_str(), &e);
    return e;
  }
  Sides overhang(double length, const std::vector<FigureTick>& ticks) const {
    Sides sides;
    for (const FigureTick& tick : ticks) {
      const double half = extents(tick.text).x_advance / 2;
      sides.left = std::max(sides.left, half - tick.share * length);
      sides.right = std::max(sides.right, half - (1 - tick.share) * length);
    }
    return sides;
  }

  void paper(double x, double y, double wide, double high, std::string_view what) {
    if (x < 0 || y < 0 || x + wide > width_) {
      throw Error(
          fmt::format("figure: {} needs {:.0f} x {:.0f} pixels, too large for the image of {} x {} (enlarge the image)",
                      what, wide, high, width_, height_));
    }
    if (x < scale_end_) {
      throw Error(
          fmt::format("figure: the scale bar and {} need {:.0f} pixels side by side, too wide for the image of {} x {} "
                      "(enlarge the image, or leave one out)",
                      what, scale_end_ + wide + pad(), width_, height_));
    }
    cairo_set_source_rgba(cr(), 1, 1, 1, kPaper);
    cairo_rectangle(cr(), x, y, wide, high);
    cairo_fill(cr());
  }
  void fill(double x, double y, double wide, double high, double grey) {
    cairo_set_source_rgb(cr(), grey, grey, grey);
    cairo_rectangle(cr(), x, y, wide, high);
    cairo_fill(cr());
  }
  void outline(double x, double y, double wide) {
    cairo_set_source_rgb(cr(), 0, 0, 0);
    cairo_set_line_width(cr(), text_ / 12);
    cairo_rectangle(cr(), x, std::floor(y), wide, std::ceil(bar()));
    cairo_stroke(cr());
  }
  void write(double x, double baseline, const std::string& text) {
    cairo_set_source_rgb(cr(), 0, 0, 0);
    cairo_move_to(cr(), x, baseline);
    cairo_show_text(cr(), text.c_str());
  }
  // Returns the smallest n such that every n-th label, counted from the last, does not touch the next one.
  std::size_t label_stride(double length, const std::vector<FigureTick>& ticks) const {
    const auto touch = [&](const FigureTick& a, const FigureTick& b) {
      const double middles = (b.share - a.share) * length;
      return middles < (extents(a.text).x_advance + extents(b.text).x_advance) / 2 + gap();
    };
    for (std::size_t stride = 1;; ++stride) {
      bool fits = true;
      for (std::size_t i = ticks.size(); i > stride; i -= stride) fits &= !touch(ticks[i - 1 - stride], ticks[i - 1]);
      if (fits) return stride;
    }
  }
  void write_ticks(double x, double y, double length, const std::vector<FigureTick>& ticks) {
    const std::size_t stride = label_stride(length, ticks);
    for (std::size_t left = ticks.size(); const FigureTick& tick : ticks) {
      const double at = x + tick.share * length;
      cairo_set_source_rgb(cr(), 0, 0, 0);
      cairo_set_line_width(cr(), text_ / 12);
      cairo_move_to(cr(), at, y - bar() / 3);
      cairo_line_to(cr(), at, y + gap() / 2);
      cairo_stroke(cr());
      if (--left % stride == 0) write(at - extents(tick.text).x_advance / 2, y + gap() + font_.ascent, tick.text);
    }
  }

  std::uint8_t* rgb_;
  int width_, height_;
  double text_;
  double scale_end_ = 0;  // where the scale bar's paper ends
  std::unique_ptr<cairo_surface_t, Free> surface_;
  std::unique_ptr<cairo_t, Free> context_;
  cairo_font_extents_t font_{};
};

}  // namespace

std::vector<double> round_numbers(double low, double high, int most, double least_step) {
  const double range = high - low;
  double power = std::pow(10.0, std::floor(std::log10(range)) - 1);
  for (;; power *= 10) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double step = digit * power, first = std::ceil(low / step), last = std::floor(high / step);
      if (step < least_step || last - first + 1 > most) continue;
      std::vector<double> numbers;
      for (double k = first; k <= last; ++k) numbers.push_back(k * step + 0.0);  // not -0
      return numbers;
    }
  }
}

void draw_figure(std::uint8_t* rgb, int width, int height, const Figure& figure) {
  Drawing drawing(rgb, width, height);
  if (figure.scale) drawing.scale(*figure.scale);
  if (figure.legend) drawing.legend(*figure.legend);
  if (figure.key) drawing.key(*figure.key);
  drawing.finish();
}

}  // namespace scarp
