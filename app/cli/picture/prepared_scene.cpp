// SPDX-License-Identifier: MIT
#include "app/cli/picture/prepared_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "app/cli/options/kept_inputs.h"
#include "app/cli/options/mesh_options.h"
#include "app/cli/options/picture_format.h"
#include "app/cli/options/scene_input.h"
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

// Maximum length of camera rays: infinite, except over wrapped ground. There, unless requested, it is the extent of the
// picture, plus twice the distance to the field for a camera outside the box. That reaches the field's far corners:
// their distance exceeds the sum of the longer side and the distance to the field by less than half of that side, and a
// camera that sees a whole field is farther away than that.
double reach_of(const PictureRequest& asked, double across, const Scene& scene, const WorldBox& box,
                const Camera& camera) {
  constexpr double kFarthestCorner = 2;
  if (asked.reach) return *asked.reach;
  if (!scene.wraps()) return std::numeric_limits<double>::infinity();
  return across + kFarthestCorner * length(glm::clamp(camera.eye(), box.low, box.high) - camera.eye());
}

}  // namespace

void PreparedScene::open() {
  Watch watch;
  const MeshInput mesh(request_.input.mesh);
  const PictureFiles files = read_picture_files(options_.picture_files, options_.picture);
  input_ = open_render_input(request_);
  keep_inputs(options_.output, input_.files);
  if (request_.kind == InputKind::scene) check_effect(options_.picture, input_.subject.own);
  stop_if_interrupted();
  read_s_ = watch.lap();
  view_ = chosen_view();
  if (const std::string note = note_on_relief(); !note.empty()) input_.notes.push_back(note);
  places_.emplace(input_.raster, find_coordinates(request_.camera.coordinates), exaggeration());
  input_.scene = mesh.with_mesh(std::move(input_.scene), *places_);
  input_.notes.insert(input_.notes.end(), mesh.notes().begin(), mesh.notes().end());
  if (input_.coarse_voxels) {
    scene_ = input_.scene;
  } else {
    put_on_device(input_.scene);
  }
  stop_if_interrupted();
  subject_ = input_.subject;
  subject_.files.ramp_stops = files.ramp_stops, subject_.files.detail_texture = files.detail_texture;
  subject_.size = size_;
  if (request_.camera.top) subject_.map = map_box();
  if (has_pixel_per_sample()) subject_.size.width = input_.raster.cols;
  if (!options_.output.empty()) subject_.alpha = picture_format_of(options_.output).map;
  picture_ = picture(options_, nullptr);
  facts_.heights = subject_.heights;
  facts_.area = request_.camera.area.has_value();
  facts_.function_reach = input_.function_reach;
  build_s_ = watch.lap();
}

// --view replaces the whole view of a function, including the view angle.
ViewSettings PreparedScene::chosen_view() const {
  const CameraOptions& camera = request_.camera;
  const ViewSettings view = view_of(input_.camera, camera, look_of(options_.picture));
  if (request_.kind != InputKind::function || camera.view) return view;
  ViewSettings own = kFunctionView;
  if (camera.fov_deg) own.fov_deg = view.fov_deg;
  return own;
}

// For lit pictures in perspective.
std::string PreparedScene::note_on_relief() const {
  const bool shows_relief = !request_.camera.top && entry_of(look_of(options_.picture)).lit;
  if (request_.kind != InputKind::terrain || !shows_relief || request_.input.exaggeration.given) return {};
  const ReliefRange& heights = input_.subject.heights;
  return flatness_note(heights.high - heights.low, input_.subject.across);
}

bool PreparedScene::serves(InputRequest asked) const {
  InputRequest read = request_;
  // Averaged rasters have at least a quarter of the allowed number of samples, because blocks are at least 2 x 2. A
  // raster with fewer samples was read completely.
  const std::int64_t samples = std::int64_t{input_.raster.cols} * input_.raster.rows;
  if (4 * samples < Decimation{}.above) asked.input.raster.decimation = read.input.raster.decimation;
  // NaN, which --nodata accepts, is not equal to itself.
  std::optional<double>&a = asked.input.raster.nodata, &b = read.input.raster.nodata;
  if (a && b && std::isnan(*a) && std::isnan(*b)) a.reset(), b.reset();
  return asked == read;
}

PictureSettings PreparedScene::picture(const RenderOptions& options, const Camera* camera) const {
  PictureSubject subject = subject_;
  if (camera) subject.box = scene_box();
  if (options.picture_files != options_.picture_files) {
    const PictureFiles files = read_picture_files(options.picture_files, options.picture);
    subject.files.ramp_stops = files.ramp_stops, subject.files.detail_texture = files.detail_texture;
  }
  return resolve(options.picture, subject, camera);
}

void PreparedScene::put_on_device(const Scene& scene) {
  there_ = scene_on_device(request_.input.device, scene, request_.voxel_drawing);
  scene_ = there_.scene;
}

