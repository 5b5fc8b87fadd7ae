// SPDX-License-Identifier: MIT
// Options of `scarp-bench simt`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/fields.h"
#include "bench/rays.h"

namespace scarp::bench {

/// `simt`: rays in lockstep, traced on the CPU by the shader source: costs of bundles with max-mip and with naive.
struct SimtOptions {
  FieldOptions field;
  std::vector<int> sizes{1025, 4097};
  std::vector<std::string> classes{"chunk", "primary", "shadow", "grazing", "ao"};
  RayCounts rays;
  std::int64_t groups = 512;  ///< groups of 64 successive rays, spread evenly over each class; all are judged
  std::uint64_t ray_seed = 1;
  double wrong_limit = 0.001;  ///< fraction of rays that naive may get wrong
  std::string blocks;          ///< table of instructions by block; empty: bench/simt_blocks.csv in the source tree
  bool recount = false;        ///< with Vulkan: uses the blocks as this build compiles them (simt_recount.h)
  std::string disassembly{};   ///< a folder for the counted disassemblies; empty: none
  std::string update{};        ///< a file to write the recounted table to, instead of tracing rays
  bool voxels = false;         ///< instead: the marches of voxels, in pictures of the sets of voxel_sets.h
  std::vector<std::string> voxel_sets{"standard", "degenerate", "far-wall"};
  std::vector<int> voxel_layers{1, 16};  ///< layers of 1,024 objects each
  int voxel_stride = 4;                  ///< one tile of 8 x 8 pixels in stride x stride
};

}  // namespace scarp::bench
