// SPDX-License-Identifier: MIT
// The options of `scarp render`, with their types.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/options/depth_options.h"
#include "app/cli/options/figure_options.h"
#include "app/cli/options/frames.h"
#include "app/cli/options/look_options.h"
#include "app/cli/options/open_input.h"
#include "app/cli/options/places.h"
#include "app/options/command.h"
#include "scarp/render/frame/picture_request.h"

namespace scarp::cli {

constexpr double kComancheFov = 60;       // degrees, without --fov
constexpr double kModelSunAzimuth = 235;  // degrees, without --sun: over the shoulder of the default camera

/// --view.
struct TypedView {
  double azimuth_deg = 0, elevation_deg = 0;
  std::optional<double> distance{};

  bool operator==(const TypedView&) const = default;
};

/// --area: edges in coordinates of --coords, with the text for messages.
struct TypedArea {
  double west = 0, south = 0, east = 0, north = 0;
  std::string text;

  bool operator==(const TypedArea&) const = default;
};

/// The viewpoint of a picture.
struct CameraOptions {
  std::optional<TypedView> view;
  std::optional<TypedPlace> eye, target;
  std::optional<double> eye_above;
  std::optional<double> fov_deg;
  std::optional<TypedArea> area;
  std::string coordinates = "local";
  bool top = false;

  bool operator==(const CameraOptions&) const = default;
};

struct RenderOptions : InputOptions {
  std::string output;
  PictureRequest picture;
  PictureFileNames picture_files;
  CameraOptions camera;
  FrameOptions frames;
  DepthOptions depth;
  FigureOptions figure;
  std::string voxel_drawing = "compute";
  bool no_plinth = false;
  bool json = false, quiet = false;
  std::vector<std::string> compared;  ///< marches, a strip of the picture each; empty: `march` alone
  bool full = false;                  ///< reads all samples of large rasters
  int threads = 0;
  std::vector<std::string> typed;  ///< the typed values; files among them must not be overwritten
};

/// Declares the options of pictures; if `written`, also those of files, figures and several frames.
void declare_picture(Command& command, RenderOptions& options, bool written);

/// Adds the subcommand and declares its options.
Command& declare_render(Program& program, RenderOptions& options);

/// Returns the view of the options, completed by the defaults of the look.
ViewSettings view_of(const CameraOptions& camera, Look look);

/// Checks everything that needs neither the input nor the output. Throws Error.
void check_picture(const RenderOptions& options);

/// Whether the output is a map of the numbers of a look (Picture::numbers) instead of colours.
bool writes_numbers(const RenderOptions& options);

}  // namespace scarp::cli
