// SPDX-License-Identifier: MIT
// Terrain function instructions in vectors, a segment per lane: on plain numbers, on the Taylor models of
// function_taylor.h, and on these with their derivative along the segment (function_jet.h). The same operations in the
// same order, so results are bit-identical; where scalar code branches, lanes are blended. Rare instructions with many
// branches run as scalar code, lane by lane. Compiled once per instruction set.
#if defined(SCARP_MARCH_FUNCTION_SIMD_TAYLOR_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SCARP_MARCH_FUNCTION_SIMD_TAYLOR_H
#undef SCARP_MARCH_FUNCTION_SIMD_TAYLOR_H
#else
#define SCARP_MARCH_FUNCTION_SIMD_TAYLOR_H
#endif

#include "hwy/highway.h"
#include "scarp/field/function_run.h"
#include "scarp/march/function/function_simd_noise.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

using function::kSlack;

HWY_INLINE V vmax(V a, V b) { return hn::Max(a, b); }
HWY_INLINE V vmin(V a, V b) { return hn::Min(a, b); }
HWY_INLINE V vabs(V a) { return hn::Abs(a); }
HWY_INLINE V scaled(double k, V a) { return hn::Mul(set(k), a); }
HWY_INLINE V pick(M m, V yes, V no) { return hn::IfThenElse(m, yes, no); }

// --- plain numbers ---------------------------------------------------------------------------------------------------

HWY_INLINE V combine(double k0, V a, double k1, V b, double k2) {
  return hn::Add(hn::Add(scaled(k0, a), scaled(k1, b)), set(k2));
}
HWY_INLINE V turned_place(double k0, V a, double k1, V b) { return hn::Add(scaled(k0, a), scaled(k1, b)); }
HWY_INLINE V multiply(V a, V b) { return hn::Mul(a, b); }
HWY_INLINE V square(V a) { return hn::Mul(a, a); }
HWY_INLINE V absolute(V a) { return vabs(a); }
HWY_INLINE V clamp(V a, double low, double high) { return vmin(vmax(a, set(low)), set(high)); }
HWY_INLINE V minimum(V a, V b) { return vmin(a, b); }
HWY_INLINE V maximum(V a, V b) { return vmax(a, b); }
HWY_INLINE V reciprocal(V a) { return hn::Div(set(1), a); }
HWY_INLINE void set_constant(V& out, double k) { out = set(k); }

// --- Taylor models ---------------------------------------------------------------------------------------------------

struct VT {
  V mid, slope, rest, low, high, error;
};

HWY_INLINE V reach_of(const VT& t) { return hn::Mul(hn::Add(t.rest, vabs(t.slope)), set(1 + kSlack)); }
HWY_INLINE V most_of(const VT& t) { return hn::Add(vmax(vabs(t.low), vabs(t.high)), t.error); }
HWY_INLINE VT pick(M m, const VT& a, const VT& b) {
  return {pick(m, a.mid, b.mid), pick(m, a.slope, b.slope), pick(m, a.rest, b.rest),
          pick(m, a.low, b.low), pick(m, a.high, b.high),   pick(m, a.error, b.error)};
}

HWY_INLINE void settle(VT& t) {
  const V reach = reach_of(t), slack = scaled(kSlack, hn::Add(vabs(t.mid), reach));
  t.low = vmax(t.low, hn::Sub(hn::Sub(t.mid, reach), slack));
  t.high = vmin(t.high, hn::Add(hn::Add(t.mid, reach), slack));
  const V half = hn::Mul(scaled(0.5, hn::Sub(t.high, t.low)), set(1 + kSlack));
  const M narrower = hn::Le(half, t.rest);
  t.mid = pick(narrower, scaled(0.5, hn::Add(t.low, t.high)), t.mid);
  t.slope = hn::IfThenZeroElse(narrower, t.slope);
  t.rest = pick(narrower, hn::Add(half, scaled(kSlack, vabs(t.mid))), t.rest);
}
HWY_INLINE VT from_range(V low, V high, V error) {
  VT t;
  t.low = low, t.high = high, t.error = error;
  t.mid = scaled(0.5, hn::Add(low, high));
  t.slope = zero();
  t.rest = hn::Add(hn::Mul(scaled(0.5, hn::Sub(high, low)), set(1 + kSlack)), scaled(kSlack, vabs(t.mid)));
  return t;
}
HWY_INLINE VT constant_model(V k) { return {k, zero(), zero(), k, k, zero()}; }
HWY_INLINE void set_constant(VT& out, double k) { out = constant_model(set(k)); }

