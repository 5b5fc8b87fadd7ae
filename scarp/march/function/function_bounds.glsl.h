// SPDX-License-Identifier: MIT
// Bounds of a terrain function along a segment, for shaders: field/function_taylor.h in single precision, including
// rounding errors.
//
// The middle of a position is two floats, because noise depends on the position within its cell; the rest are floats.
// Every operation widens its result by kScarpSlack (16 units) of its float operands and by kScarpTwoSlack of the pairs,
// more than twice the effect of its fewer than 8 roundings and of a division or root accurate to 2.5 units. Noise adds
// its own error (noise.glsl.h). A bound holds for the true function.
//
// Compiles as C++ and GLSL, including GLSL ES 3.0, which lacks `precise`: positions then have float accuracy. The
// including file must define scarp_instruction(), see function_heights.glsl.h.
#ifndef SCARP_MARCH_FUNCTION_BOUNDS_GLSL_H
#define SCARP_MARCH_FUNCTION_BOUNDS_GLSL_H

#include "scarp/march/function/function_heights.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

const float kScarpSlack = 9.5367431640625e-7f;           // 2^-20
const float kScarpTwoSlack = 1.136868377216160297e-13f;  // 2^-43
const float kScarpSteepestFade = 1.875f;

/// Over s in [-1, 1] the true function is within rest of mid + slope s, and between low and high.
struct ScarpBound {
  ScarpTwoFloat mid;
  float slope;
  float rest;
  float low, high;
};

/// Maximum distance of the linear model from its middle.
SCARP_FN float scarp_reach(ScarpBound t) { return (abs(t.slope) + t.rest) * (1.0f + kScarpSlack); }
/// Maximum magnitude in its range.
SCARP_FN float scarp_most(ScarpBound t) { return max(abs(t.low), abs(t.high)); }

/// Intersects low and high with the range of the linear model, and flattens the model if the range is tighter.
SCARP_FN ScarpBound scarp_settled(ScarpBound t) {
  float reach = scarp_reach(t);
  float slack = kScarpSlack * (abs(t.mid.high) + reach);
  ScarpBound out_ = t;
  out_.low = max(t.low, t.mid.high - reach - slack);
  out_.high = min(t.high, t.mid.high + reach + slack);
  float half_ = 0.5f * (out_.high - out_.low) * (1.0f + kScarpSlack);
  if (half_ <= t.rest) {
    out_.mid = scarp_two(0.5f * (out_.low + out_.high));
    out_.slope = 0.0f;
    out_.rest = half_ + kScarpSlack * abs(out_.mid.high);
  }
  return out_;
}
/// A bound given only by a range.
SCARP_FN ScarpBound scarp_range(float low, float high) {
  ScarpBound t;
  t.low = low;
  t.high = high;
  t.mid = scarp_two(0.5f * (low + high));
  t.slope = 0.0f;
  t.rest = 0.5f * (high - low) * (1.0f + kScarpSlack) + kScarpSlack * abs(t.mid.high);
  return t;
}
/// A number that is constant along the segment.
SCARP_FN ScarpBound scarp_exactly(ScarpTwoFloat k) {
  ScarpBound t;
  t.mid = k;
  t.slope = 0.0f;
  t.rest = kScarpTwoSlack * abs(k.high);
  t.low = k.high - kScarpSlack * abs(k.high);
  t.high = k.high + kScarpSlack * abs(k.high);
  return t;
}

