// SPDX-License-Identifier: MIT
// Evaluates the program of a shape with gradients, and over segments of a ray.
//
//   BentMode   A value is a linear function along the segment and a bound of the deviation (function_taylor.h). A solid
//              provides its value and gradient at the middle, and a bound of its curvature in the ball around the
//              segment: a distance to a convex core has curvature 1 / (distance to the core), a flat face none. If
//              there is a crease in the ball, the only bound is the Lipschitz constant 1.
#pragma once

#include <cmath>
#include <limits>

#include "scarp/field/distance_run.h"
#include "scarp/field/distance_turn.h"
#include "scarp/field/function_taylor.h"

namespace scarp::distance {

/// A distance within a ball: its value and gradient at the centre, and the maximum second derivative in any direction
/// anywhere in the ball; infinite if there may be a crease.
struct Bent {
  double value;
  dvec3 gradient;
  double bend;
};

inline constexpr double kCreased = std::numeric_limits<double>::infinity();

/// Returns the model of a solid at q from its centre, in a ball of radius r.
Bent bent_solid(DistanceOp op, const dvec3& q, const double* k, double r);
/// Returns the model of outside().
Bent bent_outside(const dvec3& p, const double* k, double r);

/// Gradient of field_ground_value().
dvec3 field_ground_gradient(const HeightField& field, const HeightField* holes, const dvec3& q, double shrink);
/// Slope range of field heights from -d to d around a position, as a rate per d.
struct FieldSlope {
  double low, high;
};
FieldSlope field_slope(const HeightField& field, const dvec3& q, const dvec3& d, double slope);

/// Evaluates values with gradients.
struct GradientMode {
  struct Position {
    dvec3 p;
    Turn turn;  // row i: axis i of this frame in world directions
  };
  struct Value {
    double value;
    dvec3 gradient;
  };
  FunctionUse use = FunctionUse::march;

  static dvec3 to_world(const Position& p, const dvec3& g) {
    return g.x * p.turn[0] + g.y * p.turn[1] + g.z * p.turn[2];
  }

  void turn(const Position& p, const double* k, Position& out) const {
    PointMode<double>{}.turn(p.p, k, out.p);
    out.turn = after({dvec3(k[3], k[4], k[5]), dvec3(k[6], k[7], k[8]), dvec3(k[9], k[10], k[11])}, p.turn);
  }
  void fold(const Position& p, const double* k, Position& out) const { out = {folded(p.p, k), p.turn}; }
  void neighbour(const Position& p, const double* k, int mask, Position& out) const {
    out = {folded_next(p.p, k, mask), p.turn};
  }

  template <DistanceOp op>
  Value solid(const DistanceProgram& program, const DistanceInstruction& in, const double* k, const Position& p) const {
    const double value = PointMode<double>{}.solid<op>(program, in, k, p.p);
    if constexpr (op == DistanceOp::function_ground) {
      const dvec3 q = within_reach((p.p - dvec3(k[0], k[1], k[2])) / k[3]);
      const dvec2 slope = program.functions[in.index]->gradient(q.x, q.y, use);
      return {value, to_world(p, k[4] * dvec3(-slope, 1.0))};
    } else if constexpr (op == DistanceOp::field_ground) {
      const dvec3 q = (p.p - dvec3(k[0], k[1], k[2])) / k[3];
      return {value,
              to_world(p, field_ground_gradient(*program.fields[in.index], program.holes[in.index].get(), q, k[4]))};
    } else if constexpr (op == DistanceOp::plane) {
      return {value, to_world(p, {k[0], k[1], k[2]})};
    } else {
      return {value, to_world(p, bent_solid(op, p.p - dvec3(k[0], k[1], k[2]), k + 3, 0).gradient)};
    }
  }

