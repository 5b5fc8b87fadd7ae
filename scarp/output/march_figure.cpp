// SPDX-License-Identifier: MIT
#include "scarp/output/march_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scarp/base/error.h"
#include "scarp/output/plot.h"

namespace scarp {
namespace {

constexpr double kPanelText = 13;  // pixels
constexpr double kTurn = 2 * std::numbers::pi;
// Heights of panels in pixels, if that of the figure is not given: heights are exaggerated until a panel has the least.
constexpr double kLeastPanel = 170, kMostPanel = 420;
constexpr double kPanelMargin = 0.05;  // of the range of heights, above and below
constexpr double kBeside = 0.012;      // of the range of distances, on both sides
constexpr double kMostBeside = 0.2;    // of the length of the ray: room for balls beside its ends
constexpr double kLeastBall = 7;       // pixels, for cones
constexpr double kLeastCircle = 1;     // pixels, of balls that are drawn
constexpr double kLeastDots = 0.8;     // pixels between dots of samples
constexpr double kCellWidth = 5;       // pixels, of cells along the ray
constexpr double kLeastGap = 5;        // pixels between shells

constexpr PlotColour kRayLine{0.15, 0.15, 0.15}, kBeyondHit{0.15, 0.15, 0.15, 0.45}, kSurface{0.45, 0.38, 0.28},
    kSample{0.00, 0.27, 0.55}, kBar{0.00, 0.45, 0.70, 0.55}, kStep{0.00, 0.45, 0.70, 0.95}, kRefined{0.80, 0.47, 0.65},
    kShell{0.34, 0.55, 0.75, 0.6}, kBall{0.00, 0.45, 0.70, 0.10}, kBallEdge{0.00, 0.45, 0.70, 0.85},
    kCone{0.35, 0.35, 0.35, 0.8}, kPassed{0.34, 0.71, 0.91, 0.22}, kPassedEdge{0.10, 0.45, 0.70, 0.9},
    kEntered{0.90, 0.62, 0.00, 0.16}, kEnteredEdge{0.80, 0.50, 0.00, 0.9}, kTested{0.84, 0.37, 0.00},
    kHit{0.80, 0.05, 0.05};

// An entry of the legend.
struct Key {
  std::string text;
  PlotColour fill, edge;
  enum class Shape { line, thick, dashes, dot, ring, box } shape;
};

std::vector<Key> keys_of(const MarchPanel& panel) {
  using Shape = Key::Shape;
  switch (panel.marks) {
    case MarchMarks::bars:
      return {{"height above ground", kBar, kBar, Shape::line}, {"length of the step", kStep, kStep, Shape::line}};
    case MarchMarks::shells:
      return {{"shell around the start", kShell, kShell, Shape::line}};
    case MarchMarks::balls: {
      std::vector<Key> keys{{panel.proof == BallProof::none ? "ball that may contain ground" : "ball free of ground",
                             kBall, kBallEdge, Shape::ring}};
      const std::vector<TraceStep>& steps = panel.trace.steps;
      if (std::any_of(steps.begin(), steps.end(), [](const TraceStep& step) { return step.clearance > step.free; }))
        keys.push_back({panel.proof == BallProof::steepest_slope ? "steepest slope" : "slope that the step allows for",
                        kCone, kCone, Shape::dashes});
      return keys;
    }
    case MarchMarks::blocks:
      return {{"block passed", kPassed, kPassedEdge, Shape::box},
              {"block entered", kEntered, kEnteredEdge, Shape::box},
              {"cell passed", kPassedEdge, kPassedEdge, Shape::thick},
              {"cell tested", kTested, kTested, Shape::thick}};
  }
  return {};
}

class MarchDrawing {
 public:
  explicit MarchDrawing(const MarchFigure& figure) : figure_(figure) {
    collect_keys();
    lay_out_legend();
    find_range();
    place_panels();
  }

  int width() const { return figure_.width; }
  int height() const { return static_cast<int>(std::ceil(height_)); }
  /// Whether the panels have a sensible height.
  bool fits() const { return panel_ >= 4 * kPanelText; }

