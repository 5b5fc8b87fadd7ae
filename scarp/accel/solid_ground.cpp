// SPDX-License-Identifier: MIT
#include "scarp/accel/solid_ground.h"

#include <utility>

#include "scarp/accel/slope_bound.h"
#include "scarp/base/error.h"
#include "scarp/field/ground_holes.h"

namespace scarp {

shape::FieldGround solid_ground(std::shared_ptr<const HeightField> field) {
  if (!field) throw Error("shape: field of a ground is missing (must be a height field)");
  const double slope = slope_bound(*field);
  if (field->nodata_count() == 0) return {std::move(field), slope, nullptr};
  auto filled = std::make_shared<const HeightField>(filled_holes(*field, slope));
  const double steepest = slope_bound(*filled);
  return {std::move(filled), steepest, std::move(field)};
}

}  // namespace scarp
