// SPDX-License-Identifier: MIT
// Outputs never overwrite inputs.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace scarp::cli {

/// Throws Error if `output` refers to the same file as any of `inputs`. Ignores inputs that do not exist.
void keep_inputs(const std::string& output, const std::vector<std::string>& inputs);

/// For the `file` of an `option` that is written beside `output` (empty: standard output). Throws Error if both are the
/// same file, which need not exist, or if `file` is one of the values `typed` for options, its own excepted. An empty
/// `file` is none.
void keep_apart(std::string_view option, const std::string& file, const std::string& output,
                std::vector<std::string> typed);

}  // namespace scarp::cli
