// SPDX-License-Identifier: MIT
// Private to the station: one field of a scene on a device (scene_vk.cpp).
#pragma once

#include <cstdint>
#include <span>

#include "scarp/base/ray.h"

namespace scarp {

struct DeviceTerrain;  // scene_vk.h

class FieldOnDevice {
 public:
  virtual ~FieldOnDevice() = default;
  /// Rays start as Ray::start states. `from`, which may be empty, is for fields whose rays need more than that.
  virtual void closest_hits(std::span<const Ray> rays, std::span<Hit> hits, std::span<std::uint32_t> steps,
                            std::span<const Hit* const> from) = 0;
  virtual void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                        std::span<const Hit* const> from) = 0;
  virtual const DeviceTerrain* terrain() const { return nullptr; }
};

}  // namespace scarp
