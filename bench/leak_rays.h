// SPDX-License-Identifier: MIT
// The rays of `scarp-bench leaks`. Each ray is a function only of seed, index, class and field: it does not depend on
// the number of threads, and can be reproduced without the others.
#pragma once

#include <cstdint>
#include <string_view>

#include "bench/leak_fields.h"
#include "bench/random.h"
#include "scarp/base/ray.h"

namespace scarp::bench {

enum class LeakClass : std::uint8_t {
  nodes,      ///< from above at nodes, ending below all ground
  edges,      ///< the same at points of edges
  diagonals,  ///< the same at points of both diagonals
  axis,       ///< parallel to an axis, most of them along a grid line
  vertical,   ///< straight up and down, over nodes, edges and anywhere
  tangent,    ///< level, at the height of a node on their path
  two_nodes,  ///< through two nodes
  border,     ///< starting on the border, along it, through its nodes and corners
  rims,       ///< at nodes next to holes, and past them
  seam,       ///< at nodes and edges of the seam, several periods away
  below,      ///< starting below the ground
  plane,      ///< from the surface of a plane, in it and slightly off it
  saddles,    ///< from the surface of saddles
  surface,    ///< from the surface, anywhere
  leaning,    ///< nearly vertical, at nodes and edges, on borders and rims
  far,        ///< at nodes from 10^5 to 10^7 m away
  any,        ///< from anywhere to anywhere
};
constexpr LeakClass kLeakClasses[] = {LeakClass::nodes,    LeakClass::edges,   LeakClass::diagonals, LeakClass::axis,
                                      LeakClass::vertical, LeakClass::tangent, LeakClass::two_nodes, LeakClass::border,
                                      LeakClass::rims,     LeakClass::seam,    LeakClass::below,     LeakClass::plane,
                                      LeakClass::saddles,  LeakClass::surface, LeakClass::leaning,   LeakClass::far,
                                      LeakClass::any};
std::string_view name_of(LeakClass leak_class);

/// Whether the class applies to that kind of ground: rims need holes, the seam a wrapped field.
bool suits(LeakClass leak_class, const LeakField& ground);

/// A ray of the class; its range is finite. In the classes nodes, edges and diagonals, `in_float32` rays consist of
/// float32 numbers, so that an engine in float gets the same rays; all other rays reach their point at exactly t = 1,
/// if the field's own numbers allow it.
Ray make_leak_ray(LeakClass leak_class, const LeakField& ground, Random& random, bool in_float32);

}  // namespace scarp::bench
