// SPDX-License-Identifier: MIT
// A raster and its mirror images, as one raster that goes on with itself without a seam.
//
//   q d q     b is the raster, d and p its images at the north and east border, q both. Border samples are there once:
//   p b p     N columns become 2N - 2, and the first follows the last as it does in the mirror.
#pragma once

#include "scarp/source/raster.h"

namespace scarp {

/// The raster stays in the south-west corner: local coordinates are as before. Throws Error naming the file when there
/// are fewer than 2 x 2 samples, or more than 2^30 columns or rows would come of it.
Raster mirrored(Raster raster);

}  // namespace scarp
