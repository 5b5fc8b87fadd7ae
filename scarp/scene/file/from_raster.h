// SPDX-License-Identifier: MIT
// Converts samples of a file to a surface in metres.
#pragma once

#include "scarp/field/height_field.h"
#include "scarp/source/raster/raster.h"

namespace scarp {

/// Properties of the surface that a raster does not state; see HeightFieldSettings.
struct FieldOptions {
  double exaggeration = 1.0;  ///< > 0
  Surface surface = Surface::bilinear;
  Wrap wrap = Wrap::none;
  bool mirror = false;  ///< the raster and its mirror images as one (source/mirrored.h); `wrap` is periodic then
  bool solid = false;

  bool operator==(const FieldOptions&) const = default;
};

/// Returns the surface of a raster, with the georeference's cell lengths on the ground. Moves the samples. Throws Error
/// naming the file for infinite samples, an exaggeration that is not above 0, or sides that differ although `wrap` is
/// shared_border.
HeightField height_field_from(Raster raster, const FieldOptions& options = {});

}  // namespace scarp
