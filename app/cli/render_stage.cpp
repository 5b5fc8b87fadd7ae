// SPDX-License-Identifier: MIT
#include "app/cli/render_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "app/cli/mesh_options.h"
#include "app/cli/numbers.h"
#include "app/cli/picture_output.h"
#include "app/cli/progress.h"
#include "scarp/base/error.h"

namespace scarp::cli {
namespace {

// Stopwatch: seconds since construction or the last call.
class Watch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(begin_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

SceneDetail detail_of(const Camera& camera, int aa) {
  return {camera.eye(), camera.forward(), [&camera, aa](double depth) { return camera.pixel_width(depth) / aa; }};
}

}  // namespace

void RenderStage::open() {
  Watch watch;
  const MeshInput mesh(options_.mesh);
  input_ = open_render_input(kind_, options_, typed_view_);
  options_.typed.insert(options_.typed.end(), input_.files.begin(), input_.files.end());
  stop_if_interrupted();
  read_s_ = watch.lap();
  places_.emplace(input_.raster, find_coordinates(options_.coordinates), exaggeration());
  input_.scene = mesh.with_mesh(std::move(input_.scene), *places_);
  input_.notes.insert(input_.notes.end(), mesh.notes().begin(), mesh.notes().end());
  if (input_.coarse_voxels) {
    scene_ = input_.scene;
  } else {
    put_on_device(input_.scene);
  }
  stop_if_interrupted();
  if (options_.top && options_.size.empty()) fit_size_to_scene(map_box(), options_.picture);
  facts_.heights = input_.heights;
  facts_.area = !options_.area.empty();
  if (kind_ == InputKind::function) facts_.function_reach = options_.march_settings.function.reach;
  finish_look(options_.look_options, input_.across, input_.heights, input_.exaggeration, options_.picture);
  build_s_ = watch.lap();
}

void RenderStage::put_on_device(const Scene& scene) {
  there_ = scene_on_device(options_.device, scene, options_.voxel_drawing);
  scene_ = there_.scene;
}

std::string RenderStage::on_device() const {
  if (there_.device.empty()) return {};
  const std::string drawn = drawn_by(there_);
  return fmt::format(", on {}{}{}", there_.device, drawn.empty() ? "" : ", ", drawn);
}

WorldBox RenderStage::scene_box() const {
  const WorldBox& box = scene_.box();
  if (!box.empty() || !scene_.endless()) return picture_box(scene_);
  return scene_.terrain() ? picture_box(scene_)
                          : WorldBox{input_.target.value_or(dvec3(0.0)), input_.target.value_or(dvec3(0.0))};
}

void RenderStage::finish(Camera& camera, const RenderOptions& options) {
  camera.set_reach(reach_of(options.look_options, input_.across, scene_, scene_box(), camera));
  // The reference march must stop where the march does.
  if (kind_ == InputKind::function && options.picture.look == Look::error)
    camera.set_reach(std::min(camera.reach(), options.march_settings.function.reach));
  if (input_.coarse_voxels) put_on_device(input_.scene.coarser(detail_of(camera, options.picture.aa)));
}

bool RenderStage::restyles(const Declared& option) const {
  switch (option.option.topic) {
    case Topic::picture:
      return option.name != "--no-plinth";
    case Topic::ground:
      // Functions have materials by --ramp, and volumes colours.
      return option.name != "--overlay" && kind_ != InputKind::function && kind_ != InputKind::voxels;
    case Topic::light:
      // Rays over functions end where haze hides everything.
      return option.name != "--haze" || kind_ != InputKind::function;
    case Topic::water:
    case Topic::fog:
      return true;
    default:
      return false;
  }
}

bool RenderStage::may_read_otherwise(const RenderOptions& options) const {
  if (kind_ != InputKind::terrain || reads_all_samples(options) == reads_all_samples(options_)) return false;
  // Averaging, with blocks of at least 2 x 2, leaves at least a quarter of the allowed samples.
  const std::int64_t samples = std::int64_t{input_.raster.cols} * input_.raster.rows;
  return 4 * samples >= Decimation{}.above;
}

RenderOptions RenderStage::restyled(RenderOptions options) const {
  settle_again(kind_, input_, options_, options);
  finish_look(options.look_options, input_.across, input_.heights, input_.exaggeration, options.picture);
  return options;
}

Camera RenderStage::framed(const ViewSettings& view) {
  const FieldView found = input_.framed(scene_, view);
  raised_ = std::max(raised_, found.raised);
  return found.camera;
}

double RenderStage::exaggeration() const {
  const HeightField* field = input_.scene.terrain();
  return field ? field->settings().exaggeration : 1;
}

dvec3 RenderStage::typed_eye() const {
  constexpr std::string_view kEye = "--eye";
  const TypedPlace eye = typed_place(options_.eye, kEye);
  if (eye.z) return places_->world(eye, input_.scene, kEye);
  return above_surface(places_->world(dvec3(eye.x, eye.y, 0), kEye), kEye);
}

// --eye-above over the surface at (x, y) of `at`, or over water that covers it.
dvec3 RenderStage::above_surface(const dvec3& at, std::string_view what) const {
  dvec3 eye = places_->on_surface(at, input_.scene, what);
  if (options_.picture.water) eye.z = std::max(eye.z, options_.picture.water->level * exaggeration());
  return eye + dvec3(0, 0, *options_.eye_above * exaggeration());
}

// The area that --top shows.
WorldBox RenderStage::map_box() const {
  WorldBox box = picture_box(scene_);
  if (options_.area.empty()) return box;
  constexpr std::string_view kArea = "--area";
  const auto edges =
      ground_numbers_from(options_.area, 4, 4, kArea, "W,S,E,N in coordinates of --coords, for example 0,0,500,300");
  const dvec3 low = places_->world(dvec3(edges[0], edges[1], 0), kArea),
              high = places_->world(dvec3(edges[2], edges[3], 0), kArea);
  if (!(low.x < high.x && low.y < high.y))
    throw Error(fmt::format("{} '{}': expected W below E, and S below N", kArea, options_.area));
  box.low.x = low.x, box.low.y = low.y, box.high.x = high.x, box.high.y = high.y;
  return box;
}

Camera RenderStage::camera() {
  const int width = options_.picture.width, height = options_.picture.height;
  if (options_.top && scene_.box().empty() && scene_.endless() && !scene_.terrain())
    throw Error(
        "--top: everything in the scene is endless, without a border to fit a map to (leave --top out, and use "
        "--eye and --target)");
  if (options_.top) return Camera::top(map_box(), width, height);
  if (!options_.eye.empty()) {
    const dvec3 target = !options_.target.empty()
                             ? places_->world(typed_place(options_.target, "--target"), input_.scene, "--target")
                         : input_.target ? *input_.target
                                         : picture_box(scene_).middle();
    return Camera::look_at(typed_eye(), target, input_.view.fov_deg, width, height);
  }
  if (options_.view.empty()) {
    if (input_.eye) return Camera::look_at(*input_.eye, *input_.target, input_.view.fov_deg, width, height);
    if (options_.picture.look == Look::comanche && scene_.terrain() && !input_.viewed) {
      return flight_camera(*scene_.terrain(), options_.picture.grid_north_azimuth, input_.view.fov_deg, width, height);
    }
  }
  return framed(input_.view);
}

PathPlaces RenderStage::path_places() const {
  PathPlaces path{*places_, input_.scene};
  if (options_.eye_above)
    path.above_surface = [this](const dvec3& at, const std::string& what) { return above_surface(at, what); };
  return path;
}

}  // namespace scarp::cli