HWY_INLINE VT combine(double k0, const VT& a, double k1, const VT& b, double k2) {
  VT t;
  const double ka = std::abs(k0), kb = std::abs(k1);
  const V most_2 = set(std::abs(k2));
  t.mid = combine(k0, a.mid, k1, b.mid, k2);
  t.slope = hn::Add(scaled(k0, a.slope), scaled(k1, b.slope));
  const V size_mid = hn::Add(
      hn::Add(scaled(ka, hn::Add(vabs(a.mid), reach_of(a))), scaled(kb, hn::Add(vabs(b.mid), reach_of(b)))), most_2);
  t.rest = hn::Add(hn::Add(scaled(ka, a.rest), scaled(kb, b.rest)), scaled(kSlack, size_mid));
  const V size = hn::Add(hn::Add(scaled(ka, most_of(a)), scaled(kb, most_of(b))), most_2);
  const V slack = scaled(kSlack, size);
  t.low = hn::Sub(combine(k0, k0 < 0 ? a.high : a.low, k1, k1 < 0 ? b.high : b.low, k2), slack);
  t.high = hn::Add(combine(k0, k0 < 0 ? a.low : a.high, k1, k1 < 0 ? b.low : b.high, k2), slack);
  t.error = hn::Add(hn::Add(scaled(ka, a.error), scaled(kb, b.error)), slack);
  settle(t);
  return t;
}
HWY_INLINE VT negative(const VT& a) { return combine(-1, a, 0, a, 0); }

HWY_INLINE VT turned_place(double k0, const VT& a, double k1, const VT& b) {
  VT t;
  const double ka = std::abs(k0), kb = std::abs(k1);
  t.mid = hn::Add(scaled(k0, a.mid), scaled(k1, b.mid));
  t.slope = hn::Add(scaled(k0, a.slope), scaled(k1, b.slope));
  const V slack = scaled(kSlack, hn::Add(scaled(ka, hn::Add(hn::Add(vabs(a.mid), reach_of(a)), a.error)),
                                         scaled(kb, hn::Add(hn::Add(vabs(b.mid), reach_of(b)), b.error))));
  t.rest = hn::Add(hn::Add(scaled(ka, a.rest), scaled(kb, b.rest)), slack);
  const V reach = hn::Add(reach_of(t), slack);
  t.low = hn::Sub(t.mid, reach), t.high = hn::Add(t.mid, reach);
  t.error = hn::Add(hn::Add(scaled(ka, a.error), scaled(kb, b.error)), slack);
  return t;
}

HWY_INLINE VT multiply(const VT& a, const VT& b) {
  VT t;
  const V ra = reach_of(a), rb = reach_of(b), ma = vabs(a.mid), mb = vabs(b.mid);
  t.mid = hn::Mul(a.mid, b.mid);
  t.slope = hn::Add(hn::Mul(a.mid, b.slope), hn::Mul(b.mid, a.slope));
  t.rest = hn::Add(hn::Add(hn::Add(hn::Mul(ma, b.rest), hn::Mul(mb, a.rest)), hn::Mul(ra, rb)),
                   hn::Mul(scaled(kSlack, hn::Add(ma, ra)), hn::Add(mb, rb)));
  const V size = hn::Mul(most_of(a), most_of(b)), slack = scaled(kSlack, size);
  const V p = hn::Mul(a.low, b.low), q = hn::Mul(a.low, b.high);
  const V r = hn::Mul(a.high, b.low), s = hn::Mul(a.high, b.high);
  t.low = hn::Sub(vmin(vmin(p, q), vmin(r, s)), slack);
  t.high = hn::Add(vmax(vmax(p, q), vmax(r, s)), slack);
  t.error = hn::Add(hn::Add(hn::Mul(most_of(a), b.error), hn::Mul(most_of(b), a.error)), slack);
  settle(t);
  return t;
}

