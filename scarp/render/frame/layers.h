// SPDX-License-Identifier: MIT
// A picture for further processing: linear light before any display transfer, with the geometry that the rays hit.
#pragma once

#include <cstdint>
#include <vector>

#include "scarp/render/frame/picture.h"

namespace scarp {

/// Rows from the top, no padding. `colour` is the mean of the pixel's aa x aa samples; all others hold the hit of the
/// ray through the pixel's centre, never a mean: a mean depth between two ridges would belong to neither.
struct PictureLayers {
  int width = 0;
  int height = 0;
  std::vector<vec3> colour;          ///< linear light, Rec. 709 primaries
  std::vector<float> depth;          ///< metres along the camera's view axis, infinity for a miss
  std::vector<vec3> normal;          ///< unit, world, of the surface itself (not the shading normal); 0 for a miss
  std::vector<vec3> position;        ///< metres, world; 0 for a miss
  std::vector<std::uint32_t> steps;  ///< sum over all marches
};

/// Layers of a picture without hits. Throws Error if the settings are out of range or the look is neither `shaded` nor
/// `comanche`.
PictureLayers empty_layers(const PictureSettings& settings);

/// Renders the look `shaded` or `comanche` with all layers; water and walls count as hits. Large pixels are scaled up,
/// as in render_picture(). Throws Error if the settings are out of range, the look is another one, or nothing is
/// visible. Throws Interrupted if `progress` returns false.
PictureLayers render_layers(const Scene& scene, const Camera& camera, const PictureSettings& settings,
                            const Progress& progress = {});

}  // namespace scarp
