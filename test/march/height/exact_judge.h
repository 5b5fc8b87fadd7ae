// SPDX-License-Identifier: MIT
// The hits of a ray in rational arithmetic: nothing is rounded, so ties are exact. For small fields.
//
// The chain of cells, the definition of a hit and the order of ties are those of ray.h, height_field.h and
// doc/dev/numerics.md; nothing here is shared with the marches. Signs are exact. An irrational root is not computed: it
// is compared with rationals, by signs.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <vector>

#include "scarp/field/height_field.h"

namespace scarp::test {

using Rational = boost::multiprecision::cpp_rational;

/// A hit: where f(t - begin) = (a s + b) s + c, the clearance, falls to zero in [begin, end]; at `begin` for walls and
/// for touches there.
struct ExactHit {
  Rational begin, end, a, b, c;
  bool at_begin = false;
  bool wall = false;

  /// Whether the hit is at t or before.
  bool not_after(const Rational& t) const;
  /// Whether the hit is within `tolerance` > 0 of t.
  bool is_at(double t, double tolerance) const;
};

struct ExactAnswer {
  HitStatus status = HitStatus::miss;
  std::vector<ExactHit> hits;  ///< in order of t
};

/// All hits of a ray. Its range must be finite if the field wraps.
ExactAnswer cast_exactly(const HeightField& field, const Ray& ray);

}  // namespace scarp::test