/// Bound of k0 a + k1 b + k2, as computed by scarp_two_combine().
SCARP_FN ScarpBound scarp_bound_combine(ScarpTwoFloat k0, ScarpBound a, ScarpTwoFloat k1, ScarpBound b,
                                        ScarpTwoFloat k2) {
  float ka = abs(k0.high);
  float kb = abs(k1.high);
  ScarpBound t;
  t.mid = scarp_two_combine(k0, a.mid, k1, b.mid, k2);
  t.slope = k0.high * a.slope + k1.high * b.slope;
  t.rest = ka * a.rest + kb * b.rest + kScarpSlack * (ka * scarp_reach(a) + kb * scarp_reach(b)) +
           kScarpTwoSlack * (ka * abs(a.mid.high) + kb * abs(b.mid.high) + abs(k2.high));
  float slack = kScarpSlack * (ka * scarp_most(a) + kb * scarp_most(b) + abs(k2.high));
  t.low = k0.high * (k0.high < 0.0f ? a.high : a.low) + k1.high * (k1.high < 0.0f ? b.high : b.low) + k2.high - slack;
  t.high = k0.high * (k0.high < 0.0f ? a.low : a.high) + k1.high * (k1.high < 0.0f ? b.low : b.high) + k2.high + slack;
  return scarp_settled(t);
}
/// Bound of k0 a + k1 b.
SCARP_FN ScarpBound scarp_bound_sum(float k0, ScarpBound a, float k1, ScarpBound b) {
  return scarp_bound_combine(scarp_two(k0), a, scarp_two(k1), b, scarp_two(0.0f));
}
/// Bound of -a.
SCARP_FN ScarpBound scarp_bound_negate(ScarpBound a) {
  ScarpBound t;
  t.mid = scarp_two_negate(a.mid);
  t.slope = -a.slope;
  t.rest = a.rest;
  t.low = -a.high;
  t.high = -a.low;
  return t;
}
/// Bound of k0 a + k1 b of positions, whose linear model is nearly exact.
SCARP_FN ScarpBound scarp_bound_turn(ScarpTwoFloat k0, ScarpBound a, ScarpTwoFloat k1, ScarpBound b) {
  float ka = abs(k0.high);
  float kb = abs(k1.high);
  ScarpBound t;
  t.mid = scarp_two_combine(k0, a.mid, k1, b.mid, scarp_two(0.0f));
  t.slope = k0.high * a.slope + k1.high * b.slope;
  t.rest = ka * a.rest + kb * b.rest + kScarpSlack * (ka * scarp_reach(a) + kb * scarp_reach(b)) +
           kScarpTwoSlack * (ka * abs(a.mid.high) + kb * abs(b.mid.high));
  float reach = scarp_reach(t) + kScarpSlack * (abs(t.mid.high) + scarp_reach(t));
  t.low = t.mid.high - reach;
  t.high = t.mid.high + reach;
  return t;
}

/// Bound of a b.
SCARP_FN ScarpBound scarp_bound_multiply(ScarpBound a, ScarpBound b) {
  float ra = scarp_reach(a);
  float rb = scarp_reach(b);
  float ma = abs(a.mid.high);
  float mb = abs(b.mid.high);
  ScarpBound t;
  t.mid = scarp_two_multiply(a.mid, b.mid);
  t.slope = a.mid.high * b.slope + b.mid.high * a.slope;
  t.rest = ma * b.rest + mb * a.rest + ra * rb + kScarpSlack * (ma * rb + mb * ra + ra * rb) + kScarpTwoSlack * ma * mb;
  float slack = kScarpSlack * scarp_most(a) * scarp_most(b);
  float p = a.low * b.low;
  float q = a.low * b.high;
  float r = a.high * b.low;
  float s = a.high * b.high;
  t.low = min(min(p, q), min(r, s)) - slack;
  t.high = max(max(p, q), max(r, s)) + slack;
  return scarp_settled(t);
}

