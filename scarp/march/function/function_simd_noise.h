// SPDX-License-Identifier: MIT
// noise.cpp in vectors: the same operations in the same order, so results are bit-identical, with one position per
// lane. Compiled once per instruction set.
#if defined(SCARP_MARCH_FUNCTION_SIMD_NOISE_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SCARP_MARCH_FUNCTION_SIMD_NOISE_H
#undef SCARP_MARCH_FUNCTION_SIMD_NOISE_H
#else
#define SCARP_MARCH_FUNCTION_SIMD_NOISE_H
#endif

#include <cstddef>
#include <cstdint>

#include "hwy/highway.h"
#include "scarp/field/noise.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<double, 8> dd;
constexpr hn::RebindToSigned<decltype(dd)> di;
constexpr hn::RebindToUnsigned<decltype(dd)> du;
constexpr std::size_t N = hn::MaxLanes(dd);
using V = hn::Vec<decltype(dd)>;
using VI = hn::Vec<decltype(di)>;
using VU = hn::Vec<decltype(du)>;
using M = hn::Mask<decltype(dd)>;

HWY_INLINE V set(double k) { return hn::Set(dd, k); }
HWY_INLINE V zero() { return hn::Zero(dd); }

struct VNoise {
  V n, x, y, xx, xy, yy;
};

// Hashes are in the lower halves of 64-bit lanes.
HWY_INLINE VU low_half(VU x) { return hn::And(x, hn::Set(du, 0xffffffffu)); }
// Computed in 64 bits.
HWY_INLINE VU product(VU x, std::uint32_t k) {
#if HWY_TARGET == HWY_SCALAR
  return hn::Set(du, hn::GetLane(x) * k);
#else
  constexpr hn::Repartition<std::uint32_t, decltype(dd)> halves;
  return hn::MulEven(hn::BitCast(halves, x), hn::BitCast(halves, hn::Set(du, std::uint64_t{k})));
#endif
}
HWY_INLINE VU times(VU x, std::uint32_t k) { return low_half(product(x, k)); }
HWY_INLINE VU mix(VU x) {
  x = times(hn::Xor(x, hn::ShiftRight<16>(x)), 0x7feb352du);
  x = times(hn::Xor(x, hn::ShiftRight<15>(x)), 0x846ca68bu);
  return hn::Xor(x, hn::ShiftRight<16>(x));
}

HWY_INLINE V within_reach(V p) {
  const V reach = set(kLatticeReach);
  return hn::IfThenElse(hn::Gt(p, hn::Neg(reach)), hn::IfThenElse(hn::Lt(p, reach), p, reach), hn::Neg(reach));
}

HWY_INLINE V fade(V t) {
  return hn::Mul(hn::Mul(hn::Mul(t, t), t), hn::Add(hn::Mul(t, hn::Sub(hn::Mul(t, set(6)), set(15))), set(10)));
}
HWY_INLINE V fade_slope(V t) {
  const V less = hn::Sub(t, set(1));
  return hn::Mul(hn::Mul(set(30), hn::Mul(t, t)), hn::Mul(less, less));
}
HWY_INLINE V fade_curvature(V t) {
  return hn::Mul(hn::Mul(hn::Mul(set(60), t), hn::Sub(hn::Mul(t, set(2)), set(1))), hn::Sub(t, set(1)));
}
HWY_INLINE V lerp(V a, V b, V t) { return hn::Add(a, hn::Mul(t, hn::Sub(b, a))); }

HWY_INLINE V value_at(VU hash) {
  return hn::Sub(hn::Mul(hn::ConvertTo(dd, hn::BitCast(di, hash)), set(0x1p-31)), set(1));
}
// The twelve directions of lattice_direction().
struct Directions {
  alignas(64) double x[12], y[12];
  Directions() {
    for (std::uint64_t k = 0; k < 12; ++k) {
      const double* d = lattice_direction(static_cast<std::uint32_t>(((k << 32) + 11) / 12));
      x[k] = d[0], y[k] = d[1];
    }
  }
};
struct Direction {
  V x, y;
};
HWY_INLINE Direction direction_at(const Directions& directions, VU hash) {
  const VI index = hn::BitCast(di, hn::ShiftRight<32>(product(hash, 12)));
  return {hn::GatherIndex(dd, directions.x, index), hn::GatherIndex(dd, directions.y, index)};
}

