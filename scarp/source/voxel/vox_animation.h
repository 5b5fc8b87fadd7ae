// SPDX-License-Identifier: MIT
// Animation in a .vox file: keyframes of transforms and shapes.
//
//   frame       0  1  2  3  4  5  6  7  8     of a node with keyframes at 2 and 5
//   no _loop    2  2  2  .  .  5  5  5  5     the first and the last keyframe are held
//   _loop 1     .  5  2  .  .  5  2  .  .     frames 2 to 5 repeat
//
// Between two keyframes (the dots), a translation is interpolated linearly and rounded to whole voxels, halves up;
// rotation and model are those of the earlier keyframe. Each transform is rounded before it is combined with its
// parents, so voxels stay on one lattice.
//
// Source: ephtracy/voxel-model, "MagicaVoxel .vox file format extension", for _f and _loop. It does
// not define interpolation and loops; the rules above, except for the rounding, are those of jpaver/opengametools.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scarp/source/voxel/vox_file.h"

namespace scarp {

/// Animation of a whole file.
struct VoxAnimation {
  std::int64_t frames = 1;  ///< 1 + the highest keyframe; 1 without animation
  bool loops = false;       ///< whether some nodes repeat
  bool ends = false;        ///< whether some nodes keep their last keyframe
};

/// Describes the animation of all nodes, hidden ones included. In a file with PACK and without a scene, each model is a
/// frame. Throws Error for a frame that is not an integer.
VoxAnimation vox_animation(const VoxFile& file);

/// Returns the frame of each keyframe of a node, in file order; none for groups. Throws Error for a frame that is not
/// an integer.
std::vector<std::int64_t> vox_keyframes(const VoxNode& node);

/// Returns whether the frames of a node repeat.
bool vox_loops(const VoxNode& node);

/// A frame between two keyframes; both are the same if a keyframe is held.
struct VoxMoment {
  std::size_t before = 0, after = 0;      ///< indices of the keyframes
  std::int64_t passed = 0, distance = 1;  ///< frames since the earlier keyframe; frames between the two, > 0
};

/// Finds the keyframes around a frame. `keyframes`: at least one, in any order; if several are equal, the last one
/// counts.
VoxMoment vox_moment(std::span<const std::int64_t> keyframes, bool loop, std::int64_t frame);

}  // namespace scarp
