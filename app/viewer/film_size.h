// SPDX-License-Identifier: MIT
// How many pixels are rendered for a window.
#pragma once

#include "scarp/render/frame/picture.h"

namespace scarp::viewer {

struct FilmSize {
  int width, height;  ///< in pixels, each at least 1
};

/// The size of the picture that fills a window of width x height pixels, in the units of PictureSettings: large pixels
/// for the look comanche. The image is then up to half a large pixel smaller or larger than the window.
FilmSize film_size(const PictureSettings& picture, int width, int height);

/// The window size that the settings' own picture size fills.
FilmSize window_size(const PictureSettings& picture);

}  // namespace scarp::viewer
