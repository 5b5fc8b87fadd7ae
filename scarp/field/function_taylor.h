// SPDX-License-Identifier: MIT
// Terrain function instructions on Taylor models: a linear function over a segment (or rectangle) and a bound of the
// deviation. Certified bounds are computed with these.
//
//        ___high____________________            over s in [-1, 1]^N the true function is
//              ___---  mid + slope s + rest       within rest of mid + slope . s,
//        __---    .  .  mid + slope s             and between low and high;
//          ___---  . .  mid + slope s - rest      values computed in double at any point
//        _low_______________________              are within `error` of the true value
//
// To cover the rounding of the bounds themselves, every operation widens its results by kSlack times the magnitude of
// its operands, twice the effect of fewer than 8 roundings of 2^-53. Noise is bounded by its value and gradient at the
// middle and by bound_of() (noise.h), to second order if the segment is short relative to the lattice; otherwise by its
// range, without evaluating the lattice.
//
// Source: K. Makino, M. Berz, "Taylor models and other validated functional inclusion methods", 2003; the local bound
// on a segment of the ray as in E. Galin et al., "Segment tracing using local Lipschitz bounds", Eurographics 2020.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "scarp/field/function_numbers.h"

namespace scarp::function {

inline constexpr double kSlack = 0x1p-49;

template <std::size_t N>
struct Taylor {
  double mid = 0;
  std::array<double, N> slope{};  // per half of the segment
  double rest = 0;                // >= 0
  double low = 0, high = 0;
  double error = 0;

