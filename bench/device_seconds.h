// SPDX-License-Identifier: MIT
// Time of passes on a Vulkan device.
#pragma once

#include <fmt/format.h>

#include <span>

#include "scarp/base/error.h"
#include "scarp/vk/commands.h"
#include "scarp/vk/device.h"

namespace scarp::bench {

/// Returns the total time of the passes in seconds, by the device's clock. Throws Error if the device has none.
inline double device_seconds(const Device& device, std::span<const PassTime> passes) {
  constexpr double kNanosecond = 1e-9;
  double sum = 0;
  for (const PassTime& pass : passes) {
    if (!pass.nanoseconds)
      throw Error(
          fmt::format("device '{}': has no timestamps, which the bench measures by", device.description().name));
    sum += *pass.nanoseconds * kNanosecond;
  }
  return sum;
}

}  // namespace scarp::bench
