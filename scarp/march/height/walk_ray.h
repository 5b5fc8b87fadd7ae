// SPDX-License-Identifier: MIT
// A ray of `max-mip` over the ground of one field: what is constant in a query, the state of a traversal, and the
// clearance of the ray in a cell.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "scarp/march/height/cell_surface.h"
#include "scarp/march/height/grid_axis.h"
#include "scarp/march/height/height_target.h"
#include "scarp/march/height/max_mip_rims.h"
#include "scarp/march/height/rounding.h"
#include "scarp/march/height/walk_ground.h"
#include "scarp/march/height/walk_query.h"

namespace scarp::max_mip {
namespace {

// How the ray got to its position: through a line of constant column (x) or row (y), or not through a line.
enum class Through { point, x_line, y_line };

// T: type of samples. Holes: whether the field has any. Only queries as wanted may request hits from below.
template <class T, bool Holes, bool Wraps, Ask ask>
class WalkRay {
 public:
  static constexpr bool kMayInvert = ask == Ask::as_wanted;
  using Axis = GridAxis<Wraps>;

  MarchStats stats;

 protected:
  WalkRay(const HeightTarget& target, const SampleGrid<T>& grid, const Ray& ray, const GridRay& local,
          const Wanted& wanted)
      : field_(*target.field),
        seam_(target.seam),
        seam_step_(target.seam_step),
        ground_(field_, *target.pyramid, grid, wanted.from_below),
        x_(local.origin.x, local.direction.x, grid.cell_cols),
        y_(local.origin.y, local.direction.y, grid.cell_rows),
        z_(ground_.inverted() ? -local.origin.z : local.origin.z),
        dz_(ground_.inverted() ? -local.direction.z : local.direction.z),
        t_in_(ray.t_min),
        t_end_(ray.t_max),
        strict_(ray.start == RayStart::on_surface),
        triangles_(field_.settings().surface == Surface::triangles),
        solid_(field_.settings().solid && !ground_.inverted()),
        wanted_(wanted),
        ray_(ray) {}

  double ray_height(double t) const { return z_ + dz_ * t; }

  CellQuadratic quadratic(const CellHeights& h, double t) const {
    return {h, x_.place(t, col_), y_.place(t, row_), x_.direction, y_.direction, ray_height(t), dz_};
  }
  CellPlane plane(const CellHeights& h, bool south_east, double t) const {
    return {h, south_east, x_.place(t, col_), y_.place(t, row_), x_.direction, y_.direction, ray_height(t), dz_};
  }
  bool south_east(double t) const { return x_.place(t, col_) + y_.place(t, row_) > 1; }

  // Height of the surface under a point of the ray in the current cell.
  double surface(const CellHeights& h, double t) const {
    return triangles_ ? plane(h, south_east(t), t).surface : quadratic(h, t).surface;
  }

  // Clearance where the ray enters or leaves the current cell: at a line, from the same two nodes for both neighbours.
  double clearance(const CellHeights& h, Through through, bool leaving, double t) const {
    switch (through) {
      case Through::x_line: {
        const bool high = (x_.ahead == 1) == leaving;
        return ray_height(t) - edge_height(high ? h.h10 : h.h00, high ? h.h11 : h.h01, y_.place(t, row_));
      }
      case Through::y_line: {
        const bool high = (y_.ahead == 1) == leaving;
        return ray_height(t) - edge_height(high ? h.h01 : h.h00, high ? h.h11 : h.h10, x_.place(t, col_));
      }
      case Through::point:
        break;
    }
    return ray_height(t) - surface(h, t);
  }

  Rim<T, Wraps, kMayInvert> rim(const GridRay& ray) const { return {field_, ground_, x_, y_, ray, seam_, seam_step_}; }

  // The query, a compile-time constant except for Ask::as_wanted.
  bool lists() const { return ask == Ask::as_wanted && wanted_.all; }
  bool bisects() const { return ask == Ask::as_wanted && wanted_.bisects; }
  bool accepts() const { return ask == Ask::as_wanted && !lists() && !bisects(); }

  // Whether a ray that is not above can never hit again: falling, below the lowest ground, with no walls of holes
  // ahead.
  bool lost(double t) const { return dz_ < 0 && ray_height(t) < ground_.lowest() && !(Holes && solid_); }

  // The bound where a sign alone is not enough. A ray from below has emerged only if it is above by more than this
  // (otherwise a ray that rises through a node could be above at one line and, by rounding, not above at the next: a
  // hit from below). A ray from the surface, or under a block, is strictly below only by more than this.
  double rounding_of_clearance(double t) const { return scarp::rounding_of_clearance(field_, grid_ray(), t); }
  // The bound for the whole ray, from t_in_ on.
  void bound_rounding() { rounding_ = rounding_of_clearance(std::max(std::abs(t_in_), std::abs(t_end_))); }
  GridRay grid_ray() const { return {{x_.origin, y_.origin, z_}, {x_.direction, y_.direction, dz_}}; }

  // A clearance <= 0 is a hit; rays that start on the surface require < -rounding.
  bool is_hit(double clearance, double t) const { return !strict_ || clearance < -rounding_of_clearance(t); }

  const HeightField& field_;
  double seam_, seam_step_;
  const WalkGround<T, kMayInvert> ground_;
  Axis x_, y_;
  double z_, dz_;  // ray height in sample units
  double t_in_, t_end_;
  double rounding_ = 0;  // of the clearance: bound_rounding()
  bool strict_, triangles_, solid_;
  const Wanted wanted_;
  const Ray& ray_;

  int col_ = 0, row_ = 0;  // the current cell: this is the state, times are derived from it
  Side side_ = Side::unknown;
  Through through_ = Through::point;
  double cell_end_ = std::numeric_limits<double>::infinity();  // when the ray leaves the current cell
  bool from_outside_ = false;                                  // whether the ray entered through the border
  bool begun_ = false;      // with holes: whether a cell has been left; only in the first one can the ray start below
  bool slow_ = false;       // with holes: whether rims are followed
  bool below_rim_ = false;  // whether it has sunk below the adjacent rim, from outside or over a hole
};

}  // namespace
}  // namespace scarp::max_mip
