// SPDX-License-Identifier: MIT
// The scene in a .vox file: placement of models.
//
//   transform ── group ── transform ── shape ── model       a transform rotates and moves everything below it, in
//                     └── transform ── shape ── model       quarter turns and whole voxels
//
//   nTRN  _r  a byte: bits 0-1 and 2-3 are the columns of the entries of rows 0 and 1 of the matrix, bits 4, 5, 6 are
//             set if rows 0, 1, 2 are negative         _t  "x y z"
//         _hidden  1: everything below is hidden       _f, _loop of nTRN and nSHP: see vox_animation.h
//   LAYR  _hidden  1: its transforms are hidden
//
// The root is node 0, or the first node of a scene without a node 0.
//
// A model rotates about its centre, rounded down to a voxel corner: its point p moves to turn * (p - floor(size / 2)) +
// move.
#pragma once

#include <string>
#include <vector>

#include "scarp/base/lattice_rotation.h"
#include "scarp/source/voxel/vox_file.h"

namespace scarp {

/// A placed model.
struct VoxInstance {
  int model = 0;
  LatticeRotation turn;  ///< editors also write reflections
  ivec3 move{0};
};

/// Selection of instances.
struct VoxSceneOptions {
  int frame = 0;        ///< animation frame, >= 0; beyond the last frame: see vox_animation.h
  bool hidden = false;  ///< whether to include hidden nodes and layers

  bool operator==(const VoxSceneOptions&) const = default;
};

/// Returns instances in file order, which decides overlaps: from version 200 on, the first one wins, before that the
/// last one. Without a scene, returns the first model or, in a file with PACK, the model of the frame. Throws Error for
/// more than 2^20 instances, or positions beyond 2^24 voxels.
std::vector<VoxInstance> vox_instances(const VoxFile& file, const VoxSceneOptions& options = {});

/// Returns notes for users, one line each: a frame beyond the end, voxels with palette index 0,
/// glass.
std::vector<std::string> vox_notes(const VoxFile& file, const VoxSceneOptions& options = {});

/// Throws Error in one line if the scene is invalid: see parse_vox().
void check_vox_scene(const VoxFile& file);

}  // namespace scarp
