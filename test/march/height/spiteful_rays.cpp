// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "march/height/spiteful.h"

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

double period(const HeightField& f) { return std::max(f.width(), f.depth()); }

// Over a wrapped field a ray needs an end: some periods beyond t = 1, where most kinds aim.
Ray ended(const HeightField& f, Random& r, Ray ray, double periods = 8) {
  if (!f.wraps() || std::isfinite(ray.t_max)) return ray;
  const double speed = std::max(std::abs(ray.direction.x), std::abs(ray.direction.y));
  const double longest = speed > 0 ? periods * period(f) / speed : 4 * tall(f) / std::abs(ray.direction.z);
  ray.t_max = ray.t_min + std::min(1.0, longest) + uniform(r, 0, 1) * longest;
  return ray;
}

// Sets the origin to a point on the surface, in a cell with ground, at place(col, row); returns false if none was
// found.
template <class Place>
bool on_surface(const HeightField& f, Random& r, Ray& ray, const Place& place) {
  for (int attempt = 0; attempt < 20 && f.has_cells(); ++attempt) {
    const dvec2 at = place();
    const Cell cell{std::min(static_cast<int>(at.x), f.cell_cols() - 1),
                    std::min(static_cast<int>(at.y), f.cell_rows() - 1)};
    const auto h = f.cell_heights(cell);
    if (!h) continue;
    const double z = height_in_cell(f.settings().surface, *h, at.x - cell.col, at.y - cell.row);
    // In a wrapped field, in any copy.
    const int reach = f.wraps() ? 3 : 0;
    ray.origin = f.world_from_grid(at.x + whole(r, -reach, reach) * f.cell_cols(),
                                   at.y + whole(r, -reach, reach) * f.cell_rows(), z);
    ray.start = RayStart::on_surface;
    ray.start_cell = cell;
    return true;
  }
  return false;
}
bool on_surface(const HeightField& f, Random& r, Ray& ray) {
  return on_surface(f, r, ray, [&] {
    return whole(r, 0, 3) == 0 ? dvec2(whole(r, 0, f.cell_cols() - 1), whole(r, 0, f.cell_rows() - 1))
                               : dvec2(uniform(r, 0, 1) * f.cell_cols(), uniform(r, 0, 1) * f.cell_rows());
  });
}

// The height of the surface (in metres) at a point in grid units; over a hole and outside, any height of the field.
double ground(const HeightField& f, Random& r, double col, double row) {
  const dvec3 p = f.world_from_grid(col, row, 0);
  return f.height(p.x, p.y).value_or(uniform(r, low(f), high(f)));
}
dvec3 point(const HeightField& f, Random& r, double col, double row) {
  dvec3 p = f.world_from_grid(col, row, 0);
  p.z = ground(f, r, col, row);
  return p;
}

// A nodata sample; any sample if there is none.
dvec2 hole(const HeightField& f, Random& r) {
  return f.visit([&](const auto& grid) {
    dvec2 at{whole(r, 0, f.cols() - 1), whole(r, 0, f.rows() - 1)};
    for (int i = 0; i < f.cols() * f.rows() && !grid.is_nodata(grid.at(static_cast<int>(at.x), static_cast<int>(at.y)));
         ++i) {
      if (++at.x == f.cols()) at = {0, at.y + 1 == f.rows() ? 0 : at.y + 1};
    }
    return at;
  });
}

// Through a point, from above, from the side or from below; at the point t is 1.
Ray through(const HeightField& f, Random& r, dvec3 to) {
  dvec3 from = to + dvec3(uniform(r, -1, 1) * f.width(), uniform(r, -1, 1) * f.depth(), 0);
  from.z += uniform(r, -0.2, 1) * tall(f) * whole(r, 0, 1);
  return towards(from, to);
}
// Between two points, starting some lengths before the first.
Ray along(Random& r, dvec3 from, dvec3 to) {
  Ray ray = towards(from, to);
  ray.origin -= ray.direction * static_cast<double>(whole(r, 0, 4));
  ray.origin.z += uniform(r, -0.2, 0.2) * whole(r, 0, 1);
  return ray;
}

