// SPDX-License-Identifier: MIT
// --march, and the settings of all marches as options.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/options/command.h"
#include "scarp/march/march_settings.h"

namespace scarp::cli {

/// Declares --march; empty: the default of the kind of input.
void add_march_option(Command& command, std::string& march);
/// Declares --compare. `several`: whether there are several pictures.
void add_compare_option(Command& command, std::vector<std::string>& marches, const std::function<bool()>& several);
/// Declares an option for each setting of each march. `interpolate` receives --fixed-step-interpolate if it is typed;
/// null: its default does not depend on --shells.
void add_march_options(Command& command, MarchSettings& march, std::optional<bool>* interpolate = nullptr);

}  // namespace scarp::cli
