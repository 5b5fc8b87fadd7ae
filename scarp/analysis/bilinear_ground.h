// SPDX-License-Identifier: MIT
// Shadows and lines of sight over the bilinear surface of a field, by exact rays (`max-mip`, march/height/max_mip.h),
// instead of ground defined only at crossings of grid lines (sight.h).
//
// A ray is blocked where it is strictly below the surface, by more than rounding; a ray that grazes the surface passes.
// Cells with a missing sample are holes: rays pass through them, but not through the ground at their rims. Rays exactly
// along the line between a hole and ground may count as in either. The Earth is flat.
#pragma once

#include <memory>

#include "scarp/accel/max_pyramid.h"
#include "scarp/analysis/line_of_sight.h"
#include "scarp/analysis/shadow.h"
#include "scarp/march/height/height_target.h"

namespace scarp {

/// A field ready for rays. Thread-safe. A plain view: the field's samples must outlive it, without edits.
class BilinearGround {
 public:
  /// Builds the pyramid. Throws Error for a wrapped field, and for one without cells.
  explicit BilinearGround(const HeightField& field);
  /// Shares the pyramid of a field with the same samples but other cell lengths.
  BilinearGround(const HeightField& field, const BilinearGround& same_samples);

  const HeightField& field() const { return field_; }

  /// Returns the shade of a node; self_shaded if the adjacent cell blocks the ray.
  Shade shade(const SunRay& sun, Node node) const;

  /// Answers one query, as scarp::line_of_sight() without curvature. `clearance` covers crossings and the points
  /// between them.
  LineOfSight line_of_sight(const SightEnd& from, const SightEnd& to) const;

 private:
  Hit block(Ray ray) const;

  HeightField field_;  // solid below the surface, so that rims of holes block
  std::shared_ptr<const MaxPyramid> pyramid_;

  HeightTarget target() const { return {.field = &field_, .pyramid = pyramid_.get()}; }
};

}  // namespace scarp
