// SPDX-License-Identifier: MIT
// The planes between which a depth buffer counts.
#pragma once

#include <optional>
#include <string>

#include "app/options/command.h"
#include "scarp/render/camera/depth.h"

namespace scarp::cli {

/// Typed options.
struct DepthOptions {
  std::string range;
  bool reversed = false;
};

/// Declares --depth-range and --depth-reversed.
void add_depth_options(Command& command, DepthOptions& options);

/// Nothing when none was given. Throws Error.
std::optional<DepthRange> depth_range_of(const DepthOptions& options);

}  // namespace scarp::cli
