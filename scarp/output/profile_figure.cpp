// SPDX-License-Identifier: MIT
#include "scarp/output/profile_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scarp/output/plot.h"

namespace scarp {
namespace {

constexpr double kText = 13;      // pixels
constexpr double kMargin = 0.06;  // fraction of the height range, above and below
constexpr double kLeast = 1;      // metres: height range of flat profiles

constexpr PlotColour kSeen{0.10, 0.55, 0.20}, kHidden{0.62, 0.20, 0.16}, kSight{0.10, 0.25, 0.65},
    kZone{0.68, 0.72, 0.85};

class Drawing {
 public:
  Drawing(cairo_t* cr, const ProfileFigure& figure) : cr_(cr), pen_(cr, kText), figure_(figure) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const ProfileFigurePoint& p : figure.points)
      for (const double z : {p.ground, p.sight})
        if (std::isfinite(z)) low = std::min(low, z), high = std::max(high, z);
    for (const ProfileFigureZone& p : figure.zone) low = std::min(low, p.low), high = std::max(high, p.high);
    const double margin = std::max(kMargin * (high - low), kLeast / 2);
    const double line = pen_.line_height();
    plot_.box = {5 * kText, 2.6 * line, figure.width - 6.5 * kText, figure.height - 7.6 * line};
    plot_.end = std::max(figure.points.back().distance, kLeast);
    plot_.low = low - margin, plot_.high = high + margin;
  }

  void draw() const {
    plot_.axes(pen_, true);
    ground();
    if (!figure_.zone.empty()) zone();
    sight();
    pen_.frame(plot_.box, 1);
    pen_.write(plot_.box.x, pen_.line_height(), figure_.title);
    pen_.write(plot_.box.x, 2 * pen_.line_height(), figure_.remark);
    legend();
  }

 private:
  double x(double distance) const { return plot_.x(distance); }
  double y(double height) const { return plot_.y(height); }
  void colour(const PlotColour& c) const { set_colour(cr_, c); }

  // Draws the ground, filled down to the axis, and the surface coloured by its visibility to the observer.
  void ground() const {
    const auto& points = figure_.points;
    const double floor = plot_.box.y + plot_.box.height;
    // One polygon per run without holes: adjacent polygons would leave seams.
    colour(kPlotGround);
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

  // Draws the first Fresnel zone, over the ground that it touches.
  void zone() const {
    const auto& points = figure_.zone;
    cairo_new_path(cr_);
    for (const ProfileFigureZone& p : points) cairo_line_to(cr_, x(p.distance), y(p.high));
    for (auto p = points.rbegin(); p != points.rend(); ++p) cairo_line_to(cr_, x(p->distance), y(p->low));
    cairo_close_path(cr_);
    colour({kSight.r, kSight.g, kSight.b, 0.18});
    cairo_fill_preserve(cr_);
    colour(kSight);
    cairo_set_line_width(cr_, 0.8);
    cairo_stroke(cr_);
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
  void dot(double distance, double height, const PlotColour& c) const {
    colour(c);
    cairo_new_path(cr_);
    cairo_arc(cr_, x(distance), y(height), 4.5, 0, 4 * std::acos(0.0));
    cairo_fill(cr_);
  }

  void legend() const {
    double at = plot_.box.x;
    const double base = figure_.height - 0.6 * pen_.line_height();
    const auto entry = [&](const PlotColour& c, const std::string& text, bool point) {
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
    if (!figure_.zone.empty()) entry(kZone, "first Fresnel zone", false);
  }

  cairo_t* cr_;
  FigurePen pen_;
  const ProfileFigure& figure_;
  Plot plot_;
};

}  // namespace

void write_profile_figure(ReplaceFile& file, const std::string& path, const ProfileFigure& figure) {
  write_plot(file, path, figure.width, figure.height, [&](cairo_t* cr) { Drawing(cr, figure).draw(); });
}

}  // namespace scarp
