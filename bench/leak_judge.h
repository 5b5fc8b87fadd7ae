// SPDX-License-Identifier: MIT
// Decides with certainty about one ray in O(1), without a march: whether it must hit, and whether a reported hit can be
// right.
//
// Everything is computed from world coordinates in long double with a 64-bit mantissa, so the judge's own rounding is
// 2^-11 of the marches'. Below, B is the bound on the rounding error of a clearance in a march: 16 u (abs(o_z) +
// abs(d_z t)
// + max abs(sample) + (abs(o_x) + abs(d_x t) + abs(o_y) + abs(d_y t)) (highest - lowest)), doc/dev/numerics.md.
// Decisions within B are not judged. None of the marches' own rules are used.
#pragma once

#include <optional>

#include "bench/leak_fields.h"
#include "scarp/base/ray.h"

namespace scarp::bench {

class LeakJudge {
 public:
  LeakJudge(const LeakField& ground, const Ray& ray);

  /// Whether the ray certainly hits: above the ground by more than B where it starts (or from the surface, which is
  /// above by definition), below it by more than B where it ends, and no hole among the cells that it can touch in
  /// between: the clearance is continuous, so it passes through zero. Or, in solid ground, the ray enters through the
  /// border below the surface. Or it passes from above all ground to below it, and moves so little sideways that
  /// rounding cannot distinguish it from a vertical ray through a point of the ground, borders and rims included.
  bool must_hit() const { return must_hit_; }

  /// Why an answer has lost a hit, or null. A hit is lost if the answer reports no hit, or a hit behind a position
  /// where a ray from above is already below the ground by more than B, with no hole in between. The position is at the
  /// fraction `share` (0..1) of the distance to the hit.
  const char* lost(const Hit& hit, double share) const;

  /// Why a reported hit is false, or null.
  ///  - It is not on the ray: cell, u and v against ray.at(t), by more than the sideways part of B.
  ///  - It is not on the surface: there the clearance is at most 2 B: one B for the signs that decided and one for the
  ///  root (a backward-stable formula gives the exact root for coefficients off by some u of their size).
  ///  - It is an exit from the ground: along the piece of the cell before it, where the clearance is one parabola, the
  ///  ray has risen monotonically from more than 2 B below. If the hit is at the entry of its cell, the previous cell
  ///  counts.
  ///  - The ray starts on the surface and is never strictly below it in that cell, by at least 5/16 B: a hit needs a
  ///  computed clearance below -B, and numerics.md counts 11 of its 16 roundings.
  ///  - It is on a wall, but not at a border or rim, or above the ground there by more than B.
  const char* false_hit(const Hit& hit) const;

  /// Why the status of an answer without a hit is wrong, or null: `below` for a ray that started above by more than B,
  /// `miss` for one that started below by more than B.
  const char* false_status(const Hit& hit) const;

  /// cut_behind() returns a time after a hit, in the hit's cell, at which the ray is below by more than 2 B and has
  /// been falling since the hit: a ray cut there still hits. cut_before() returns a time before the hit from which the
  /// ray has been falling, from more than 2 B above: a ray cut there does not hit, if nothing was hit before. Nullopt
  /// if rounding leaves no room.
  std::optional<double> cut_behind(const Hit& hit) const;
  std::optional<double> cut_before(const Hit& hit) const;

  /// Whether two answers may both be right: the same status and, between the two hits, a ray within 2 B of the surface
  /// at `kProbes` positions.
  bool same(const Hit& a, const Hit& b) const;
  static constexpr int kProbes = 8;

 private:
  using Real = long double;
  // The clearance around a time over one cell (or triangle): f(t + s) = f + b s + a s^2.
  struct Piece {
    Real f, b, a;
  };
  // A cell in the copy of the field that the ray is over.
  struct Place {
    Real col, row;
    CellHeights h;
  };

  Real x(Real t) const { return ox_ + dx_ * t; }
  Real y(Real t) const { return oy_ + dy_ * t; }
  Real z(Real t) const { return oz_ + dz_ * t; }
  Real sideways(Real t) const;
  Real bound(Real t) const;
  Real bound_at_rim(const Hit& hit, const CellHeights& h, Real t, Real off) const;
  Real under(Real t) const;
  void put_on_surface();
  void clip();
  bool hugs_border() const;
  bool stands_on_ground() const;
  Real allowance(int axis) const;
  bool holes_between(Real from, Real to) const;
  std::optional<Place> place_at(Real t) const;
  std::optional<Place> place_of(const Hit& hit) const;
  std::optional<Real> clearance(Real t) const;
  Piece piece(const Place& place, Real t, bool south_east) const;
  bool south_east(const Place& place, Real t) const { return x(t) - place.col + (y(t) - place.row) > 1; }
  Real time_in_cell(const Place& place, Real t, bool back, Real room = 0) const;
  Real risen(const Place& place, Real t, Real length) const;
  Real deepest(const Place& place, Real t) const;

  const LeakField& ground_;
  const HeightField& field_;
  Ray ray_;
  bool triangles_, wraps_, exact_plan_, on_surface_;
  Real ox_, oy_, oz_, dx_, dy_, dz_;  // in cells and sample units
  Real low_, high_, offset_;          // of the samples, in sample units
  Real t0_, t1_;                      // over the field; empty when t0_ > t1_
  Real late_ = 0, early_ = 0;         // bound of the rounding of these
  bool from_outside_ = false, begins_above_ = false;
  std::optional<Real> c0_;  // clearance at t0_
  bool must_hit_ = false;
};

}  // namespace scarp::bench
