// SPDX-License-Identifier: MIT
// A back end that answers the rays of a scene instead of the CPU. One call is for thousands of rays over one field, in
// that field's space, so that it may go through a table of functions.
#pragma once

#include <cstdint>
#include <span>

#include "scarp/base/ray.h"

namespace scarp {

struct DeviceTerrain;  // scene_vk.h

/// `field` is an index of the scene's fields. Rays begin as SceneField has it, by Ray::start or on the surface of
/// `from`. The spans of one call have one length, but `steps` and `from` may be empty.
class SceneBackEnd {
 public:
  virtual ~SceneBackEnd() = default;

  /// hits[i] answers rays[i], with object 0; steps[i] is what that cost, as in MarchStats.
  virtual void closest_hits(std::uint32_t field, std::span<const Ray> rays, std::span<Hit> hits,
                            std::span<std::uint32_t> steps, std::span<const Hit* const> from) = 0;
  /// blocked[i] is 1 where SceneField::occluded() is true, else 0.
  virtual void occluded(std::uint32_t field, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                        std::span<const Hit* const> from) = 0;
  /// What a device holds of a height field, for pictures that it makes whole; null for other fields and back ends.
  virtual const DeviceTerrain* terrain(std::uint32_t) const { return nullptr; }
};

}  // namespace scarp
