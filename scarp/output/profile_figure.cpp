// SPDX-License-Identifier: MIT
#include "scarp/output/profile_figure.h"

#include <cairo-svg.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/output/figure_pen.h"

namespace scarp {
namespace {

constexpr double kText = 13;      // pixels
constexpr double kMargin = 0.06;  // fraction of the height range, above and below
constexpr double kLeast = 1;      // metres: height range of flat profiles

struct Colour {
  double r, g, b;
};
constexpr Colour kGround{0.80, 0.76, 0.69}, kSeen{0.10, 0.55, 0.20}, kHidden{0.62, 0.20, 0.16},
    kSight{0.10, 0.25, 0.65}, kGrid{0.86, 0.86, 0.86};

// Returns 1, 2 or 5 times a power of ten, for about `count` steps over the range.
double step_for(double range, double count) {
  const double raw = range / count, power = std::pow(10, std::floor(std::log10(raw))), share = raw / power;
  return power * (share < 1.5 ? 1 : share < 3.5 ? 2 : share < 7.5 ? 5 : 10);
}

class Drawing {
 public:
  Drawing(cairo_t* cr, const ProfileFigure& figure) : cr_(cr), pen_(cr, kText), figure_(figure) {
    low_ = HUGE_VAL, high_ = -HUGE_VAL;
    for (const ProfileFigurePoint& p : figure.points)
      for (const double z : {p.ground, p.sight})
        if (std::isfinite(z)) low_ = std::min(low_, z), high_ = std::max(high_, z);
    const double margin = std::max(kMargin * (high_ - low_), kLeast / 2);
    low_ -= margin, high_ += margin;
    end_ = std::max(figure.points.back().distance, kLeast);
    const double line = pen_.line_height();
    box_ = {5 * kText, 2.6 * line, figure.width - 6.5 * kText, figure.height - 7.6 * line};
  }

  void draw() const {
    cairo_set_source_rgb(cr_, 1, 1, 1);
    cairo_paint(cr_);
    axes();
    ground();
    sight();
    pen_.frame(box_, 1);
    pen_.write(box_.x, pen_.line_height(), figure_.title);
    pen_.write(box_.x, 2 * pen_.line_height(), figure_.remark);
    legend();
  }

 private:
  double x(double distance) const { return box_.x + box_.width * distance / end_; }
  double y(double height) const { return box_.y + box_.height * (high_ - height) / (high_ - low_); }
  void colour(const Colour& c) const { cairo_set_source_rgb(cr_, c.r, c.g, c.b); }

  void axes() const {
    cairo_set_line_width(cr_, 1);
    const double up = step_for(high_ - low_, box_.height / (4 * kText));
    for (double z = std::ceil(low_ / up) * up; z <= high_; z += up) {
      rule(box_.x, y(z), box_.x + box_.width, y(z));
      const std::string text = fmt::format("{:.10g}", std::abs(z) < up / 2 ? 0.0 : z);
      pen_.write(box_.x - pen_.width_of(text) - kText / 2, y(z) + pen_.ascent() / 2.5, text);
    }
    const bool kilometres = end_ >= 5000;
    const double unit = kilometres ? 1000 : 1, along = step_for(end_ / unit, box_.width / (8 * kText));
    const double below = box_.y + box_.height;
    // Rounding may move the last tick beyond the end.
    constexpr double kTickSlack = 1.0 / 1024;  // of a step: less than a pixel
    const double last = std::floor(end_ / unit / along + kTickSlack);
    for (double i = 0; i <= last; ++i) {
      const double d = i * along;
      rule(x(d * unit), box_.y, x(d * unit), below);
      const std::string text = fmt::format("{:.6g}", d);
      pen_.write(x(d * unit) - pen_.width_of(text) / 2, below + 1.3 * pen_.line_height(), text);
    }
    const std::string name = kilometres ? "distance (km)" : "distance (m)";
    pen_.write(box_.x + (box_.width - pen_.width_of(name)) / 2, below + 2.5 * pen_.line_height(), name);
    cairo_save(cr_);
    cairo_translate(cr_, 1.1 * kText, box_.y + box_.height / 2);
    cairo_rotate(cr_, -std::acos(0.0));
    const std::string upward = "height (m)";
    pen_.write(-pen_.width_of(upward) / 2, 0, upward);
    cairo_restore(cr_);
  }
  void rule(double x0, double y0, double x1, double y1) const {
    colour(kGrid);
    cairo_move_to(cr_, x0, y0);
    cairo_line_to(cr_, x1, y1);
    cairo_stroke(cr_);
  }