/// Bound of f(a) from f, accurate to `off`, and f' at a.mid, the maximum of |f''| over the range, and the range of f.
SCARP_FN ScarpBound scarp_bound_composed(ScarpBound a, ScarpTwoFloat f, float off, float f1, float f2, float low,
                                         float high) {
  float reach = scarp_reach(a);
  float bent = 0.5f * f2 * reach * reach;
  ScarpBound t;
  t.mid = f;
  t.slope = f1 * a.slope;
  t.rest = abs(f1) * a.rest + bent + kScarpSlack * ((abs(f1) + f2) * reach + bent) + off;
  t.low = low;
  t.high = high;
  return scarp_settled(t);
}
/// Bound of a^2, never below 0.
SCARP_FN ScarpBound scarp_bound_square(ScarpBound a) {
  float p = a.low * a.low;
  float q = a.high * a.high;
  float least = a.low <= 0.0f && a.high >= 0.0f ? 0.0f : min(p, q);
  float most = max(p, q);
  return scarp_bound_composed(a, scarp_two_multiply(a.mid, a.mid), kScarpTwoSlack * a.mid.high * a.mid.high,
                              2.0f * a.mid.high, 2.0f, max(0.0f, least - kScarpSlack * most),
                              most + kScarpSlack * most);
}
/// Bound of |a|.
SCARP_FN ScarpBound scarp_bound_absolute(ScarpBound a) {
  if (a.low >= 0.0f) return a;
  if (a.high <= 0.0f) return scarp_bound_negate(a);
  return scarp_range(0.0f, max(-a.low, a.high));
}
/// Bound of a clamped to [low, high].
SCARP_FN ScarpBound scarp_bound_clamp(ScarpBound a, float low, float high) {
  if (a.low >= low && a.high <= high) return a;
  return scarp_range(clamp(a.low, low, high), clamp(a.high, low, high));
}
/// Bound of the sine of an angle in radians.
SCARP_FN ScarpBound scarp_bound_sine(ScarpBound a) {
  float sine;
  float cosine;
  scarp_sine(a.mid, sine, cosine);
  float off = 2.384185791015625e-7f + kScarpTwoSlack * abs(a.mid.high);  // 2^-22
  return scarp_bound_composed(a, scarp_two(sine), off, cosine, 1.0f, -1.0f, 1.0f);
}
/// Bound of the minimum as (a + b - |a - b|) / 2, which keeps the linear model.
SCARP_FN ScarpBound scarp_bound_minimum(ScarpBound a, ScarpBound b) {
  if (a.high <= b.low) return a;
  if (b.high <= a.low) return b;
  ScarpBound t = scarp_bound_sum(0.5f, scarp_bound_sum(1.0f, a, 1.0f, b), -0.5f,
                                 scarp_bound_absolute(scarp_bound_sum(1.0f, a, -1.0f, b)));
  t.low = max(t.low, min(a.low, b.low));
  t.high = min(t.high, min(a.high, b.high));
  return scarp_settled(t);
}
/// Bound of 1 / a; the true a is at least 1.
SCARP_FN ScarpBound scarp_bound_reciprocal(ScarpBound a) {
  float low = (1.0f - kScarpSlack) / max(a.high, 1.0f);
  float high = min(1.0f, (1.0f + kScarpSlack) / max(a.low, 1.0f));
  if (a.mid.high < 1.0f) return scarp_range(low, high);
  float f = 1.0f / a.mid.high;
  return scarp_bound_composed(a, scarp_two(f), kScarpSlack * f, -f * f, 2.0f * high * high * high, low, high);
}
/// b + phi(b - a) with phi' = -weight and |phi''| <= 1 / (2 radius).
SCARP_FN ScarpBound scarp_bound_smooth_minimum(ScarpBound a, ScarpBound b, float radius) {
  float share = scarp_smooth_share(scarp_two_add(a.mid, scarp_two_negate(b.mid)).high, radius);
  float other = 1.0f - share;
  float ra = scarp_reach(a);
  float rb = scarp_reach(b);
  float size = scarp_most(a) + scarp_most(b) + abs(a.mid.high) + abs(b.mid.high) + radius;
  float bent = (ra + rb) * (ra + rb) / (4.0f * radius);
  ScarpBound t;
  t.mid = scarp_smooth_minimum(a.mid, b.mid, radius);
  t.slope = share * a.slope + other * b.slope;
  t.rest = share * a.rest + other * b.rest + bent + kScarpSlack * (bent + ra + rb + size);
  t.low = scarp_smooth_minimum(scarp_two(a.low), scarp_two(b.low), radius).high - kScarpSlack * size;
  t.high = scarp_smooth_minimum(scarp_two(a.high), scarp_two(b.high), radius).high + kScarpSlack * size;
  return scarp_settled(t);
}
/// Bound of scarp_terrace(), which is monotone: by its values at both ends.
SCARP_FN ScarpBound scarp_bound_terrace(ScarpBound a, ScarpInstruction at) {
  float slack = kScarpSlack * (scarp_most(a) + at.k0) * (1.0f + kScarpSteepestFade / at.k1);
  return scarp_range(scarp_terrace(scarp_two(a.low), scarp_k0(at), scarp_k2(at), at.k1).high - slack,
                     scarp_terrace(scarp_two(a.high), scarp_k0(at), scarp_k2(at), at.k1).high + slack);
}
/// Bound of scarp_radial(), by the nearest and the farthest position.
SCARP_FN ScarpBound scarp_bound_radial(ScarpBound x, ScarpBound y, ScarpInstruction at) {
  float near_x = max(0.0f, max(x.low - at.k0, at.k0 - x.high));
  float near_y = max(0.0f, max(y.low - at.k1, at.k1 - y.high));
  float far_x = max(abs(x.low - at.k0), abs(x.high - at.k0));
  float far_y = max(abs(y.low - at.k1), abs(y.high - at.k1));
  float slack = kScarpSlack * (8.0f + kScarpSteepestFade / (at.k3 - at.k2) *
                                          (scarp_most(x) + scarp_most(y) + abs(at.k0) + abs(at.k1) + at.k3));
  return scarp_range(max(0.0f, scarp_radial(far_x, far_y, at.k2, at.k3) - slack),
                     min(1.0f, scarp_radial(near_x, near_y, at.k2, at.k3) + slack));
}

