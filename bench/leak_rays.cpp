// SPDX-License-Identifier: MIT
#include "bench/leak_rays.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bench/off_vertical.h"

namespace scarp::bench {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kGrid = 0x1p-10;  // positions on edges and slants are multiples of it: exact in float32 and in double

double round_to_grid(double x) { return std::round(x / kGrid) * kGrid; }
dvec3 in_floats(dvec3 p) { return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)}; }

class Maker {
 public:
  Maker(const LeakField& ground, Random& random) : ground_(ground), f_(ground.field), r_(random) {
    relief_ = std::max(f_.max_height() - f_.min_height(), f_.settings().cell_x);
    cell_ = std::min(f_.settings().cell_x, f_.settings().cell_y);
  }

  Ray nodes(bool in_float32) { return aimed(any_node(), 0, 0, in_float32); }
  Ray edges(bool in_float32) {
    const bool along_col = r_.below(2);
    const double along = place();
    return aimed(any_cell(), along_col ? along : 0, along_col ? 0 : along, in_float32);
  }
  Ray diagonals(bool in_float32) {
    const double along = place();
    return aimed(any_cell(), r_.below(2) ? along : 1 - along, along, in_float32);
  }

  Ray axis() {
    const int way = r_.below(2), across = 1 - way;
    dvec3 from = r_.below(4) ? at(any_node()) : anywhere();
    const double extent = way == 0 ? f_.width() : f_.depth();
    const double sign = r_.below(2) ? 1 : -1;
    from[way] = r_.below(2) ? (sign > 0 ? -cell_ : extent + cell_) : r_.uniform(0, extent);
    if (r_.below(2)) from.z += r_.uniform(-0.3, 0.6) * relief_;
    Ray ray = along(from, dvec3(0.0), 0);
    ray.direction[way] = sign;
    ray.direction[across] = 0;
    ray.t_max = r_.below(2) ? extent + 2 * cell_ : r_.uniform(0, 1) * extent;
    if (r_.below(2)) ray.direction.z = r_.uniform(-1.2, 0.4) * relief_ / ray.t_max;
    return ray;
  }

  Ray vertical() {
    const int kind = r_.below(3);
    dvec3 over = kind == 0 ? at(any_node()) : anywhere();
    if (kind == 1) over[r_.below(2)] = 0;
    if (kind == 1 && r_.below(2)) over.x = f_.width(), over.y = r_.below(2) ? f_.depth() : over.y;
    over.z = f_.min_height() + r_.uniform(-0.5, 1.5) * relief_;
    return along(over, {0, 0, r_.below(3) ? -relief_ : relief_}, 2);
  }

  Ray tangent() {
    const dvec3 from = at(any_node()), to = at(any_node());
    dvec3 direction = to - from;
    direction.z = 0;
    if (direction == dvec3(0.0)) direction.x = cell_;
    const double back = r_.below(3);
    return along(from - direction * back, direction, back + 1.5);
  }

  Ray two_nodes() {
    const dvec3 from = at(any_node()), to = at(any_node());
    dvec3 direction = to - from;
    if (direction == dvec3(0.0)) direction.z = -cell_;
    const double back = r_.below(3);
    return along(from - direction * back, direction, back + 2);
  }

  Ray border() {
    const bool last = r_.below(2), by_col = r_.below(2);
    Node node = any_node();
    (by_col ? node.col : node.row) = last ? (by_col ? f_.cols() : f_.rows()) - 1 : 0;
    if (r_.below(4) == 0) (by_col ? node.row : node.col) = 0;  // a corner
    const dvec3 on = at(node);
    switch (r_.below(4)) {
      case 0: {  // starts on the border
        dvec3 from = on;
        from.z += r_.uniform(-0.2, 1) * relief_;
        return along(from, anywhere() - from, 1.2);
      }
      case 1: {  // along the border
        dvec3 direction(0.0);
        direction[by_col ? 1 : 0] = (r_.below(2) ? 1 : -1) * (by_col ? f_.depth() : f_.width());
        direction.z = r_.uniform(-1, 0.2) * relief_;
        return along(on + dvec3(0, 0, r_.uniform(0, 1) * relief_), direction, 1);
      }
      case 2: {  // inwards through the node from outside
        const dvec3 to = anywhere();
        return along(on - (to - on) * static_cast<double>(1 + r_.below(2)), to - on, 3);
      }
      default: {  // down at the node
        const double high = height_above();
        return along(on + dvec3(lean(high), lean(high), high), on, high);
      }
    }
  }

