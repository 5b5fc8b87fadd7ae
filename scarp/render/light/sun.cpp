// SPDX-License-Identifier: MIT
#include "scarp/render/light/sun.h"

#include <fmt/format.h>

#include <cmath>

#include "scarp/base/error.h"

namespace scarp {

void validate(const SunSettings& settings) {
  if (!std::isfinite(settings.azimuth_deg)) {
    throw Error(fmt::format("sun: the azimuth is {} (must be a finite number of degrees)", settings.azimuth_deg));
  }
  if (!(settings.altitude_deg >= kLowestSun && settings.altitude_deg <= 90)) {
    throw Error(fmt::format("sun: the altitude is {} (must be {} to 90 degrees)", settings.altitude_deg, kLowestSun));
  }
  if (!(settings.size_deg >= 0 && settings.size_deg <= 90)) {
    throw Error(fmt::format("sun: the size is {} (must be 0 to 90 degrees)", settings.size_deg));
  }
}

}  // namespace scarp
