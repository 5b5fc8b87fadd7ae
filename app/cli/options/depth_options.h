// SPDX-License-Identifier: MIT
// Options for the near and far plane of a depth buffer.
#pragma once

#include <optional>

#include "app/options/command.h"
#include "scarp/render/camera/depth.h"

namespace scarp::cli {

struct DepthOptions {
  std::optional<DepthRange> range;  ///< nullopt: none, or fitted
  bool fitted = false;              ///< --depth-range auto
  bool reversed = false;

  /// Whether depths of a buffer are requested, in addition to metres.
  bool buffer() const { return range || fitted || reversed; }
};

/// Declares --depth-range and --depth-reversed of a subcommand that writes depths. Without planes, they enclose what
/// the picture shows.
void add_depth_options(Command& command, DepthOptions& options);
/// Declares both for a subcommand that reads depths, whose planes must be known.
void add_read_depth_options(Command& command, DepthOptions& options);

/// The range with its direction; nullopt if none was given.
std::optional<DepthRange> depth_range_of(const DepthOptions& options);

}  // namespace scarp::cli
