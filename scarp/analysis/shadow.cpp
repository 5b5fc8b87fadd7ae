// SPDX-License-Identifier: MIT
#include "scarp/analysis/shadow.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scarp/analysis/shadow_sweep.h"
#include "scarp/base/setting.h"

namespace scarp {

SunRay sun_ray(const HeightField& field, const SunDirection& sun) {
  require_setting("shadow", std::isfinite(sun.azimuth), "sun azimuth", sun.azimuth, "finite");
  require_setting("shadow", sun.altitude > 0 && sun.altitude <= std::numbers::pi / 2, "sun altitude", sun.altitude,
                  "above 0, at most pi/2");
  const double cell_x = field.settings().cell_x, cell_y = field.settings().cell_y;
  const double col = std::sin(sun.azimuth) / cell_x, row = -std::cos(sun.azimuth) / cell_y;
  const double per_cell = static_cast<double>(SunRay::kUnit) / std::max(std::abs(col), std::abs(row));
  SunRay ray{std::llround(col * per_cell), std::llround(row * per_cell), 0};
  const double x = static_cast<double>(ray.col) * cell_x, y = static_cast<double>(ray.row) * cell_y;
  ray.rise = std::sqrt(x * x + y * y) * std::tan(sun.altitude);
  return ray;
}

std::vector<Shade> shadow(const HeightField& field, const SunDirection& sun, const Progress& progress) {
  const SightGround ground(field);
  const SunRay ray = sun_ray(field, sun);
  std::vector<Shade> codes(static_cast<std::size_t>(field.cols()) * static_cast<std::size_t>(field.rows()));
  sweep_shadow(ground, ray, codes.data(), progress);
  return codes;
}

}  // namespace scarp
