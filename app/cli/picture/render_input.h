// SPDX-License-Identifier: MIT
// The inputs of `scarp render` with the defaults of their pictures.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/options/places.h"
#include "app/cli/options/render_options.h"
#include "scarp/render/camera/field_view.h"
#include "scarp/render/frame/picture_request.h"
#include "scarp/scene/scene.h"

namespace scarp::cli {

/// A scene, and the default picture settings of this kind of input.
struct RenderInput {
  Scene scene;
  PictureSubject subject{};              ///< without files except the overlay, and without the shape of a map
  std::vector<std::string> notes{};      ///< one line each, for users
  std::vector<std::string> files{};      ///< files read in addition to typed ones
  PlaceRaster raster{};                  ///< defines positions; terrain only
  std::string march{};                   ///< label of the printed times; empty: none
  ViewSettings view{};                   ///< from the options, else the input, else the default
  bool viewed = false;                   ///< the input itself sets azimuth, elevation or distance
  bool coarse_voxels = false;            //
  double function_reach = 0;             ///< metres, of rays over functions; 0: no function
  bool all_samples = true;               ///< rasters of any size are read completely
  std::optional<SolidRange> numbers{};   ///< range that a volume's colours show
  std::optional<dvec3> eye{}, target{};  ///< of the input's own camera
  /// Frames a scene that contains this one; sets FieldView::raised if the eye was raised out of the ground.
  std::function<FieldView(const Scene&, const ViewSettings&, const PictureSettings&)> framed{};
};

/// Reads the inputs and builds their accelerators. `size` is the default size of pictures. Throws Error naming the
/// file.
RenderInput open_render_input(InputKind kind, const RenderOptions& options, ImageSize size);

/// Returns whether rasters of any size are read completely; otherwise large ones are averaged.
bool reads_all_samples(const RenderOptions& options);

}  // namespace scarp::cli
