// SPDX-License-Identifier: MIT
// Converts scenes of any kind to voxels: terrain, functions, shapes, other voxels.
//
// A voxel is solid if its centre is inside an object, by the object's own arithmetic: below the surface of heights (z
// <= height), in a shape (value <= 0), or in a voxel. Parts thinner than a voxel may fall between the centres.
#pragma once

#include <functional>

#include "scarp/base/progress.h"
#include "scarp/field/voxel_grid.h"
#include "scarp/scene/scene.h"

namespace scarp {

/// The voxels in `box`. Voxel v is the cube from v * side to (v + 1) * side in world space.
struct VoxelLattice {
  double side = 1;  ///< metres
  VoxelBox box;
};

/// Returns the lattice around the scene, or around the part inside `within` (required if the scene is unbounded).
/// Voxels are aligned to the world's origin. Throws Error if `side` is not above 0, no object is bounded, an axis has
/// more than `most` voxels, or positions exceed 2^24 voxels.
VoxelLattice lattice_around(const Scene& scene, double side, const std::optional<WorldBox>& within = {},
                            int most = VoxelGrid::kMaxModelSide);

/// The grid starts at lattice.box.low. `entry` returns the entry of a solid voxel, 24 bits, and is called on one thread
/// with the result of Scene::within() at its centre. Throws Interrupted if `progress` returns false.
VoxelGrid voxelised(const Scene& scene, const VoxelLattice& lattice,
                    const std::function<std::uint32_t(const SceneSurface&)>& entry, const Progress& progress = {});

/// The same for a scene of heights only (Scene::only_heights()), column by column, for boxes of up to
/// VoxelGrid::kMaxSide voxels a side. Without entries.
VoxelGrid voxelised_ground(const HeightField& heights, const VoxelLattice& lattice, const Progress& progress = {});

}  // namespace scarp
