// SPDX-License-Identifier: MIT
// From samples of a file to a surface in metres.
#pragma once

#include "scarp/field/height_field.h"
#include "scarp/source/raster.h"

namespace scarp {

/// What a raster does not say about the surface through its samples; see HeightFieldSettings.
struct FieldOptions {
  double exaggeration = 1.0;  ///< > 0
  Surface surface = Surface::bilinear;
  Wrap wrap = Wrap::none;
  bool mirror = false;  ///< the raster and its mirror images as one (source/mirrored.h); `wrap` is periodic then
  bool solid = false;
};

/// The surface of a raster; its cells have the lengths on the ground that the georeference gives. Takes the samples
/// without copying them. Throws Error naming the file: infinite samples, an exaggeration that is not above 0, a border
/// that is not the shared one it should be.
HeightField height_field_from(Raster raster, const FieldOptions& options = {});

}  // namespace scarp
