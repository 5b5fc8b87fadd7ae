// SPDX-License-Identifier: MIT
#include "scarp/analysis/shadow.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scarp/analysis/shadow_sweep.h"
#include "scarp/base/error.h"
#include "scarp/base/setting.h"

namespace scarp {

SunRay sun_ray(const NodeSteps& steps, const SunDirection& sun) {
  require_setting("shadow", std::isfinite(sun.azimuth), "sun azimuth", sun.azimuth, "finite");
  require_setting("shadow", sun.altitude > 0 && sun.altitude <= std::numbers::pi / 2, "sun altitude", sun.altitude,
                  "above 0, at most pi/2");
  const dvec2 to(std::sin(sun.azimuth), std::cos(sun.azimuth));
  const double area = steps.col.x * steps.row.y - steps.col.y * steps.row.x;
  if (!(area != 0 && std::isfinite(area))) throw Error("shadow: steps between nodes have no area (at a pole?)");
  const double col = (to.x * steps.row.y - to.y * steps.row.x) / area,
               row = (to.y * steps.col.x - to.x * steps.col.y) / area;
  const double per_cell = static_cast<double>(SunRay::kUnit) / std::max(std::abs(col), std::abs(row));
  SunRay ray{std::llround(col * per_cell), std::llround(row * per_cell), 0};
  const dvec2 way = static_cast<double>(ray.col) * steps.col + static_cast<double>(ray.row) * steps.row;
  ray.rise = std::sqrt(way.x * way.x + way.y * way.y) * std::tan(sun.altitude);
  return ray;
}

NodeSteps node_steps(const HeightField& field) { return {{field.settings().cell_x, 0}, {0, -field.settings().cell_y}}; }

SunRay sun_ray(const HeightField& field, const SunDirection& sun) { return sun_ray(node_steps(field), sun); }

std::vector<Shade> shadow(const HeightField& field, const SunDirection& sun, const Progress& progress) {
  const SightGround ground(field);
  const SunRay ray = sun_ray(field, sun);
  std::vector<Shade> codes(static_cast<std::size_t>(field.cols()) * static_cast<std::size_t>(field.rows()));
  sweep_shadow(ground, ray, codes.data(), progress);
  return codes;
}

}  // namespace scarp