HWY_INLINE VT composed(const VT& a, V f, V f1, V f2, V low, V high, V error) {
  VT t;
  const V reach = reach_of(a), steep = vabs(f1);
  const V second = hn::Mul(hn::Mul(scaled(0.5, f2), reach), reach);
  t.mid = f;
  t.slope = hn::Mul(f1, a.slope);
  t.rest = hn::Add(hn::Add(hn::Mul(steep, a.rest), second),
                   scaled(kSlack, hn::Add(hn::Add(vabs(f), hn::Mul(hn::Add(steep, f2), reach)), second)));
  t.low = low, t.high = high, t.error = error;
  settle(t);
  return t;
}
HWY_INLINE VT square(const VT& a) {
  const V low2 = hn::Mul(a.low, a.low), high2 = hn::Mul(a.high, a.high);
  const V most = vmax(low2, high2);
  const M around = hn::And(hn::Le(a.low, zero()), hn::Ge(a.high, zero()));
  const V least = hn::IfThenZeroElse(around, vmin(low2, high2));
  const V slack = scaled(kSlack, hn::Add(most, hn::Mul(a.error, a.error)));
  return composed(a, hn::Mul(a.mid, a.mid), scaled(2, a.mid), set(2), hn::Sub(least, slack), hn::Add(most, slack),
                  hn::Add(hn::Mul(scaled(2, most_of(a)), a.error), slack));
}
HWY_INLINE VT absolute(const VT& a) {
  const VT both = from_range(zero(), vmax(hn::Neg(a.low), a.high), a.error);
  return pick(hn::Ge(a.low, zero()), a, pick(hn::Le(a.high, zero()), negative(a), both));
}
HWY_INLINE VT clamp(const VT& a, double low, double high) {
  const M inside = hn::And(hn::Ge(a.low, set(low)), hn::Le(a.high, set(high)));
  return pick(inside, a, from_range(clamp(a.low, low, high), clamp(a.high, low, high), a.error));
}
HWY_INLINE VT minimum(const VT& a, const VT& b) {
  VT t = combine(0.5, combine(1, a, 1, b, 0), -0.5, absolute(combine(1, a, -1, b, 0)), 0);
  t.low = vmax(t.low, vmin(a.low, b.low));
  t.high = vmin(t.high, vmin(a.high, b.high));
  settle(t);
  t = pick(hn::Le(a.high, b.low), a, pick(hn::Le(b.high, a.low), b, t));
  t.error = vmax(a.error, b.error);
  return t;
}
HWY_INLINE VT maximum(const VT& a, const VT& b) {
  return combine(-1, minimum(negative(a), combine(-1, b, 0, b, 0)), 0, a, 0);
}
HWY_INLINE VT reciprocal(const VT& a) {
  const V one = set(1), low = hn::Div(one, a.high), high = hn::Div(one, a.low), slack = scaled(kSlack, high);
  const V f2 = hn::Mul(hn::Mul(hn::Mul(scaled(2, high), high), high), set(1 + kSlack));
  const V error = hn::Add(hn::Mul(hn::Mul(hn::Mul(a.error, high), high), set(1 + kSlack)), slack);
  return composed(a, hn::Div(one, a.mid), hn::Div(set(-1), hn::Mul(a.mid, a.mid)), f2, hn::Sub(low, slack),
                  hn::Add(high, slack), error);
}

