// SPDX-License-Identifier: MIT
// The number of pixels to render for a window.
#pragma once

#include "scarp/render/frame/picture_request.h"

namespace scarp::viewer {

/// Returns the size of the picture that fills a window of width x height pixels: in large pixels for the look comanche.
/// The image is then up to half a large pixel smaller or larger than the window. Each side is at least 1.
ImageSize film_size(const PictureRequest& picture, int width, int height);

/// Returns the request with the size that fills a window.
PictureRequest for_window(PictureRequest picture, int width, int height);

/// Returns the window that the size of the request fills; nullopt without a requested size.
std::optional<ImageSize> window_size(const PictureRequest& picture);

}  // namespace scarp::viewer
