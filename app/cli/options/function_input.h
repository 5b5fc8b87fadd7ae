// SPDX-License-Identifier: MIT
// Terrain functions as inputs of subcommands: --function and --preset.
#pragma once

#include <string>

#include "app/options/command.h"
#include "scarp/march/march_settings.h"
#include "scarp/render/camera/camera.h"

namespace scarp::cli {

/// The march without --march.
constexpr const char* kFunctionMarch = "lipschitz-local";
/// The view without --view and --fov.
constexpr ViewSettings kFunctionView{.azimuth_deg = 190, .elevation_deg = 14, .distance = 0.5, .fov_deg = 45};

struct FunctionInput {
  std::string function;  // a name or a file; empty: none
  std::string preset;
  double extent = 6000;

  bool operator==(const FunctionInput&) const = default;
};

/// Declares --function and, unless its help is empty, --extent.
void add_function_option(Command& command, FunctionInput& input, const std::string& extent);
/// Declares these options and --preset. `march` and `settings` are the variables of --march and its settings, which a
/// preset sets before other options apply.
void add_function_options(Command& command, FunctionInput& input, const std::string& extent, std::string& march,
                          MarchSettings& settings);

}  // namespace scarp::cli
