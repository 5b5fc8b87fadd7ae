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

/// The face by which a ray enters a voxel: 2 * axis + (1 if the ray travels towards lower coordinates).
enum class VoxelFace : std::uint8_t { low_x, high_x, low_y, high_y, low_z, high_z, inside };

/// Where a ray starts.
enum class RayStart {
  free,        ///< anywhere; a ray that touches the surface hits it
  on_surface,  ///< on the surface of `start_cell`: above it by definition; later hits must be strictly below
};

/// A ray origin + t * direction in world space (right-handed, x east, y north, z up, metres), t in [t_min, t_max],
/// closed at both ends. The direction is any finite non-zero vector. t is in units of its length; it is never
/// renormalised.
struct Ray {
  dvec3 origin{0.0};
  dvec3 direction{0.0, 0.0, -1.0};
  double t_min = 0.0;                                      ///< finite; may be negative
  double t_max = std::numeric_limits<double>::infinity();  ///< >= t_min; may be infinite
  RayStart start = RayStart::free;
  Cell start_cell{};  ///< on_surface of a height field: the cell that contains the point at t_min; of a mesh: as
                      ///< Hit::cell
  std::uint32_t start_object = 0;  ///< on_surface in a scene: the object whose surface it is

  dvec3 at(double t) const { return origin + t * direction; }
};

enum class HitStatus : std::uint8_t {
  miss,
  hit,
  below,      ///< the ray started below the surface and never rose above it
  exhausted,  ///< a limit on steps, or on countable cells of a wrapped field, was reached: nothing is known
              ///< beyond t
};

/// Result of a closest-hit query. `status` is always set, `t` for hits and `exhausted`, all other members for hits
/// only, and members of one kind of field for hits on that kind only.
struct Hit {
  HitStatus status = HitStatus::miss;
  bool wall = false;                   ///< height fields: a wall below a border or a hole's rim was hit (solid fields)
  VoxelFace face = VoxelFace::inside;  ///< voxels: the face that was hit; inside: the ray began in this solid voxel;
                                       ///< plinths: the side of the wall that was hit
  std::uint32_t object = 0;            ///< scenes: index of the object
  double t = std::numeric_limits<double>::infinity();  ///< in units of the direction's length
  Cell cell;                                           ///< height fields; meshes: col is the index of the triangle
  double u = 0.0;          ///< height fields: position in the cell towards col+1, 0..1; meshes: weight of corner 1
  double v = 0.0;          ///< height fields: position in the cell towards row+1, 0..1; meshes: weight of corner 2
  double height = 0.0;     ///< all but voxels: z of the point that was hit, in the field's space
  ivec3 voxel{-1};         ///< voxels: place in the grid
  std::uint32_t part = 0;  ///< voxels: index of the model that was hit, among the places of the field

  explicit operator bool() const { return status == HitStatus::hit; }
  friend bool operator==(const Hit&, const Hit&) = default;
};
static_assert(sizeof(Hit) <= 64, "hits of large batches are bound by memory: one cache line each");

/// Cost of one ray.
struct MarchStats {
  std::uint32_t steps = 0;          ///< visited positions: pyramid nodes, or samples of the surface
  std::uint32_t level_changes = 0;  ///< moves to a finer or coarser pyramid level
  std::uint32_t cell_tests = 0;     ///< cells whose surface was intersected
  std::uint32_t boxes = 0;          ///< objects of scenes and voxel fields whose boxes the ray hit
};

}  // namespace scarp
