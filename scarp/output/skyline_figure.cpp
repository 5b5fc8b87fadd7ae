// SPDX-License-Identifier: MIT
#include "scarp/output/skyline_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scarp/output/plot.h"

namespace scarp {
namespace {

constexpr double kSkylineText = 13;  // pixels
constexpr double kNoGround = -89.9;  // degrees: directions without ground are below
constexpr double kLeftOfPlot = 5;    // texts, left of the plot
constexpr double kKeyWidth = 2;      // texts, of a colour in the legend with its gap
constexpr double kLeastRange = 2;    // degrees of elevation
constexpr double kFullTurn = 2 * std::numbers::pi;

constexpr PlotColour kNearGround{0.25, 0.33, 0.20}, kFarGround{0.74, 0.82, 0.90}, kSun{0.90, 0.55, 0.05},
    kMark{0.62, 0.20, 0.16}, kName{0.10, 0.10, 0.10}, kLevel{0.35, 0.35, 0.35};
constexpr std::array<PlotColour, 4> kPaths{
    {{0.45, 0.45, 0.45}, {0.10, 0.45, 0.70}, {0.10, 0.55, 0.20}, {0.62, 0.20, 0.60}}};

PlotColour between(const PlotColour& a, const PlotColour& b, double share) {
  const auto mix = [&](double from, double to) { return from + share * (to - from); };
  return {mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b)};
}

std::vector<PlotTick> ticks_of(double first, bool every) {
  constexpr std::array<const char*, 8> kWinds{"N", "NE", "E", "SE", "S", "SW", "W", "NW"};
  const int step = every ? 15 : 45;
  std::vector<PlotTick> ticks;
  for (int at = static_cast<int>(std::ceil(first / step)) * step; at <= first + 360; at += step)
    ticks.push_back({static_cast<double>(at), fmt::format("{}", at % 360),
                     at % 45 == 0 ? kWinds[static_cast<std::size_t>(at / 45 % 8)] : ""});
  return ticks;
}

class SkylineDrawing {
 public:
  SkylineDrawing(cairo_t* cr, const SkylineFigure& figure) : cr_(cr), pen_(cr, kSkylineText), figure_(figure) {
    const double line = pen_.line_height();
    double low = 0, high = 0;
    for (const double elevation : figure.layers.front().elevation)
      if (elevation > kNoGround) low = std::min(low, elevation), high = std::max(high, elevation);
    // Places at the observer's feet would leave no room for the skyline.
    for (const SkylineLabel& label : figure.labels) high = std::max(high, label.at.elevation);
    double sun = high;
    for (const SunPath& path : figure.paths)
      for (const SkyPoint& point : path.points) sun = std::max(sun, point.elevation);
    const double range = std::max(high - low, kLeastRange);
    rows_ = lay_out_legend();
    const double beside = kLeftOfPlot * kSkylineText;
    plot_.box = {beside, 2.6 * line, figure.width - beside - 1.5 * kSkylineText, figure.height - (7.1 + rows_) * line};
    plot_.begin = figure.azimuths.front(), plot_.end = figure.azimuths.back();
    plot_.low = low - 0.25 * range;
    // Names are above the skyline.
    plot_.high = std::max(low + range + (figure.labels.empty() ? 0.12 : 0.6) * range, 1.08 * sun);
    constexpr double kTicks = 24;
    plot_.ticks = ticks_of(plot_.begin, plot_.box.width / kTicks > 3 * kSkylineText);
    plot_.along = "azimuth (degrees from true north)", plot_.upward = "elevation (degrees)";
  }

  void draw() {
    plot_.axes(pen_, true);
    cairo_save(cr_);
    cairo_rectangle(cr_, plot_.box.x, plot_.box.y, plot_.box.width, plot_.box.height);
    cairo_clip(cr_);
    for (std::size_t i = 0; i < figure_.paths.size(); ++i) path(i);
    for (std::size_t i = 0; i < figure_.layers.size(); ++i) layer(i);
    level();
    cairo_restore(cr_);
    for (const SkylineLabel& mark : figure_.marks) named_dot(mark, kMark);
    for (const SkylineLabel& label : figure_.labels) place(label);
    pen_.frame(plot_.box, 1);
    pen_.write(plot_.box.x, pen_.line_height(), figure_.title);
    const double exaggeration =
        plot_.box.height / (plot_.high - plot_.low) * (plot_.end - plot_.begin) / plot_.box.width;
    pen_.write(plot_.box.x, 2 * pen_.line_height(),
               fmt::format("{}; elevations {:.2g} times as large as azimuths", figure_.remark, exaggeration));
    legend();
  }

