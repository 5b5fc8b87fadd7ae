// SPDX-License-Identifier: MIT
// The scene of `scarp render` and of the window, ready for rays: reads the inputs, copies them to the device, and
// creates the cameras of the options.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "app/cli/options/device_option.h"
#include "app/cli/options/places.h"
#include "app/cli/options/render_options.h"
#include "app/cli/picture/render_input.h"
#include "app/cli/picture/seen.h"
#include "scarp/render/frame/picture_request.h"

namespace scarp::cli {

class PreparedScene {
 public:
  /// The options must be consistent with each other; `size` is the default size of pictures.
  PreparedScene(InputKind kind, RenderOptions options, ImageSize size = PictureSubject{}.size)
      : options_(std::move(options)), request_(input_request(kind, options_)), size_(size) {}
  PreparedScene(const PreparedScene&) = delete;
  PreparedScene& operator=(const PreparedScene&) = delete;

  /// Reads the inputs and builds their accelerators. Throws Error naming the file.
  void open();

  const RenderOptions& options() const { return options_; }
  /// Whether options with this request have the same scene and are valid for picture().
  bool serves(InputRequest asked) const;
  /// The settings of the options, for any camera.
  const PictureSettings& picture() const { return picture_; }
  /// The settings of `options`, whose request serves() must accept, for a camera; null: for any camera. Throws Error
  /// naming a file, or a setting that is out of range.
  PictureSettings picture(const RenderOptions& options, const Camera* camera) const;
  PictureSettings picture(const Camera& camera) const { return picture(options_, &camera); }
  /// The scene as read. scene() may have coarser voxels or be on a device.
  const Scene& given_scene() const { return input_.scene; }
  const Scene& scene() const { return scene_; }
  const RenderInput& input() const { return input_; }
  /// The view of the options, or of the input, or the default.
  const ViewSettings& view() const { return view_; }
  const Places& places() const { return *places_; }
  const SceneOnDevice& there() const { return there_; }
  const BlankFacts& facts() const { return facts_; }
  double read_seconds() const { return read_s_; }
  double build_seconds() const { return build_s_; }
  /// Maximum height in metres by which eyes were raised out of the ground so far.
  double raised() const { return raised_; }
  /// ", on NAME", and the number of drawn rays; empty on the CPU.
  std::string on_device() const;
  /// Box of the scene; for unbounded scenes, a point: the centre of the picture's extent.
  WorldBox scene_box() const;
  /// The ratio of z to heights in the file.
  double exaggeration() const;

  /// The camera of the options.
  Camera camera();
  /// A camera that frames the scene.
  Camera framed(const ViewSettings& view);
  PathPlaces path_places() const;
  /// Sets the maximum length of the camera's rays, and coarsens voxels for it.
  void finish(Camera& camera) { finish(camera, options_); }
  void finish(Camera& camera, const RenderOptions& options);

  /// Whether the picture is a map of numbers (writes_numbers()) whose pixels are those of the raster.
  bool has_pixel_per_sample() const;

 private:
  ViewSettings chosen_view() const;
  std::string note_on_relief() const;
  WorldBox map_box() const;
  void put_on_device(const Scene& scene);
  dvec3 typed_eye() const;
  dvec3 above_surface(const dvec3& at, std::string_view what) const;

  const RenderOptions options_;
  const InputRequest request_;
  ImageSize size_;
  PictureSubject subject_{};
  PictureSettings picture_{};
  RenderInput input_{Scene({}, {})};
  ViewSettings view_{};
  std::optional<Places> places_;
  Scene scene_{{}, {}};
  SceneOnDevice there_{Scene({}, {}), {}};
  double read_s_ = 0, build_s_ = 0;
  double raised_ = 0;
  BlankFacts facts_;
};

}  // namespace scarp::cli
