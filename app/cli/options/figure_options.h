// SPDX-License-Identifier: MIT
// Options of a picture's annotations: title, legend, scale bar, north arrow, graticule, labels of contour lines.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "app/cli/options/draw_options.h"
#include "app/options/command.h"

namespace scarp::cli {

/// --graticule.
struct GraticuleSpacing {
  std::optional<double> degrees;  ///< nullopt: automatic
};

struct FigureOptions {
  bool legend = false, scale_bar = false, north_arrow = false, contour_labels = false;
  std::string title, layout = "on";
  std::optional<GraticuleSpacing> graticule;
  double dots_per_inch = 150;
  DrawOptions draw;

  /// The first option that was given, for messages; empty if there is none.
  std::string_view any() const;
};

/// `top` is the value of --top, and `output` the file's name; both must outlive the command.
void add_figure_options(Command& command, FigureOptions& options, const bool& top, const std::string& output);

}  // namespace scarp::cli