  int left_out() const { return left_out_; }

 private:
  double x(double azimuth) const {
    double at = azimuth;
    while (at < plot_.begin) at += 360;
    while (at > plot_.end) at -= 360;
    return plot_.x(at);
  }
  double y(double elevation) const { return plot_.y(elevation); }
  double floor() const { return plot_.box.y + plot_.box.height; }
  void colour(const PlotColour& c) const { set_colour(cr_, c); }

  PlotColour colour_of(std::size_t layer) const {
    const std::size_t last = figure_.layers.size() - 1;
    return between(kFarGround, kNearGround, last == 0 ? 0.5 : static_cast<double>(layer) / static_cast<double>(last));
  }

  // Fills the ground below a layer, and draws its edge.
  void layer(std::size_t i) const {
    const auto& elevation = figure_.layers[i].elevation;
    // Directions without ground end below the picture.
    const auto height = [&](std::size_t k) { return std::min(y(elevation[k]), 2 * floor()); };
    cairo_move_to(cr_, plot_.x(plot_.begin), 2 * floor());
    for (std::size_t k = 0; k < elevation.size(); ++k) cairo_line_to(cr_, plot_.x(figure_.azimuths[k]), height(k));
    cairo_line_to(cr_, plot_.x(plot_.end), 2 * floor());
    cairo_close_path(cr_);
    colour(colour_of(i));
    cairo_fill_preserve(cr_);
    colour(between(colour_of(i), {0, 0, 0}, 0.35));
    cairo_set_line_width(cr_, i == 0 ? 1.5 : 0.7);
    cairo_set_line_join(cr_, CAIRO_LINE_JOIN_ROUND);
    cairo_stroke(cr_);
  }

  // Draws the horizontal.
  void level() const {
    constexpr double kDashes[] = {2, 4};
    colour(kLevel);
    cairo_set_line_width(cr_, 1);
    cairo_set_dash(cr_, kDashes, 2, 0);
    cairo_move_to(cr_, plot_.box.x, y(0));
    cairo_rel_line_to(cr_, plot_.box.width, 0);
    cairo_stroke(cr_);
    cairo_set_dash(cr_, nullptr, 0, 0);
  }

  void dot(const SkyPoint& at, double radius) const {
    cairo_new_path(cr_);
    cairo_arc(cr_, x(at.azimuth), y(at.elevation), radius, 0, kFullTurn);
    cairo_fill(cr_);
  }

  // The name is below: above may be a path.
  void named_dot(const SkylineLabel& label, const PlotColour& c) const {
    colour(c);
    dot(label.at, 4);
    if (label.name.empty()) return;
    const double half = pen_.width_of(label.name) / 2 + pen_.gap();
    const double at = std::clamp(x(label.at.azimuth), plot_.box.x + half, plot_.box.x + plot_.box.width - half);
    pen_.write_on_picture({at, y(label.at.elevation) + 1.2 * kSkylineText}, 0, label.name);
  }

  double width_of_path(std::size_t i) const { return figure_.paths[i].main ? 2.5 : 1.2; }
  PlotColour colour_of_path(std::size_t i) const { return figure_.paths[i].main ? kSun : kPaths[i % kPaths.size()]; }

  void path(std::size_t i) const {
    const SunPath& sun = figure_.paths[i];
    double before = plot_.box.x;
    for (const SkyPoint& point : sun.points) {
      const double at = x(point.azimuth);
      // The path leaves the figure on one side and enters it on the other.
      const bool jumps = &point == &sun.points.front() || std::abs(at - before) > plot_.box.width / 2;
      before = at;
      jumps ? cairo_move_to(cr_, at, y(point.elevation)) : cairo_line_to(cr_, at, y(point.elevation));
    }
    colour(colour_of_path(i));
    cairo_set_line_width(cr_, width_of_path(i));
    cairo_stroke(cr_);
    for (const SkylineLabel& hour : sun.hours) {
      colour(colour_of_path(i));
      dot(hour.at, sun.main ? 4 : 2);
      if (!hour.name.empty())
        pen_.write_on_picture({x(hour.at.azimuth), y(hour.at.elevation) - kSkylineText}, 0, hour.name);
    }
  }

