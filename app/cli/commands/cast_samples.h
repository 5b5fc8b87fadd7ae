// SPDX-License-Identifier: MIT
// `scarp cast --samples`: the steps of each ray's march as a table.
#pragma once

#include <span>

#include "scarp/base/ray.h"
#include "scarp/output/trace_table.h"
#include "scarp/scene/scene.h"
#include "scarp/source/raster/coordinates.h"
#include "scarp/source/table/ray_table.h"

namespace scarp::cli {

/// Below the options in the help, which has to fit on a screen.
inline constexpr const char* kSampleColumns =
    "Samples (--samples): a row for each step of a march and for its result; columns: doc/user/cast.md";

/// Throws Error unless the scene is one field whose march records its steps.
void require_samples(const Scene& scene);

/// Traces the rays of `table` again and adds their steps, in the coordinates of `frame`, to the samples, which the
/// caller commits.
void write_samples(TraceTable& samples, const Scene& scene, std::span<const Ray> rays, const RayTable& table,
                   const CoordinateFrame& frame);

}  // namespace scarp::cli
