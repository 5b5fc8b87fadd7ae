// SPDX-License-Identifier: MIT
// The inputs of `scarp render` with the defaults of their pictures.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/open_input.h"
#include "app/cli/places.h"
#include "app/cli/render_options.h"
#include "scarp/render/camera/field_view.h"
#include "scarp/scene/scene.h"

namespace scarp::cli {

/// A scene, and the default picture settings of this kind of input. Settings that follow from the input alone have been
/// stored in the options' picture settings.
struct RenderInput {
  Scene scene;
  std::vector<std::string> notes{};             ///< one line each, for users
  std::vector<std::string> files{};             ///< files read in addition to those that were typed
  PlaceRaster raster{};                         ///< raster that defines positions; terrain only
  std::shared_ptr<const SceneFile> document{};  ///< scene files only
  std::string march{};                          ///< label of the printed times; empty: none
  ViewSettings view{};
  bool viewed = false;  ///< the input itself sets azimuth, elevation or distance of its view
  bool coarse_voxels = false;
  double across = 0;      ///< extent of the picture in metres: for visibility and reach
  ReliefRange heights{};  ///< of the ground, exaggerated
  double exaggeration = 1;
  std::optional<SolidRange> numbers{};   ///< range of a volume's colours
  std::optional<dvec3> eye{}, target{};  ///< of the input's own camera
  /// Frames a scene that contains this one; sets FieldView::raised if the eye was raised out of the ground.
  std::function<FieldView(const Scene&, const ViewSettings&)> framed{};
};

/// Reads the inputs and builds their accelerators. `view` holds the typed values. Throws Error naming the file.
RenderInput open_render_input(InputKind kind, RenderOptions& options, const ViewSettings& view);

/// Returns whether rasters of any size are read completely; otherwise large ones are averaged.
bool reads_all_samples(const RenderOptions& options);

/// Applies the settings that follow from the input, which was opened with the options `before`, to other picture
/// options.
void settle_again(InputKind kind, const RenderInput& input, const RenderOptions& before, RenderOptions& options);

}  // namespace scarp::cli
