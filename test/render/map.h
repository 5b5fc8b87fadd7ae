// SPDX-License-Identifier: MIT
// Maps of height fields, for tests that compare pixels with cells.
#pragma once

#include <string_view>

#include "render/terrain.h"
#include "scarp/render/frame/picture.h"
#include "scarp/scene/plinth.h"

namespace scarp::test {

/// A map with 10 pixels per cell, everything plain.
inline PictureSettings map_settings(const HeightField& field) {
  PictureSettings settings;
  settings.width = 10 * field.cell_cols();
  settings.height = 10 * field.cell_rows();
  settings.aa = 1;
  settings.haze = 0;
  settings.ramp = "grey";
  return settings;
}

inline Picture map_of(const HeightField& field, PictureSettings settings, double grid_north = 0,
                      std::string_view march = "max-mip") {
  const Scene scene = terrain(field, march);
  settings.grid_north_azimuth = grid_north;
  return render_picture(scene, Camera::top(picture_box(scene), settings.width, settings.height), settings);
}

inline int red(const Image& image, int x, int y) { return image.pixel(x, y)[0]; }

}  // namespace scarp::test
