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
  Cell start_cell{};  ///< for on_surface only: the cell that contains the point at t_min

  dvec3 at(double t) const { return origin + t * direction; }
};

enum class HitStatus : std::uint8_t {
  miss,
  hit,
  below,      ///< the ray started below the surface and never rose above it
  exhausted,  ///< a limit on steps, or on countable cells of a wrapped field, was reached: nothing is known
              ///< beyond t
};

/// Result of a closest-hit query. Members other than `status` are set for hits only, except `t` for `exhausted`.
struct Hit {
  HitStatus status = HitStatus::miss;
  double t = std::numeric_limits<double>::infinity();  ///< in units of the direction's length
  Cell cell;
  double u = 0.0;       ///< position in the cell towards col+1, 0..1
  double v = 0.0;       ///< position in the cell towards row+1, 0..1
  double height = 0.0;  ///< height of the hit point, metres in world space
  bool wall = false;    ///< true if the ray hit a wall below a border or a hole's rim (solid fields)

  explicit operator bool() const { return status == HitStatus::hit; }
};

/// Cost of one ray.
struct MarchStats {
  std::uint32_t steps = 0;          ///< visited positions: pyramid nodes, or samples of the surface
  std::uint32_t level_changes = 0;  ///< moves to a finer or coarser pyramid level
  std::uint32_t cell_tests = 0;     ///< cells whose surface was intersected
};

}  // namespace scarp
