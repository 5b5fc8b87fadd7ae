// SPDX-License-Identifier: MIT
// Turns a height field into a solid for distance fields.
#pragma once

#include <memory>

#include "scarp/field/distance_node.h"

namespace scarp {

/// Returns the argument for make_shape(): the field with its slope bound. If the field has holes, copies it with the
/// holes filled and uses the original for the positions of the holes (field/ground_holes.h); the original must then not
/// be edited. Throws Error if the field is null or all nodata.
shape::FieldGround solid_ground(std::shared_ptr<const HeightField> field);

}  // namespace scarp