const std::vector<RayKind>& endless_rays() {
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
         Ray ray = towards(to + 1e7 * dvec3(std::cos(azimuth), std::sin(azimuth), rise), to);
         // Between the two points there is nothing, or one copy of the field after another.
         if (f.wraps()) ray.t_min = 1 - 4e-7 * period(f), ray.t_max = 1 + 4e-7 * period(f);
         return ray;
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
         Ray ray = ended(f, r, towards(above(f, r), anywhere_in(f, r)));
         const int power = whole(r, 0, 1) ? whole(r, -1000, -400) : whole(r, 400, 1000);
         ray.direction = ray.direction * std::ldexp(1.0, power);
         ray.t_max = std::ldexp(ray.t_max, -power);
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
      {"from the surface, at a line, a diagonal or a node",
       [](const HeightField& f, Random& r) {
         Ray ray = towards(above(f, r), anywhere_in(f, r));
         const auto place = [&] {
           const int u = whole(r, 0, 4), v = whole(r, 0, 2) ? 4 - u : 2 * whole(r, 0, 1);
           return dvec2(whole(r, 0, f.cell_cols() - 1) + u / 4.0, whole(r, 0, f.cell_rows() - 1) + v / 4.0);
         };
         if (!on_surface(f, r, ray, place)) return ray;
         // Along lines, diagonals and anything else; in the surface, slightly off it, or level.
         const double azimuth = uniform(r, 0, 6.2832);
         dvec2 d{std::cos(azimuth), std::sin(azimuth)};
         if (whole(r, 0, 2))
           d = dvec2(whole(r, -1, 1), whole(r, -1, 1)) * dvec2(f.settings().cell_x, f.settings().cell_y);
         if (d == dvec2(0.0)) d.x = 1;
         const dvec3 p = ray.origin;
         const dvec2 slope = f.gradient(p.x, p.y).value_or(dvec2(0.0));
         ray.direction = {d, whole(r, 0, 1) ? dot(slope, d) + uniform(r, -0.1, 0.1) * whole(r, 0, 1) : 0.0};
         return ray;
       }},
      {"at a diagonal",
       [](const HeightField& f, Random& r) {
         if (!f.has_cells()) return towards(above(f, r), anywhere_in(f, r));
         const int col = whole(r, 0, f.cell_cols() - 1), row = whole(r, 0, f.cell_rows() - 1);
         const auto on_it = [&](double u) { return point(f, r, col + u, row + 1 - u); };
         return whole(r, 0, 1) ? through(f, r, on_it(uniform(r, 0, 1))) : along(r, on_it(0), on_it(1));
       },
       kTriangles},
      {"at a hole's rim",
       [](const HeightField& f, Random& r) {
         // The rim is one sample away; its corners are one sample away along both axes.
         const dvec2 at = hole(f, r);
         const auto rim = [&](double along_it) {
           const double off = whole(r, 0, 1) ? 1 : -1;
           return whole(r, 0, 1) ? point(f, r, at.x + off, at.y + along_it) : point(f, r, at.x + along_it, at.y + off);
         };
         switch (whole(r, 0, 2)) {
           case 0:
             return through(f, r, rim(whole(r, -1, 1)));
           case 1:
             return through(f, r, rim(uniform(r, -1, 1)));
           default: {
             const double side = whole(r, 0, 1) ? 1 : -1;
             return whole(r, 0, 1) ? along(r, point(f, r, at.x - 1, at.y + side), point(f, r, at.x + 1, at.y + side))
                                   : along(r, point(f, r, at.x + side, at.y - 1), point(f, r, at.x + side, at.y + 1));
           }
         }
       },
       kHoles},
      {"at the seam",
       [](const HeightField& f, Random& r) {
         const double copy_x = whole(r, -2, 2) * f.cell_cols(), copy_y = whole(r, -2, 2) * f.cell_rows();
         const auto on_it = [&](double a) {
           return whole(r, 0, 1) ? point(f, r, copy_x, copy_y + a * f.cell_rows())
                                 : point(f, r, copy_x + a * f.cell_cols(), copy_y);
         };
         switch (whole(r, 0, 2)) {
           case 0:
             return through(f, r, on_it(uniform(r, -1, 1)));
           case 1:
             return through(f, r, point(f, r, copy_x, copy_y));
           default:
             return whole(r, 0, 1) ? along(r, point(f, r, copy_x, copy_y), point(f, r, copy_x, copy_y + 1))
                                   : along(r, point(f, r, copy_x, copy_y), point(f, r, copy_x + 1, copy_y));
         }
       },
       kWraps},
      {"many periods long",
       [](const HeightField& f, Random& r) {
         Ray ray = towards(anywhere_in(f, r), anywhere_in(f, r));
         ray.origin.z = high(f) + uniform(r, 0, 0.5) * tall(f);
         ray.direction.z = -uniform(r, 0, 0.1) * tall(f);
         return ended(f, r, ray, 12);
       },
       kWraps},
  };
  return kinds;
}

}  // namespace