  Ray rims() {
    const Node node = ground_.rim[static_cast<std::size_t>(r_.below(static_cast<int>(ground_.rim.size())))];
    if (r_.below(2)) return aimed(node, 0, 0, false);
    const dvec3 on = at(node);
    if (r_.below(2)) return along(on - (anywhere() - on), anywhere() - on, 2);
    dvec3 direction(r_.below(3) - 1, r_.below(3) - 1, 0);
    if (direction == dvec3(0.0)) direction.x = 1;
    direction.z = r_.uniform(-1, 1) * r_.below(2);
    const double back = 1 + r_.below(8);
    return along(on - direction * (back * cell_), direction * cell_, back + 8);
  }

  Ray seam() {
    Node node = any_node();
    (r_.below(2) ? node.col : node.row) = 0;
    Ray ray = r_.below(2) ? aimed(node, 0, 0, false) : along(at(node), anywhere() - at(node), 2);
    if (r_.below(2)) ray.origin -= ray.direction * static_cast<double>(r_.below(2));
    ray.origin.x += (r_.below(9) - 4) * f_.width();
    ray.origin.y += (r_.below(9) - 4) * f_.depth();
    return ray;
  }

  Ray below() {
    dvec3 from = anywhere();
    from.z = f_.min_height() - r_.uniform(0, 0.5) * relief_;
    const dvec3 to = r_.below(2) ? at(any_node()) : anywhere();
    return along(from, to - from, 1 + r_.below(3));
  }

  // On a plane and slightly off it: by 2^-50 to 2^-1 of a slope of 1.
  Ray plane() {
    Ray ray = from_surface();
    tilt(ray);
    if (r_.below(2)) ray.direction.z += (r_.below(2) ? 1 : -1) * std::ldexp(1.0, -1 - r_.below(50));
    return ray;
  }
  Ray saddles() {
    Ray ray = from_surface();
    if (r_.below(2)) {
      ray.direction = {r_.below(2) ? 1 : -1, r_.below(2) ? 1 : -1, 0};
    } else {
      tilt(ray);
    }
    if (r_.below(2)) ray.direction.z += r_.uniform(-1, 1) * std::ldexp(1.0, -r_.below(30));
    return ray;
  }
  Ray surface() {
    Ray ray = from_surface();
    ray.direction.z = std::tan(r_.uniform(-0.6, 1.0)) * (r_.below(2) ? 1 : 0.1);
    return ray;
  }

  // Off the vertical by the cosine of 90 degrees, the noise of quaternions, or 2^-30 to 2^-1000. Aimed at a node or an
  // edge; half of the rays at a border or a rim, a quarter off their target by the rounding of the position.
  Ray leaning() {
    Node node = any_node();
    if (!ground_.rim.empty() && r_.below(2))
      node = ground_.rim[static_cast<std::size_t>(r_.below(static_cast<int>(ground_.rim.size())))];
    else if (r_.below(2))
      (r_.below(2) ? node.col : node.row) = 0;
    else if (r_.below(2))
      node.col = f_.cell_cols();
    dvec3 on = at(node);
    if (r_.below(2)) on[r_.below(2)] += r_.uniform(0, 1) * cell_;
    if (r_.below(4) == 0) on[r_.below(2)] *= 1 + 0x1p-53 * r_.uniform(-2, 2);
    const double high = height_above();
    dvec3 direction(off_vertical(r_), r_.below(2) ? off_vertical(r_) : 0, -1);
    if (r_.below(2)) std::swap(direction.x, direction.y);
    on.z = f_.min_height();
    const double down = relief_ + high;
    return along(on - direction * down, direction, down + high);
  }

