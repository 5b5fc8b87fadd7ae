// SPDX-License-Identifier: MIT
// The planes between which a depth buffer counts.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "scarp/render/camera/depth.h"

namespace scarp::cli {

/// What was typed.
struct DepthOptions {
  std::string range;
  bool reversed = false;
};

/// Adds --depth-range and --depth-reversed. `options` must live until the subcommand has run.
void add_depth_options(CLI::App& command, DepthOptions& options);

/// Nothing when none was given. Throws Error.
std::optional<DepthRange> depth_range_of(const DepthOptions& options);

}  // namespace scarp::cli