  void draw(cairo_t* cr) {
    const FigurePen pen(cr, kPanelText);
    const double line = pen.line_height();
    pen.write(left(), line, figure_.title);
    pen.write(left(), 2 * line, fmt::format("{}; straight rays, no curvature", scale_text()));
    double top = kHeader * line_;
    for (std::size_t i = 0; i < figure_.panels.size(); ++i) {
      const bool last = i + 1 == figure_.panels.size();
      plot_.box = {left(), top + kCaption * line_, plot_width_, panel_};
      draw_panel(pen, figure_.panels[i], last);
      top += kCaption * line_ + panel_ + kBelow * line_;
    }
    legend(pen);
  }

 private:
  // In lines of text: above the first panel, for the caption of each, for the numbers below each, and at the end.
  static constexpr double kHeader = 2.4, kCaption = 1.6, kBelow = 1.7, kFooter = 3.1;

  void collect_keys() {
    bool sampled = false, refined = false, any = false;
    for (const MarchPanel& panel : figure_.panels) {
      any = any || panel.hit;
      for (const TraceStep& step : panel.trace.steps) {
        sampled = sampled || is_sample(step.kind);
        refined = refined || step.kind == TraceKind::refinement;
      }
    }
    if (sampled) keys_.push_back({"sample", kSample, kSample, Key::Shape::dot});
    if (refined) keys_.push_back({"sample of the refinement", kRefined, kRefined, Key::Shape::dot});
    for (const MarchPanel& panel : figure_.panels) {
      for (const Key& key : keys_of(panel)) {
        const auto same = [&](const Key& other) { return other.text == key.text; };
        if (std::none_of(keys_.begin(), keys_.end(), same)) keys_.push_back(key);
      }
    }
    if (any) keys_.push_back({"hit", {1, 1, 1}, kHit, Key::Shape::ring});
  }

  // Counts the lines of the legend, with the font of the figure.
  void lay_out_legend() {
    const CairoSurface surface(cairo_recording_surface_create(CAIRO_CONTENT_COLOR, nullptr));
    const CairoContext context(cairo_create(surface.get()));
    const FigurePen pen(context.get(), kPanelText);
    place_keys(pen, [&](const Key&, double, int line) { legend_lines_ = line + 1; });
  }
  // Calls place(key, x, line) with the places of the legend, from the left, in as many lines as the width requires.
  template <class Place>
  void place_keys(const FigurePen& pen, const Place& place) const {
    double at = left();
    int line = 0;
    for (const Key& key : keys_) {
      const double wide = 3.7 * kPanelText + pen.width_of(key.text);
      if (at > left() && at + wide > figure_.width - kPanelText) at = left(), ++line;
      place(key, at, line);
      at += wide;
    }
  }

  double left() const { return 5 * kPanelText; }
  std::string scale_text() const {
    return std::abs(exaggeration_ - 1) < 5e-4 ? "equal axes" : fmt::format("heights x {:.3g}", exaggeration_);
  }
  double distance(double t) const { return figure_.distance_per_t * t; }
  double ray_height(double t) const { return figure_.z + figure_.rise_per_t * t; }
  double begin_time() const { return figure_.begin / figure_.distance_per_t; }
  double end_time() const { return figure_.length / figure_.distance_per_t; }
  double x(double t) const { return plot_.x(distance(t)); }
  double y(double t) const { return plot_.y(ray_height(t)); }

  void find_range() {
    const double t_begin = begin_time(), t_end = end_time(), spare = kMostBeside * (figure_.length - figure_.begin);
    double low = std::min(ray_height(t_begin), ray_height(t_end)),
           high = std::max(ray_height(t_begin), ray_height(t_end));
    for (const MarchFigurePoint& p : figure_.ground)
      if (std::isfinite(p.height)) low = std::min(low, p.height), high = std::max(high, p.height);
    plot_.begin = figure_.begin, plot_.end = figure_.length;
    for (const MarchPanel& panel : figure_.panels) {
      for (const TraceStep& step : panel.trace.steps) {
        if (is_block(step.kind)) high = std::max(high, step.maximum);
        if (panel.marks != MarchMarks::balls || !(step.free > 0) || step.clearance < 0) continue;
        high = std::max(high, ray_height(step.t) + step.free);
        plot_.begin = std::min(plot_.begin, std::max(distance(step.t) - step.free, figure_.begin - spare));
        plot_.end = std::max(plot_.end, std::min(distance(step.t) + step.free, figure_.length + spare));
      }
    }
    const double beside = kBeside * (plot_.end - plot_.begin);
    plot_.begin -= beside, plot_.end += beside;
    const double margin = std::max(kPanelMargin * (high - low), 1e-3 * (figure_.length - figure_.begin));
    plot_.low = low - margin, plot_.high = high + margin;
  }