/// Noise over a segment, with its gradient if requested.
struct ScarpNoiseOver {
  ScarpBound n, x, y;
};
/// A derivative d of noise, its own derivatives dx and dy at the middle, and bounds of it (most) and of its first and
/// second derivatives, over a segment within distance r of the middle; d is accurate to d_off, dx and dy to first_off.
SCARP_FN ScarpBound scarp_derivative_over(ScarpBound a, ScarpBound b, float r, float d, float dx, float dy, float most,
                                          float first, float second, float d_off, float first_off) {
  ScarpBound t;
  t.mid = scarp_two(d);
  t.slope = dx * a.slope + dy * b.slope;
  t.rest = abs(dx) * a.rest + abs(dy) * b.rest + 0.5f * second * r * r * (1.0f + kScarpSlack) + d_off +
           2.0f * first_off * r + kScarpSlack * (most + first * r);
  float away = first * r * (1.0f + kScarpSlack) + d_off + kScarpSlack * most;
  t.low = max(-most, d - away);
  t.high = min(most, d + away);
  return scarp_settled(t);
}
/// The rounding of pairs in the position (a, b) is in their rests; the error of floor and fraction is in n_off.
SCARP_FN ScarpNoiseOver scarp_noise_over(ScarpInstruction at, ScarpBound a, ScarpBound b, bool slopes) {
  ScarpNoiseBound bound = scarp_noise_bound(at.kind);
  float half_ = sqrt(a.slope * a.slope + b.slope * b.slope) * (1.0f + kScarpSlack);
  float off = sqrt(a.rest * a.rest + b.rest * b.rest) * (1.0f + kScarpSlack);
  float r = half_ + off;
  ScarpNoiseOver over;
  // Beyond this the second-order term alone is wider than the range.
  if (!(bound.curvature * r * r < 2.0f * bound.height)) {
    over.n = scarp_range(-bound.height, bound.height);
    over.x = scarp_range(-bound.slope, bound.slope);
    over.y = over.x;
    return over;
  }
  ScarpNoise jet = scarp_program_noise(at, a.mid, b.mid);
  // The rotation of simplex noise to its own axes, in pairs.
  float moved = kScarpTwoSlack * (abs(a.mid.high) + abs(b.mid.high));
  float n_off = bound.n_off + bound.slope * moved;
  float slope_off = bound.slope_off + bound.curvature * moved;
  float curvature_off = bound.curvature_off + bound.third * moved;
  // Bound of the second derivative in any direction anywhere on the segment: that at the middle, or the global bound.
  float hessian =
      sqrt(jet.xx * jet.xx + 2.0f * jet.xy * jet.xy + jet.yy * jet.yy) * (1.0f + kScarpSlack) + 2.0f * curvature_off;
  float curvature = min(bound.curvature, hessian + bound.third * r * (1.0f + kScarpSlack));
  // Along the segment the second derivative is q at the middle, and the parabola q s^2 / 2 stays within |q| / 4 of q /
  // 4 (value_over() of function_taylor.h); the error of q is below 2 curvature_off r^2.
  float q = a.slope * a.slope * jet.xx + 2.0f * a.slope * b.slope * jet.xy + b.slope * b.slope * jet.yy;
  float bent = 0.25f * abs(q) + hessian * off * (half_ + 0.5f * off) + bound.third / 6.0f * r * r * r;
  float plain = 0.5f * curvature * r * r;
  bool bends = bent < plain;
  over.n.mid = scarp_two(jet.n + (bends ? 0.25f * q : 0.0f));
  over.n.slope = jet.x * a.slope + jet.y * b.slope;
  over.n.rest = abs(jet.x) * a.rest + abs(jet.y) * b.rest + min(bent, plain) * (1.0f + kScarpSlack) + n_off +
                2.0f * slope_off * r + 2.0f * curvature_off * r * r +
                kScarpSlack * (1.0f + bound.slope * r + bound.curvature * r * r);
  float away = bound.slope * r * (1.0f + kScarpSlack) + n_off + kScarpSlack;
  over.n.low = max(-bound.height, jet.n - away);
  over.n.high = min(bound.height, jet.n + away);
  over.n = scarp_settled(over.n);
  over.x = over.n;
  over.y = over.n;
  if (slopes) {
    over.x = scarp_derivative_over(a, b, r, jet.x, jet.xx, jet.xy, bound.slope, curvature, bound.third, slope_off,
                                   curvature_off);
    over.y = scarp_derivative_over(a, b, r, jet.y, jet.xy, jet.yy, bound.slope, curvature, bound.third, slope_off,
                                   curvature_off);
  }
  return over;
}

