// SPDX-License-Identifier: MIT
// The scene in a .vox file: placement of models.
//
//   transform ── group ── transform ── shape ── model       a transform rotates and moves everything below it, in
//                     └── transform ── shape ── model       quarter turns and whole voxels
//
//   nTRN  _r  a byte: bits 0-1 and 2-3 are the columns of the entries of rows 0 and 1 of the matrix, bits 4, 5, 6 are
//             set if rows 0, 1, 2 are negative         _t  "x y z"     _f  first frame that it applies to
//         _hidden  1: everything below is hidden       nSHP  _f  likewise for its models
//   LAYR  _hidden  1: its transforms are hidden
//
// A model rotates about its centre, rounded down to a voxel corner: a point p of it moves to turn * (p - floor(size /
// 2)) + move.
#pragma once

#include <vector>

#include "scarp/base/lattice_rotation.h"
#include "scarp/source/vox_file.h"

namespace scarp {

/// A placed model.
struct VoxInstance {
  int model = 0;
  LatticeRotation turn;  ///< editors also write reflections
  ivec3 move{0};
};

/// Selection of instances.
struct VoxSceneOptions {
  int frame = 0;        ///< of animations, >= 0
  bool hidden = false;  ///< whether to include hidden nodes and layers
};

/// Returns instances in file order, which decides overlaps: from version 200 on the first wins, before that the last.
/// Without a scene, returns the first model, or that of the frame in a file with PACK. Throws Error for more than 2^20
/// instances, or positions beyond 2^24 voxels.
std::vector<VoxInstance> vox_instances(const VoxFile& file, const VoxSceneOptions& options = {});

/// Throws Error in one line if the scene is invalid: see parse_vox().
void check_vox_scene(const VoxFile& file);

}  // namespace scarp