std::string PreparedScene::on_device() const {
  if (there_.device.empty()) return {};
  const std::string drawn = drawn_by(there_);
  return fmt::format(", on {}{}{}", there_.device, drawn.empty() ? "" : ", ", drawn);
}

WorldBox PreparedScene::scene_box() const {
  const WorldBox& box = scene_.box();
  if (!box.empty() || !scene_.endless()) return picture_box(scene_);
  return scene_.terrain()
             ? picture_box(scene_)
             : WorldBox{input_.camera.target.value_or(dvec3(0.0)), input_.camera.target.value_or(dvec3(0.0))};
}

void PreparedScene::finish(Camera& camera, const RenderOptions& options) {
  camera.set_reach(reach_of(options.picture, subject_.across, scene_, scene_box(), camera));
  // The judge's rays must end where those of the march do.
  if (request_.kind == InputKind::function && look_of(options.picture) == Look::error)
    camera.set_reach(std::min(camera.reach(), input_.function_reach));
  if (input_.coarse_voxels)
    put_on_device(input_.scene.coarser(detail_of(camera, resolve(options.picture, subject_).aa)));
}

Camera PreparedScene::framed(const ViewSettings& view) {
  const FieldView found = input_.framed(scene_, view, picture_);
  raised_ = std::max(raised_, found.raised);
  return found.camera;
}

double PreparedScene::exaggeration() const {
  const HeightField* field = input_.scene.terrain();
  return field ? field->settings().exaggeration : 1;
}

dvec3 PreparedScene::typed_eye() const {
  constexpr std::string_view kEye = "--eye";
  const TypedPlace& eye = *request_.camera.eye;
  if (eye.z) return places_->world(eye, input_.scene, kEye);
  return above_surface(places_->world(dvec3(eye.x, eye.y, 0), kEye), kEye);
}

// Applies --eye-above over the surface at (x, y) of `at`, or over water that covers it.
dvec3 PreparedScene::above_surface(const dvec3& at, std::string_view what) const {
  dvec3 eye = places_->on_surface(at, input_.scene, what);
  if (picture_.water) eye.z = std::max(eye.z, picture_.water->level * exaggeration());
  return eye + dvec3(0, 0, *request_.camera.eye_above * exaggeration());
}

bool PreparedScene::has_pixel_per_sample() const {
  return request_.camera.top && !request_.camera.area && writes_numbers(options_) && input_.scene.only_heights() &&
         !options_.picture.width;
}

// The area that --top shows.
WorldBox PreparedScene::map_box() const {
  if (scene_.box().empty() && scene_.endless() && !scene_.terrain())
    throw Error(
        "--top: everything in the scene is endless, without a border to fit a map to (leave --top out, and use "
        "--eye and --target)");
  WorldBox box = picture_box(scene_);
  const auto& area = request_.camera.area;
  if (has_pixel_per_sample()) {
    const HeightFieldSettings& cell = input_.scene.only_heights()->settings();
    const dvec3 half(cell.cell_x / 2, cell.cell_y / 2, 0);
    box.low -= half, box.high += half;
  }
  if (!area) return box;
  constexpr std::string_view kArea = "--area";
  const dvec3 low = places_->world(dvec3(area->west, area->south, 0), kArea),
              high = places_->world(dvec3(area->east, area->north, 0), kArea);
  if (!(low.x < high.x && low.y < high.y))
    throw Error(fmt::format("{} '{}': expected W below E, and S below N", kArea, area->text));
  box.low.x = low.x, box.low.y = low.y, box.high.x = high.x, box.high.y = high.y;
  return box;
}

Camera PreparedScene::camera() {
  const CameraOptions& asked = request_.camera;
  const SceneCamera& own = input_.camera;
  const int width = picture_.width, height = picture_.height;
  if (asked.top) return Camera::top(map_box(), width, height);
  if (asked.eye) {
    const dvec3 target = asked.target ? places_->world(*asked.target, input_.scene, "--target")
                         : own.target ? *own.target
                                      : picture_box(scene_).middle();
    return Camera::look_at(typed_eye(), target, view_.fov_deg, width, height);
  }
  if (!asked.view) {
    if (own.eye) return Camera::look_at(*own.eye, *own.target, view_.fov_deg, width, height);
    if (picture_.look == Look::comanche && scene_.terrain() && !own.azimuth_deg && !own.elevation_deg && !own.distance)
      return flight_camera(*scene_.terrain(), picture_.grid_north_azimuth, view_.fov_deg, width, height);
  }
  return framed(view_);
}

PathPlaces PreparedScene::path_places() const {
  PathPlaces path{*places_, input_.scene};
  if (request_.camera.eye_above)
    path.above_surface = [this](const dvec3& at, const std::string& what) { return above_surface(at, what); };
  return path;
}

}  // namespace scarp::cli
