// SPDX-License-Identifier: MIT
#include "scarp/render/camera/depth.h"

#include <fmt/format.h>

#include <cmath>

#include "scarp/base/error.h"

namespace scarp {

void validate(const DepthRange& range) {
  if (!(std::isfinite(range.near_m) && range.near_m > 0)) {
    throw Error(fmt::format("depth: the near plane is at {} m (must be finite and above 0)", range.near_m));
  }
  if (!(range.far_m > range.near_m)) {
    throw Error(
        fmt::format("depth: the far plane, at {} m, must lie beyond the near one, at {} m", range.far_m, range.near_m));
  }
}

double device_depth(double z, const DepthRange& range) {
  const double n = range.near_m, f = range.far_m;
  if (range.reversed) {
    if (std::isinf(z)) return 0;
    // 1 - f (z - n) / ((f - n) z), without cancellation.
    return std::isinf(f) ? n / z : n * (f - z) / ((f - n) * z);
  }
  if (std::isinf(z)) return 1;
  const double share = 1 - n / z;
  return std::isinf(f) ? share : f / (f - n) * share;
}

double view_depth_from_device(double depth, const DepthRange& range) {
  const double n = range.near_m, f = range.far_m;
  const double left = range.reversed ? depth : 1 - depth;  // 1 near, 0 far
  if (std::isinf(f)) return n / left;
  return n * f / (n + (f - n) * left);
}

}  // namespace scarp
