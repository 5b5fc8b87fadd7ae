// SPDX-License-Identifier: MIT
// The record of a march along one ray, for figures and tables: what it looked at, in order.
//
//   sampling marches  ──▶ samples of the ground        max-mip  ──▶ blocks and cells        voxels  ──▶ empty bodies
//
// The marches record on request only: the `traced` column of their tables runs the same loop as the query, over a probe
// (sampling/traced_probe.h), a visitor (height/traced_visitor.h) or a walk (voxel/voxel_loop.h) that records as well.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "scarp/base/vec.h"

namespace scarp {

enum class TraceKind : std::uint8_t {
  sample,         ///< of the ground below the ray
  hole,           ///< the same over nodata
  refinement,     ///< a sample of the refinement of a hit
  passed_block,   ///< of the pyramid: the ray stays above (or below) all of its ground
  entered_block,  ///< the march descends into it
  passed_cell,    ///< the ray stays above its four samples
  tested_cell,    ///< its surface is intersected
  voxel,          ///< one empty voxel is crossed
  cube,           ///< an empty cube, or block, is left
  sphere,         ///< the radius of an empty sphere, or cube, is travelled
  solid,          ///< a solid voxel: the hit
};
/// Returns "sample", "passed-block" and so on.
std::string_view name_of(TraceKind kind);

constexpr bool is_sample(TraceKind kind) { return kind <= TraceKind::refinement; }
constexpr bool is_block(TraceKind kind) { return kind == TraceKind::passed_block || kind == TraceKind::entered_block; }
constexpr bool is_cell(TraceKind kind) { return kind == TraceKind::passed_cell || kind == TraceKind::tested_cell; }
constexpr bool is_voxel(TraceKind kind) { return kind >= TraceKind::voxel; }

struct TraceStep {
  TraceKind kind = TraceKind::sample;
  double t = 0;      ///< time of the sample, or where the ray enters the block, cell or voxel
  double t_out = 0;  ///< where the ray leaves the block or cell, or arrives from the voxel; samples: t

  // Samples.
  double clearance = 0;  ///< height of the ray above the ground in metres; NaN over a hole
  double free = 0;       ///< radius of the ball that is free of ground, in metres, as `lipschitz` proves; 0: others

  // Blocks of 2^level x 2^level cells, and cells, whose level is 0.
  int level = 0, col = 0, row = 0;
  double maximum = 0;  ///< of a block's ground, in metres, rounded up as the pyramid has it

  // Voxels, in those of their grid.
  std::uint32_t object = 0;  ///< index of the grid, as Hit::part
  ivec3 voxel{0};
  ivec3 low{0};  ///< lowest corner of a cube
  int size = 0;  ///< side of a cube, radius of a sphere
};

/// `steps` are at least as many as MarchStats counts: a cell or voxel that is decided at once counts as no step. They
/// are empty if the march is not followed: for rays that miss its bounds, and for those along a grid line of a height
/// field with holes, which `max-mip` tests against every cell.
struct MarchTrace {
  std::vector<TraceStep> steps;

  /// Divides all times by 2^exponent: those of a ray that was marched at usual length.
  void scale_times(int exponent);
};

}  // namespace scarp