HWY_INLINE V length_of(V a, V b) { return hn::Sqrt(hn::Add(hn::Mul(a, a), hn::Mul(b, b))); }

HWY_INLINE VT derivative_over(const VT& a, const VT& b, V r, V d, V dx, V dy, V most, V first, V second, V rounding) {
  VT t;
  t.mid = d;
  t.slope = hn::Add(hn::Mul(dx, a.slope), hn::Mul(dy, b.slope));
  const V curved = hn::Mul(hn::Mul(hn::Mul(scaled(0.5, second), r), r), set(1 + kSlack));
  t.rest = hn::Add(hn::Add(hn::Add(hn::Mul(vabs(dx), a.rest), hn::Mul(vabs(dy), b.rest)), curved),
                   hn::Mul(hn::Add(rounding, scaled(kSlack, first)), hn::Add(set(1), r)));
  const V away = hn::Add(hn::Mul(hn::Mul(first, r), set(1 + kSlack)), rounding);
  t.low = vmax(hn::Neg(most), hn::Sub(d, away)), t.high = vmin(most, hn::Add(d, away));
  t.error = hn::Add(hn::Mul(first, hn::Add(a.error, b.error)), rounding);
  settle(t);
  return t;
}

HWY_INLINE VT value_over(const VT& a, const VT& b, V r, const VNoise& jet, const NoiseBound& bound, V hessian,
                         V curvature, V rounding) {
  const V sx = a.slope, sy = b.slope, xx = hn::Mul(sx, sx), yy = hn::Mul(sy, sy);
  const V q = hn::Add(hn::Add(hn::Mul(xx, jet.xx), hn::Mul(hn::Mul(scaled(2, sx), sy), jet.xy)), hn::Mul(yy, jet.yy));
  const V half = hn::Sqrt(hn::Add(xx, yy)), off = length_of(a.rest, b.rest);
  const V bent =
      hn::Add(hn::Add(scaled(0.25, vabs(q)), hn::Mul(hn::Mul(hessian, off), hn::Add(half, scaled(0.5, off)))),
              hn::Mul(hn::Mul(scaled(bound.third / 6, r), r), r));
  const V plain = hn::Mul(hn::Mul(scaled(0.5, curvature), r), r);
  const M is_bent = hn::Lt(bent, plain);
  VT t;
  t.mid = hn::Add(jet.n, hn::IfThenElseZero(is_bent, scaled(0.25, q)));
  t.slope = hn::Add(hn::Mul(jet.x, sx), hn::Mul(jet.y, sy));
  t.rest = hn::Add(hn::Add(hn::Add(hn::Mul(vabs(jet.x), a.rest), hn::Mul(vabs(jet.y), b.rest)),
                           hn::Mul(pick(is_bent, bent, plain), set(1 + kSlack))),
                   scaled(3, hn::Add(rounding, set(kSlack * (bound.slope + bound.curvature)))));
  const V height = set(bound.height), slope = set(bound.slope);
  const V away = hn::Add(hn::Mul(hn::Mul(slope, r), set(1 + kSlack)), rounding);
  t.low = vmax(hn::Neg(height), hn::Sub(jet.n, away)), t.high = vmin(height, hn::Add(jet.n, away));
  t.error = hn::Add(hn::Mul(slope, hn::Add(a.error, b.error)), rounding);
  settle(t);
  return t;
}

