// SPDX-License-Identifier: MIT
#include "app/cli/render_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/device_option.h"
#include "app/cli/exr_output.h"
#include "app/cli/findings.h"
#include "app/cli/kept_inputs.h"
#include "app/cli/numbers.h"
#include "app/cli/picture_output.h"
#include "app/cli/places.h"
#include "app/cli/progress.h"
#include "app/cli/render_input.h"
#include "app/cli/seen.h"
#include "scarp/base/error.h"
#include "scarp/base/replace_file.h"
#include "scarp/render/frame/contour_spacing.h"

namespace scarp::cli {
namespace {

// Seconds since it was made or last asked.
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

class Render {
 public:
  Render(InputKind kind, RenderOptions options, const ViewSettings& view)
      : kind_(kind), options_(std::move(options)), typed_view_(view) {}

  void run() {
    // Reserved first: an unwritable place is found before the work and not after it.
    ReplaceFile file(options_.output);
    read();
    if (options_.frames.several()) return make_all();
    Camera camera = only_camera();
    finish(camera);
    see_from_afar(options_.look_options, scene_box(), camera, options_.picture);
    const Picture picture = make(file, options_.output, camera, terminal_progress("render"));
    const double render_s = watch_.lap();
    tell_notes();
    tell_of_contours(camera);
    if (!blank_.tell()) tell_if_buried(camera, "the eye");
    fmt::print("{}: {} x {} pixels; {}read {:.2f} s, build {:.2f} s, render {:.2f} s{}\n", options_.output,
               written_.width, written_.height, input_.march.empty() ? "" : input_.march + "; ", read_s_, build_s_,
               render_s, on_device());
    print_findings(picture);
  }

 private:
  void read() {
    const MeshInput mesh(options_.mesh);
    input_ = open_render_input(kind_, options_, typed_view_);
    options_.typed.insert(options_.typed.end(), input_.files.begin(), input_.files.end());
    stop_if_interrupted();
    read_s_ = watch_.lap();
    places_.emplace(input_.raster, find_coordinates(options_.coordinates), exaggeration());
    input_.scene = mesh.with_mesh(std::move(input_.scene), *places_);
    input_.notes.insert(input_.notes.end(), mesh.notes().begin(), mesh.notes().end());
    if (input_.coarse_voxels) {
      scene_ = input_.scene;
    } else {
      put_on_device(input_.scene);
    }
    stop_if_interrupted();
    if (options_.top && options_.size.empty()) fit_size_to_scene(picture_box(scene_), options_.picture);
    facts_.heights = input_.heights;
    if (kind_ == InputKind::function) facts_.function_reach = options_.march_settings.function.reach;
    finish_look(options_.look_options, input_.across, input_.heights, input_.exaggeration, options_.picture);
    build_s_ = watch_.lap();
  }

  void put_on_device(const Scene& scene) {
    there_ = scene_on_device(options_.device, scene, options_.voxel_drawing);
    scene_ = there_.scene;
  }

  // ", on NAME", and what it drew.
  std::string on_device() const {
    if (there_.device.empty()) return {};
    const std::string drawn = drawn_by(there_);
    return fmt::format(", on {}{}{}", there_.device, drawn.empty() ? "" : ", ", drawn);
  }

  // Where nothing has an end, a point: the middle of what the picture is about.
  WorldBox scene_box() const {
    const WorldBox& box = scene_.box();
    if (!box.empty() || !scene_.endless()) return picture_box(scene_);
    return scene_.terrain() ? picture_box(scene_)
                            : WorldBox{input_.target.value_or(dvec3(0.0)), input_.target.value_or(dvec3(0.0))};
  }

  // What depends on where the picture is seen from.
  void finish(Camera& camera) {
    camera.set_reach(reach_of(options_.look_options, input_.across, scene_, scene_box(), camera));
    // The judge has to stop where the march does.
    if (kind_ == InputKind::function && options_.picture.look == Look::error)
      camera.set_reach(std::min(camera.reach(), options_.march_settings.function.reach));
    if (input_.coarse_voxels) put_on_device(input_.scene.coarser(detail_of(camera, options_.picture.aa)));
  }

  Camera framed(const ViewSettings& view) {
    const FieldView found = input_.framed(scene_, view);
    raised_ = std::max(raised_, found.raised);
    return found.camera;
  }

  // The factor between heights of the file and z.
  double exaggeration() const {
    const HeightField* field = input_.scene.terrain();
    return field ? field->settings().exaggeration : 1;
  }

  dvec3 typed_eye() const {
    constexpr std::string_view kEye = "--eye";
    const TypedPlace eye = typed_place(options_.eye, kEye);
    if (eye.z) return places_->world(eye, input_.scene, kEye);
    return above_surface(places_->world(dvec3(eye.x, eye.y, 0), kEye), kEye);
  }

  // --eye-above over the surface at (x, y) of `at`, or over water that covers it.
  dvec3 above_surface(const dvec3& at, std::string_view what) const {
    dvec3 eye = places_->on_surface(at, input_.scene, what);
    if (options_.picture.water) eye.z = std::max(eye.z, options_.picture.water->level * exaggeration());
    return eye + dvec3(0, 0, *options_.eye_above * exaggeration());
  }

  Camera only_camera() {
    const int width = options_.picture.width, height = options_.picture.height;
    if (options_.top && scene_.box().empty() && scene_.endless() && !scene_.terrain())
      throw Error(
          "--top: everything in the scene is endless, without a border to fit a map to (leave --top out, and use "
          "--eye and --target)");
    if (options_.top) return Camera::top(picture_box(scene_), width, height);
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
        return flight_camera(*scene_.terrain(), options_.picture.grid_north_azimuth, input_.view.fov_deg, width,
                             height);
      }
    }
    return framed(input_.view);
  }

