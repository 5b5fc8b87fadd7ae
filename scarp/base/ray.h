// SPDX-License-Identifier: MIT
// A ray, what it can meet, and what the meeting cost.
#pragma once

#include <cstdint>
#include <limits>

#include "scarp/base/vec.h"

namespace scarp {

/// A cell of a raster: the square between the samples (col, row), (col+1, row), (col, row+1), (col+1, row+1).
struct Cell {
  int col = -1;
  int row = -1;
  friend bool operator==(const Cell&, const Cell&) = default;
};

/// Where a ray begins.
enum class RayStart {
  free,        ///< anywhere; a ray that touches the surface hits it
  on_surface,  ///< on the surface of `start_cell`: above it by definition; a later hit needs strictly below
};

/// A ray origin + t * direction in world space (right-handed, x east, y north, z up, metres), t in [t_min, t_max].
/// The direction is any finite vector but zero; t counts in its length and is never renormalised.
struct Ray {
  dvec3 origin{0.0};
  dvec3 direction{0.0, 0.0, -1.0};
  double t_min = 0.0;                                      ///< finite, >= 0 or negative alike
  double t_max = std::numeric_limits<double>::infinity();  ///< >= t_min; infinity is allowed
  RayStart start = RayStart::free;
  Cell start_cell{};  ///< used by on_surface only: the cell that holds the point at t_min

  dvec3 at(double t) const { return origin + t * direction; }
};

enum class HitStatus : std::uint8_t {
  miss,
  hit,
  below,      ///< the ray began below the surface and never came from above to it
  exhausted,  ///< a limit was reached (of steps, or of countable cells where a field wraps round): nothing is known
              ///< beyond t
};

/// The answer to a closest-hit question. All but `status` and, for `exhausted`, `t` is set for hits only.
struct Hit {
  HitStatus status = HitStatus::miss;
  double t = std::numeric_limits<double>::infinity();  ///< in lengths of the ray's direction
  Cell cell;
  double u = 0.0;       ///< position in the cell towards col+1, 0..1
  double v = 0.0;       ///< position in the cell towards row+1, 0..1
  double height = 0.0;  ///< height of the ray's point at t, metres in world space
  bool wall = false;    ///< whether the wall under a border or a hole's rim was hit, not the surface (solid fields)

  explicit operator bool() const { return status == HitStatus::hit; }
};

/// What one ray cost.
struct MarchStats {
  std::uint32_t steps = 0;          ///< positions looked at: nodes of the pyramid, or samples of the surface
  std::uint32_t level_changes = 0;  ///< moves to a finer or coarser level
  std::uint32_t cell_tests = 0;     ///< cells whose surface was intersected
};

}  // namespace scarp
