// SPDX-License-Identifier: MIT
// One ray at a time: lines of sight between nodes and rays to the sun, for any subset of nodes. Cost: one comparison
// per crossing, about |columns| + |rows| between the ends.
#pragma once

#include "scarp/analysis/shadow.h"
#include "scarp/analysis/sight.h"

namespace scarp {

/// Returns whether no crossing between two nodes blocks. `eye` and `target` are lowered heights in metres.
bool sees(const SightGround& ground, Node observer, double eye, Node node, double target);

/// Returns the smallest lowered height at which a target over `node` is visible; -infinity if there is no crossing.
double least_visible(const SightGround& ground, Node observer, double eye, Node node);

/// Returns the shade of a node; hole if it has no sample.
Shade shade(const SightGround& ground, const SunRay& sun, Node node);

}  // namespace scarp
