// SPDX-License-Identifier: MIT
// A height field as a solid among shapes.
#pragma once

#include <memory>

#include "scarp/field/distance_node.h"

namespace scarp {

/// What make_shape() takes: the field with its slope bound. Of a field with holes a copy is made whose holes are
/// filled, and the field itself says where they are (field/ground_holes.h); it may not be edited then. Throws Error for
/// a field that is missing, or nodata all over.
shape::FieldGround solid_ground(std::shared_ptr<const HeightField> field);

}  // namespace scarp
