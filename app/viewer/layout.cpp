// SPDX-License-Identifier: MIT
#include "app/viewer/layout.h"

#include <algorithm>
#include <cmath>

namespace scarp::viewer {
namespace {

constexpr double kLeastPicture = 420;  // width beside a panel, in pixels at a scale of 1

}  // namespace

WindowLayout layout_of(int width, int height, bool panel, double scale) {
  WindowLayout layout{.width = std::max(width, 1), .height = std::max(height, 1)};
  const int column = static_cast<int>(std::lround(kPanelWidth * scale));
  layout.beside = panel && width - column >= kLeastPicture * scale;
  if (layout.beside) layout.left = column, layout.width = width - column;
  layout.panel_width = std::clamp(width - 2 * kMargin * scale, 1.0, static_cast<double>(column));
  return layout;
}

}  // namespace scarp::viewer
