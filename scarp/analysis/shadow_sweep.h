// SPDX-License-Identifier: MIT
// Shadows of all nodes by a sweep away from the sun, equal to one ray per node (sight_rays.h).
//
//      sun        Seen along the rays, every ray is a point: u counts across them, s above them. In a frame whose x
//       *         runs away from the sun, with `across` sides and `rise` metres per ring towards it,
//        \          u = y + x across,  s = z + x rise
//     ----o----   Edges stay straight. A node is lit if no edge of a ring before it, at its u, is above its s: the
//     |    \  |   upper envelope of all of them is the horizon.
//     ------o--
//
// Guarantee: exact, for any number of threads. Cost: one comparison for nodes in deep shadow, a few for lit ones.
#pragma once

#include "scarp/analysis/shadow.h"
#include "scarp/analysis/sweep_statistics.h"

namespace scarp {

/// Writes the code of every node, rows from north to south.
SweepStatistics sweep_shadow(const SightGround& ground, const SunRay& sun, Shade* codes, const Progress& progress = {});

}  // namespace scarp
