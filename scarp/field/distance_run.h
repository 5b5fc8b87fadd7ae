// SPDX-License-Identifier: MIT
// Interpreter for the program of a shape, at positions (PointMode, here), with gradients, or over ray segments
// (distance_local.h). A mode defines positions, values and the effect of each instruction.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "scarp/field/distance_program.h"
#include "scarp/field/distance_solids.h"

namespace scarp::distance {

template <class Value>
struct Result {
  Value value;
  std::uint16_t material;
};

template <class Mode>
Result<typename Mode::Value> run(const DistanceProgram& program, const Mode& mode,
                                 const typename Mode::Position& start) {
  typename Mode::Position p[kDistancePositions];
  typename Mode::Value v[kDistanceValues];
  std::uint16_t material[kDistanceValues];
  p[0] = start;
  material[0] = 0;
  const DistanceInstruction* const end = program.code.data() + program.code.size();
  for (const DistanceInstruction* at = program.code.data(); at < end; ++at) {
    const DistanceInstruction& in = *at;
    const double* const k = program.numbers.data() + in.number;
    const auto solid = [&]<DistanceOp op>() {
      v[in.out] = mode.template solid<op>(program, in, k, p[in.a]);
      material[in.out] = in.material;
    };
    const auto combined = [&](bool first) { material[in.out] = material[first ? in.a : in.b]; };
    switch (in.op) {
      case DistanceOp::turn:
        mode.turn(p[in.a], k, p[in.out]);
        break;
      case DistanceOp::fold:
        mode.fold(p[in.a], k, p[in.out]);
        break;
      case DistanceOp::neighbour:
        mode.neighbour(p[in.a], k, in.mask, p[in.out]);
        break;
      case DistanceOp::sphere:
        solid.template operator()<DistanceOp::sphere>();
        break;
      case DistanceOp::box:
        solid.template operator()<DistanceOp::box>();
        break;
      case DistanceOp::plane:
        solid.template operator()<DistanceOp::plane>();
        break;
      case DistanceOp::capsule:
        solid.template operator()<DistanceOp::capsule>();
        break;
      case DistanceOp::cylinder:
        solid.template operator()<DistanceOp::cylinder>();
        break;
      case DistanceOp::cone:
        solid.template operator()<DistanceOp::cone>();
        break;
      case DistanceOp::torus:
        solid.template operator()<DistanceOp::torus>();
        break;
      case DistanceOp::ellipsoid:
        solid.template operator()<DistanceOp::ellipsoid>();
        break;
      case DistanceOp::function_ground:
        solid.template operator()<DistanceOp::function_ground>();
        break;
      case DistanceOp::field_ground:
        solid.template operator()<DistanceOp::field_ground>();
        break;
      case DistanceOp::unite:
      case DistanceOp::smooth_unite:
        combined(mode.first_is_less(v[in.a], v[in.b]));
        v[in.out] =
            in.op == DistanceOp::unite ? mode.minimum(v[in.a], v[in.b]) : mode.smooth_minimum(v[in.a], v[in.b], k[0]);
        break;
      case DistanceOp::intersect:
      case DistanceOp::smooth_intersect:
      case DistanceOp::subtract:
      case DistanceOp::smooth_subtract: {
        // max(a, b) = -min(-a, -b); subtraction intersects with the complement of b.
        const bool cut = in.op == DistanceOp::subtract || in.op == DistanceOp::smooth_subtract;
        const bool smooth = in.op == DistanceOp::smooth_intersect || in.op == DistanceOp::smooth_subtract;
        const auto a = mode.negative(v[in.a]), b = cut ? v[in.b] : mode.negative(v[in.b]);
        combined(mode.first_is_less(a, b));
        v[in.out] = mode.negative(smooth ? mode.smooth_minimum(a, b, k[0]) : mode.minimum(a, b));
        break;
      }
      case DistanceOp::clamp:
        v[in.out] = mode.clamp(v[in.a], p[in.b], k);
        material[in.out] = material[in.a];
        break;
      case DistanceOp::rest_bound:
        v[in.out] = mode.rest_bound(v[in.a], p[in.b], k, in.mask);
        material[in.out] = material[in.a];
        break;
      case DistanceOp::skip_far:
        if (mode.is_far(in.mask ? mode.negative(v[in.a]) : v[in.a], p[in.b], k)) at += in.index;
        break;
      case DistanceOp::skip_copy:
        if (mode.copy_is_far(v[in.a], p[in.b], k, in.mask)) at += in.index;
        break;
    }
  }
  return {v[0], material[0]};
}

/// Clamps to the reach of terrain functions; the ground is constant beyond it.
inline dvec3 within_reach(const dvec3& q) {
  return {std::clamp(q.x, -kFunctionReach, kFunctionReach), std::clamp(q.y, -kFunctionReach, kFunctionReach), q.z};
}
/// Scaled height above a field's ground, including its walls, at a position in the field's frame, with x and y clamped
/// to the field. `holes` as in FieldGround.
double field_ground_value(const HeightField& field, const HeightField* holes, const dvec3& q, double shrink);

/// Evaluates positions and values without derivatives.
template <class T>
struct PointMode {
  using Position = Vec<T>;
  using Value = T;

