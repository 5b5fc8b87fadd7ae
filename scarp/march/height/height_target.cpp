// SPDX-License-Identifier: MIT
#include "scarp/march/height/height_target.h"

#include "scarp/base/error.h"

namespace scarp {

void refuse_target(const HeightTarget& target, HeightPart part) {
  if (!target.field) throw Error("march: its target has no field (set HeightTarget::field)");
  if (!target.pyramid && part != HeightPart::slope)
    throw Error("march: it needs a maximum pyramid (build a MaxPyramid of the field and set HeightTarget::pyramid)");
  throw Error("march: it needs a bound of the slope (set HeightTarget::slope to slope_bound(field))");
}

}  // namespace scarp
