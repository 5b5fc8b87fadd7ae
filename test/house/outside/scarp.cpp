// SPDX-License-Identifier: MIT
// Links scarp::scarp: a small terrain becomes a picture in a file, through scene, render and output.
#include <cstdint>
#include <vector>

#include "scarp/output/png.h"
#include "scarp/render/frame/picture.h"
#include "scarp/scene/scene.h"

int main() {
  const std::vector<std::int16_t> samples{0, 1, 2, 1, 5, 1, 2, 1, 0};
  const scarp::Scene scene(scarp::scene_heights(scarp::HeightField::own(samples, 3, 3)));
  scarp::PictureSettings settings;
  settings.width = 32;
  settings.height = 32;
  const auto camera = scarp::Camera::top(scarp::picture_box(scene), settings.width, settings.height);
  const scarp::Picture picture = scarp::render_picture(scene, camera, settings);
  scarp::write_png("outside.png", {picture.image.rgb.data(), picture.image.width, picture.image.height});
}
