// SPDX-License-Identifier: MIT
// The options of `scarp render`.
#pragma once

#include <string>
#include <vector>

#include "app/cli/command.h"
#include "app/cli/depth_options.h"
#include "app/cli/figure_options.h"
#include "app/cli/frames.h"
#include "app/cli/function_input.h"
#include "app/cli/look_options.h"
#include "app/cli/mesh_options.h"
#include "app/cli/raster_options.h"
#include "app/cli/vox_input.h"
#include "scarp/render/frame/picture.h"
#include "scarp/scene/file/from_raster.h"

namespace scarp::cli {

/// The march for terrain without --march.
constexpr const char* kTerrainMarch = "max-mip";
constexpr double kComancheFov = 60;       // degrees, without --fov
constexpr double kVoxelSunAzimuth = 235;  // degrees, without --sun: from over the default camera's shoulder

/// Texts stay texts until there is a message for them.
struct RenderOptions {
  std::vector<std::string> inputs;
  std::string output;
  RasterOptions raster;
  FieldOptions field;
  VoxOptions vox;
  VoxLookOptions vox_look;
  FunctionInput function;
  std::string march;  ///< empty: the fastest exact one
  std::string device;
  MarchSettings march_settings;
  PictureSettings picture;
  LookOptions look_options;
  FrameOptions frames;
  DepthOptions depth;
  FigureOptions figure;
  MeshOptions mesh;
  std::string size, look = "shaded", sun, view, eye, target;
  bool exr = false;
  double fov_deg = ViewSettings{}.fov_deg, error_tolerance = ErrorSettings{}.tolerance;
  bool top = false, no_shadows = false, no_plinth = false;
  int threads = 0;
  std::vector<std::string> given;  ///< names of the options that were typed
  std::vector<std::string> typed;  ///< and their values

  bool is_given(std::string_view option) const;
};

/// Adds the subcommand and declares its options.
Command& declare_render(Program& program, RenderOptions& options);

}  // namespace scarp::cli
