// SPDX-License-Identifier: MIT
// Options for the near and far plane of a depth buffer.
#pragma once

#include <optional>

#include "app/options/command.h"
#include "scarp/render/camera/depth.h"

namespace scarp::cli {

struct DepthOptions {
  std::optional<DepthRange> range;  ///< nullopt: none, or fitted
  bool fitted = false;              ///< the planes enclose what the picture shows
  bool reversed = false;
};

/// Declares --depth-range and --depth-reversed.
void add_depth_options(Command& command, DepthOptions& options);

/// The range with its direction; nullopt if none was given. Throws Error if it is to be fitted to a picture.
std::optional<DepthRange> depth_range_of(const DepthOptions& options);

}  // namespace scarp::cli
