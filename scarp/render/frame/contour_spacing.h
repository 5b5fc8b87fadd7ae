// SPDX-License-Identifier: MIT
// Checks whether the contour lines of a picture are distinguishable: lines closer than a few pixels are omitted
// (surface/ground_paint.h), so a picture with too small an interval has none.
#pragma once

#include <optional>

#include "scarp/render/camera/camera.h"
#include "scarp/render/frame/picture.h"
#include "scarp/scene/scene.h"

namespace scarp {

/// If the interval in the settings is too small for nearly all of the ground in the picture, returns an interval at
/// which half of the ground has all lines and nearly all of it has the heavy ones: 1, 2 or 5 times a power of ten in
/// metres, not exaggerated. Returns nullopt if lines are visible, or there is no sloping ground. Traces a few thousand
/// rays.
std::optional<double> better_contours(const Scene& scene, const Camera& camera, const PictureSettings& settings);

}  // namespace scarp
