// SPDX-License-Identifier: MIT
// Holes of a height field whose ground is a solid: where there is no ground, there is a shaft without a bottom.
//
//   over_hole   how far a place is from the nearest rim, on which side of it: positive over a hole. Together with the
//               height over a ground that goes on across the hole (filled_holes) this makes a function that changes by
//               no more than a metre per metre and is positive just where there is no solid:
//
//                 ____        ____             max(height over the ground / sqrt(1 + c^2), over_hole)
//                 ####|......|####   . filled
//                 ####|      |####
#pragma once

#include "scarp/field/height_field.h"

namespace scarp {

struct OverHole {
  double value;    ///< metres to the rim, negative over the ground; no farther than the shorter side of a cell
  dvec2 gradient;  ///< of the value, in metres per metre; 0 where no rim is that near
  bool flat;       ///< within the radius asked for it is linear
};

/// At a place of the field, x and y in metres; off the field that of its nearest cell would be wrong: clamp it before.
OverHole over_hole(const HeightField& field, dvec2 place, double radius);

/// The field with heights in the place of nodata: as high as a cone of this slope (metres per metre) under each sample
/// that there is, but no lower than the lowest of them. Samples become float32. Throws Error when there are none.
HeightField filled_holes(const HeightField& field, double slope);

}  // namespace scarp
