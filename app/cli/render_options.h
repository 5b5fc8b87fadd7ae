// SPDX-License-Identifier: MIT
// The options of `scarp render`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/cli/command.h"
#include "app/cli/depth_options.h"
#include "app/cli/figure_options.h"
#include "app/cli/frames.h"
#include "app/cli/look_options.h"
#include "app/cli/open_input.h"
#include "scarp/render/frame/picture.h"

namespace scarp::cli {

constexpr double kComancheFov = 60;       // degrees, without --fov
constexpr double kModelSunAzimuth = 235;  // degrees, without --sun: from over the default camera's shoulder

/// Texts are parsed later, where messages can name the option.
struct RenderOptions : InputOptions {
  std::string output;
  PictureSettings picture;
  LookOptions look_options;
  FrameOptions frames;
  DepthOptions depth;
  FigureOptions figure;
  std::string size, look = "shaded", steps_range, sun, sky, view, eye, target, area, coordinates = "local";
  std::string voxel_drawing = "compute";
  std::optional<double> eye_above;
  const PictureFormat* format = nullptr;  ///< of the output
  double fov_deg = ViewSettings{}.fov_deg, error_tolerance = ErrorSettings{}.tolerance;
  bool top = false, no_shadows = false, no_plinth = false, no_tone_curve = false;
  bool full = false;  ///< reads all samples of large rasters
  int threads = 0;
  std::vector<std::string> given;  ///< names of the options that were typed
  std::vector<std::string> typed;  ///< and their values

  bool is_given(std::string_view option) const;
};

/// Declares the options of pictures; if `written`, those of files, figures and several frames as well.
void declare_picture(Command& command, RenderOptions& options, bool written);

/// Adds the subcommand and declares its options.
Command& declare_render(Program& program, RenderOptions& options);

}  // namespace scarp::cli
