// SPDX-License-Identifier: MIT
// The bounds of a beam of rays in a box: where the rays enter, and their slopes.
#pragma once

#include <array>
#include <cstdint>

#include "scarp/scene/tree/box_tree.h"

namespace scarp {

struct BeamBounds {
  // For the rays that enter the box: bounds of their entry points, and of their slopes per length along the beam's
  // axis.
  dvec3 low, high, least, most;
  double slowest = 0;  // length along the axis per t
  double last = 0;     // length from there to where the ray ends
};

/// Bounds at most Beam::kRays rays. `sign` is the sign of their directions along the beam's axis. `axis` must be 0, 1
/// or 2. Results are relative to `middle`. Sets start and per_t of each ray, 0 for those that miss the box, and returns
/// a bit for each of the other rays. slowest is not above 0 if one of those has a different sign.
std::uint64_t bound_beam(const BoxTree::Rays& rays, const WorldBox& box, const dvec3& middle, int axis, double sign,
                         double* start, double* per_t, BeamBounds& bounds);

}  // namespace scarp
