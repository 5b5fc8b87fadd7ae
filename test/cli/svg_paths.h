// SPDX-License-Identifier: MIT
// The paths of an SVG picture by Cairo.
#pragma once

#include <cctype>
#include <sstream>
#include <string>
#include <vector>

namespace scarp::test {

struct SvgPoint {
  double x, y;
};

struct SvgPath {
  std::string style;
  bool curved = false;
  std::vector<SvgPoint> points;  ///< with control points
};

/// Cairo stores coordinates in steps of this many pixels.
inline constexpr double kSvgStep = 1.0 / 256;

/// Returns all paths in the order in which they are drawn, without the shapes of letters.
inline std::vector<SvgPath> paths_of(const std::string& svg) {
  std::vector<SvgPath> paths;
  const std::string open = "<path style=\"", middle = "\" d=\"";
  for (auto at = svg.find(open); at != std::string::npos; at = svg.find(open, at + 1)) {
    const auto style_end = svg.find(middle, at), end = svg.find('"', style_end + middle.size());
    SvgPath path;
    path.style = svg.substr(at + open.size(), style_end - at - open.size());
    if (path.style == "stroke:none;") continue;  // a letter
    std::string text = svg.substr(style_end + middle.size(), end - style_end - middle.size());
    path.curved = text.find('C') != std::string::npos;
    for (char& c : text)
      if (std::isalpha(static_cast<unsigned char>(c))) c = ' ';
    std::istringstream numbers(text);
    for (SvgPoint point{}; numbers >> point.x >> point.y;) path.points.push_back(point);
    paths.push_back(std::move(path));
  }
  return paths;
}

}  // namespace scarp::test
