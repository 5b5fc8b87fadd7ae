// SPDX-License-Identifier: MIT
#include "scarp/march/height/closest_point.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scarp/base/error.h"
#include "scarp/march/closest_of.h"
#include "scarp/march/height/ground_search.h"

namespace scarp {
namespace {

double square(double x) { return x * x; }

// A query of GroundSearch: distances.
class Search {
 public:
  Search(const HeightField& field, const dvec3& p, double max_distance)
      : field_(field),
        p_(p),
        slack_(GroundSearch<Search>::slack(field)),
        best_(std::nextafter(max_distance, std::numeric_limits<double>::infinity())) {}

  double best() const { return best_; }
  double bound(const WorldBox& box) const {
    return std::sqrt(square(std::max({box.low.x - p_.x, p_.x - box.high.x, 0.0})) +
                     square(std::max({box.low.y - p_.y, p_.y - box.high.y, 0.0})) +
                     square(std::max({box.low.z - p_.z, p_.z - box.high.z, 0.0})));
  }

  double bound(const GroundPart& part) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Triangle& triangle : part.triangles)
      nearest = std::min(nearest, length(closest_of_triangle(p_, triangle) - p_));
    return std::max(0.0, nearest - part.off);
  }

  // Returns whether the quarters of the part contain nothing better. Both the point found so far and the closest one
  // are within GroundPart::off of the triangles.
  bool compare(const GroundPart& part, bool flat) {
    if (part.off > 0) {
      const PatchPoint found = closest_of_patch(part.patch(), p_, slack_);
      take(found.point, part.cell, part.u + part.side * found.u, part.v + part.side * found.v);
      if (found.proven) return true;
    }
    const HeightFieldSettings& settings = field_.settings();
    double nearest = std::numeric_limits<double>::infinity();
    for (const Triangle& triangle : part.triangles) {
      const dvec3 q = closest_of_triangle(p_, triangle);
      nearest = std::min(nearest, length(q - p_));
      const Cell cell = part.cell;
      const double u = std::clamp(q.x / settings.cell_x - cell.col, 0.0, 1.0),
                   v = std::clamp(field_.rows() - 1 - q.y / settings.cell_y - cell.row, 0.0, 1.0);
      // On the patch itself, above or below the triangle.
      take(settings.surface == Surface::bilinear
               ? field_.world_from_grid(cell.col + u, cell.row + v,
                                        height_in_cell(Surface::bilinear, part.heights, u, v))
               : q,
           cell, u, v);
    }
    return flat || nearest - part.off > best_;
  }

  std::optional<ClosestPoint> answer() {
    if (!found_) return {};
    answer_.distance = best_;
    answer_.normal = field_.normal(answer_.cell, answer_.u, answer_.v);
    return answer_;
  }

 private:
  void take(const dvec3& q, Cell cell, double u, double v) {
    const double away = length(q - p_);
    if (!(away < best_)) return;
    best_ = away;
    found_ = true;
    answer_ = {.point = q, .cell = cell, .u = u, .v = v};
  }

  const HeightField& field_;
  dvec3 p_;
  double slack_;
  double best_;
  bool found_ = false;
  ClosestPoint answer_;
};

}  // namespace

std::optional<ClosestPoint> closest_point(const HeightTarget& target, const dvec3& p, double max_distance) {
  require(target, HeightPart::pyramid);
  const HeightField& field = *target.field;
  if (field.wraps()) throw Error("closest point: the field wraps round (ask a field without wrap)");
  if (!(max_distance >= 0)) return {};
  Search search(field, p, max_distance);
  GroundSearch(target, search).run();
  return search.answer();
}

}  // namespace scarp
