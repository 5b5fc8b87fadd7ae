// SPDX-License-Identifier: MIT
// The depth buffer of a layered picture: what a renderer with near and far planes has in it.
#pragma once

#include <string>
#include <vector>

#include "app/cli/options/depth_options.h"

namespace scarp::cli {

struct DepthLayer {
  std::vector<float> values;  ///< empty unless DepthOptions::buffer()
  std::string note;           ///< the planes that were chosen, or that would show all surfaces; empty: nothing to say
};

/// Converts view depths in metres, infinite where nothing was hit. Surfaces beyond the planes have the depth of the
/// plane; no surface has the depth of the background, so a depth test keeps every surface in front of it.
DepthLayer depth_layer(const std::vector<float>& view_depths, const DepthOptions& options);

}  // namespace scarp::cli
