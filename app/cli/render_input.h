// SPDX-License-Identifier: MIT
// The inputs of `scarp render` with the defaults of their pictures.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/places.h"
#include "app/cli/render_options.h"
#include "scarp/render/camera/field_view.h"
#include "scarp/render/frame/picture_request.h"
#include "scarp/scene/scene.h"

namespace scarp::cli {

/// A scene, and what pictures of this kind of input do by default.
struct RenderInput {
  Scene scene;
  PictureSubject subject{};          ///< without files but the overlay, and without the shape of a map
  std::vector<std::string> notes{};  ///< one line each, for people
  std::vector<std::string> files{};  ///< that were read, beside those that were typed
  PlaceRaster raster{};              ///< by which positions are converted; terrain only
  std::string march{};               ///< what times are printed with; empty: nothing
  ViewSettings view{};               ///< of the options, else of the input, else by default
  bool viewed = false;               ///< the input itself says from where it is seen, by azimuth, elevation or distance
  bool coarse_voxels = false;        //
  double function_reach = 0;         ///< metres, of rays over functions; 0: no function
  bool all_samples = true;           ///< rasters are read completely, however large they are
  std::optional<SolidRange> numbers{};   ///< range that a volume's colours show
  std::optional<dvec3> eye{}, target{};  ///< of the input's own camera
  /// Frames a scene that contains this one; FieldView::raised is set where the eye was lifted out of the ground.
  std::function<FieldView(const Scene&, const ViewSettings&, const PictureSettings&)> framed{};
};

/// Reads the inputs and builds what rays need. `files` are those of read_picture_files(), `size` is that of pictures
/// for which the options ask none. Throws Error naming the file.
RenderInput open_render_input(InputKind kind, const RenderOptions& options, const PictureFiles& files, ImageSize size);

/// Returns whether rasters of any size are read completely; otherwise large ones are averaged.
bool reads_all_samples(const RenderOptions& options);

}  // namespace scarp::cli
