// SPDX-License-Identifier: MIT
// A raster and its mirror images as one raster that repeats seamlessly.
//
//   q d q     b is the raster, d and p its images at the north and east border, q both. Border samples occur once:
//   p b p     N columns become 2N - 2, and the first follows the last as in the mirror.
#pragma once

#include "scarp/source/raster/raster.h"

namespace scarp {

/// The raster stays in the south-west corner, so local coordinates do not change. Throws Error naming the file for
/// fewer than 2 x 2 samples, or if the result would have more than 2^30 columns or rows.
Raster mirrored(Raster raster);

}  // namespace scarp
