// SPDX-License-Identifier: MIT
// The argument of the height field marches.
#pragma once

#include <cstdint>
#include <limits>
#include <string_view>

#include "scarp/accel/max_pyramid.h"
#include "scarp/base/ray.h"
#include "scarp/field/height_field.h"

namespace scarp {

/// A height field with the structures built for it.
struct HeightTarget {
  const HeightField* field = nullptr;
  const MaxPyramid* pyramid = nullptr;  ///< null: only for marches that do not need it
  /// slope_bound(*field), metres per metre; NaN: only for marches that do not need it.
  double slope = std::numeric_limits<double>::quiet_NaN();
  /// Distance in cells, >= 0, up to which the borders of fields that meet count as one: for max-mip and exhaustive. A
  /// ray that passes the border or the rim of a hole this near to the surface touches it.
  double seam = 0;
  /// Height in sample units, >= 0, by which the border may be below that of an adjacent field: a ray that enters
  /// through the border at most this far below the surface touches it. For max-mip and exhaustive.
  double seam_step = 0;
};

/// The parts of a target, besides the field, that a march needs.
enum class HeightPart { none, pyramid, slope, pyramid_and_slope };

/// Throws Error naming the part of a target that is missing.
[[noreturn]] void refuse_target(const HeightTarget& target, HeightPart part);

/// Throws Error if the target lacks a required part: a null field or pyramid, or a NaN slope.
inline void require(const HeightTarget& target, HeightPart part) {
  const bool pyramid = part == HeightPart::pyramid || part == HeightPart::pyramid_and_slope;
  const bool slope = part == HeightPart::slope || part == HeightPart::pyramid_and_slope;
  if (!target.field || (pyramid && !target.pyramid) || (slope && target.slope != target.slope)) [[unlikely]]
    refuse_target(target, part);
}

/// The fields that a march takes.
enum class HeightFields : std::uint8_t {
  all,
  plain,  ///< bilinear, without holes and without wrap
};

/// Returns whether a march that takes `fields` takes this one.
inline bool takes(HeightFields fields, const HeightField& field) {
  return fields == HeightFields::all ||
         (field.settings().surface == Surface::bilinear && field.nodata_count() == 0 && !field.wraps());
}

/// Throws Error if a march does not take a field, naming both.
void require_field(const HeightField& field, HeightFields fields, std::string_view march);

}  // namespace scarp
