// SPDX-License-Identifier: MIT
// Hits of the rays through the centres of a picture's pixels.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "scarp/base/progress.h"
#include "scarp/render/camera/camera.h"
#include "scarp/render/film/film.h"
#include "scarp/render/film/tile_work.h"
#include "scarp/scene/scene.h"

namespace scarp {

/// The rays through the centres of a tile's pixels, row by row.
std::vector<Ray> rays_through_middles(const Camera& camera, const PixelTile& tile);

/// Receives a pixel's index (rows from the top), its ray, its hit, and its steps (0 without `count`).
using TakeMiddle = std::function<void(std::size_t, const Ray&, const Hit&, std::uint32_t)>;

/// Sets the hits of a round's rays; called on any thread.
using TraceMiddles = std::function<void(RayRound&)>;

/// Calls `take` for each pixel of a picture of the camera, on any thread. `count`: whether to count steps. If not
/// empty, `trace` traces the rays instead of the scene, without counting.
void look_through_middles(const Scene& scene, const Camera& camera, ImageSize size, bool count,
                          const Progress& progress, const TakeMiddle& take, const TraceMiddles& trace = {});

}  // namespace scarp
