// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "march/spiteful.h"

namespace scarp::test {
namespace {

double low(const HeightField& f) { return f.all_nodata() ? 0 : f.min_height(); }
double high(const HeightField& f) { return f.all_nodata() ? 1 : f.max_height(); }
double tall(const HeightField& f) { return std::max(high(f) - low(f), f.settings().cell_x); }

dvec3 anywhere_in(const HeightField& f, Random& r) {
  return {uniform(r, -0.2, 1.2) * f.width(), uniform(r, -0.2, 1.2) * f.depth(),
          low(f) + uniform(r, -0.3, 1.6) * tall(f)};
}
dvec3 above(const HeightField& f, Random& r) {
  return {uniform(r, -0.5, 1.5) * f.width(), uniform(r, -0.5, 1.5) * f.depth(), high(f) + uniform(r, 0.1, 2) * tall(f)};
}
dvec3 node(const HeightField& f, Random& r) {
  const int col = whole(r, 0, f.cols() - 1), row = whole(r, 0, f.rows() - 1);
  const double sample = f.visit([&](const auto& grid) { return static_cast<double>(grid.at(col, row)); });
  return f.world_from_grid(col, row, std::isfinite(sample) ? sample : f.all_nodata() ? 0 : f.min_sample());
}
Ray towards(dvec3 from, dvec3 to) {
  Ray ray;
  ray.origin = from;
  ray.direction = to - from;
  if (ray.direction == dvec3(0.0)) ray.direction.z = -1;
  return ray;
}

// A point on the surface, in a cell that is no hole; nothing if none was found.
bool on_surface(const HeightField& f, Random& r, Ray& ray) {
  for (int attempt = 0; attempt < 20 && f.has_cells(); ++attempt) {
    const bool at_node = whole(r, 0, 3) == 0;
    const double col = at_node ? whole(r, 0, f.cols() - 2) : uniform(r, 0, f.cols() - 1),
                 row = at_node ? whole(r, 0, f.rows() - 2) : uniform(r, 0, f.rows() - 1);
    const Cell cell{std::min(static_cast<int>(col), f.cols() - 2), std::min(static_cast<int>(row), f.rows() - 2)};
    const auto h = f.cell_heights(cell);
    if (!h) continue;
    const double u = col - cell.col, v = row - cell.row;
    const double z = (h->h00 * (1 - u) + h->h10 * u) * (1 - v) + (h->h01 * (1 - u) + h->h11 * u) * v;
    ray.origin = f.world_from_grid(col, row, z);
    ray.start = RayStart::on_surface;
    ray.start_cell = cell;
    return true;
  }
  return false;
}

}  // namespace

const std::vector<RayKind>& spiteful_rays() {
  static const std::vector<RayKind> kinds = {
      {"random", [](const HeightField& f, Random& r) { return towards(anywhere_in(f, r), anywhere_in(f, r)); }},
      {"from above", [](const HeightField& f, Random& r) { return towards(above(f, r), anywhere_in(f, r)); }},
      {"through a node", [](const HeightField& f, Random& r) { return towards(above(f, r), node(f, r)); }},
      {"through two nodes",
       [](const HeightField& f, Random& r) {
         Ray ray = towards(node(f, r), node(f, r));
         ray.origin -= ray.direction * static_cast<double>(whole(r, 0, 2));
         return ray;
       }},
      {"along a grid line",
       [](const HeightField& f, Random& r) {
         Ray ray = towards(node(f, r), node(f, r));
         ray.direction[whole(r, 0, 1)] = 0;
         ray.direction.z = uniform(r, -1, 1) * whole(r, 0, 1);
         if (length(ray.direction) == 0) ray.direction.z = 1;
         ray.origin -= ray.direction * 3.0;
         ray.origin.z += uniform(r, -1, 1) * whole(r, 0, 1);
         return ray;
       }},
      {"along a diagonal",
       [](const HeightField& f, Random& r) {
         Ray ray;
         ray.origin = node(f, r);
         const double sx = whole(r, 0, 1) ? 1 : -1, sy = whole(r, 0, 1) ? 1 : -1;
         ray.direction = {sx * f.settings().cell_x, sy * f.settings().cell_y, uniform(r, -2, 1)};
         ray.origin -= ray.direction * static_cast<double>(whole(r, 0, 20));
         return ray;
       }},
      {"parallel to an axis",
       [](const HeightField& f, Random& r) {
         Ray ray = towards(anywhere_in(f, r), anywhere_in(f, r));
         const int kept = whole(r, 0, 2);
         for (int axis = 0; axis < 3; ++axis) ray.direction[axis] = axis == kept ? (whole(r, 0, 1) ? 1 : -1) : 0;
         return ray;
       }},
      {"upright",
       [](const HeightField& f, Random& r) {
         Ray ray;
         ray.origin = whole(r, 0, 1) ? node(f, r) : anywhere_in(f, r);
         ray.origin.z = low(f) + uniform(r, -1, 2) * tall(f);
         ray.direction = {0, 0, uniform(r, -2, 1)};
         return ray;
       }},
      {"tangent at a node's height",
       [](const HeightField& f, Random& r) {
         Ray ray = towards(node(f, r), node(f, r));
         ray.direction.z = 0;
         if (length(ray.direction) == 0) ray.direction.x = 1;
         ray.origin -= ray.direction * static_cast<double>(whole(r, 0, 9));
         return ray;
       }},
      {"starting below",
       [](const HeightField& f, Random& r) {
         dvec3 from = anywhere_in(f, r);
         from.z = low(f) - uniform(r, 0, 0.5) * tall(f);
         return towards(from, anywhere_in(f, r));
       }},
      {"starting on the border",
       [](const HeightField& f, Random& r) {
         dvec3 from = anywhere_in(f, r);
         const int axis = whole(r, 0, 1);
         from[axis] = whole(r, 0, 1) ? 0 : (axis ? f.depth() : f.width());
         return towards(from, anywhere_in(f, r));
       }},
      {"from 10^7 m away",
       [](const HeightField& f, Random& r) {
         const dvec3 to = whole(r, 0, 1) ? node(f, r) : anywhere_in(f, r);
         const double azimuth = uniform(r, 0, 6.2832), rise = uniform(r, 0, 0.3);
         return towards(to + 1e7 * dvec3(std::cos(azimuth), std::sin(azimuth), rise), to);
       }},
      {"a part of a ray",
       [](const HeightField& f, Random& r) {
         Ray ray = towards(anywhere_in(f, r), anywhere_in(f, r));
         ray.t_min = uniform(r, -0.5, 0.7);
         ray.t_max = ray.t_min + uniform(r, 0, 0.6);
         return ray;
       }},
      {"a direction of extreme length",
       [](const HeightField& f, Random& r) {
         Ray ray = towards(above(f, r), anywhere_in(f, r));
         ray.direction = ray.direction * std::ldexp(1.0, whole(r, 0, 1) ? whole(r, -1000, -400) : whole(r, 400, 1000));
         return ray;
       }},
      {"from the surface",
       [](const HeightField& f, Random& r) {
         Ray ray = towards(above(f, r), anywhere_in(f, r));
         if (!on_surface(f, r, ray)) return ray;
         const double azimuth = uniform(r, 0, 6.2832), slope = std::tan(uniform(r, -0.6, 1.2));
         ray.direction = {std::cos(azimuth), std::sin(azimuth), slope};
         return ray;
       }},
      {"from the surface, grazing",
       [](const HeightField& f, Random& r) {
         Ray ray = towards(above(f, r), anywhere_in(f, r));
         if (!on_surface(f, r, ray)) return ray;
         const double azimuth = uniform(r, 0, 6.2832);
         ray.direction = {std::cos(azimuth), std::sin(azimuth), uniform(r, -0.1, 0.1)};
         return ray;
       }},
  };
  return kinds;
}

}  // namespace scarp::test
