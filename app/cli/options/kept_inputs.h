// SPDX-License-Identifier: MIT
// Outputs never overwrite inputs.
#pragma once

#include <string>
#include <vector>

namespace scarp::cli {

/// Throws Error if `output` refers to the same file as any of `inputs`. Ignores inputs that do not exist.
void keep_inputs(const std::string& output, const std::vector<std::string>& inputs);

}  // namespace scarp::cli
