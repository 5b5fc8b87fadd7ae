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

/// A scene, and what pictures of this kind of input do by default. What follows from the input alone has been put into
/// the options' picture settings.
struct RenderInput {
  Scene scene;
  std::vector<std::string> notes{};             ///< one line each, for people
  std::vector<std::string> files{};             ///< that were read, beside those that were typed
  PlaceRaster raster{};                         ///< by which positions are converted; terrain only
  std::shared_ptr<const SceneFile> document{};  ///< scene files only
  std::string march{};                          ///< what times are printed with; empty: nothing
  ViewSettings view{};
  bool viewed = false;  ///< the input itself says from where it is seen, by azimuth, elevation or distance
  bool coarse_voxels = false;
  double across = 0;      ///< metres that a picture is about: visibility, reach
  ReliefRange heights{};  ///< of the ground, exaggerated
  double exaggeration = 1;
  std::optional<SolidRange> numbers{};   ///< range that a volume's colours show
  std::optional<dvec3> eye{}, target{};  ///< of the input's own camera
  /// Frames a scene that contains this one; FieldView::raised is set where the eye was lifted out of the ground.
  std::function<FieldView(const Scene&, const ViewSettings&)> framed{};
};

/// Reads the inputs and builds what rays need. `view` is what was typed. Throws Error naming the file.
RenderInput open_render_input(InputKind kind, RenderOptions& options, const ViewSettings& view);

/// Returns whether rasters are read completely, however large they are; otherwise large ones are averaged.
bool reads_all_samples(const RenderOptions& options);

/// Puts into other options of the picture what follows from the input, which was opened with the options `before`.
void settle_again(InputKind kind, const RenderInput& input, const RenderOptions& before, RenderOptions& options);

}  // namespace scarp::cli