  PathPlaces path_places() const {
    PathPlaces path{*places_, input_.scene};
    if (options_.eye_above)
      path.above_surface = [this](const dvec3& at, const std::string& what) { return above_surface(at, what); };
    return path;
  }

  void make_all() {
    const FrameOptions& frames = options_.frames;
    const std::vector<Camera> cameras = frame_cameras(
        frames, input_.view, options_.picture.width, options_.picture.height,
        [&](const ViewSettings& turned) { return framed(turned); }, path_places());
    // Without --overwrite nothing is written over.
    for (int i = 0; frames.overwrite && i < static_cast<int>(cameras.size()); ++i)
      keep_inputs(frame_name(options_.output, i), options_.typed);
    make_frames(frames, options_.output, cameras, [&](Camera camera, const std::string& name) {
      finish(camera);
      ReplaceFile file(name);
      const int blank_before = blank_.count();
      make(file, name, camera, [](double) { return caught_signal() == 0; });
      if (!options_.format->layers && blank_.count() == blank_before)
        tell_if_buried(camera, fmt::format("the eye of '{}'", name));
    });
    tell_notes();
    if (!cameras.empty()) tell_of_contours(cameras.front());
    blank_.tell();
  }

  // Renders and writes one picture. What was found is returned; layers have no findings.
  Picture make(ReplaceFile& file, const std::string& name, const Camera& camera, const Progress& progress) {
    look_through(there_, camera,
                 options_.picture.look == Look::shaded || options_.format->layers ? options_.picture.aa : 1);
    if (options_.format->layers) {
      const PictureLayers layers = render_layers(scene_, camera, options_.picture, progress);
      look_if_blank(name, camera, has_one_colour(layers));
      write_layers(file, name, layers, camera, depth_range_of(options_.depth));
      written_ = {layers.width, layers.height};
      return {};
    }
    const FigureSubject subject{scene_,
                                camera,
                                options_.top,
                                input_.numbers,
                                input_.raster.georeference,
                                input_.raster.cols,
                                input_.raster.rows};
    std::optional<Figure> figure = figure_of(options_.figure, options_.picture, subject);
    Picture picture = render_picture(scene_, camera, options_.picture, progress);
    // Green throughout is what the look of errors should be.
    look_if_blank(name, camera, options_.picture.look != Look::error && has_one_colour(picture.image));
    add_legend(options_.figure, options_.picture, subject, picture, figure);
    std::optional<MapPlace> place;
    if (options_.format->map) {
      place = place_of_map(camera, picture.image.width, picture.image.height, input_.raster.georeference,
                           input_.raster.cols, input_.raster.rows);
    }
    written_ = write_picture(file, name, *options_.format, picture.image, figure, place, options_.figure.dots_per_inch);
    return picture;
  }

  void look_if_blank(const std::string& name, const Camera& camera, bool one_colour) {
    BlankFacts facts = facts_;
    facts.one_colour = one_colour;
    blank_.add(name, why_blank(scene_, camera, options_.picture, facts));
  }

  // Last: what fails prints one line alone.
  void tell_notes() const {
    for (const std::string& note : input_.notes) fmt::print(stderr, "note: {}\n", note);
    if (const std::string note = note_on_low_water(scene_, options_.picture, facts_); !note.empty())
      fmt::print(stderr, "note: {}\n", note);
    if (options_.format->map && !input_.raster.georeference.present)
      fmt::print(stderr, "note: the input has no georeference, nor has {}\n", options_.output);
    if (raised_ > 0) {
      fmt::print(stderr, "note: the eye is raised by {}{} m, out of the ground\n",
                 options_.frames.several() ? "up to " : "", metres_text(raised_));
    }
  }

  // Contour lines of which nothing is seen.
  void tell_of_contours(const Camera& camera) const {
    const double interval = options_.picture.ground.contours;
    if (!(interval > 0)) return;
    const PaintExtent extent = paint_extent(scene_, options_.picture);
    const double low = extent.low / extent.exaggeration, high = extent.high / extent.exaggeration;
    if (std::ceil(low / interval) > std::floor(high / interval)) {
      fmt::print(stderr, "note: --contours {:g}: no line lies between {:.6g} and {:.6g} m, the heights of the scene\n",
                 interval, low, high);
    } else if (const auto better = better_contours(scene_, camera, options_.picture)) {
      fmt::print(stderr,
                 "note: --contours {:g}: the lines are closer than pixels and left out nearly everywhere; --contours "
                 "{:g} shows them\n",
                 interval, *better);
    }
  }

  // From under the ground one sees its other side, and through it.
  void tell_if_buried(const Camera& camera, const std::string& whose) const {
    const auto ground = scene_.height(camera.eye().x, camera.eye().y);
    if (!ground || camera.eye().z >= *ground) return;
    fmt::print(stderr, "note: {} is {} m below the ground\n", whose, metres_text(*ground - camera.eye().z));
  }

  InputKind kind_;
  RenderOptions options_;
  ViewSettings typed_view_;
  RenderInput input_{Scene({}, {})};
  std::optional<Places> places_;
  Scene scene_{{}, {}};
  SceneOnDevice there_{Scene({}, {}), {}};
  Watch watch_;
  double read_s_ = 0, build_s_ = 0;
  WrittenSize written_;
  double raised_ = 0;  // metres, of the eye, the most of all frames
  BlankFacts facts_;
  BlankPictures blank_;
};

}  // namespace

void render_input(InputKind kind, RenderOptions options, const ViewSettings& view) {
  Render(kind, std::move(options), view).run();
}

}  // namespace scarp::cli
