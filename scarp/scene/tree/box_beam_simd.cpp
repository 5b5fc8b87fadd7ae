// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdint>
#include <limits>

#include "scarp/scene/tree/box_beam.h"

// This file is compiled once for each instruction set.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scarp/scene/tree/box_beam_simd.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h comes first.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<double, 8> dd;
constexpr std::size_t N = hn::MaxLanes(dd);
using VD = hn::Vec<decltype(dd)>;

std::uint64_t bound(const BoxTree::Rays& rays, const WorldBox& box, const dvec3& middle, int axis, double sign,
                    double* start, double* per_t, BeamBounds& bounds) {
  const VD infinity = hn::Set(dd, std::numeric_limits<double>::infinity()), beyond = hn::Neg(infinity);
  const VD zero = hn::Zero(dd), one = hn::Set(dd, 1.0);
  VD low[3], high[3], least[3], most[3];
  for (int i = 0; i < 3; ++i) low[i] = least[i] = infinity, high[i] = most[i] = beyond;
  VD slowest = infinity, last = hn::Set(dd, -1.0);
  std::uint64_t all = 0;
  for (std::size_t o = 0; o < rays.count; o += N) {
    VD t_in = hn::LoadU(dd, rays.t_min + o);
    VD t_out = hn::IfThenElse(hn::FirstN(dd, rays.count - o), hn::LoadU(dd, rays.t_max + o), beyond);
    VD from[3], direction[3];
    for (int i = 0; i < 3; ++i) {
      const VD bottom = hn::Set(dd, box.low[i]), top = hn::Set(dd, box.high[i]);
      from[i] = hn::LoadU(dd, rays.origin[i] + o), direction[i] = hn::LoadU(dd, rays.direction[i] + o);
      const VD inverse = hn::Div(one, direction[i]);
      const VD a = hn::Mul(hn::Sub(bottom, from[i]), inverse), b = hn::Mul(hn::Sub(top, from[i]), inverse);
      const auto level = hn::Eq(direction[i], zero);
      const auto in = hn::And(hn::Ge(from[i], bottom), hn::Le(from[i], top));
      const VD near = hn::IfThenElse(level, hn::IfThenElse(in, beyond, infinity), hn::Min(a, b));
      const VD far = hn::IfThenElse(level, infinity, hn::Max(a, b));
      t_in = hn::Max(t_in, near), t_out = hn::Min(t_out, far);
    }
    const auto inside = hn::Le(t_in, t_out);
    if (hn::AllFalse(dd, inside)) {
      hn::StoreU(zero, dd, start + o), hn::StoreU(zero, dd, per_t + o);
      continue;
    }
    const VD speed = hn::Mul(direction[axis], hn::Set(dd, sign)), per_speed = hn::Div(one, speed);
    slowest = hn::IfThenElse(inside, hn::Min(slowest, speed), slowest);
    last = hn::IfThenElse(inside, hn::Max(last, hn::Mul(hn::Sub(t_out, t_in), speed)), last);
    for (int i = 0; i < 3; ++i) {
      const VD at = hn::Sub(hn::Add(from[i], hn::Mul(t_in, direction[i])), hn::Set(dd, middle[i]));
      const VD slope = hn::Mul(direction[i], per_speed);
      low[i] = hn::IfThenElse(inside, hn::Min(low[i], at), low[i]);
      high[i] = hn::IfThenElse(inside, hn::Max(high[i], at), high[i]);
      least[i] = hn::IfThenElse(inside, hn::Min(least[i], slope), least[i]);
      most[i] = hn::IfThenElse(inside, hn::Max(most[i], slope), most[i]);
    }
    hn::StoreU(hn::IfThenElseZero(inside, t_in), dd, start + o);
    hn::StoreU(hn::IfThenElseZero(inside, speed), dd, per_t + o);
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(dd, inside, bits);
    all |= std::uint64_t{bits[0]} << o;
  }
  for (int i = 0; i < 3; ++i) {
    bounds.low[i] = hn::GetLane(hn::MinOfLanes(dd, low[i])), bounds.high[i] = hn::GetLane(hn::MaxOfLanes(dd, high[i]));
    bounds.least[i] = hn::GetLane(hn::MinOfLanes(dd, least[i]));
    bounds.most[i] = hn::GetLane(hn::MaxOfLanes(dd, most[i]));
  }
  bounds.slowest = hn::GetLane(hn::MinOfLanes(dd, slowest)), bounds.last = hn::GetLane(hn::MaxOfLanes(dd, last));
  return all;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace scarp {
namespace {

HWY_EXPORT(bound);

}  // namespace

std::uint64_t bound_beam(const BoxTree::Rays& rays, const WorldBox& box, const dvec3& middle, int axis, double sign,
                         double* start, double* per_t, BeamBounds& bounds) {
  return HWY_DYNAMIC_DISPATCH(bound)(rays, box, middle, axis, sign, start, per_t, bounds);
}

}  // namespace scarp
#endif