  // Draws the ground, filled down to the axis, and the surface coloured by its visibility to the observer.
  void ground() const {
    const auto& points = figure_.points;
    const double floor = box_.y + box_.height;
    // One polygon per run without holes: adjacent polygons would leave seams.
    colour(kGround);
    for (std::size_t begin = 0; begin < points.size();) {
      std::size_t end = begin;
      while (end < points.size() && std::isfinite(points[end].ground) && (end == begin || !points[end].after_hole))
        ++end;
      if (end > begin) {
        cairo_move_to(cr_, x(points[begin].distance), floor);
        for (std::size_t i = begin; i < end; ++i) cairo_line_to(cr_, x(points[i].distance), y(points[i].ground));
        cairo_line_to(cr_, x(points[end - 1].distance), floor);
        cairo_close_path(cr_);
        cairo_fill(cr_);
      }
      begin = std::max(end, begin + 1);
    }
    for (std::size_t i = 1; i < points.size(); ++i) {
      const auto &a = points[i - 1], &b = points[i];
      if (!std::isfinite(a.ground) || !std::isfinite(b.ground) || b.after_hole) continue;
      colour(b.visible && a.visible ? kSeen : kHidden);
      cairo_set_line_width(cr_, 2.5);
      cairo_set_line_cap(cr_, CAIRO_LINE_CAP_ROUND);
      cairo_move_to(cr_, x(a.distance), y(a.ground));
      cairo_line_to(cr_, x(b.distance), y(b.ground));
      cairo_stroke(cr_);
    }
  }

  void sight() const {
    colour(kSight);
    cairo_set_line_width(cr_, 1.5);
    cairo_set_line_cap(cr_, CAIRO_LINE_CAP_BUTT);
    for (const ProfileFigurePoint& p : figure_.points) cairo_line_to(cr_, x(p.distance), y(p.sight));
    if (figure_.blocked) {
      constexpr double kDashes[] = {7, 5};
      cairo_set_dash(cr_, kDashes, 2, 0);
    }
    cairo_stroke(cr_);
    cairo_set_dash(cr_, nullptr, 0, 0);
    for (const ProfileFigurePoint& p : {figure_.points.front(), figure_.points.back()})
      dot(p.distance, p.sight, kSight);
    if (figure_.blocked) dot(figure_.block.distance, figure_.block.ground, kHidden);
  }
  void dot(double distance, double height, const Colour& c) const {
    colour(c);
    cairo_new_path(cr_);
    cairo_arc(cr_, x(distance), y(height), 4.5, 0, 4 * std::acos(0.0));
    cairo_fill(cr_);
  }

  void legend() const {
    double at = box_.x;
    const double base = figure_.height - 0.6 * pen_.line_height();
    const auto entry = [&](const Colour& c, const std::string& text, bool point) {
      colour(c);
      cairo_new_path(cr_);
      if (point) {
        cairo_arc(cr_, at + kText, base - kText / 3, 4.5, 0, 4 * std::acos(0.0));
        cairo_fill(cr_);
      } else {
        cairo_set_line_width(cr_, 2.5);
        cairo_move_to(cr_, at, base - kText / 3);
        cairo_line_to(cr_, at + 2 * kText, base - kText / 3);
        cairo_stroke(cr_);
      }
      pen_.write(at + 2.5 * kText, base, text);
      at += 4.5 * kText + pen_.width_of(text);
    };
    entry(kSeen, "ground in view", false);
    entry(kHidden, "ground out of view", false);
    entry(kSight, figure_.blocked ? "line of sight, blocked" : "line of sight", false);
    if (figure_.blocked) entry(kHidden, "first obstruction", true);
  }

  cairo_t* cr_;
  FigurePen pen_;
  const ProfileFigure& figure_;
  double low_, high_, end_;
  FigureRect box_;
};

}  // namespace

void write_profile_figure(ReplaceFile& file, const std::string& path, const ProfileFigure& figure) {
  const bool svg = extension_of(path) == ".svg";
  if (!svg && extension_of(path) != ".png") throw Error(fmt::format("output '{}': expected .svg or .png", path));
  std::ofstream stream(file.temporary_path(), std::ios::binary);
  const CairoSurface surface(
      svg ? cairo_svg_surface_create_for_stream(write_bytes, &stream, figure.width, figure.height)
          : cairo_image_surface_create(CAIRO_FORMAT_RGB24, figure.width, figure.height));
  const CairoContext context(cairo_create(surface.get()));
  require_good(surface.get(), context.get());
  Drawing(context.get(), figure).draw();
  cairo_status_t status = cairo_status(context.get());
  if (!svg && status == CAIRO_STATUS_SUCCESS)
    status = cairo_surface_write_to_png_stream(surface.get(), write_bytes, &stream);
  cairo_surface_finish(surface.get());
  if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(surface.get());
  stream.close();
  if (status != CAIRO_STATUS_SUCCESS || !stream)
    throw Error(fmt::format("{}: cannot be written: {} (is the disk full?)", path, cairo_status_to_string(status)));
  file.commit();
}

}  // namespace scarp
