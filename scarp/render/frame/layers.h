// SPDX-License-Identifier: MIT
// A picture for further work: linear light before any display transfer, and beside it what the rays found.
#pragma once

#include <cstdint>
#include <vector>

#include "scarp/render/frame/picture.h"

namespace scarp {

/// Rows from the top, no padding. `colour` is the mean of the pixel's aa x aa samples; all others hold what the ray
/// through the middle of the pixel met, never a mean: a depth between two ridges belongs to neither.
struct PictureLayers {
  int width = 0;
  int height = 0;
  std::vector<vec3> colour;    ///< linear light, Rec. 709 primaries
  std::vector<float> depth;    ///< metres along the camera's view axis, infinity where nothing was met
  std::vector<vec3> normal;    ///< unit, world, of the surface itself (not the shading normal); 0 where nothing was
  std::vector<vec3> position;  ///< metres, world; 0 where nothing was met
  std::vector<std::uint32_t> steps;  ///< of all marches
};

/// Layers of a picture in which nothing was met. Throws Error when the settings are out of range or name another look
/// than `shaded`.
PictureLayers empty_layers(const PictureSettings& settings);

/// The look `shaded` with all layers; water and walls count as met. Throws Error when the settings are out of range or
/// name another look, or there is nothing to see; Interrupted when progress asks for it.
PictureLayers render_layers(const Scene& scene, const Camera& camera, const PictureSettings& settings,
                            const Progress& progress = {});

}  // namespace scarp
