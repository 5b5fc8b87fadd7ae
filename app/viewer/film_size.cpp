// SPDX-License-Identifier: MIT
#include "app/viewer/film_size.h"

#include <algorithm>
#include <cmath>

namespace scarp::viewer {
namespace {

int side_of_pixel(const PictureSettings& picture) {
  return picture.look == Look::comanche ? picture.comanche.scale : 1;
}

}  // namespace

FilmSize film_size(const PictureSettings& picture, int width, int height) {
  const auto pixels = [side = side_of_pixel(picture)](int length) {
    return std::max(1, static_cast<int>(std::lround(static_cast<double>(length) / side)));
  };
  return {pixels(width), pixels(height)};
}

FilmSize window_size(const PictureSettings& picture) {
  const int side = side_of_pixel(picture);
  return {picture.width * side, picture.height * side};
}

}  // namespace scarp::viewer
