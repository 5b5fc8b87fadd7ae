// SPDX-License-Identifier: MIT
// Adversarial voxel grids and rays.
#pragma once

#include <functional>
#include <random>
#include <string_view>
#include <vector>

#include "march/height/spiteful.h"
#include "scarp/field/voxel_grid.h"
#include "scarp/march/voxel/voxel_ray.h"

namespace scarp::test {

struct VoxelGridKind {
  std::string_view name;
  std::function<VoxelGrid(Random&)> make;
};

struct VoxelRayKind {
  std::string_view name;
  std::function<VoxelRay(const VoxelGrid&, Random&)> make;
};

const std::vector<VoxelGridKind>& spiteful_voxel_grids();
const std::vector<VoxelRayKind>& spiteful_voxel_rays();

/// VoxelRay::room of a scene whose farthest coordinate is 2^18 voxels: 2^-48 of that, as in VoxelObjects.
constexpr double kSceneRoom = 0x1p18 * 0x1p-48;

/// A grid's orientation: a signed permutation, the identity in half of the cases.
glm::dmat3 random_orientation(Random& random);

/// Fills, clears or paints a random box, ball or voxel; returns the dirty box.
VoxelBox random_edit(VoxelGrid& grid, Random& random);

}  // namespace scarp::test
