// SPDX-License-Identifier: MIT
// The rays of a table in a scene: their coordinates, checks of their starts, and rays that cannot be used.
#pragma once

#include <string>
#include <vector>

#include "scarp/base/ray.h"
#include "scarp/scene/scene.h"
#include "scarp/source/raster/coordinates.h"
#include "scarp/source/table/ray_table.h"

namespace scarp::cli {

/// Returns the rays in local coordinates. Throws Error for a ray outside the domain of the CRS; `skip_bad`: the table
/// leaves it out.
std::vector<Ray> placed_rays(RayTable& table, const CoordinateFrame& frame, bool skip_bad);

/// Checks all rays. Those that start on a surface start on the only terrain of the scene. Returns notes: about a ray
/// that starts farther above or below it than the side of a cell, and about the rays that the table leaves out. Throws
/// Error for a ray that the scene does not accept, or, with `skip_bad`, leaves it out, and throws Error if no ray is
/// left.
std::vector<std::string> check_rays(RayTable& table, std::vector<Ray>& rays, const Scene& scene, bool skip_bad);

}  // namespace scarp::cli
