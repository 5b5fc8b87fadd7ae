// SPDX-License-Identifier: MIT
// render(), declared in scarp.h.
#include "scarp/base/error.h"
#include "scarp/base/replace_file.h"
#include "scarp/output/png.h"
#include "scarp/render/camera/field_view.h"
#include "scarp/render/frame/picture.h"
#include "scarp/scarp.h"
#include "scarp/scene/scene_plinth.h"

namespace scarp {

void render(const Scene& scene, const std::string& path) {
  PictureSettings picture;
  if (!scene.only_heights()) picture.haze = 0;
  render(scene, path, picture, {});
}

void render(const Terrain& terrain, const std::string& path) {
  PictureSettings picture;
  picture.grid_north_azimuth = terrain.georeference().grid_north_azimuth;
  render(terrain, path, picture, {});
}

void render(const Scene& scene, const std::string& path, const PictureSettings& settings, const ViewSettings& view) {
  validate(settings);
  validate(view);
  require_visible(scene);
  if (scene.wraps())
    throw Error("picture: ground that wraps round has no end (give a camera a reach, and call render_picture())");
  // Reserved first, so that an unwritable path fails before rendering starts.
  ReplaceFile file(path);
  const Scene shown = scene.only_field() && !scene.on_device() ? with_plinth(scene) : scene;
  const WorldBox box = picture_box(shown);
  const HeightField* heights = scene.only_heights();
  const Camera camera =
      heights ? view_of_field(*heights, box, view, settings.grid_north_azimuth, settings.width, settings.height).camera
              : Camera::framed(box, view, settings.grid_north_azimuth, settings.width, settings.height);
  const Picture picture = render_picture(shown, camera, settings);
  write_png(file, path, {picture.image.rgb.data(), picture.image.width, picture.image.height});
}

}  // namespace scarp