  // The highest pixel of the skyline between two positions.
  double top_between(double left, double right) const {
    double top = floor();
    for (std::size_t k = 0; k < figure_.azimuths.size(); ++k) {
      const double at = plot_.x(figure_.azimuths[k]);
      if (at >= left && at <= right) top = std::min(top, y(figure_.layers.front().elevation[k]));
    }
    return top;
  }

  // Draws a label in the lowest free row above the skyline, right or left of its line.
  void place(const SkylineLabel& label) {
    const double at = x(label.at.azimuth), from = y(label.at.elevation), high = pen_.line_height();
    if (from > floor()) return void(++left_out_);
    const double wide = pen_.width_of(label.name), gap = pen_.gap();
    constexpr double kLine = 1;  // half the width of a line's room
    for (const bool right : {true, false}) {
      const double left = right ? at + gap : at - gap - wide;
      if (left < plot_.box.x + gap || left + wide > plot_.box.x + plot_.box.width - gap) continue;
      const double first = std::min(top_between(left, left + wide), from) - 1.5 * high;
      for (double row = first; row >= plot_.box.y + gap; row -= high) {
        const FigureRect text{left, row, wide, high}, line{at - kLine, row, 2 * kLine, from - row};
        const auto touches = [&](const FigureRect& other) { return text.touches(other) || line.touches(other); };
        if (std::any_of(taken_.begin(), taken_.end(), touches)) continue;
        taken_.push_back(text), taken_.push_back(line);
        colour(kName);
        cairo_set_line_width(cr_, 0.8);
        cairo_move_to(cr_, at, from);
        cairo_line_to(cr_, at, row + 0.2 * high);
        cairo_stroke(cr_);
        dot(label.at, 2.5);
        pen_.write(left, row + pen_.ascent(), label.name);
        return;
      }
    }
    ++left_out_;
  }

  // An entry of the legend.
  struct Key {
    enum class Shape { none, box, line } shape;
    PlotColour colour;
    double line_width;
    std::string text;
    double x = 0;
    int row = 0;
  };

  // Ground from near to far, then paths, in as many rows as they need. Returns their number.
  int lay_out_legend() {
    if (figure_.layers.size() > 1) keys_.push_back({Key::Shape::none, {}, 0, "distance of the ground:"});
    for (std::size_t i = figure_.layers.size(); i-- > 0;)
      if (!figure_.layers[i].name.empty()) keys_.push_back({Key::Shape::box, colour_of(i), 0, figure_.layers[i].name});
    for (std::size_t i = 0; i < figure_.paths.size(); ++i)
      keys_.push_back({Key::Shape::line, colour_of_path(i), width_of_path(i), figure_.paths[i].name});
    const double left = kLeftOfPlot * kSkylineText, right = figure_.width - kSkylineText;
    double at = left;
    int row = 0;
    for (Key& key : keys_) {
      const double wide = (key.shape == Key::Shape::none ? 0 : kKeyWidth * kSkylineText) + pen_.width_of(key.text);
      if (at + wide > right && at > left) at = left, ++row;
      key.x = at, key.row = row;
      at += wide + kSkylineText;
    }
    return keys_.empty() ? 0 : row + 1;
  }

  void legend() const {
    const double side = kSkylineText;
    for (const Key& key : keys_) {
      const double base = figure_.height - (rows_ - key.row - 0.4) * pen_.line_height();
      colour(key.colour);
      if (key.shape == Key::Shape::box) {
        cairo_rectangle(cr_, key.x, base - 0.8 * side, 1.5 * side, side);
        cairo_fill(cr_);
      } else if (key.shape == Key::Shape::line) {
        cairo_set_line_width(cr_, key.line_width);
        cairo_move_to(cr_, key.x, base - side / 3);
        cairo_rel_line_to(cr_, 1.5 * side, 0);
        cairo_stroke(cr_);
      }
      pen_.write(key.x + (key.shape == Key::Shape::none ? 0 : kKeyWidth * side), base, key.text);
    }
  }

  cairo_t* cr_;
  FigurePen pen_;
  const SkylineFigure& figure_;
  Plot plot_;
  std::vector<Key> keys_;
  int rows_ = 0;                   // of the legend
  std::vector<FigureRect> taken_;  // by labels
  int left_out_ = 0;
};

}  // namespace

int write_skyline_figure(ReplaceFile& file, const std::string& path, const SkylineFigure& figure) {
  int left_out = 0;
  write_plot(file, path, figure.width, figure.height, [&](cairo_t* cr) {
    SkylineDrawing drawing(cr, figure);
    drawing.draw();
    left_out = drawing.left_out();
  });
  return left_out;
}

}  // namespace scarp
