// SPDX-License-Identifier: MIT
// Shapes of each kind, and random trees of them.
#pragma once

#include <string>
#include <vector>

#include "field/terrain_functions.h"
#include "scarp/field/distance_node.h"

namespace scarp::test {

struct NamedShape {
  std::string name;
  Shape shape;
};

/// All solids, all operations, both kinds of ground; within some 20 m of the origin.
std::vector<NamedShape> shape_zoo();

/// Solids of one or two metres in size.
Shape random_solid(FunctionRandom& random);
/// Trees nested at most `depth` deep. Without `smooth` the solid follows from set operations, and solid_holds() decides
/// it.
Shape random_shape(FunctionRandom& random, int depth, bool smooth);

/// Whether a position is in the solid: by the inequality of each solid, and by set operations. Without smooth
/// operations.
bool solid_holds(const Shape& shape, const dvec3& p);

}  // namespace scarp::test
