// SPDX-License-Identifier: MIT
// A picture of a scene of many fields.
//
//   shaded  materials in the light of sun and sky, exact hard shadows (or, with `samples`, soft ones and ambient
//           occlusion), haze with distance, sky
//   height  grey by height, see height_look.h
//   steps   what the marches cost: steps per ray as a ramp from the least to the most in the picture
#pragma once

#include <limits>
#include <span>

#include "scarp/render/camera/camera.h"
#include "scarp/render/frame/layers.h"
#include "scarp/render/frame/picture.h"
#include "scarp/scene/material.h"
#include "scarp/scene/scene.h"

namespace scarp {

struct SceneLook {
  std::vector<Material> materials;  ///< what SceneObject::material counts
  /// Metres after which haze hides all but 1/e of a colour; > 0, infinity: none.
  double haze_distance = std::numeric_limits<double>::infinity();
};

/// Camera::framed() takes it: around all that has an end. Throws Error when that is nothing.
Box picture_box(const Scene& scene);

/// Of the settings `plinth`, `haze` and `error_tolerance` do not count; y is north. `camera` must have been made for
/// the settings' width and height. Throws Error when a setting is out of its range or the look is another one,
/// Interrupted when progress asks for it.
Picture render_scene(const Scene& scene, const SceneLook& look, const Camera& camera, const PictureSettings& settings,
                     const Progress& progress = {});

/// The look `shaded` with all layers, see layers.h.
PictureLayers render_scene_layers(const Scene& scene, const SceneLook& look, const Camera& camera,
                                  const PictureSettings& settings, const Progress& progress = {});

}  // namespace scarp
