// SPDX-License-Identifier: MIT
// --draw: vectors on maps.
#pragma once

#include <string>
#include <vector>

#include "app/options/command.h"

namespace scarp::cli {

struct DrawOptions {
  std::vector<std::string> files;
  std::string label;  ///< column; empty: no labels
};

/// Declares --draw and --draw-label. `rule`: when maps are drawn.
void add_draw_options(Command& command, DrawOptions& options, Topic topic, const Rule& rule,
                      const std::vector<std::string>& excludes = {});

}  // namespace scarp::cli
