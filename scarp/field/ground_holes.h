// SPDX-License-Identifier: MIT
// Holes of a height field used as a solid: bottomless shafts.
//
//   over_hole   signed distance to the nearest rim, positive over a hole. Combined with the height above a ground that
//               continues across the hole (filled_holes) it gives a 1-Lipschitz function that is positive exactly
//               outside the solid:
//
//                 ____        ____             max(height above the ground / sqrt(1 + c^2), over_hole)
//                 ####|......|####   . filled
//                 ####|      |####
#pragma once

#include "scarp/field/height_field.h"

namespace scarp {

struct OverHole {
  double value;    ///< metres to the rim, negative over ground; capped at the shorter side of a cell
  dvec2 gradient;  ///< of the value, in metres per metre; 0 if no rim is within the cap
  bool flat;       ///< whether the value is linear within the requested radius
};

/// `place` is a position in the field, x and y in metres; callers clamp positions outside the field first.
OverHole over_hole(const HeightField& field, dvec2 place, double radius);

/// Returns the field with nodata replaced by heights. Each is the maximum, over all samples, of a cone that descends
/// from the sample with this slope (metres per metre), but at least the lowest sample. Samples become float32. Throws
/// Error if all are nodata.
HeightField filled_holes(const HeightField& field, double slope);

}  // namespace scarp
