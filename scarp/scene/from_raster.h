// SPDX-License-Identifier: MIT
// From samples of a file to a surface in metres.
#pragma once

#include "scarp/field/height_field.h"
#include "scarp/source/raster.h"

namespace scarp {

/// The bilinear surface of a raster; its cells have the lengths on the ground that the georeference gives. Takes the
/// samples without copying them. Throws Error naming the file: infinite samples, an exaggeration that is not above 0.
HeightField height_field_from(Raster raster, double exaggeration = 1.0);

}  // namespace scarp
