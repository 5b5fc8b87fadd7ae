// SPDX-License-Identifier: MIT
// Pictures of scenes, as arrays.
#include <pybind11/stl.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "python/bind/bind.h"
#include "python/bind/tasks.h"
#include "python/bind/terrain_object.h"
#include "scarp/base/error.h"
#include "scarp/render/camera/field_view.h"
#include "scarp/render/frame/picture.h"
#include "scarp/scene/scene_plinth.h"

namespace scarp::python {
namespace {

namespace py = pybind11;

using Three = std::array<double, 3>;

dvec3 vector_of(const Three& numbers) { return {numbers[0], numbers[1], numbers[2]}; }

// The position of the camera: a view of everything, from above, or an eye and its target.
struct CameraRequest {
  ViewSettings view{};
  bool top = false;
  std::optional<Three> eye{}, target{};

  Camera camera(const Scene& scene, const Scene& shown, const PictureSettings& picture) const {
    const WorldBox box = picture_box(shown);
    if (top) return Camera::top(box, picture.width, picture.height);
    const HeightField* heights = scene.only_heights();
    if (eye) {
      const dvec3 at = target ? vector_of(*target) : 0.5 * (box.low + box.high);
      return Camera::look_at(vector_of(*eye), at, view.fov_deg, picture.width, picture.height);
    }
    if (heights)
      return view_of_field(*heights, box, view, picture.grid_north_azimuth, picture.width, picture.height).camera;
    return Camera::framed(box, view, picture.grid_north_azimuth, picture.width, picture.height);
  }
};

// As render() of scarp.h does, which writes a file.
Picture picture_of(const Scene& scene, const CameraRequest& request, const PictureSettings& settings,
                   const Progress& progress) {
  validate(settings);
  validate(request.view);
  require_visible(scene);
  if (scene.wraps()) throw Error("picture: ground that wraps round has no end (build the terrain with wrap='none')");
  const Scene shown = !request.top && scene.only_field() ? with_plinth(scene) : scene;
  return render_picture(shown, request.camera(scene, shown, settings), settings, progress);
}

py::array picture(const SceneObject& self, std::array<int, 2> size, const std::string& look, int aa,
                  std::array<double, 2> sun, std::array<double, 2> view, double distance, double fov, bool top,
                  const std::optional<Three>& eye, const std::optional<Three>& target, bool shadows, bool unlit,
                  double haze, int samples, double ao_distance, const std::string& ramp, const std::string& sky,
                  bool alpha, double grid_north, const py::object& progress) {
  PictureSettings settings;
  settings.width = size[0];
  settings.height = size[1];
  settings.look = find_look(look);
  settings.aa = aa;
  settings.sun.azimuth_deg = sun[0];
  settings.sun.altitude_deg = sun[1];
  settings.shadows = shadows;
  settings.unlit = unlit;
  settings.haze = haze;
  settings.samples = samples;
  settings.ao_distance = ao_distance;
  settings.ramp = ramp;
  settings.sky.kind = find_sky(sky);
  settings.alpha = alpha;
  settings.grid_north_azimuth = grid_north;
  const CameraRequest request{{view[0], view[1], distance, fov}, top, eye, target};
  require_memory(self);
  Image image = result_of_task(progress, [&](const Progress& report) {
    const auto locks = shared_locks(self);
    return picture_of(self.scene(), request, settings, report).image;
  });
  const py::ssize_t height = image.height, width = image.width;
  if (image.alpha.empty()) return handed_over<std::uint8_t>(std::move(image.rgb), {height, width, 3});
  std::vector<std::uint8_t> pixels;
  pixels.reserve(4 * image.alpha.size());
  for (std::size_t i = 0; i < image.alpha.size(); ++i) {
    pixels.insert(pixels.end(), image.rgb.begin() + static_cast<std::ptrdiff_t>(3 * i),
                  image.rgb.begin() + static_cast<std::ptrdiff_t>(3 * i + 3));
    pixels.push_back(image.alpha[i]);
  }
  return handed_over<std::uint8_t>(std::move(pixels), {height, width, 4});
}

}  // namespace

void bind_picture(py::module_& module) {
  module.def("render", &picture, py::arg("scene"), py::arg("size"), py::arg("look"), py::arg("aa"), py::arg("sun"),
             py::arg("view"), py::arg("distance"), py::arg("fov"), py::arg("top"), py::arg("eye"), py::arg("target"),
             py::arg("shadows"), py::arg("unlit"), py::arg("haze"), py::arg("samples"), py::arg("ao_distance"),
             py::arg("ramp"), py::arg("sky"), py::arg("alpha"), py::arg("grid_north"), py::arg("progress"));
}

}  // namespace scarp::python
