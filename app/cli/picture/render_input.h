// SPDX-License-Identifier: MIT
// The inputs of `scarp render` with the defaults of their pictures. Readers get an InputRequest, not the options.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/options/places.h"
#include "app/cli/options/render_options.h"
#include "scarp/render/camera/field_view.h"
#include "scarp/render/frame/picture_request.h"
#include "scarp/scene/file/scene_file.h"
#include "scarp/scene/scene.h"

namespace scarp::cli {

/// The options that the scene of a picture depends on. Options with equal requests have the same scene.
struct InputRequest {
  InputKind kind = InputKind::terrain;
  InputOptions input{};             ///< including the decimation of rasters and the reach of functions
  std::string ramp{};               ///< colours of the numbers of volumes; empty: one colour
  PictureFileNames overlay{};       ///< only the file of the overlay, and how it is placed
  std::int64_t overlay_pixels = 0;  ///< over the raster; an image with more is averaged
  bool plinth = true;               ///< below a raster
  std::string voxel_drawing{};
  CameraOptions camera{};

  bool operator==(const InputRequest&) const = default;
};
/// Large rasters are read at the resolution of the picture; rays over functions end at the view distance.
InputRequest input_request(InputKind kind, const RenderOptions& options);

/// A scene, and the default picture settings of this kind of input.
struct RenderInput {
  Scene scene;
  PictureSubject subject{};             ///< without files except the overlay, and without the aspect ratio of a map
  std::vector<std::string> notes{};     ///< one line each, for users
  std::vector<std::string> files{};     ///< files read in addition to typed ones
  PlaceRaster raster{};                 ///< defines positions; terrain only
  std::string march{};                  ///< label of the printed times; empty: none
  SceneCamera camera{};                 ///< the input's own; functions have only a target
  bool coarse_voxels = false;           //
  double function_reach = 0;            ///< length of rays over functions in metres; 0: no function
  std::optional<SolidRange> numbers{};  ///< range that a volume's colours show
  /// Frames a scene that contains this one; sets FieldView::raised if the eye was raised out of the ground.
  std::function<FieldView(const Scene&, const ViewSettings&, const PictureSettings&)> framed{};
};

/// Reads the inputs and builds their accelerators. Throws Error naming the file.
RenderInput open_render_input(const InputRequest& request);

}  // namespace scarp::cli