  double reach() const {
    double sum = rest;
    for (const double d : slope) sum += std::abs(d);
    return sum * (1 + kSlack);
  }
  double most() const { return std::max(std::abs(low), std::abs(high)) + error; }
};

/// Intersects low and high with the range of the linear model, and flattens the model if the range is tighter.
template <std::size_t N>
inline void settle(Taylor<N>& t) {
  const double reach = t.reach(), slack = kSlack * (std::abs(t.mid) + reach);
  t.low = std::max(t.low, t.mid - reach - slack);
  t.high = std::min(t.high, t.mid + reach + slack);
  const double half = 0.5 * (t.high - t.low) * (1 + kSlack);
  if (half <= t.rest) {
    t.mid = 0.5 * (t.low + t.high);
    t.slope.fill(0);
    t.rest = half + kSlack * std::abs(t.mid);
  }
}

/// A model that consists of a range only. `low` and `high` must already include rounding errors.
template <std::size_t N>
Taylor<N> from_range(double low, double high, double error) {
  Taylor<N> t;
  t.low = low, t.high = high, t.error = error;
  t.mid = 0.5 * (low + high);
  t.rest = 0.5 * (high - low) * (1 + kSlack) + kSlack * std::abs(t.mid);
  return t;
}
template <std::size_t N>
Taylor<N> from_constant(double k) {
  Taylor<N> t;
  t.mid = t.low = t.high = k;
  return t;
}

template <std::size_t N>
Taylor<N> combine(double k0, const Taylor<N>& a, double k1, const Taylor<N>& b, double k2) {
  Taylor<N> t;
  t.mid = k0 * a.mid + k1 * b.mid + k2;
  for (std::size_t i = 0; i < N; ++i) t.slope[i] = k0 * a.slope[i] + k1 * b.slope[i];
  const double ka = std::abs(k0), kb = std::abs(k1);
  t.rest = ka * a.rest + kb * b.rest +
           kSlack * (ka * (std::abs(a.mid) + a.reach()) + kb * (std::abs(b.mid) + b.reach()) + std::abs(k2));
  const double size = ka * a.most() + kb * b.most() + std::abs(k2);
  t.low = k0 * (k0 < 0 ? a.high : a.low) + k1 * (k1 < 0 ? b.high : b.low) + k2 - kSlack * size;
  t.high = k0 * (k0 < 0 ? a.low : a.high) + k1 * (k1 < 0 ? b.low : b.high) + k2 + kSlack * size;
  t.error = ka * a.error + kb * b.error + kSlack * size;
  settle(t);
  return t;
}

/// k0 a + k1 b for positions: their linear model is nearly exact, so the range is that of the model.
template <std::size_t N>
Taylor<N> turned_place(double k0, const Taylor<N>& a, double k1, const Taylor<N>& b) {
  Taylor<N> t;
  t.mid = k0 * a.mid + k1 * b.mid;
  for (std::size_t i = 0; i < N; ++i) t.slope[i] = k0 * a.slope[i] + k1 * b.slope[i];
  const double ka = std::abs(k0), kb = std::abs(k1);
  const double slack =
      kSlack * (ka * (std::abs(a.mid) + a.reach() + a.error) + kb * (std::abs(b.mid) + b.reach() + b.error));
  t.rest = ka * a.rest + kb * b.rest + slack;
  const double reach = t.reach() + slack;
  t.low = t.mid - reach, t.high = t.mid + reach;
  t.error = ka * a.error + kb * b.error + slack;
  return t;
}

template <std::size_t N>
Taylor<N> multiply(const Taylor<N>& a, const Taylor<N>& b) {
  Taylor<N> t;
  const double ra = a.reach(), rb = b.reach(), ma = std::abs(a.mid), mb = std::abs(b.mid);
  t.mid = a.mid * b.mid;
  for (std::size_t i = 0; i < N; ++i) t.slope[i] = a.mid * b.slope[i] + b.mid * a.slope[i];
  t.rest = ma * b.rest + mb * a.rest + ra * rb + kSlack * (ma + ra) * (mb + rb);
  const double size = a.most() * b.most();
  const double p = a.low * b.low, q = a.low * b.high, r = a.high * b.low, s = a.high * b.high;
  t.low = std::min({p, q, r, s}) - kSlack * size;
  t.high = std::max({p, q, r, s}) + kSlack * size;
  t.error = a.most() * b.error + b.most() * a.error + kSlack * size;
  settle(t);
  return t;
}

/// f(a) from f and f' at a.mid, the maximum of |f''| over the range, and the range and error of f.
template <std::size_t N>
Taylor<N> composed(const Taylor<N>& a, double f, double f1, double f2, double low, double high, double error) {
  Taylor<N> t;
  const double reach = a.reach();
  t.mid = f;
  for (std::size_t i = 0; i < N; ++i) t.slope[i] = f1 * a.slope[i];
  t.rest = std::abs(f1) * a.rest + 0.5 * f2 * reach * reach +
           kSlack * (std::abs(f) + (std::abs(f1) + f2) * reach + 0.5 * f2 * reach * reach);
  t.low = low, t.high = high, t.error = error;
  settle(t);
  return t;
}

template <std::size_t N>
Taylor<N> square(const Taylor<N>& a) {
  const double most = std::max(a.low * a.low, a.high * a.high);
  const double least = a.low <= 0 && a.high >= 0 ? 0 : std::min(a.low * a.low, a.high * a.high);
  const double slack = kSlack * (most + a.error * a.error);
  return composed(a, a.mid * a.mid, 2 * a.mid, 2, least - slack, most + slack, 2 * a.most() * a.error + slack);
}

template <std::size_t N>
Taylor<N> absolute(const Taylor<N>& a) {
  if (a.low >= 0) return a;
  if (a.high <= 0) return combine(-1, a, 0, a, 0);
  return from_range<N>(0, std::max(-a.low, a.high), a.error);
}

template <std::size_t N>
Taylor<N> clamp(const Taylor<N>& a, double low, double high) {
  if (a.low >= low && a.high <= high) return a;
  return from_range<N>(clamp(a.low, low, high), clamp(a.high, low, high), a.error);
}

// Assumes that the C library's sine and cosine are accurate to 2 units in the last place; GNU's documented error is
// well below that.
template <std::size_t N>
Taylor<N> sine(const Taylor<N>& a) {
  return composed(a, std::sin(a.mid), std::cos(a.mid), 1, -1, 1, a.error + kSlack);
}
template <std::size_t N>
Taylor<N> cosine(const Taylor<N>& a) {
  return composed(a, std::cos(a.mid), -std::sin(a.mid), 1, -1, 1, a.error + kSlack);
}

/// The minimum as (a + b - |a - b|) / 2, which keeps the linear model.
template <std::size_t N>
Taylor<N> minimum(const Taylor<N>& a, const Taylor<N>& b) {
  Taylor<N> t;
  if (a.high <= b.low) {
    t = a;
  } else if (b.high <= a.low) {
    t = b;
  } else {
    t = combine(0.5, combine(1, a, 1, b, 0), -0.5, absolute(combine(1, a, -1, b, 0)), 0);
    t.low = std::max(t.low, std::min(a.low, b.low));
    t.high = std::min(t.high, std::min(a.high, b.high));
    settle(t);
  }
  t.error = std::max(a.error, b.error);
  return t;
}
template <std::size_t N>
Taylor<N> maximum(const Taylor<N>& a, const Taylor<N>& b) {
  return combine(-1, minimum(combine(-1, a, 0, a, 0), combine(-1, b, 0, b, 0)), 0, a, 0);
}

template <std::size_t N>
Taylor<N> reciprocal(const Taylor<N>& a) {
  const double low = 1 / a.high, high = 1 / a.low, slack = kSlack * high;
  return composed(a, 1 / a.mid, -1 / (a.mid * a.mid), 2 * high * high * high * (1 + kSlack), low - slack, high + slack,
                  a.error * high * high * (1 + kSlack) + slack);
}

template <std::size_t N>
Taylor<N> smooth_share(const Taylor<N>& a, const Taylor<N>& b, double radius) {
  return clamp(combine(0.5 / radius, b, -0.5 / radius, a, 0.5), 0, 1);
}
/// The smooth minimum is b + phi(b - a) with phi' = -weight and |phi''| <= 1 / (2 radius).
template <std::size_t N>
Taylor<N> smooth_minimum(const Taylor<N>& a, const Taylor<N>& b, double radius) {
  Taylor<N> t;
  const double size = a.most() + b.most() + radius, slack = 2 * kSlack * size;
  const double share = smooth_share(a.mid, b.mid, radius), rest = 1 - share;
  const double apart = a.reach() + b.reach();
  t.mid = smooth_minimum(a.mid, b.mid, radius);
  for (std::size_t i = 0; i < N; ++i) t.slope[i] = share * a.slope[i] + rest * b.slope[i];
  t.rest = share * a.rest + rest * b.rest + apart * apart / (4 * radius) * (1 + kSlack) + slack;
  t.low = smooth_minimum(a.low, b.low, radius) - slack;
  t.high = smooth_minimum(a.high, b.high, radius) + slack;
  t.error = std::max(a.error, b.error) + slack;
  settle(t);
  return t;
}

template <std::size_t N>
Taylor<N> terrace(const Taylor<N>& a, double step, double rise) {
  const double slack = kSlack * (a.most() + step) * (1 + kSteepestFade / rise);
  return from_range<N>(terrace(a.low, step, rise) - slack, terrace(a.high, step, rise) + slack,
                       a.error * kSteepestFade / rise + slack);
}
/// Range of the fade's slope between two phases. The slope rises until 1/2 and falls after it.
inline std::array<double, 2> fade_slope_range(double low, double high) {
  const double a = fade_slope(low), b = fade_slope(high);
  return {std::max(0.0, std::min(a, b) - 8 * kSlack),
          low <= 0.5 && high >= 0.5 ? kSteepestFade : std::max(a, b) * (1 + 8 * kSlack)};
}
template <std::size_t N>
Taylor<N> terrace_slope(const Taylor<N>& a, double step, double rise) {
  const double slack = kSlack * (a.most() + step);
  double floor_low = 0, floor_high = 0;
  const double low = terrace_phase(a.low - slack, step, rise, floor_low);
  const double high = terrace_phase(a.high + slack, step, rise, floor_high);
  if (floor_low != floor_high) return from_range<N>(0, kSteepestFade / rise, kSteepestFade / rise);
  const auto [least, most] = fade_slope_range(low, high);
  return from_range<N>(least / rise * (1 - kSlack), most / rise * (1 + kSlack), kSteepestFade / rise);
}

/// Minimum and maximum distance from the mask's centre over the ranges of x and y.
template <std::size_t N>
std::array<double, 2> radial_range(const Taylor<N>& x, const Taylor<N>& y, const FunctionInstruction& in) {
  const auto away = [](double low, double high, double centre, double& near, double& far) {
    near = std::max({0.0, low - centre, centre - high});
    far = std::max(std::abs(low - centre), std::abs(high - centre));
  };
  double near_x = 0, far_x = 0, near_y = 0, far_y = 0;
  away(x.low, x.high, in.k0, near_x, far_x);
  away(y.low, y.high, in.k1, near_y, far_y);
  const double slack = kSlack * (x.most() + y.most() + std::abs(in.k0) + std::abs(in.k1));
  return {std::sqrt(near_x * near_x + near_y * near_y) - slack, std::sqrt(far_x * far_x + far_y * far_y) + slack};
}
template <std::size_t N>
Taylor<N> radial(const Taylor<N>& x, const Taylor<N>& y, const FunctionInstruction& in) {
  const auto [near, far] = radial_range(x, y, in);
  const double steepest = kSteepestFade / (in.k3 - in.k2);
  const double slack = kSlack * (8 + steepest * (x.most() + y.most() + std::abs(in.k0) + std::abs(in.k1) + in.k3));
  return from_range<N>(std::max(0.0, fade(radial_phase(far, in.k2, in.k3)) - slack),
                       std::min(1.0, fade(radial_phase(near, in.k2, in.k3)) + slack),
                       steepest * (x.error + y.error) + slack);
}
template <std::size_t N>
void radial_slope(const Taylor<N>& x, const Taylor<N>& y, const FunctionInstruction& in, Taylor<N>& out_x,
                  Taylor<N>& out_y) {
  const auto [near, far] = radial_range(x, y, in);
  const double width = in.k3 - in.k2;
  const auto [least, most] =
      fade_slope_range(radial_phase(far, in.k2, in.k3) * (1 - kSlack), radial_phase(near, in.k2, in.k3) * (1 + kSlack));
  // Unit vector away from the centre: any direction if the range includes the centre, otherwise a quotient of ranges.
  const double steepest = most / width * (1 + kSlack), calmest = least / width * (1 - kSlack);
  const auto part = [&, near = near, far = far](double low, double high) {
    double from = -1, to = 1;
    if (near > 0) {
      from = std::max(-1.0, low / (low < 0 ? near : far) - kSlack);
      to = std::min(1.0, high / (high < 0 ? far : near) + kSlack);
    }
    // The mask decreases outwards.
    return from_range<N>(-to * (to > 0 ? steepest : calmest), -from * (from > 0 ? calmest : steepest), steepest);
  };
  out_x = part(x.low - in.k0, x.high - in.k0);
  out_y = part(y.low - in.k1, y.high - in.k1);
}

/// Maximum distance of the position (a, b) from the middle position.
template <std::size_t N>
double wander(const Taylor<N>& a, const Taylor<N>& b) {
  double sum = std::sqrt(a.rest * a.rest + b.rest * b.rest);
  for (std::size_t i = 0; i < N; ++i) sum += std::sqrt(a.slope[i] * a.slope[i] + b.slope[i] * b.slope[i]);
  return sum * (1 + kSlack);
}

/// Model of d, a derivative of noise, over a segment within distance r of the middle: from d and its derivatives dx and
/// dy at the middle, and bounds of d and of its first and second derivatives.
template <std::size_t N>
Taylor<N> derivative_over(const Taylor<N>& a, const Taylor<N>& b, double r, double d, double dx, double dy, double most,
                          double first, double second, double rounding) {
  Taylor<N> t;
  t.mid = d;
  for (std::size_t i = 0; i < N; ++i) t.slope[i] = dx * a.slope[i] + dy * b.slope[i];
  t.rest = std::abs(dx) * a.rest + std::abs(dy) * b.rest + 0.5 * second * r * r * (1 + kSlack) +
           (rounding + kSlack * first) * (1 + r);
  const double away = first * r * (1 + kSlack) + rounding;
  t.low = std::max(-most, d - away), t.high = std::min(most, d + away);
  t.error = first * (a.error + b.error) + rounding;
  settle(t);
  return t;
}

/// Noise over a segment that is short relative to the lattice. The second derivative along it is q at the middle, and
/// the parabola q s^2 / 2 stays within |q| / 4 of q / 4:
///
///      q/2  .             .          n = mid + slope s + q s^2 / 2 +- third r^3 / 6
///             .         .
///      q/4 - - - . - . - - - -       the offset from the line adds curvature: |off| (half + |off| / 2) |H|, where H
///        0 ________.__________       is the matrix of second derivatives and |H| the root of the sum of their squares
///          s = -1     0     1
///
/// The other bound, curvature r^2 / 2 without q, is smaller for longer segments. `rounding` is the rounding error of n
/// and of each of its derivatives; r < 1.
inline Taylor<1> value_over(const Taylor<1>& a, const Taylor<1>& b, double r, const NoiseJet& jet,
                            const NoiseBound& bound, double hessian, double curvature, double rounding) {
  const double sx = a.slope[0], sy = b.slope[0];
  const double q = sx * sx * jet.xx + 2 * sx * sy * jet.xy + sy * sy * jet.yy;
  const double half = std::sqrt(sx * sx + sy * sy), off = std::sqrt(a.rest * a.rest + b.rest * b.rest);
  const double bent = 0.25 * std::abs(q) + hessian * off * (half + 0.5 * off) + bound.third / 6 * r * r * r;
  const double plain = 0.5 * curvature * r * r;
  Taylor<1> t;
  t.mid = jet.n + (bent < plain ? 0.25 * q : 0.0);
  t.slope[0] = jet.x * sx + jet.y * sy;
  t.rest = std::abs(jet.x) * a.rest + std::abs(jet.y) * b.rest + (bent < plain ? bent : plain) * (1 + kSlack) +
           3 * (rounding + kSlack * (bound.slope + bound.curvature));
  const double away = bound.slope * r * (1 + kSlack) + rounding;
  t.low = std::max(-bound.height, jet.n - away), t.high = std::min(bound.height, jet.n + away);
  t.error = bound.slope * (a.error + b.error) + rounding;
  settle(t);
  return t;
}

/// Noise over a segment, with the requested derivatives.
template <std::size_t N>
struct NoiseOver {
  Taylor<N> n, x, y, xx, xy, yy;
};
template <int order, std::size_t N>
NoiseOver<N> noise_over(const FunctionInstruction& in, const Taylor<N>& a, const Taylor<N>& b) {
  const NoiseBound bound = bound_of(in.kind);
  const double rounding = noise_rounding(in.kind, a.most(), b.most());
  const double moved = a.error + b.error;
  const double r = wander(a, b);
  NoiseOver<N> out;
  // Beyond this the second-order term alone is wider than the range.
  if (bound.curvature * r * r >= 2 * bound.height) {
    out.n = from_range<N>(-bound.height, bound.height, bound.slope * moved + rounding);
    if constexpr (order >= 1) {
      out.x = out.y = from_range<N>(-bound.slope, bound.slope, bound.curvature * moved + rounding);
    }
    if constexpr (order >= 2) {
      out.xx = out.xy = out.yy = from_range<N>(-bound.curvature, bound.curvature, bound.third * moved + rounding);
    }
    return out;
  }
  const NoiseJet jet = noise_jet(in.kind, in.seed, a.mid, b.mid);
  // Bound of the second derivative in any direction, anywhere on the segment: from its value at the middle, or the
  // global bound.
  const double hessian = std::sqrt(jet.xx * jet.xx + 2 * jet.xy * jet.xy + jet.yy * jet.yy) * (1 + kSlack);
  const double curvature = std::min(bound.curvature, hessian + bound.third * r + rounding);
  if constexpr (N == 1) {
    out.n = value_over(a, b, r, jet, bound, hessian, curvature, rounding);
  } else {
    out.n = derivative_over(a, b, r, jet.n, jet.x, jet.y, bound.height, bound.slope, curvature, rounding);
  }
  if constexpr (order >= 1) {
    out.x = derivative_over(a, b, r, jet.x, jet.xx, jet.xy, bound.slope, curvature, bound.third, rounding);
    out.y = derivative_over(a, b, r, jet.y, jet.xy, jet.yy, bound.slope, curvature, bound.third, rounding);
    out.x.error = out.y.error = bound.curvature * moved + rounding;
  }
  if constexpr (order >= 2) {
    const double away = bound.third * r * (1 + kSlack) + rounding, most = bound.curvature;
    const auto range = [&](double d) {
      return from_range<N>(std::max(-most, d - away), std::min(most, d + away), bound.third * moved + rounding);
    };
    out.xx = range(jet.xx), out.xy = range(jet.xy), out.yy = range(jet.yy);
  }
  return out;
}

template <std::size_t N>
Taylor<N> noise_value(const FunctionInstruction& in, const Taylor<N>& a, const Taylor<N>& b) {
  return noise_over<0>(in, a, b).n;
}
template <std::size_t N>
void noise_slope(const FunctionInstruction& in, const Taylor<N>& a, const Taylor<N>& b, Taylor<N>& n, Taylor<N>& x,
                 Taylor<N>& y) {
  const NoiseOver<N> over = noise_over<1>(in, a, b);
  n = over.n, x = over.x, y = over.y;
}
template <std::size_t N>
void noise_curvature(const FunctionInstruction& in, const Taylor<N>& a, const Taylor<N>& b, Taylor<N>& n, Taylor<N>& x,
                     Taylor<N>& y, Taylor<N>& xx, Taylor<N>& xy, Taylor<N>& yy) {
  const NoiseOver<N> over = noise_over<2>(in, a, b);
  n = over.n, x = over.x, y = over.y, xx = over.xx, xy = over.xy, yy = over.yy;
}

}  // namespace scarp::function
