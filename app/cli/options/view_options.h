// SPDX-License-Identifier: MIT
// The options of `scarp view`: those of a picture and those of the window.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "app/cli/options/render_options.h"

namespace scarp::cli {

struct ViewOptions : RenderOptions {
  std::string record;      ///< file to write events to; empty: none
  std::string play;        ///< file of events to play, with a fixed clock, before the window closes
  std::string screenshot;  ///< picture of the window after the last event, once it has converged
  std::string timings;     ///< table of events and presents to write; empty: none
  std::string window_device = "auto";
  bool validation = false;
};

/// Options that the window's command sets itself, or that `scarp render` does not have.
extern const std::vector<std::string_view> kWindowOptions;

/// Adds the subcommand and declares its options.
Command& declare_view(Program& program, ViewOptions& options);

}  // namespace scarp::cli