  // Equal axes or, if panels would be too low, exaggerated ones; and narrower plots, if they would be too high.
  void place_panels() {
    plot_width_ = figure_.width - 6.5 * kPanelText;
    line_ = 1.2 * kPanelText;
    const auto count = static_cast<double>(figure_.panels.size());
    const double around = line_ * (kHeader + kFooter + count * (kCaption + kBelow) + 1.2 * (legend_lines_ - 1));
    const double natural = plot_width_ * (plot_.high - plot_.low) / (plot_.end - plot_.begin);
    if (figure_.height > 0) {
      height_ = figure_.height;
      panel_ = (height_ - around) / count;
      if (panel_ < natural) plot_width_ *= panel_ / natural;
      exaggeration_ = std::max(1.0, panel_ / natural);
      return;
    }
    for (double power = 1; panel_ < kLeastPanel; power *= 10) {
      for (const double factor : {1.0, 2.0, 5.0}) {
        if (panel_ < kLeastPanel) exaggeration_ = factor * power, panel_ = natural * exaggeration_;
      }
    }
    if (panel_ > kMostPanel && exaggeration_ == 1) plot_width_ *= kMostPanel / panel_, panel_ = kMostPanel;
    height_ = around + count * panel_;
  }

  void draw_panel(const FigurePen& pen, const MarchPanel& panel, bool last) {
    cr_ = pen.cr();
    plot_.axes(pen, last);
    pen.write(plot_.box.x, plot_.box.y - 0.4 * kPanelText, panel.caption);
    cairo_save(cr_);
    cairo_rectangle(cr_, plot_.box.x, plot_.box.y, plot_.box.width, plot_.box.height);
    cairo_clip(cr_);
    ground();
    switch (panel.marks) {
      case MarchMarks::bars:
        bars(panel);
        break;
      case MarchMarks::shells:
        shells(panel);
        break;
      case MarchMarks::balls:
        balls(panel);
        break;
      case MarchMarks::blocks:
        blocks(panel);
        break;
    }
    ray(panel);
    samples(panel);
    cairo_restore(cr_);
    if (panel.hit) hit(panel.hit.t);
    pen.frame(plot_.box, 1);
  }

  void stroke(const PlotColour& colour, double line_width) const {
    set_colour(cr_, colour);
    cairo_set_line_width(cr_, line_width);
    cairo_stroke(cr_);
  }
  void segment(double x0, double y0, double x1, double y1) const {
    cairo_move_to(cr_, x0, y0);
    cairo_line_to(cr_, x1, y1);
  }
  void dot(double at_x, double at_y, double radius, const PlotColour& colour) const {
    cairo_new_path(cr_);
    cairo_arc(cr_, at_x, at_y, radius, 0, kTurn);
    set_colour(cr_, colour);
    cairo_fill(cr_);
  }
  // Along a circle in metres, which is an ellipse if heights are exaggerated.
  void arc(double at_distance, double at_height, double radius, double from, double to) const {
    cairo_save(cr_);
    cairo_translate(cr_, plot_.x(at_distance), plot_.y(at_height));
    cairo_scale(cr_, plot_.box.width / (plot_.end - plot_.begin), plot_.box.height / (plot_.high - plot_.low));
    cairo_new_sub_path(cr_);
    cairo_arc(cr_, 0, 0, radius, from, to);
    cairo_restore(cr_);
  }

  void ground() const {
    const auto& points = figure_.ground;
    const double floor = plot_.box.y + plot_.box.height;
    for (std::size_t begin = 0; begin < points.size();) {
      std::size_t end = begin;
      while (end < points.size() && std::isfinite(points[end].height)) ++end;
      if (end > begin + 1) {
        const auto surface = [&] {
          for (std::size_t i = begin; i < end; ++i)
            cairo_line_to(cr_, plot_.x(points[i].distance), plot_.y(points[i].height));
        };
        cairo_move_to(cr_, plot_.x(points[begin].distance), floor);
        surface();
        cairo_line_to(cr_, plot_.x(points[end - 1].distance), floor);
        set_colour(cr_, kPlotGround);
        cairo_fill(cr_);
        surface();
        stroke(kSurface, 1.5);
      }
      begin = end + 1;
    }
  }

