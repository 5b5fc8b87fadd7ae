// SPDX-License-Identifier: MIT
// Who answers the rays of a scene when it is not the CPU. One call is for thousands of rays, so that it may go through
// a table of functions.
#pragma once

#include <cstdint>
#include <span>

#include "scarp/base/ray.h"

namespace scarp {

struct DeviceTerrain;  // terrain_scene_vk.h

/// Spans of one call have one length, but `steps` may be empty.
class BatchQueries {
 public:
  virtual ~BatchQueries() = default;

  /// hits[i] answers rays[i]; steps[i] is what that cost, as in MarchStats.
  virtual void closest_hits(std::span<const Ray> rays, std::span<Hit> hits, std::span<std::uint32_t> steps) = 0;
  /// blocked[i] is 1 where closest_hits would tell a hit, else 0.
  virtual void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) = 0;
  /// What a device holds, when one does: for those who make whole pictures there.
  virtual const DeviceTerrain* terrain() const { return nullptr; }
};

}  // namespace scarp
