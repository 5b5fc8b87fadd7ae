// SPDX-License-Identifier: MIT
#include "app/viewer/film_size.h"

#include <algorithm>
#include <cmath>

namespace scarp::viewer {
namespace {

int side_of_pixel(const PictureRequest& picture) {
  return entry_of(look_of(picture)).large_pixels ? picture.comanche.scale : 1;
}

}  // namespace

ImageSize film_size(const PictureRequest& picture, int width, int height) {
  const auto pixels = [side = side_of_pixel(picture)](int length) {
    return std::max(1, static_cast<int>(std::lround(static_cast<double>(length) / side)));
  };
  return {pixels(width), pixels(height)};
}

PictureRequest for_window(PictureRequest picture, int width, int height) {
  const ImageSize size = film_size(picture, width, height);
  if (entry_of(look_of(picture)).large_pixels) {
    picture.low_resolution = size;
  } else {
    picture.width = size.width, picture.height = size.height;
  }
  return picture;
}

std::optional<ImageSize> window_size(const PictureRequest& picture) {
  const int side = side_of_pixel(picture);
  if (picture.low_resolution)
    return ImageSize{picture.low_resolution->width * side, picture.low_resolution->height * side};
  if (picture.width && picture.height) return ImageSize{*picture.width, *picture.height};
  return {};
}

}  // namespace scarp::viewer
