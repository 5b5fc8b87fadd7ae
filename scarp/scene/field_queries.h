// SPDX-License-Identifier: MIT
// Who answers the rays of a scene's fields when their marches on the CPU do not. One call is for thousands of rays over
// one field, in that field's space, so that it may go through a table of functions.
#pragma once

#include <cstdint>
#include <span>

#include "scarp/scene/scene_field.h"

namespace scarp {

/// As SceneField of the same names, for the field of that number in the scene. Spans of one call have one length, but
/// `steps` may be empty.
class FieldQueries {
 public:
  virtual ~FieldQueries() = default;

  /// steps[i] is what rays[i] cost, as in MarchStats.
  virtual void closest_hits(std::uint32_t field, std::span<const Ray> rays, std::span<const FieldHit* const> from,
                            std::span<FieldHit> hits, std::span<std::uint32_t> steps) = 0;
  virtual void occluded(std::uint32_t field, std::span<const Ray> rays, std::span<const FieldHit* const> from,
                        std::span<std::uint8_t> blocked) = 0;
};

}  // namespace scarp