  bool first_is_less(const Value& a, const Value& b) const { return a.value <= b.value; }
  Value negative(const Value& a) const { return {-a.value, -a.gradient}; }
  Value minimum(const Value& a, const Value& b) const { return first_is_less(a, b) ? a : b; }
  Value smooth_minimum(const Value& a, const Value& b, double radius) const {
    const double share = smooth_share(a.value, b.value, radius);
    return {distance::smooth_minimum(a.value, b.value, radius), share * a.gradient + (1 - share) * b.gradient};
  }
  Value clamp(const Value& a, const Position& p, const double* k) const {
    const double away = outside(p.p, k);
    if (!(away > 0 && away > a.value)) return a;
    return {away, to_world(p, bent_outside(p.p, k, 0).gradient)};
  }
  Value rest_bound(const Value& a, const Position& p, const double* k, int mask) const;
  bool is_far(const Value& a, const Position& p, const double* k) const {
    return PointMode<double>{}.is_far(a.value, p.p, k);
  }
  bool copy_is_far(const Value& a, const Position& p, const double* k, int mask) const {
    return PointMode<double>{}.copy_is_far(a.value, p.p, k, mask);
  }
};

/// Evaluates bounds over the segment from p - d to p + d.
struct BentMode {
  struct Position {
    dvec3 p, d;
  };
  struct Value {
    function::Taylor<1> f;
    double rate_low, rate_high;  // bounds of the derivative by s, s in [-1, 1]
  };
  double radius = 0;   // length of d, rounded up
  bool rates = false;  // whether to compute rates

  void turn(const Position& p, const double* k, Position& out) const {
    PointMode<double>{}.turn(p.p, k, out.p);
    out.d = turned({dvec3(k[3], k[4], k[5]), dvec3(k[6], k[7], k[8]), dvec3(k[9], k[10], k[11])}, p.d);
  }
  void fold(const Position& p, const double* k, Position& out) const { out = {folded(p.p, k), p.d}; }
  void neighbour(const Position& p, const double* k, int mask, Position& out) const {
    out = {folded_next(p.p, k, mask), p.d};
  }

  template <DistanceOp op>
  Value solid(const DistanceProgram& program, const DistanceInstruction& in, const double* k, const Position& p) const {
    if constexpr (op == DistanceOp::plane) {
      const dvec3 n(k[0], k[1], k[2]);
      return from_bent({plane(p.p, k), n, 0}, p.d);
    } else if constexpr (op == DistanceOp::function_ground) {
      return function_ground(*program.functions[in.index], k, p);
    } else if constexpr (op == DistanceOp::field_ground) {
      return field_ground(*program.fields[in.index], program.holes[in.index].get(), k, p);
    } else {
      return from_bent(bent_solid(op, p.p - dvec3(k[0], k[1], k[2]), k + 3, radius), p.d);
    }
  }

  bool first_is_less(const Value& a, const Value& b) const { return a.f.mid <= b.f.mid; }
  Value negative(const Value& a) const { return {function::combine(-1, a.f, 0, a.f, 0), -a.rate_high, -a.rate_low}; }
  Value minimum(const Value& a, const Value& b) const;
  Value smooth_minimum(const Value& a, const Value& b, double k) const;
  Value clamp(const Value& a, const Position& p, const double* k) const;
  Value rest_bound(const Value& a, const Position& p, const double* k, int mask) const;
  bool is_far(const Value& a, const Position& p, const double* k) const {
    const double away = outside(p.p, k) - radius;
    return away > 0 && a.f.high <= away - k[6];
  }
  bool copy_is_far(const Value& a, const Position& p, const double* k, int mask) const {
    const double away = neighbour_bound(p.p, k, mask) - radius;
    return away > 0 && a.f.high <= away;
  }

 private:
  Value from_bent(const Bent& bent, const dvec3& d) const;
  Value from_range(double low, double high) const;
  Value function_ground(const HeightFunction& function, const double* k, const Position& p) const;
  Value field_ground(const HeightField& field, const HeightField* holes, const double* k, const Position& p) const;
  Value field_without_holes(const HeightField& field, const double* k, const Position& p) const;
};

}  // namespace scarp::distance
