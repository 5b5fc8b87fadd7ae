// SPDX-License-Identifier: MIT
// Scenes of any kind made voxels: terrain, functions, shapes, other voxels.
//
// A voxel is solid when its middle is inside of an object, told by the object's own arithmetic: below the surface of
// heights (z <= height), in a shape (value <= 0), in a voxel. What is thinner than a voxel may fall between the
// middles.
#pragma once

#include <functional>

#include "scarp/base/progress.h"
#include "scarp/field/voxel_grid.h"
#include "scarp/scene/scene.h"

namespace scarp {

/// Voxel v is the cube from v * side to (v + 1) * side in the world, of those in `box`.
struct VoxelLattice {
  double side = 1;  ///< metres
  VoxelBox box;
};

/// Around the scene, or around the part of it within `within` (where it has no end, needed). Sides are counted from the
/// world's origin. Throws Error: a side that is not above 0, nothing that has an end, more than `most` voxels along an
/// axis, places beyond 2^24 voxels.
VoxelLattice lattice_around(const Scene& scene, double side, const std::optional<WorldBox>& within = {},
                            int most = VoxelGrid::kMaxModelSide);

/// The grid begins at lattice.box.low. `entry`: of a solid voxel, 24 bits, asked on one thread; the surface is what
/// Scene::within() tells of its middle. Throws Interrupted when progress asks.
VoxelGrid voxelised(const Scene& scene, const VoxelLattice& lattice,
                    const std::function<std::uint32_t(const SceneSurface&)>& entry, const Progress& progress = {});

/// The same voxels of a scene that has heights only (Scene::only_heights()), column by column, for boxes of up to
/// VoxelGrid::kMaxSide voxels a side. Without entries.
VoxelGrid voxelised_ground(const HeightField& heights, const VoxelLattice& lattice, const Progress& progress = {});

}  // namespace scarp
