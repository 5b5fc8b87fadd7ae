// SPDX-License-Identifier: MIT
#include "scarp/march/height/height_target.h"

#include <fmt/format.h>

#include "scarp/base/error.h"

namespace scarp {

void refuse_target(const HeightTarget& target, HeightPart part) {
  if (!target.field) throw Error("march: its target has no field (set HeightTarget::field)");
  if (!target.pyramid && part != HeightPart::slope)
    throw Error("march: it needs a maximum pyramid (build a MaxPyramid of the field and set HeightTarget::pyramid)");
  throw Error("march: it needs a bound of the slope (set HeightTarget::slope to slope_bound(field))");
}

void require_field(const HeightField& field, HeightFields fields, std::string_view march) {
  if (takes(fields, field)) return;
  const char* has = field.wraps() ? "wraps" : field.nodata_count() > 0 ? "has holes" : "consists of triangles";
  throw Error(fmt::format(
      "march: {} takes only bilinear ground without holes or wrap, and this ground {} (use max-mip)", march, has));
}

}  // namespace scarp
