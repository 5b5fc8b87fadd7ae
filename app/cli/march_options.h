// SPDX-License-Identifier: MIT
// The settings of all marches as options.
#pragma once

#include "app/cli/command.h"
#include "scarp/march/march_settings.h"

namespace scarp::cli {

/// Declares an option for each setting of each march.
void add_march_options(Command& command, MarchSettings& march);

}  // namespace scarp::cli