  Ray far() {
    const dvec3 to = r_.below(2) ? at(any_node()) : anywhere();
    const double away = std::pow(10.0, 5 + r_.below(3)), azimuth = r_.uniform(0, 2 * kPi);
    const dvec3 from = to + away * dvec3(std::cos(azimuth), std::sin(azimuth), r_.uniform(0, 0.3));
    // In a wrapped field, not up to the ends: everything along the ray is ground.
    const double rest = 1 + 4 * (f_.width() + f_.depth()) / away;
    Ray ray = along(from, to - from, rest);
    if (f_.wraps()) ray.t_min = std::max(0.0, 2 - rest);
    return ray;
  }

  Ray any() {
    const dvec3 from = anywhere();
    return along(from, anywhere() - from, 1.2);
  }

 private:
  Node any_node() { return {r_.below(f_.cols()), r_.below(f_.rows())}; }
  Node any_cell() { return {r_.below(f_.cell_cols()), r_.below(f_.cell_rows())}; }
  double place() { return (1 + r_.below(1022)) * kGrid; }

  // A node in world space; a node without a height is at the lowest height.
  dvec3 at(Node node) const {
    const double sample = f_.visit([&](const auto& grid) {
      const auto s = grid.at(node.col, node.row);
      return grid.is_nodata(s) ? f_.min_sample() : static_cast<double>(s);
    });
    return f_.world_from_grid(node.col, node.row, sample);
  }
  dvec3 anywhere() {
    return {r_.uniform(-0.1, 1.1) * f_.width(), r_.uniform(-0.1, 1.1) * f_.depth(),
            f_.min_height() + r_.uniform(-0.3, 1.4) * relief_};
  }

  // A power of two above all ground, so heights of targets stay exact when it is added.
  double height_above() const { return std::exp2(std::ceil(std::log2(1.25 * relief_ + 0.1))); }
  double lean(double high) {
    return round_to_grid(r_.uniform(-0.5, 0.5) * std::min(high, 0.25 * std::min(f_.width(), f_.depth())));
  }

  static Ray along(dvec3 from, dvec3 direction, double t_max) {
    Ray ray;
    ray.origin = from;
    ray.direction = direction;
    ray.t_max = t_max;
    return ray;
  }

  // Down at a position in a cell (or at a node, which may be in the last column or row) and on to below all ground. The
  // ray is over the field along its whole length, if there is room.
  Ray aimed(Node node, double u, double v, bool in_float32) {
    double sample = 0;
    const Cell cell{std::min(node.col, f_.cell_cols() - 1), std::min(node.row, f_.cell_rows() - 1)};
    if (const auto h = f_.cell_heights(cell)) {
      sample = height_in_cell(f_.settings().surface, *h, node.col - cell.col + u, node.row - cell.row + v);
    } else {
      sample = f_.min_sample();
    }
    const dvec3 target = f_.world_from_grid(node.col + u, node.row + v, sample);
    const double high = height_above();
    const double t_max = (target.z + high - f_.min_height()) / high + 0x1p-6;
    const auto over_field = [&](dvec3 p) { return p.x > 0 && p.x < f_.width() && p.y > 0 && p.y < f_.depth(); };
    Ray ray;
    for (int attempt = 0; attempt < 8; ++attempt) {
      const dvec3 offset = attempt < 7 ? dvec3(lean(high), lean(high), high) : dvec3(0, 0, high);
      ray = along(target + offset, -offset, t_max);
      if (in_float32) {
        ray.origin = in_floats(ray.origin);
        ray.direction = in_floats(target - ray.origin);
        ray.t_max = static_cast<float>(t_max);
      }
      if (f_.wraps() || (over_field(ray.origin) && over_field(ray.at(ray.t_max)))) break;
    }
    return ray;
  }

