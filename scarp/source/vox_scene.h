// SPDX-License-Identifier: MIT
// The scene in a .vox file: which model stands where.
//
//   transform ── group ── transform ── shape ── model       a transform turns and moves what is below it, in quarter
//                     └── transform ── shape ── model       turns and whole voxels
//
//   nTRN  _r  a byte: bits 0-1 and 2-3 are the columns of the entries of rows 0 and 1 of the matrix, bits 4, 5, 6 are
//             set where rows 0, 1, 2 are negative     _t  "x y z"     _f  first frame that it holds for
//         _hidden  1: nothing below it is shown       nSHP  _f  likewise for its models
//   LAYR  _hidden  1: none of its transforms is shown
//
// A model turns about its middle, rounded down to a corner of voxels: a point p of it goes to
// turn * (p - floor(size / 2)) + move.
#pragma once

#include <vector>

#include "scarp/base/lattice_rotation.h"
#include "scarp/source/vox_file.h"

namespace scarp {

struct VoxInstance {
  int model = 0;
  LatticeRotation turn;  ///< mirrored ones come from editors, too
  ivec3 move{0};
};

struct VoxSceneOptions {
  int frame = 0;        ///< of animations, >= 0
  bool hidden = false;  ///< whether to take hidden nodes and layers, too
};

/// In the order of the file, which decides where two overlap: from version 200 on the first one is seen, before the
/// last. Without a scene the first model alone, or that of the frame in a file with PACK. Throws Error: more than 2^20
/// instances, places beyond 2^24 voxels.
std::vector<VoxInstance> vox_instances(const VoxFile& file, const VoxSceneOptions& options = {});

/// Throws Error in one line when the scene cannot be followed: see parse_vox().
void check_vox_scene(const VoxFile& file);

}  // namespace scarp
