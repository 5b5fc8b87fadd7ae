// SPDX-License-Identifier: MIT
// What leaves the window: pictures, commands that make them again, and places of a path.
#pragma once

#include <string>

#include "app/cli/view_options.h"
#include "app/viewer/navigation.h"
#include "scarp/render/frame/film.h"
#include "scarp/render/frame/picture.h"

namespace scarp::viewer {

/// Whether PictureSettings::haze has an effect: fog, or haze by a distance, replaces it.
bool has_haze(const PictureSettings& picture);

/// The command that writes the picture of `pose` to `output`.
std::string render_command(const cli::ViewOptions& options, const Pose& pose, const PictureSettings& picture,
                           const std::string& output);

/// Saves the picture under the first free name of scarp-view-1.png, scarp-view-2.png, ... and returns it. Throws Error
/// if it cannot be written.
std::string save_numbered(const Image& image);

/// Adds the pose to scarp-path.csv, for `scarp render --path`, and returns the file's name. Throws Error if the file
/// cannot be written; then it stays as it was.
std::string add_to_path(const Pose& pose);

}  // namespace scarp::viewer
