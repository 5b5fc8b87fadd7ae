// SPDX-License-Identifier: MIT
// The look `cost`: the number of values that the march of each pixel's ray reads. Steps alone do not show the cost: one
// step reads more or less, depending on the march.
//
//   field       a step                        reads
//   heights     a sample, also over a hole    4 heights: those of its cell
//               a block of the pyramid        1 node
//               a cell                        4 heights
//   functions   a sample, a bound             1 evaluation
//   shapes      a distance, a bound           1 evaluation
//   voxels      a look at a voxel             1 voxel, or 1 entry of a table of empty bodies
//   meshes      a triangle                    1 triangle
//
// Counted by the steps that a march records (base/march_trace.h), which include the refinement of a hit; for marches
// that record none, by MarchStats. Heights count each time that a cell is visited, although caches may hold them.
// Searches for the objects of a scene, walls of the plinth, and the pyramid nodes by which `lipschitz` finds holes do
// not count.
#pragma once

#include "scarp/scene/scene.h"

namespace scarp {

/// Returns the same objects, whose closest-hit queries report the number of reads in place of MarchStats::steps. Only
/// for free rays. Throws Error if the scene is on a device, or contains tiles.
Scene counting_reads(const Scene& scene);

}  // namespace scarp
