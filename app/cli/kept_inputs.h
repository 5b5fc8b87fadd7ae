// SPDX-License-Identifier: MIT
// Nothing is written over what it was made of.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace scarp::cli {

/// All that was typed for options other than --output, whatever they mean: files among it are inputs. So an option that
/// is added later is no gap.
std::vector<std::string> typed_values(const CLI::App& command);

/// Throws Error when `output` is one of `inputs`, by this name or another. Names that are no files are none.
void keep_inputs(const std::string& output, const std::vector<std::string>& inputs);

}  // namespace scarp::cli
