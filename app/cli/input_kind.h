// SPDX-License-Identifier: MIT
// What a subcommand that takes several kinds of input was given.
#pragma once

#include <string>
#include <vector>

#include "app/cli/command.h"
#include "app/cli/function_input.h"
#include "app/cli/vox_input.h"

namespace scarp::cli {

/// The kind of `inputs`, by their names and the options beside them. Throws Error or WrongUsage: none, or several kinds
/// at once.
InputKind kind_of_input(const Command& command, const std::vector<std::string>& inputs, const VoxOptions& vox,
                        const FunctionInput& function = {});

}  // namespace scarp::cli
