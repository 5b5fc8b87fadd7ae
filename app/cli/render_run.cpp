// SPDX-License-Identifier: MIT
#include "app/cli/render_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/device_option.h"
#include "app/cli/exr_output.h"
#include "app/cli/findings.h"
#include "app/cli/kept_inputs.h"
#include "app/cli/numbers.h"
#include "app/cli/progress.h"
#include "app/cli/render_input.h"
#include "scarp/base/error.h"
#include "scarp/base/replace_file.h"
#include "scarp/output/png.h"

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

// A map without --size has the shape of the scene, its longer side as long as a picture's default width.
void fit_size_to_scene(const WorldBox& box, PictureSettings& picture) {
  const dvec3 size = box.high - box.low;
  const double pixels_per_metre = picture.width / std::max(size.x, size.y);
  picture.width = std::max(1, static_cast<int>(std::lround(size.x * pixels_per_metre)));
  picture.height = std::max(1, static_cast<int>(std::lround(size.y * pixels_per_metre)));
}

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
    tell_if_buried(camera, "the eye");
    const int scale = options_.picture.look == Look::comanche ? options_.picture.comanche.scale : 1;
    fmt::print("{}: {} x {} pixels; {}read {:.2f} s, build {:.2f} s, render {:.2f} s{}\n", options_.output,
               options_.picture.width * scale, options_.picture.height * scale,
               input_.march.empty() ? "" : input_.march + "; ", read_s_, build_s_, render_s,
               device_.empty() ? "" : ", on " + device_);
    print_findings(picture);
  }

 private:
  void read() {
    const MeshInput mesh(options_.mesh);
    input_ = open_render_input(kind_, options_, typed_view_);
    options_.typed.insert(options_.typed.end(), input_.files.begin(), input_.files.end());
    stop_if_interrupted();
    read_s_ = watch_.lap();
    input_.scene = mesh.with_mesh(std::move(input_.scene));
    input_.notes.insert(input_.notes.end(), mesh.notes().begin(), mesh.notes().end());
    if (input_.coarse_voxels) {
      scene_ = input_.scene;
    } else {
      put_on_device(input_.scene);
    }
    stop_if_interrupted();
    if (options_.top && options_.size.empty()) fit_size_to_scene(picture_box(scene_), options_.picture);
    finish_look(options_.look_options, input_.across, input_.heights, input_.exaggeration, options_.picture);
    build_s_ = watch_.lap();
  }

  void put_on_device(const Scene& scene) {
    SceneOnDevice there = scene_on_device(options_.device, scene);
    scene_ = std::move(there.scene);
    device_ = std::move(there.device);
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

  Camera only_camera() {
    const int width = options_.picture.width, height = options_.picture.height;
    if (options_.top) return Camera::top(picture_box(scene_), width, height);
    if (!options_.eye.empty()) {
      const dvec3 target = !options_.target.empty() ? point_from(options_.target, "--target")
                           : input_.target          ? *input_.target
                                                    : picture_box(scene_).middle();
      return Camera::look_at(point_from(options_.eye, "--eye"), target, input_.view.fov_deg, width, height);
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

  void make_all() {
    const FrameOptions& frames = options_.frames;
    const std::vector<Camera> cameras =
        frame_cameras(frames, input_.view, options_.picture.width, options_.picture.height,
                      [&](const ViewSettings& turned) { return framed(turned); });
    // Without --overwrite nothing is written over.
    for (int i = 0; frames.overwrite && i < static_cast<int>(cameras.size()); ++i)
      keep_inputs(frame_name(options_.output, i), options_.typed);
    make_frames(frames, options_.output, cameras, [&](Camera camera, const std::string& name) {
      finish(camera);
      ReplaceFile file(name);
      make(file, name, camera, [](double) { return caught_signal() == 0; });
      if (!options_.exr) tell_if_buried(camera, fmt::format("the eye of '{}'", name));
    });
    tell_notes();
  }

  // Renders and writes one picture. What was found is returned; layers have no findings.
  Picture make(ReplaceFile& file, const std::string& name, const Camera& camera, const Progress& progress) const {
    if (options_.exr) {
      const PictureLayers layers = render_layers(scene_, camera, options_.picture, progress);
      write_layers(file, name, layers, camera, depth_range_of(options_.depth));
      return {};
    }
    Picture picture = render_picture(scene_, camera, options_.picture, progress);
    draw_figure_of(options_.figure, options_.picture, scene_, camera, options_.top, input_.numbers, picture);
    write_png(file, name, {picture.image.rgb.data(), picture.image.width, picture.image.height});
    return picture;
  }

  // Last: what fails prints one line alone.
  void tell_notes() const {
    for (const std::string& note : input_.notes) fmt::print(stderr, "note: {}\n", note);
    if (raised_ > 0) {
      fmt::print(stderr, "note: the eye is raised by {}{} m, out of the ground\n",
                 options_.frames.several() ? "up to " : "", metres_text(raised_));
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
  Scene scene_{{}, {}};
  std::string device_;
  Watch watch_;
  double read_s_ = 0, build_s_ = 0;
  double raised_ = 0;  // metres, of the eye, the most of all frames
};

}  // namespace

dvec3 point_from(const std::string& text, std::string_view option) {
  const auto p =
      numbers_from(text, ',', 3, 3, option, "X,Y,Z in metres from the south-west sample, for example 500,-2000,1800");
  return {p[0], p[1], p[2]};
}

void render_input(InputKind kind, RenderOptions options, const ViewSettings& view) {
  Render(kind, std::move(options), view).run();
}

}  // namespace scarp::cli