// Noise over a segment, with its derivatives in x and y if requested.
struct VNoiseOver {
  VT n, x, y;
};
template <bool slopes>
HWY_INLINE VNoiseOver noise_over(const Directions& directions, const FunctionInstruction& in, const VT& a,
                                 const VT& b) {
  const NoiseBound bound = bound_of(in.kind);
  V reach = set(1);
  if (in.kind == NoiseKind::simplex) reach = hn::Add(hn::Add(set(1), most_of(a)), most_of(b));
  const V rounding = scaled(0x1p-53 * 72 * (bound.height + bound.slope + bound.curvature), reach);
  const V moved = hn::Add(a.error, b.error);
  const V r = hn::Mul(hn::Add(length_of(a.rest, b.rest), length_of(a.slope, b.slope)), set(1 + kSlack));
  const M coarse = hn::Ge(hn::Mul(scaled(bound.curvature, r), r), set(2 * bound.height));
  VNoiseOver far;
  const V height = set(bound.height), slope = set(bound.slope);
  far.n = from_range(hn::Neg(height), height, hn::Add(hn::Mul(slope, moved), rounding));
  if constexpr (slopes) {
    far.x = far.y = from_range(hn::Neg(slope), slope, hn::Add(scaled(bound.curvature, moved), rounding));
  }
  if (hn::AllTrue(dd, coarse)) return far;
  const VNoise jet = noise_at<true>(directions, in.kind, in.seed, a.mid, b.mid);
  const V size = hn::Add(hn::Add(hn::Mul(jet.xx, jet.xx), hn::Mul(scaled(2, jet.xy), jet.xy)), hn::Mul(jet.yy, jet.yy));
  const V third = set(bound.third);
  const V hessian = hn::Mul(hn::Sqrt(size), set(1 + kSlack));
  const V curvature = vmin(set(bound.curvature), hn::Add(hn::Add(hessian, hn::Mul(third, r)), rounding));
  VNoiseOver out;
  out.n = pick(coarse, far.n, value_over(a, b, r, jet, bound, hessian, curvature, rounding));
  if constexpr (slopes) {
    out.x = derivative_over(a, b, r, jet.x, jet.xx, jet.xy, slope, curvature, third, rounding);
    out.y = derivative_over(a, b, r, jet.y, jet.xy, jet.yy, slope, curvature, third, rounding);
    out.x.error = out.y.error = hn::Add(scaled(bound.curvature, moved), rounding);
    out.x = pick(coarse, far.x, out.x), out.y = pick(coarse, far.y, out.y);
  }
  return out;
}

// --- Taylor models with their derivative -----------------------------------------------------------------------------

struct VJ {
  VT v, d;
};

HWY_INLINE void set_constant(VJ& out, double k) { out = {constant_model(set(k)), constant_model(zero())}; }
HWY_INLINE VJ combine(double k0, const VJ& a, double k1, const VJ& b, double k2) {
  return {combine(k0, a.v, k1, b.v, k2), combine(k0, a.d, k1, b.d, 0)};
}
HWY_INLINE VJ turned_place(double k0, const VJ& a, double k1, const VJ& b) {
  return {turned_place(k0, a.v, k1, b.v), combine(k0, a.d, k1, b.d, 0)};
}
HWY_INLINE VJ chained(const VT& v, const VT& fa, const VT& da, const VT& fb, const VT& db) {
  return {v, combine(1, multiply(fa, da), 1, multiply(fb, db), 0)};
}
HWY_INLINE VJ multiply(const VJ& a, const VJ& b) { return chained(multiply(a.v, b.v), b.v, a.d, a.v, b.d); }
HWY_INLINE VJ square(const VJ& a) { return {square(a.v), multiply(combine(2, a.v, 0, a.v, 0), a.d)}; }
// `first` or `second` where the order is known, otherwise a bound of both.
HWY_INLINE VT chosen(M is_first, M is_second, const VT& first, const VT& second) {
  const VT both =
      from_range(vmin(first.low, second.low), vmax(first.high, second.high), vmax(first.error, second.error));
  return pick(is_first, first, pick(is_second, second, both));
}
HWY_INLINE VJ absolute(const VJ& a) {
  return {absolute(a.v), chosen(hn::Ge(a.v.low, zero()), hn::Le(a.v.high, zero()), a.d, negative(a.d))};
}
HWY_INLINE VJ clamp(const VJ& a, double low, double high) {
  const VT still = constant_model(zero());
  const VT above = chosen(hn::Le(set(low), a.v.low), hn::Le(a.v.high, set(low)), a.d, still);
  return {clamp(a.v, low, high), chosen(hn::Le(a.v.high, set(high)), hn::Le(set(high), a.v.low), above, still)};
}
HWY_INLINE VJ minimum(const VJ& a, const VJ& b) {
  return {minimum(a.v, b.v), chosen(hn::Le(a.v.high, b.v.low), hn::Le(b.v.high, a.v.low), a.d, b.d)};
}
HWY_INLINE VJ maximum(const VJ& a, const VJ& b) {
  return {maximum(a.v, b.v), chosen(hn::Le(b.v.high, a.v.low), hn::Le(a.v.high, b.v.low), a.d, b.d)};
}
HWY_INLINE VJ reciprocal(const VJ& a) {
  const VT v = reciprocal(a.v);
  return {v, multiply(combine(-1, square(v), 0, v, 0), a.d)};
}

