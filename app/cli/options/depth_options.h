// SPDX-License-Identifier: MIT
// Options for the near and far plane of a depth buffer.
#pragma once

#include <optional>

#include "app/options/command.h"
#include "scarp/render/camera/depth.h"

namespace scarp::cli {

struct DepthOptions {
  std::optional<DepthRange> range;
  bool reversed = false;
};

/// Declares --depth-range and --depth-reversed.
void add_depth_options(Command& command, DepthOptions& options);

/// The range with its direction; nullopt if none was given.
std::optional<DepthRange> depth_range_of(const DepthOptions& options);

}  // namespace scarp::cli
