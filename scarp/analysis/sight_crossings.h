// SPDX-License-Identifier: MIT
// The crossings of a line of sight that count, with the heights there.
#pragma once

#include <cmath>
#include <utility>

#include "scarp/analysis/crossing_sign.h"
#include "scarp/analysis/line_of_sight.h"
#include "scarp/analysis/sight_line.h"

namespace scarp {

/// A crossing between the ends with ground on it.
struct SightCrossing {
  Crossing at;
  CrossingTerms terms;

  double along() const { return static_cast<double>(at.steps) / static_cast<double>(at.length); }
  double ground() const { return (terms.g0 * terms.w0 + terms.g1 * terms.w1) / (terms.w0 + terms.w1); }  ///< lowered
  /// Metres by which the ground there appears lower, interpolated as its height is.
  double drop(const SightGround& heights) const {
    const auto of = [&](Node node) { return heights.drop(node.col, node.row); };
    return (of(at.first) * terms.w0 + of(at.second) * terms.w1) / (terms.w0 + terms.w1);
  }
  double ray() const { return (terms.e * terms.v0 + terms.r * terms.v1) / (terms.v0 + terms.v1); }

  /// Updates the obstruction and the least clearance of a line.
  void add_to(LineOfSight& result, const SightLine& line) const {
    const double clearance = ray() - ground(), place = along();
    if (clearance < result.clearance) {
      result.clearance = clearance;
      result.clearance_along = place;
    }
    if ((result.visible || place < result.obstruction->along) && sign_of(terms) > 0) {
      result.visible = false;
      result.obstruction = {place, line.col(place), line.row(place), ground() + drop(line.ground())};
    }
  }
  /// Updates the least share of the first Fresnel zone. `wavelength` in metres.
  void add_to(FresnelClearance& least, const SightLine& line, double wavelength) const {
    const double place = along();
    const double radius = fresnel_radius(wavelength, place * line.distance(), (1 - place) * line.distance());
    const double share = (ray() - ground()) / radius;
    if (share < least.share) least = {share, place};
  }
};

/// Calls visit(crossing) for the crossings of one axis that count, outwards from the start, until it returns false.
/// Calls skip(Crossing) for those next to nodata.
template <class Visit, class Skip>
void visit_sight(const SightLine& line, int axis, const Visit& visit, const Skip& skip, const LineRange& range) {
  const auto steps = [](double cells) { return std::llround(cells * static_cast<double>(kSubcells)); };
  const std::int64_t x = steps(line.from().col), y = steps(line.from().row);
  const GridLine grid{x, y, steps(line.to().col) - x, steps(line.to().row) - y, kSubcells};
  const HeightField& field = line.ground().field();
  visit_crossings(
      grid, axis, field.cols(), field.rows(), true,
      [&](const Crossing& at) {
        const auto first = line.ground().lowered(at.first);
        const auto second = at.w1 > 0 ? line.ground().lowered(at.second) : first;
        if (!first || !second) {
          skip(at);
          return true;
        }
        const CrossingTerms terms{*first,        static_cast<double>(at.w0),
                                  *second,       static_cast<double>(at.w1),
                                  line.eye(),    static_cast<double>(kSubcells * (at.length - at.steps)),
                                  line.target(), static_cast<double>(kSubcells * at.steps)};
        return visit(SightCrossing{at, terms});
      },
      range);
}
template <class Visit>
void visit_sight(const SightLine& line, int axis, const Visit& visit, const LineRange& range = {}) {
  visit_sight(
      line, axis, visit, [](const Crossing&) {}, range);
}

}  // namespace scarp