/// Bounds of the function over the segment whose position is (x, y), in metres.
SCARP_FN ScarpBound scarp_bound(ScarpProgram program, ScarpBound x, ScarpBound y) {
  ScarpBound r[kScarpRegisters];
  r[0] = x;
  r[1] = y;
  for (uint i = 0u; i < program.count; ++i) {
    ScarpInstruction at = scarp_instruction(i);
    ScarpBound a = r[at.a];
    ScarpBound b = r[at.b];
    ScarpBound to = a;
    if (scarp_is(at, kScarpConstant)) {
      to = scarp_exactly(scarp_k0(at));
    } else if (scarp_is(at, kScarpCombine)) {
      to = scarp_bound_combine(scarp_k0(at), a, scarp_k1(at), b, scarp_k2(at));
    } else if (scarp_is(at, kScarpTurn)) {
      to = scarp_bound_turn(scarp_k0(at), a, scarp_two_negate(scarp_k1(at)), b);
      r[at.to_x] = scarp_bound_turn(scarp_k1(at), a, scarp_k0(at), b);
    } else if (scarp_is(at, kScarpMultiply)) {
      to = scarp_bound_multiply(a, b);
    } else if (scarp_is(at, kScarpSquare)) {
      to = scarp_bound_square(a);
    } else if (scarp_is(at, kScarpAbsolute)) {
      to = scarp_bound_absolute(a);
    } else if (scarp_is(at, kScarpClamp)) {
      to = scarp_bound_clamp(a, at.k0, at.k1);
    } else if (scarp_is(at, kScarpSine)) {
      to = scarp_bound_sine(a);
    } else if (scarp_is(at, kScarpMinimum) || scarp_is(at, kScarpMaximum)) {
      // The maximum of a and b is minus the minimum of -a and -b.
      bool larger = at.op == kScarpMaximum;
      if (larger) a = scarp_bound_negate(a);
      if (larger) b = scarp_bound_negate(b);
      to = scarp_bound_minimum(a, b);
      if (larger) to = scarp_bound_negate(to);
    } else if (scarp_is(at, kScarpSmoothMinimum)) {
      to = scarp_bound_smooth_minimum(a, b, at.k0);
    } else if (scarp_is(at, kScarpReciprocal)) {
      to = scarp_bound_reciprocal(a);
    } else if (scarp_is(at, kScarpNoiseOp) || scarp_is(at, kScarpNoiseSlope)) {
      ScarpNoiseOver over = scarp_noise_over(at, a, b, at.op == kScarpNoiseSlope);
      to = over.n;
      if (at.op == kScarpNoiseSlope) {
        r[at.to_x] = over.x;
        r[at.to_y] = over.y;
      }
    } else if (scarp_is(at, kScarpTerrace)) {
      to = scarp_bound_terrace(a, at);
    } else if (scarp_is(at, kScarpRadial)) {
      to = scarp_bound_radial(a, b, at);
    }
    r[at.to] = to;
  }
  return r[program.result];
}

SCARP_GLSL_END

#endif