// The four lattice points around a position, and the position between them.
struct VSquare {
  VU hash[4];
  V dx, dy, u, v;
};
HWY_INLINE VSquare square_of(std::uint32_t seed, V x, V y) {
  VSquare s;
  const V fx = hn::Floor(x), fy = hn::Floor(y);
  const VU i = hn::BitCast(du, hn::ConvertTo(di, fx)), j = hn::BitCast(du, hn::ConvertTo(di, fy));
  const VU one = hn::Set(du, 1);
  const VU from = hn::Set(du, std::uint64_t{seed});
  const VU west = mix(low_half(hn::Add(from, i))), east = mix(low_half(hn::Add(from, hn::Add(i, one))));
  const VU north = hn::Add(j, one);
  s.hash[0] = mix(low_half(hn::Add(west, j))), s.hash[1] = mix(low_half(hn::Add(east, j)));
  s.hash[2] = mix(low_half(hn::Add(west, north))), s.hash[3] = mix(low_half(hn::Add(east, north)));
  s.dx = hn::Sub(x, fx), s.dy = hn::Sub(y, fy);
  s.u = fade(s.dx), s.v = fade(s.dy);
  return s;
}

template <bool jet>
HWY_INLINE VNoise value_noise(std::uint32_t seed, V x, V y) {
  const VSquare s = square_of(seed, x, y);
  const V a = value_at(s.hash[0]), b = value_at(s.hash[1]), c = value_at(s.hash[2]), d = value_at(s.hash[3]);
  VNoise out{};
  out.n = lerp(lerp(a, b, s.u), lerp(c, d, s.u), s.v);
  if constexpr (jet) {
    const V du_ = fade_slope(s.dx), dv = fade_slope(s.dy);
    const V east = lerp(hn::Sub(b, a), hn::Sub(d, c), s.v), north = lerp(hn::Sub(c, a), hn::Sub(d, b), s.u);
    out.x = hn::Mul(du_, east);
    out.y = hn::Mul(dv, north);
    out.xx = hn::Mul(fade_curvature(s.dx), east);
    out.yy = hn::Mul(fade_curvature(s.dy), north);
    out.xy = hn::Mul(hn::Mul(du_, dv), hn::Sub(hn::Sub(d, c), hn::Sub(b, a)));
  }
  return out;
}

template <bool jet>
HWY_INLINE VNoise perlin_noise(const Directions& directions, std::uint32_t seed, V x, V y) {
  const VSquare s = square_of(seed, x, y);
  const Direction a = direction_at(directions, s.hash[0]), b = direction_at(directions, s.hash[1]);
  const Direction c = direction_at(directions, s.hash[2]), d = direction_at(directions, s.hash[3]);
  const V ex = hn::Sub(s.dx, set(1)), ey = hn::Sub(s.dy, set(1));
  const auto plane = [](const Direction& g, V px, V py) { return hn::Add(hn::Mul(g.x, px), hn::Mul(g.y, py)); };
  const V na = plane(a, s.dx, s.dy), nb = plane(b, ex, s.dy), nc = plane(c, s.dx, ey), nd = plane(d, ex, ey);
  const V u = s.u, v = s.v, scale = set(kPerlinScale);
  VNoise out{};
  out.n = hn::Mul(scale, lerp(lerp(na, nb, u), lerp(nc, nd, u), v));
  if constexpr (jet) {
    const V slope_v = fade_slope(s.dy);
    const V du_ = hn::Mul(scale, fade_slope(s.dx)), dv = hn::Mul(scale, slope_v);
    const V east = lerp(hn::Sub(nb, na), hn::Sub(nd, nc), v), north = lerp(hn::Sub(nc, na), hn::Sub(nd, nb), u);
    out.x = hn::Add(hn::Mul(scale, lerp(lerp(a.x, b.x, u), lerp(c.x, d.x, u), v)), hn::Mul(du_, east));
    out.y = hn::Add(hn::Mul(scale, lerp(lerp(a.y, b.y, u), lerp(c.y, d.y, u), v)), hn::Mul(dv, north));
    out.xx = hn::Add(hn::Mul(hn::Mul(set(2), du_), lerp(hn::Sub(b.x, a.x), hn::Sub(d.x, c.x), v)),
                     hn::Mul(hn::Mul(scale, fade_curvature(s.dx)), east));
    out.yy = hn::Add(hn::Mul(hn::Mul(set(2), dv), lerp(hn::Sub(c.y, a.y), hn::Sub(d.y, b.y), u)),
                     hn::Mul(hn::Mul(scale, fade_curvature(s.dy)), north));
    out.xy = hn::Add(hn::Add(hn::Mul(dv, lerp(hn::Sub(c.x, a.x), hn::Sub(d.x, b.x), u)),
                             hn::Mul(du_, lerp(hn::Sub(b.y, a.y), hn::Sub(d.y, c.y), v))),
                     hn::Mul(hn::Mul(du_, slope_v), hn::Sub(hn::Sub(nd, nc), hn::Sub(nb, na))));
  }
  return out;
}