  void bars(const MarchPanel& panel) const {
    const auto& steps = panel.trace.steps;
    for (const TraceStep& step : steps) {
      if (step.kind != TraceKind::sample) continue;
      segment(x(step.t), y(step.t), x(step.t), plot_.y(ray_height(step.t) - step.clearance));
    }
    stroke(kBar, 1.2);
    // The upper part of each is as long as the step that follows.
    const double metres = std::hypot(figure_.distance_per_t, figure_.rise_per_t);
    for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
      if (steps[i].kind != TraceKind::sample || steps[i + 1].kind != TraceKind::sample) continue;
      const double length = std::copysign(metres * (steps[i + 1].t - steps[i].t), steps[i].clearance);
      segment(x(steps[i].t), y(steps[i].t), x(steps[i].t), plot_.y(ray_height(steps[i].t) - length));
    }
    stroke(kStep, 2.6);
  }

  void shells(const MarchPanel& panel) const {
    constexpr double kHalf = 0.14;  // of an arc, in radians
    const double toward = std::atan2(-figure_.rise_per_t, figure_.distance_per_t);
    const double metres = std::hypot(figure_.distance_per_t, figure_.rise_per_t);
    double before = -1e300;
    for (const TraceStep& step : panel.trace.steps) {
      if (!is_sample(step.kind) || std::hypot(x(step.t) - x(before), y(step.t) - y(before)) < kLeastGap) continue;
      before = step.t;
      arc(0, figure_.z, metres * step.t, toward - kHalf, toward + kHalf);
    }
    stroke(kShell, 1);
  }

  void balls(const MarchPanel& panel) const {
    const double pixels = plot_.box.width / (plot_.end - plot_.begin);
    for (const TraceStep& step : panel.trace.steps) {
      if (!(step.free * pixels > kLeastCircle) || step.clearance < 0) continue;
      const double at = distance(step.t), z = ray_height(step.t);
      arc(at, z, step.free, 0, kTurn);
      set_colour(cr_, kBall);
      cairo_fill_preserve(cr_);
      stroke(kBallEdge, 1);
    }
    // The cone of the bound: as steep as the ground may be for the step to be safe, from the ground below a point to
    // where it touches the ball.
    constexpr std::array kDashes{4.0, 3.0};
    cairo_set_dash(cr_, kDashes.data(), 2, 0);
    for (const TraceStep& step : panel.trace.steps) {
      if (step.kind != TraceKind::sample || !(step.free * pixels > kLeastBall) || !(step.clearance > step.free))
        continue;
      const double at = distance(step.t), foot = ray_height(step.t) - step.clearance;
      const double slope = std::sqrt(std::pow(step.clearance / step.free, 2) - 1);
      const double across = slope * step.clearance / (1 + slope * slope);
      for (const double side : {-1.0, 1.0})
        segment(plot_.x(at), plot_.y(foot), plot_.x(at + side * across), plot_.y(foot + slope * across));
    }
    stroke(kCone, 1);
    cairo_set_dash(cr_, nullptr, 0, 0);
  }

  void blocks(const MarchPanel& panel) const {
    const double floor = plot_.box.y + plot_.box.height;
    // The coarse ones first: finer ones are drawn over them.
    std::vector<const TraceStep*> steps;
    for (const TraceStep& step : panel.trace.steps)
      if (is_block(step.kind)) steps.push_back(&step);
    std::stable_sort(steps.begin(), steps.end(), [](const auto* a, const auto* b) { return a->level > b->level; });
    for (const TraceStep* step : steps) {
      const bool passed = step->kind == TraceKind::passed_block;
      const double from = x(step->t), to = x(step->t_out), top = plot_.y(step->maximum);
      cairo_rectangle(cr_, from, top, to - from, floor - top);
      set_colour(cr_, passed ? kPassed : kEntered);
      cairo_fill_preserve(cr_);
      stroke(passed ? kPassedEdge : kEnteredEdge, passed ? 1.2 : 0.8);
    }
    for (const TraceStep& step : panel.trace.steps) {
      if (!is_cell(step.kind)) continue;
      const double end = std::isfinite(step.t_out) ? step.t_out : step.t;
      segment(x(step.t), y(step.t), x(end), y(end));
      stroke(step.kind == TraceKind::tested_cell ? kTested : kPassedEdge, kCellWidth);
    }
  }

