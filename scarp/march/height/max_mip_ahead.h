// SPDX-License-Identifier: MIT
// Any hit of `max-mip` for one ray at a time, in single precision: the lanes of a vector are the 4 x 4 children of one
// block.
//
//   block   . . . #     which children does the ray cross, and does it clear each one? One step for all of them,
//           . . # .     without branches. Lanes are numbered in rows along the ray, so their order is that of the ray:
//           . # . .     the first child that is not clear is next, the others wait in a mask for each level
//           # . . .
//   cells   4 x 4 cells of a block of level 2, with bounds of the clearance in each, are the last step
//
// The ray is followed from the block of its start upwards, as far as blocks are clear, and down again. Levels 1, 3, ...
// are not used.
//
// As in max_mip_simd.h, vectors decide only what a margin proves (doc/dev/numerics.md). The scalar traversal decides
// the rest, from the time up to which the ray is above the ground, so answers equal its own.
//
// Source: I. Wald, C. Benthin, S. Boulos, "Getting rid of packets: efficient SIMD single-ray traversal using
// multi-branching BVHs", RT 2008 (the children of a node in the lanes of a vector). Cost: no memory besides the
// pyramid.
#pragma once

#include "scarp/march/height/height_target.h"

namespace scarp::max_mip {

/// Outcome for a ray. `open`: undecided, but clear up to a time.
enum class Ahead { open, miss, hit };

/// Whether vectors can follow rays over a field: without holes and wrap, and on this machine. Requires the pyramid.
bool looks_ahead(const HeightTarget& target);

/// The answer of occluded_max_mip() for a ray that may start anywhere (RayStart::free) over such a field. Sets
/// `t_clear`, if the answer is open, to the time that resume_occluded_max_mip() takes.
Ahead look_ahead(const HeightTarget& target, const Ray& ray, double& t_clear);

}  // namespace scarp::max_mip
