// SPDX-License-Identifier: MIT
// The order in which a batch of rays is traced fastest: by the ground below their origins.
//
//   tiles of ground in Morton order    0 1 4 5
//                                      2 3 6 7     rays over one tile are traced together, so each finds samples and
//                                      8 9 ...     pyramid entries in the cache that earlier rays have fetched
//
// Source: G. M. Morton, 1966, for the order of the tiles; M. Pharr, C. Kolb, R. Gershbein, P. Hanrahan, "Rendering
// complex scenes with memory-coherent ray tracing", SIGGRAPH 1997, for the idea. Cost: one pass over the rays and a
// counting sort, some 20 ns per ray.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scarp/base/ray.h"
#include "scarp/field/height_field.h"

namespace scarp {

/// Returns the indices of the rays (at most 2^32), sorted by the tile over which they reach the ground's height.
/// Returns an empty list if sorting would not pay: for few rays, for fields that fit into a cache, and if most rays
/// start near the previous one.
std::vector<std::uint32_t> ground_order(const HeightField& field, std::span<const Ray> rays);

}  // namespace scarp