  void ray(const MarchPanel& panel) const {
    const double begin = begin_time(), t_end = end_time(), t = panel.hit ? panel.hit.t : t_end;
    segment(x(begin), y(begin), x(t), y(t));
    stroke(kRayLine, 1.4);
    if (!panel.hit) return;
    constexpr std::array kDashes{2.0, 4.0};
    cairo_set_dash(cr_, kDashes.data(), 2, 0);
    segment(x(t), y(t), x(t_end), y(t_end));
    stroke(kBeyondHit, 1.2);
    cairo_set_dash(cr_, nullptr, 0, 0);
  }

  // Smaller where they are dense. Points with round caps: circles would be most of an SVG.
  void samples(const MarchPanel& panel) const {
    constexpr std::array kRadii{0.9, 1.7, 2.6};
    cairo_set_line_cap(cr_, CAIRO_LINE_CAP_ROUND);
    for (const bool refines : {false, true}) {
      for (std::size_t size = 0; size < kRadii.size(); ++size) {
        double before = -1e300;
        for (const TraceStep& step : panel.trace.steps) {
          if (!is_sample(step.kind) || (step.kind == TraceKind::refinement) != refines) continue;
          const double gap = std::hypot(x(step.t) - x(before), y(step.t) - y(before));
          if (gap < kLeastDots) continue;
          before = step.t;
          if (size == (gap > 7 ? 2u : gap > 4 ? 1u : 0u)) segment(x(step.t), y(step.t), x(step.t), y(step.t));
        }
        stroke(refines ? kRefined : kSample, 2 * kRadii[size]);
      }
    }
    cairo_set_line_cap(cr_, CAIRO_LINE_CAP_BUTT);
  }

  void hit(double t) const {
    constexpr double kRadius = 6;
    dot(x(t), y(t), kRadius, {1, 1, 1});
    cairo_new_path(cr_);
    cairo_arc(cr_, x(t), y(t), kRadius - 1, 0, kTurn);
    stroke(kHit, 2.2);
    dot(x(t), y(t), 2, kHit);
  }

  void legend(const FigurePen& pen) {
    cr_ = pen.cr();
    place_keys(pen, [&](const Key& key, double at, int line) {
      const double base = height() - (0.6 + 1.4 * (legend_lines_ - 1 - line)) * kPanelText;
      symbol(key, at, base - kPanelText / 3);
      pen.write(at + 2.3 * kPanelText, base, key.text);
    });
  }
  void symbol(const Key& key, double at, double middle) const {
    const double wide = 1.8 * kPanelText, half = 0.45 * kPanelText;
    cairo_new_path(cr_);
    switch (key.shape) {
      case Key::Shape::dashes:
      case Key::Shape::thick:
      case Key::Shape::line: {
        constexpr std::array kDashes{4.0, 3.0};
        if (key.shape == Key::Shape::dashes) cairo_set_dash(cr_, kDashes.data(), 2, 0);
        segment(at, middle, at + wide, middle);
        stroke(key.edge, key.shape == Key::Shape::thick ? kCellWidth : 1.5);
        cairo_set_dash(cr_, nullptr, 0, 0);
        return;
      }
      case Key::Shape::dot:
        return dot(at + wide / 2, middle, 3, key.fill);
      case Key::Shape::ring:
        cairo_arc(cr_, at + wide / 2, middle, half, 0, kTurn);
        break;
      case Key::Shape::box:
        cairo_rectangle(cr_, at, middle - half, wide, 2 * half);
        break;
    }
    set_colour(cr_, key.fill);
    cairo_fill_preserve(cr_);
    stroke(key.edge, 1.2);
  }

  const MarchFigure& figure_;
  std::vector<Key> keys_;
  int legend_lines_ = 1;
  Plot plot_;
  double plot_width_ = 0, panel_ = 0, height_ = 0, line_ = 0, exaggeration_ = 1;
  cairo_t* cr_ = nullptr;
};

}  // namespace

void write_march_figure(ReplaceFile& file, const std::string& path, const MarchFigure& figure) {
  MarchDrawing drawing(figure);
  if (!drawing.fits()) {
    throw Error(fmt::format("output '{}': {} panels do not fit in {} pixels (raise the height of --size)", path,
                            figure.panels.size(), figure.height));
  }
  write_plot(file, path, drawing.width(), drawing.height(), [&](cairo_t* cr) { drawing.draw(cr); });
}

}  // namespace scarp