  // From a point on the surface, level, in any azimuth.
  Ray from_surface() {
    Ray ray = any();
    for (int attempt = 0; attempt < 20; ++attempt) {
      const Node node = any_cell();
      const Cell cell{node.col, node.row};
      const auto h = f_.cell_heights(cell);
      if (!h) continue;
      const bool exact = r_.below(4) == 0;  // nodes, middles of edges and of the cell
      const double u = exact ? 0.5 * r_.below(3) : r_.uniform(), v = exact ? 0.5 * r_.below(3) : r_.uniform();
      const double azimuth = r_.uniform(0, 2 * kPi);
      ray = along(f_.world_from_grid(cell.col + u, cell.row + v, height_in_cell(f_.settings().surface, *h, u, v)),
                  {std::cos(azimuth), std::sin(azimuth), 0}, 20 * cell_);
      ray.start = RayStart::on_surface;
      ray.start_cell = cell;
      return ray;
    }
    return ray;
  }
  // Into the plane that touches the surface at the start.
  void tilt(Ray& ray) const {
    if (ray.start != RayStart::on_surface) return;
    const auto at = f_.place(ray.origin.x, ray.origin.y);
    if (!at) return;
    const dvec2 slope = f_.gradient(ray.start_cell, at->u, at->v);
    ray.direction.z = slope.x * ray.direction.x + slope.y * ray.direction.y;
  }

  const LeakField& ground_;
  const HeightField& f_;
  Random& r_;
  double relief_;  // metres, not 0
  double cell_;
};

}  // namespace

std::string_view name_of(LeakClass leak_class) {
  constexpr std::string_view kNames[] = {"nodes",     "edges",   "diagonals", "axis", "vertical", "tangent",
                                         "two-nodes", "border",  "rims",      "seam", "below",    "plane",
                                         "saddles",   "surface", "leaning",   "far",  "any"};
  static_assert(std::size(kNames) == std::size(kLeakClasses));
  return kNames[static_cast<std::size_t>(leak_class)];
}

bool suits(LeakClass leak_class, const LeakField& ground) {
  switch (leak_class) {
    case LeakClass::rims:
      return !ground.rim.empty();
    case LeakClass::seam:
      return ground.field.wraps();
    case LeakClass::plane:
      return ground.name == "plane";
    case LeakClass::saddles:
      return ground.name == "saddles" || ground.name == "spikes" || ground.name == "periodic";
    case LeakClass::border:
      return !ground.field.wraps();
    default:
      return true;
  }
}

Ray make_leak_ray(LeakClass leak_class, const LeakField& ground, Random& random, bool in_float32) {
  Maker make(ground, random);
  switch (leak_class) {
    case LeakClass::nodes:
      return make.nodes(in_float32);
    case LeakClass::edges:
      return make.edges(in_float32);
    case LeakClass::diagonals:
      return make.diagonals(in_float32);
    case LeakClass::axis:
      return make.axis();
    case LeakClass::vertical:
      return make.vertical();
    case LeakClass::tangent:
      return make.tangent();
    case LeakClass::two_nodes:
      return make.two_nodes();
    case LeakClass::border:
      return make.border();
    case LeakClass::rims:
      return make.rims();
    case LeakClass::seam:
      return make.seam();
    case LeakClass::below:
      return make.below();
    case LeakClass::plane:
      return make.plane();
    case LeakClass::saddles:
      return make.saddles();
    case LeakClass::surface:
      return make.surface();
    case LeakClass::leaning:
      return make.leaning();
    case LeakClass::far:
      return make.far();
    case LeakClass::any:
      break;
  }
  return make.any();
}

}  // namespace scarp::bench