const std::vector<RayKind>& rays_across_tiles() {
  // A node where tiles meet, or next to one, as near as the field allows.
  static const auto corner = [](const HeightField& f, Random& r) {
    const int col = std::min(1024 * whole(r, 0, 2) + whole(r, -1, 1), f.cols() - 1);
    const int row = std::min(1024 * whole(r, 0, 2) + whole(r, -1, 1), f.rows() - 1);
    return point(f, r, std::max(col, 0), std::max(row, 0));
  };
  static const auto ending = [](const HeightField& f, Random& r, const Ray& ray) { return ended(f, r, ray, 2); };
  static const std::vector<RayKind> kinds = {
      {"along the field, grazing",
       [](const HeightField& f, Random& r) {
         dvec3 from = anywhere_in(f, r), to = anywhere_in(f, r);
         from.z = low(f) + uniform(r, 0.8, 1.1) * tall(f);
         to.z = low(f) + uniform(r, 0.2, 1.1) * tall(f);
         return ending(f, r, towards(from, to));
       }},
      {"through a corner of tiles",
       [](const HeightField& f, Random& r) { return ending(f, r, through(f, r, corner(f, r))); }},
      {"between corners of tiles",
       [](const HeightField& f, Random& r) {
         return ending(f, r, along(r, corner(f, r), corner(f, r) + dvec3(0, 0, 1e-3)));
       }},
      {"from the surface, along the field",
       [](const HeightField& f, Random& r) {
         Ray ray = towards(above(f, r), anywhere_in(f, r));
         on_surface(f, r, ray);
         ray.direction = {uniform(r, -1, 1) * f.width(), uniform(r, -1, 1) * f.depth(), uniform(r, 0, 3) * tall(f)};
         return ending(f, r, ray);
       }},
  };
  return kinds;
}

const std::vector<RayKind>& spiteful_rays() {
  static const std::vector<RayKind> kinds = [] {
    std::vector<RayKind> ended_rays = endless_rays();
    for (RayKind& kind : ended_rays) {
      kind.make = [make = kind.make](const HeightField& f, Random& r) { return ended(f, r, make(f, r)); };
    }
    return ended_rays;
  }();
  return kinds;
}

Ray along_hills(const HeightField& field, Random& random, bool from_surface) {
  Ray ray;
  const double x = uniform(random, 0, field.width()), y = uniform(random, 0, field.depth());
  ray.origin = {x, y, *field.height(x, y)};
  const double azimuth = uniform(random, 0, 6.2832);
  ray.direction = {std::cos(azimuth), std::sin(azimuth), uniform(random, -0.01, 0.06)};
  if (from_surface) {
    ray.start = RayStart::on_surface;
    ray.start_cell = field.place(x, y).value().cell;
  } else {
    ray.origin.z += uniform(random, -1, 20);
  }
  return ray;
}

std::vector<Ray> rays_of_unusual_numbers(const HeightField& field) {
  constexpr double kNumbers[] = {
      0, -0.0, 1, -1, 1e-320, 1e-200, 1e200, 1e308, HUGE_VAL, -HUGE_VAL, std::numeric_limits<double>::quiet_NaN()};
  const Ray usual{.origin = {20, 20, field.max_height()}, .direction = {0.3, 0.2, -0.1}};
  std::vector<Ray> rays;
  for (const double one : kNumbers) {
    for (const double other : kNumbers) {
      for (int axis = 0; axis < 3; ++axis) {
        Ray ray = usual;
        ray.direction[axis] = one, ray.direction[(axis + 1) % 3] = other;
        rays.push_back(ray);
        ray.direction[(axis + 1) % 3] = usual.direction[(axis + 1) % 3];
        ray.origin[axis] = other;
        rays.push_back(ray);
      }
      Ray ray = usual;
      ray.t_min = one, ray.t_max = other;
      rays.push_back(ray);
    }
  }
  return rays;
}

}  // namespace scarp::test
