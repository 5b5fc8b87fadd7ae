// SPDX-License-Identifier: MIT
// Measures skylines in SVG pictures.
#pragma once

#include <algorithm>
#include <numbers>
#include <string>
#include <vector>

#include "cli/program.h"
#include "cli/svg_paths.h"

namespace scarp::test {

inline constexpr double kDegree = std::numbers::pi / 180;

/// A skyline as it was drawn, with scales from the picture itself.
class DrawnSkyline {
 public:
  /// `fill`: of a layer; that of the farthest is the skyline.
  explicit DrawnSkyline(const std::string& file, const std::string& fill = "fill:rgb(74%,82%,90%)")
      : paths_(paths_of(text_of(file))) {
    // After a corner below the picture, from side to side. Cairo leaves out points on straight lines.
    const std::vector<SvgPoint>& all = path(fill).points;
    const auto right = std::max_element(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
    points_.assign(all.begin() + 1, right + 1);
  }

  const std::vector<SvgPoint>& points() const { return points_; }
  const SvgPoint& top() const {
    return *std::min_element(points_.begin(), points_.end(), [](const auto& a, const auto& b) { return a.y < b.y; });
  }
  /// Height of the line in pixels.
  double y(double azimuth) const {
    const double x = points_.front().x + azimuth / 360 * (points_.back().x - points_.front().x);
    auto after = std::find_if(points_.begin() + 1, points_.end(), [&](const SvgPoint& p) { return p.x >= x; });
    if (after == points_.end()) --after;
    const SvgPoint &a = *(after - 1), &b = *after;
    return a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x);
  }
  double azimuth(double x, double first = 0) const {
    return first + 360 * (x - points_.front().x) / (points_.back().x - points_.front().x);
  }
  /// Pixels of the dashed line at elevation 0.
  double level() const { return path("stroke-dasharray").points.front().y; }
  const SvgPath& path(const std::string& style) const {
    return *std::find_if(paths_.begin(), paths_.end(),
                         [&](const SvgPath& p) { return p.style.find(style) != std::string::npos; });
  }
  /// Centres of the dots of names.
  std::vector<SvgPoint> dots() const {
    std::vector<SvgPoint> centres;
    for (const SvgPath& p : paths_) {
      if (!p.curved || p.style.find("fill:rgb(10%,10%,10%)") == std::string::npos) continue;
      const auto [west, east] = std::minmax_element(p.points.begin(), p.points.end(),
                                                    [](const SvgPoint& a, const SvgPoint& b) { return a.x < b.x; });
      centres.push_back({(west->x + east->x) / 2, p.points.front().y});
    }
    return centres;
  }

 private:
  std::vector<SvgPath> paths_;
  std::vector<SvgPoint> points_;
};

}  // namespace scarp::test
