// SPDX-License-Identifier: MIT
// A back end that traces the rays of a scene instead of the CPU. One call traces thousands of rays over one field, in
// that field's space, so the cost of the virtual call is negligible.
#pragma once

#include <cstdint>
#include <span>

#include "scarp/base/ray.h"

namespace scarp {

struct DeviceTerrain;  // scene_vk.h

/// `field` is an index into the scene's fields. Rays start as in SceneField: as Ray::start states, or on the surface of
/// `from`. All spans have the same length, except that `steps` and `from` may be empty.
class SceneBackEnd {
 public:
  virtual ~SceneBackEnd() = default;

  /// Sets hits[i] to the closest hit of rays[i], with object 0, and steps[i] to its cost, as in MarchStats.
  virtual void closest_hits(std::uint32_t field, std::span<const Ray> rays, std::span<Hit> hits,
                            std::span<std::uint32_t> steps, std::span<const Hit* const> from) = 0;
  /// Sets blocked[i] to 1 if SceneField::occluded() is true, else to 0.
  virtual void occluded(std::uint32_t field, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                        std::span<const Hit* const> from) = 0;
  /// The device's copy of a height field, for pictures rendered whole on the device; null for other fields and back
  /// ends.
  virtual const DeviceTerrain* terrain(std::uint32_t) const { return nullptr; }
};

}  // namespace scarp
