// SPDX-License-Identifier: MIT
// The objects and the camera of C. Leak, "Raymarching voxel rendering": 32 x n x 32 objects of 32^3 voxels, side by
// side.
//
// Coordinates are those of the post: y up, the eye at (-16, 0, -16) looking along (1, 0, 1), 45 degrees high and 16 :
// 9; a voxel has the side 0.25, an object 8. Rays and objects have no preferred up axis, so nothing has to be rotated.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "scarp/scene/voxel/placed_voxels.h"

namespace scarp::bench {

/// standard: a ball of radius 15.5, each voxel with its own colour. degenerate: one voxel, in the far corner. empty:
/// none. far-wall: a layer at the end of z.
inline constexpr std::array<std::string_view, 4> kVoxelSets = {"standard", "degenerate", "empty", "far-wall"};

constexpr int kObjectSide = 32;

/// One object of a set, entries in RGB.
VoxelGrid voxel_object(std::string_view set);

/// 1,024 n places for model 0.
std::vector<VoxelPlace> object_places(int n);

/// Rays through the middles of the pixels of a picture of 1920 x 1080, 8 x 8 pixels after 8 x 8 pixels: one such tile
/// in stride x stride of them.
std::vector<Ray> camera_rays(int stride);

/// Rays at a box at the origin from eight sides, one per octant of directions, twice its diagonal away: width x width
/// pixels each, also in tiles. All numbers are exact in float.
std::vector<Ray> octant_rays(const dvec3& size, int width);

}  // namespace scarp::bench
