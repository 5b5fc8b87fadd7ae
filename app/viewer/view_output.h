// SPDX-License-Identifier: MIT
// Output of the window: pictures, the commands that reproduce them, and positions of a path.
#pragma once

#include <string>

#include "app/cli/options/places.h"
#include "app/viewer/navigation.h"
#include "app/viewer/opening.h"
#include "scarp/render/film/film.h"

namespace scarp::viewer {

/// The command that writes the picture of `pose` in a window of this size in pixels to `output`. All its positions are
/// local; `places` converts the position of a mesh.
std::string render_command(const Opening& opening, const cli::Places& places, const Pose& pose, int width, int height,
                           const std::string& output);

/// Saves the picture under the first free name of scarp-view-1.png, scarp-view-2.png, ... and returns it. Throws Error
/// if it cannot be written.
std::string save_numbered(const Image& image);

/// Saves a line under the first free name of scarp-line-1.geojson, ... and returns it: for `scarp render --top --draw`.
/// The ends are longitude and latitude in degrees on WGS 84. Throws Error if it cannot be written.
std::string save_line(const dvec2& from_lonlat, const dvec2& to_lonlat);

/// Adds the pose of a perspective camera to a file for `scarp render --path`. Throws Error if it cannot be written;
/// then it stays as it was.
void add_to_path(const std::string& file, const Pose& pose);
/// The first free name of scarp-path-1.csv, scarp-path-2.csv, ...
std::string next_path();

}  // namespace scarp::viewer
