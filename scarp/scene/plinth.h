// SPDX-License-Identifier: MIT
// The plinth below a terrain model, as if it were cut out of a block: vertical walls from its border, and from the
// edges of its holes, down to a common base. The surface itself is a sheet; walls exist only in pictures and are not
// part of any march.
//
//        __/\_            A ray that comes from outside (or from over a hole) into a valid cell, below the edge of the
//   ____/     \___        surface and above the base, hits a wall there. Cells are walked one after another; a field
//   |#############|       without holes has walls only at its border, so its first cell decides.
//   |#############|  base
#pragma once

#include <optional>

#include "scarp/base/ray.h"
#include "scarp/field/height_field.h"

namespace scarp {

/// Default height of the base: a fraction of the field's size below its lowest point.
double plinth_base(const HeightField& field);

class Plinth {
 public:
  /// `base` in metres, below the field's lowest point. The field must have valid samples.
  Plinth(const HeightField& field, double base);

  struct Wall {
    double t;        ///< in lengths of the ray's direction
    VoxelFace face;  ///< the side of the wall that the ray comes from
  };
  /// Returns the first wall that the ray hits from outside within its range. The surface may be hit before it. Rays
  /// that hit the surface between two walls are not followed further, nor are rays that start in the solid or enter it
  /// through the base.
  std::optional<Wall> intersect(const Ray& ray) const;

  /// Height of the base, in sample units.
  double base_sample() const { return base_sample_; }

 private:
  HeightField field_;
  double base_sample_;  // in sample units
};

}  // namespace scarp