// --- by the scalar code, lane by lane --------------------------------------------------------------------------------

template <class Number>
struct Spilled;
template <>
struct Spilled<V> {
  using Scalar = double;
  alignas(64) double k[N];
  explicit Spilled(V v) { hn::Store(v, dd, k); }
  Spilled() = default;
  double operator[](std::size_t i) const { return k[i]; }
  void put(std::size_t i, double x) { k[i] = x; }
  V vector() const { return hn::Load(dd, k); }
};
template <>
struct Spilled<VT> {
  using Scalar = function::Taylor<1>;
  Spilled<V> mid, slope, rest, low, high, error;
  explicit Spilled(const VT& t) : mid(t.mid), slope(t.slope), rest(t.rest), low(t.low), high(t.high), error(t.error) {}
  Spilled() = default;
  Scalar operator[](std::size_t i) const {
    Scalar t;
    t.mid = mid[i], t.slope[0] = slope[i], t.rest = rest[i], t.low = low[i], t.high = high[i], t.error = error[i];
    return t;
  }
  void put(std::size_t i, const Scalar& t) {
    mid.put(i, t.mid), slope.put(i, t.slope[0]), rest.put(i, t.rest);
    low.put(i, t.low), high.put(i, t.high), error.put(i, t.error);
  }
  VT vector() const {
    return {mid.vector(), slope.vector(), rest.vector(), low.vector(), high.vector(), error.vector()};
  }
};
template <>
struct Spilled<VJ> {
  using Scalar = function::Jet<function::Taylor<1>, 1>;
  Spilled<VT> v, d;
  explicit Spilled(const VJ& j) : v(j.v), d(j.d) {}
  Spilled() = default;
  Scalar operator[](std::size_t i) const { return {v[i], {d[i]}}; }
  void put(std::size_t i, const Scalar& j) { v.put(i, j.v), d.put(i, j.d[0]); }
  VJ vector() const { return {v.vector(), d.vector()}; }
};

// out = body(a, b) in each lane.
template <class Number, class Body>
HWY_INLINE Number lane_by_lane(const Number& a, const Number& b, const Body& body) {
  const Spilled<Number> from_a(a), from_b(b);
  Spilled<Number> out;
  for (std::size_t i = 0; i < N; ++i) out.put(i, body(from_a[i], from_b[i]));
  return out.vector();
}

// --- noise, and the program ------------------------------------------------------------------------------------------

