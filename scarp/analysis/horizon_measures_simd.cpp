// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstddef>
#include <limits>
#include <numbers>

#include "scarp/analysis/horizon_measures.h"

// Compiled once per instruction set.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scarp/analysis/horizon_measures_simd.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h must come first.
#include "hwy/highway.h"
#include "scarp/analysis/fused_simd.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<float, 16> df;
constexpr std::size_t N = hn::MaxLanes(df);
using VF = hn::Vec<decltype(df)>;

HWY_INLINE VF set(double value) { return hn::Set(df, static_cast<float>(value)); }

HWY_INLINE VF atan(VF x) {
  constexpr double kPi = std::numbers::pi;
  const VF a = hn::Abs(x), one = set(1);
  // Up to tan(pi/8); about 1; above tan(3 pi/8).
  const auto middle = hn::Gt(a, set(0.4142135623730950)), large = hn::Gt(a, set(2.414213562373095));
  const VF above = hn::IfThenElse(large, set(-1), hn::IfThenElse(middle, hn::Sub(a, one), a));
  const VF below = hn::IfThenElse(large, a, hn::IfThenElse(middle, hn::Add(a, one), one));
  const VF base = hn::IfThenElse(large, set(kPi / 2), hn::IfThenElseZero(middle, set(kPi / 4)));
  const VF r = hn::Div(above, below), z = hn::Mul(r, r);
  VF p = fused(set(8.05374449538e-2), z, set(-1.38776856032e-1));
  p = fused(p, z, set(1.99777106478e-1));
  p = fused(p, z, set(-3.33329491539e-1));
  return hn::CopySign(hn::Add(base, fused(hn::Mul(p, z), r, r)), x);
}

// Stores f(first lane, mask of lanes) for all vectors.
template <class F>
HWY_INLINE void for_vectors(std::size_t count, float* out, const F& f) {
  for (std::size_t i = 0; i < count; i += N) {
    const auto lanes = hn::FirstN(df, std::min(N, count - i));
    hn::BlendedStore(f(i, lanes), lanes, df, out + i);
  }
}
template <class M>
HWY_INLINE VF load(M lanes, const float* from) {
  return hn::MaskedLoad(lanes, df, from);
}

// At least 0.
HWY_INLINE VF raised(VF slope) { return hn::IfThenElse(hn::Lt(slope, hn::Zero(df)), hn::Zero(df), slope); }

void angles(const float* slopes, std::size_t count, float* out) {
  for_vectors(count, out, [&](std::size_t i, auto lanes) HWY_ATTR { return atan(load(lanes, slopes + i)); });
}

void sky_fraction(const float* slopes, std::size_t count, float* sums) {
  for_vectors(count, sums, [&](std::size_t i, auto lanes) HWY_ATTR {
    const VF s = raised(load(lanes, slopes + i)), one = set(1);
    const VF sine = hn::Div(s, hn::Sqrt(fused(s, s, one)));
    return hn::Add(load(lanes, sums + i), hn::Sub(one, sine));
  });
}

void sky_view_factor(const float* slopes, const NodeNormals& normals, float east, float north, std::size_t count,
                     float* sums) {
  for_vectors(count, sums, [&](std::size_t i, auto lanes) HWY_ATTR {
    const VF s = raised(load(lanes, slopes + i)), one = set(1);
    const VF zenith = hn::Sub(set(std::numbers::pi / 2), atan(s));
    const VF square = hn::Div(one, fused(s, s, one));  // sin^2 H
    const VF facing = fused(load(lanes, normals.east + i), hn::Set(df, east),
                            hn::Mul(load(lanes, normals.north + i), hn::Set(df, north)));
    const VF tilted = hn::Mul(facing, hn::Sub(zenith, hn::Mul(s, square)));
    return hn::Add(load(lanes, sums + i), fused(load(lanes, normals.level + i), square, tilted));
  });
}

void openness(const float* slopes, std::size_t count, float* sums) {
  for_vectors(count, sums, [&](std::size_t i, auto lanes) HWY_ATTR {
    const VF slope = load(lanes, slopes + i), none = hn::Set(df, -std::numeric_limits<float>::infinity());
    const VF s = hn::IfThenElse(hn::Eq(slope, none), hn::Zero(df), slope);
    return hn::Add(load(lanes, sums + i), hn::Sub(set(std::numbers::pi / 2), atan(s)));
  });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace scarp {
namespace {

HWY_EXPORT(angles);
HWY_EXPORT(sky_fraction);
HWY_EXPORT(sky_view_factor);
HWY_EXPORT(openness);

}  // namespace

void find_angles(const float* slopes, std::size_t count, float* out) {
  HWY_DYNAMIC_DISPATCH(angles)(slopes, count, out);
}
void add_sky_fraction(const float* slopes, std::size_t count, float* sums) {
  HWY_DYNAMIC_DISPATCH(sky_fraction)(slopes, count, sums);
}
void add_sky_view_factor(const float* slopes, const NodeNormals& normals, float east, float north, std::size_t count,
                         float* sums) {
  HWY_DYNAMIC_DISPATCH(sky_view_factor)(slopes, normals, east, north, count, sums);
}
void add_openness(const float* slopes, std::size_t count, float* sums) {
  HWY_DYNAMIC_DISPATCH(openness)(slopes, count, sums);
}

}  // namespace scarp
#endif