  void turn(const Position& p, const double* k, Position& out) const {
    const Position q(p.x - T(k[0]), p.y - T(k[1]), p.z - T(k[2]));
    for (int row = 0; row < 3; ++row) {
      const double* const m = k + 3 + 3 * row;
      out[row] = T(m[0]) * q.x + T(m[1]) * q.y + T(m[2]) * q.z;
    }
  }
  void fold(const Position& p, const double* k, Position& out) const { out = folded(p, k); }
  void neighbour(const Position& p, const double* k, int mask, Position& out) const { out = folded_next(p, k, mask); }

  template <DistanceOp op>
  Value solid(const DistanceProgram& program, const DistanceInstruction& in, const double* k, const Position& p) const {
    if constexpr (op == DistanceOp::plane) {
      return plane(p, k);
    } else {
      const Position q(p.x - T(k[0]), p.y - T(k[1]), p.z - T(k[2]));
      k += 3;
      if constexpr (op == DistanceOp::sphere) {
        return sphere(q, k);
      } else if constexpr (op == DistanceOp::box) {
        return box(q, k);
      } else if constexpr (op == DistanceOp::capsule) {
        return capsule(q, k);
      } else if constexpr (op == DistanceOp::cylinder) {
        return cylinder(q, k);
      } else if constexpr (op == DistanceOp::cone) {
        return cone(q, k);
      } else if constexpr (op == DistanceOp::torus) {
        return torus(q, k);
      } else if constexpr (op == DistanceOp::ellipsoid) {
        return ellipsoid(q, k);
      } else {
        const double scale = k[0], shrink = k[1];
        const dvec3 local = dvec3(q) / scale;
        if constexpr (op == DistanceOp::function_ground) {
          const dvec3 at = within_reach(local);
          return T((at.z - program.functions[in.index]->value(at.x, at.y)) * shrink * scale);
        } else {
          static_assert(op == DistanceOp::field_ground);
          return T(field_ground_value(*program.fields[in.index], program.holes[in.index].get(), local, shrink) * scale);
        }
      }
    }
  }

  bool first_is_less(Value a, Value b) const { return a <= b; }
  Value negative(Value a) const { return -a; }
  Value minimum(Value a, Value b) const { return std::min(a, b); }
  Value smooth_minimum(Value a, Value b, double radius) const { return distance::smooth_minimum(a, b, T(radius)); }
  // Inside the box the distance to it is negative and does not exceed the value.
  Value clamp(Value a, const Position& p, const double* k) const {
    const T away = outside(p, k);
    return away > 0 ? std::max(a, away) : a;
  }
  Value rest_bound(Value a, const Position& p, const double* k, int mask) const {
    return mask ? a : std::min(a, distance::rest_bound(p, k));
  }
  bool is_far(Value a, const Position& p, const double* k) const {
    const T away = outside(p, k);
    return away > 0 && a <= away - T(k[6]);
  }
  bool copy_is_far(Value a, const Position& p, const double* k, int mask) const {
    const T away = neighbour_bound(p, k, mask);
    return away > 0 && a <= away;
  }
};

}  // namespace scarp::distance
