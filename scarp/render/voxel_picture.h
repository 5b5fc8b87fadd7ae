// SPDX-License-Identifier: MIT
// A picture of a voxel scene.
//
//   shaded  the voxels' colours, flat faces in the light of sun and sky, hard shadows, sky behind
//   steps   what the marches cost: steps per ray as a ramp from the least to the most in the picture
#pragma once

#include <optional>

#include "scarp/render/camera.h"
#include "scarp/render/film.h"
#include "scarp/render/light.h"
#include "scarp/render/picture.h"
#include "scarp/scene/voxel_scene.h"

namespace scarp {

/// Camera::framed() takes it. Throws Error when the scene has no solid voxel.
Box picture_box(const VoxelScene& scene);

/// Of the settings width, height, look (shaded or steps), aa, ramp, sun's azimuth and altitude and shadows count; y is
/// north. `camera` must have been made for the same width and height. Throws Error when a setting is out of its range
/// or the look is another one, Interrupted when progress asks for it.
Picture render_voxels(const VoxelScene& scene, const Camera& camera, const PictureSettings& settings,
                      const Progress& progress = {});

}  // namespace scarp
