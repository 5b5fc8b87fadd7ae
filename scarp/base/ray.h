// SPDX-License-Identifier: MIT
// Rays, hits and traversal statistics.
#pragma once

#include <cstdint>
#include <limits>

#include "scarp/base/vec.h"

namespace scarp {

/// A raster cell: the square between the samples (col, row), (col+1, row), (col, row+1), (col+1, row+1).
struct Cell {
  int col = -1;
  int row = -1;
  friend bool operator==(const Cell&, const Cell&) = default;
};

/// The face through which a ray enters a voxel: 2 * axis, plus 1 if the ray travels towards lower coordinates.
/// `inside`: the ray starts in the voxel.
enum class VoxelFace : std::uint8_t { low_x, high_x, low_y, high_y, low_z, high_z, inside };

/// Where a ray starts.
enum class RayStart : std::uint8_t {
  free,        ///< anywhere; a ray that touches the surface hits it
  on_surface,  ///< on the surface of `start_cell`: above it by definition; later hits must be strictly below
};

/// A ray in world space (right-handed, metres, x east, y north, z up): the points origin + t * direction for t in
/// [t_min, t_max], ends included. The direction is any finite non-zero vector. It is never normalised; t is in units of
/// its length.
struct Ray {
  dvec3 origin{0.0};
  dvec3 direction{0.0, 0.0, -1.0};
  double t_min = 0.0;                                      ///< finite; may be negative
  double t_max = std::numeric_limits<double>::infinity();  ///< >= t_min; may be infinite
  RayStart start = RayStart::free;
  std::uint8_t frame = 0;  ///< orientation of its space in the world, for ties between voxels (voxel_ray.h); set by
                           ///< scenes
  std::uint16_t room = 0;  ///< rounding of its coordinates, for planes between voxels (ray_room.h); set by scenes
  Cell start_cell{};  ///< on_surface: height fields: the cell that contains the point at t_min; meshes: Hit::cell of
                      ///< the hit
  std::uint32_t start_object = 0;  ///< on_surface, scenes: index of the object on whose surface the ray starts

  dvec3 at(double t) const { return origin + t * direction; }
};

enum class HitStatus : std::uint8_t {
  miss,
  hit,
  below,      ///< the ray starts below the surface, or enters below it through the border, and hits nothing
  exhausted,  ///< the march reached its step limit, or the last cell of a wrapped field that it can index; the ray
              ///< beyond t is unknown
  invalid,    ///< the ray cannot be traced; only in batches with BadRays::answer_invalid (scene/cast.h)
};

/// Result of a closest-hit query. `status` is always set, `t` only for `hit` and `exhausted`, all other members only
/// for `hit`. Members that name a kind of field are set only for hits on that kind.
struct Hit {
  HitStatus status = HitStatus::miss;
  bool wall = false;                   ///< solid height fields: a wall below the border or the rim of a hole was hit
  VoxelFace face = VoxelFace::inside;  ///< voxels: the face that was hit; inside: the ray starts in this solid voxel;
                                       ///< plinths: the side of the wall that was hit
  std::uint32_t object = 0;            ///< scenes: index of the object
  double t = std::numeric_limits<double>::infinity();  ///< in units of the direction's length
  Cell cell;                                           ///< height fields; meshes: col is the index of the triangle
  double u = 0.0;          ///< height fields: position in the cell towards col+1, 0..1; meshes: weight of corner 1
  double v = 0.0;          ///< height fields: position in the cell towards row+1, 0..1; meshes: weight of corner 2
  double height = 0.0;     ///< all except voxels: z of the hit point, in the field's space
  ivec3 voxel{-1};         ///< voxels: position in the grid
  std::uint32_t part = 0;  ///< voxels: index of the placed model, as in PlacedVoxels::places

  explicit operator bool() const { return status == HitStatus::hit; }
  friend bool operator==(const Hit&, const Hit&) = default;
};
static_assert(sizeof(Hit) <= 64, "large batches are limited by memory bandwidth: a hit fits in one cache line");

/// Cost of one ray.
struct MarchStats {
  std::uint32_t steps = 0;          ///< visited positions: pyramid nodes, or samples of the surface
  std::uint32_t level_changes = 0;  ///< moves to a finer or coarser pyramid level
  std::uint32_t cell_tests = 0;     ///< cells whose surface was intersected
  std::uint32_t boxes = 0;          ///< objects of scenes and voxel fields whose boxes the ray hit
};

}  // namespace scarp
