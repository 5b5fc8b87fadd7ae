// SPDX-License-Identifier: MIT
// Terrain functions where `scarp render` takes files: --function and --preset.
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "scarp/march/march_settings.h"
#include "scarp/render/camera/depth.h"
#include "scarp/render/frame/picture.h"
#include "scarp/render/look/function_error.h"

namespace scarp::cli {

/// Without --march.
constexpr const char* kFunctionMarch = "lipschitz-local";

struct FunctionInput {
  std::string function;  // a name or a file; empty: none
  std::string preset;
  double extent = 6000;
};

/// Adds --function and --extent. `input` must live until the subcommand has run.
void add_function_option(CLI::App& command, FunctionInput& input, const std::string& extent);
/// These and --preset. `march` and `settings` are where --march and its settings go, and those of a preset with them:
/// add this before them, so that what is typed counts more. All must live until the subcommand has run.
void add_function_options(CLI::App& command, FunctionInput& input, std::string& march, MarchSettings& settings);

/// What of the command line's settings a function has other defaults for.
struct FunctionPicture {
  PictureSettings picture;
  std::string march;  // empty: kFunctionMarch
  MarchSettings march_settings;
  ViewSettings view;
  bool view_given = false, fov_given = false, haze_given = false, tolerance_given = false;
  std::string device{};     // as --device, empty: the CPU
  std::string eye, target;  // as --eye and --target, empty: of the view
  bool exr = false;         // layers instead of a PNG
  std::optional<DepthRange> depth_range{};
};

void render_function(const FunctionInput& input, FunctionPicture settings, const std::string& output);

}  // namespace scarp::cli