HWY_INLINE V noise_value(const Directions& directions, const FunctionInstruction& in, const V& a, const V& b) {
  return noise_at<false>(directions, in.kind, in.seed, a, b).n;
}
HWY_INLINE VT noise_value(const Directions& directions, const FunctionInstruction& in, const VT& a, const VT& b) {
  return noise_over<false>(directions, in, a, b).n;
}
HWY_INLINE VJ noise_value(const Directions& directions, const FunctionInstruction& in, const VJ& a, const VJ& b) {
  const VNoiseOver over = noise_over<true>(directions, in, a.v, b.v);
  return chained(over.n, over.x, a.d, over.y, b.d);
}
HWY_INLINE void noise_slope(const Directions& directions, const FunctionInstruction& in, const V& a, const V& b, V& n,
                            V& x, V& y) {
  const VNoise jet = noise_at<true>(directions, in.kind, in.seed, a, b);
  n = jet.n, x = jet.x, y = jet.y;
}
HWY_INLINE void noise_slope(const Directions& directions, const FunctionInstruction& in, const VT& a, const VT& b,
                            VT& n, VT& x, VT& y) {
  const VNoiseOver over = noise_over<true>(directions, in, a, b);
  n = over.n, x = over.x, y = over.y;
}
HWY_INLINE void noise_slope(const Directions&, const FunctionInstruction& in, const VJ& a, const VJ& b, VJ& n, VJ& x,
                            VJ& y) {
  const Spilled<VJ> from_a(a), from_b(b);
  Spilled<VJ> out, out_x, out_y;
  for (std::size_t i = 0; i < N; ++i) {
    Spilled<VJ>::Scalar ni, xi, yi;
    function::noise_slope(in, from_a[i], from_b[i], ni, xi, yi);
    out.put(i, ni), out_x.put(i, xi), out_y.put(i, yi);
  }
  n = out.vector(), x = out_x.vector(), y = out_y.vector();
}

template <class Number>
HWY_NOINLINE Number run(const Directions& directions, const FunctionProgram& program, const Number& x,
                        const Number& y) {
  using Scalar = typename Spilled<Number>::Scalar;
  Number r[kFunctionRegisters];
  r[0] = x, r[1] = y;
  for (const FunctionInstruction& in : program.code) {
    const Number &a = r[in.a], &b = r[in.b];
    Number& out = r[in.out];
    switch (in.op) {
      case FunctionOp::constant:
        set_constant(out, in.k0);
        break;
      case FunctionOp::combine:
        out = combine(in.k0, a, in.k1, b, in.k2);
        break;
      case FunctionOp::turn: {
        const Number turned = turned_place(in.k0, a, -in.k1, b);
        r[in.out_x] = turned_place(in.k1, a, in.k0, b);
        r[in.out] = turned;
        break;
      }
      case FunctionOp::multiply:
        out = multiply(a, b);
        break;
      case FunctionOp::square:
        out = square(a);
        break;
      case FunctionOp::absolute:
        out = absolute(a);
        break;
      case FunctionOp::clamp:
        out = clamp(a, in.k0, in.k1);
        break;
      case FunctionOp::sine:
        out = lane_by_lane(a, b, [](const Scalar& p, const Scalar&) { return function::sine(p); });
        break;
      case FunctionOp::minimum:
        out = minimum(a, b);
        break;
      case FunctionOp::maximum:
        out = maximum(a, b);
        break;
      case FunctionOp::smooth_minimum:
        out =
            lane_by_lane(a, b, [&](const Scalar& p, const Scalar& q) { return function::smooth_minimum(p, q, in.k0); });
        break;
      case FunctionOp::reciprocal:
        out = reciprocal(a);
        break;
      case FunctionOp::noise:
        out = noise_value(directions, in, a, b);
        break;
      case FunctionOp::noise_slope:
        noise_slope(directions, in, a, b, out, r[in.out_x], r[in.out_y]);
        break;
      case FunctionOp::terrace:
        out = lane_by_lane(a, b, [&](const Scalar& p, const Scalar&) { return function::terrace(p, in.k0, in.k1); });
        break;
      case FunctionOp::radial:
        out = lane_by_lane(a, b, [&](const Scalar& p, const Scalar& q) { return function::radial(p, q, in); });
        break;
    }
  }
  return r[program.result];
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#endif