template <bool jet>
HWY_INLINE VNoise simplex_noise(const Directions& directions, std::uint32_t seed, V x, V y) {
  constexpr double kSkew = 0.3660254037844386, kUnskew = 0.2113248654051871;
  const V skew = hn::Mul(hn::Add(x, y), set(kSkew));
  const V fi = hn::Floor(hn::Add(x, skew)), fj = hn::Floor(hn::Add(y, skew));
  const V unskew = hn::Mul(hn::Add(fi, fj), set(kUnskew));
  const V x0 = hn::Sub(x, hn::Sub(fi, unskew)), y0 = hn::Sub(y, hn::Sub(fj, unskew));
  const M to_east = hn::Gt(x0, y0);
  const VI i = hn::ConvertTo(di, fi), j = hn::ConvertTo(di, fj);
  const VU from = hn::Set(du, std::uint64_t{seed});
  VNoise out{zero(), zero(), zero(), zero(), zero(), zero()};
  for (int corner = 0; corner < 3; ++corner) {
    const V all = set(corner == 2 ? 1 : 0);
    const V step_x = corner == 1 ? hn::IfThenElseZero(to_east, set(1)) : all;
    const V step_y = corner == 1 ? hn::IfThenZeroElse(to_east, set(1)) : all;
    const V dx = hn::Add(hn::Sub(x0, step_x), set(corner * kUnskew));
    const V dy = hn::Add(hn::Sub(y0, step_y), set(corner * kUnskew));
    const V m = hn::Sub(hn::Sub(set(0.5), hn::Mul(dx, dx)), hn::Mul(dy, dy));
    const M counts = hn::Gt(m, zero());
    const VU ci = hn::BitCast(du, hn::Add(i, hn::ConvertTo(di, step_x)));
    const VU cj = hn::BitCast(du, hn::Add(j, hn::ConvertTo(di, step_y)));
    const Direction g = direction_at(directions, mix(low_half(hn::Add(mix(low_half(hn::Add(from, ci))), cj))));
    const V scale = set(kSimplexScale);
    const V plane = hn::Mul(scale, hn::Add(hn::Mul(g.x, dx), hn::Mul(g.y, dy))), m2 = hn::Mul(m, m);
    const V m4 = hn::Mul(m2, m2);
    const auto add = [&](V& sum, V more) HWY_ATTR { sum = hn::IfThenElse(counts, hn::Add(sum, more), sum); };
    add(out.n, hn::Mul(m4, plane));
    if constexpr (jet) {
      const V gx = hn::Mul(scale, g.x), gy = hn::Mul(scale, g.y), k = hn::Mul(hn::Mul(set(8), m2), m);
      add(out.x, hn::Sub(hn::Mul(m4, gx), hn::Mul(hn::Mul(k, dx), plane)));
      add(out.y, hn::Sub(hn::Mul(m4, gy), hn::Mul(hn::Mul(k, dy), plane)));
      const V m48 = hn::Mul(set(48), m2), twice = hn::Mul(set(2), k);
      add(out.xx, hn::Sub(hn::Mul(hn::Sub(hn::Mul(hn::Mul(m48, dx), dx), k), plane), hn::Mul(hn::Mul(twice, dx), gx)));
      add(out.yy, hn::Sub(hn::Mul(hn::Sub(hn::Mul(hn::Mul(m48, dy), dy), k), plane), hn::Mul(hn::Mul(twice, dy), gy)));
      add(out.xy, hn::Sub(hn::Mul(hn::Mul(hn::Mul(m48, dx), dy), plane),
                          hn::Mul(k, hn::Add(hn::Mul(dx, gy), hn::Mul(dy, gx)))));
    }
  }
  return out;
}

template <bool jet>
HWY_INLINE VNoise noise_at(const Directions& directions, NoiseKind kind, std::uint32_t seed, V x, V y) {
  x = within_reach(x), y = within_reach(y);
  if (kind == NoiseKind::value) return value_noise<jet>(seed, x, y);
  if (kind == NoiseKind::perlin) return perlin_noise<jet>(directions, seed, x, y);
  return simplex_noise<jet>(directions, seed, x, y);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#endif
