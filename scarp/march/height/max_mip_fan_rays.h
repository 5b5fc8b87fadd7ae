// SPDX-License-Identifier: MIT
// The rays of a fan's strip, turned for their octants, and when one inherits from another. Compiled once per
// instruction set.
#if defined(SCARP_MARCH_MAX_MIP_FAN_RAYS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SCARP_MARCH_MAX_MIP_FAN_RAYS_H
#undef SCARP_MARCH_MAX_MIP_FAN_RAYS_H
#else
#define SCARP_MARCH_MAX_MIP_FAN_RAYS_H
#endif

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "scarp/march/height/max_mip_fan_lines.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

// Directions of a strip, one vector per row, in the order of the walk.
struct StripRays {
  const float *dx, *dy, *dz;
  std::ptrdiff_t stride;
};

// Rays of one row, turned for their octants.
struct RowRays {
  VF per_major, m, s;
  VI octant;
  MF taken;
};

// How directions become cells and sample units per t, and which rays are taken.
struct RayScales {
  float per_x, per_y, per_z;
  float steepest;    // most rise per cell
  float most_major;  // most cells per t
};

HWY_INLINE RowRays row_rays(const StripRays& rays, int i, const RayScales& scales) {
  const VF zero = hn::Zero(df);
  const VF gx = hn::Mul(hn::LoadU(df, rays.dx + i * rays.stride), hn::Set(df, scales.per_x));
  const VF gy = hn::Mul(hn::LoadU(df, rays.dy + i * rays.stride), hn::Set(df, scales.per_y));
  const VF gz = hn::Mul(hn::LoadU(df, rays.dz + i * rays.stride), hn::Set(df, scales.per_z));
  const VF x = hn::Abs(gx), y = hn::Abs(gy);
  const MF turned = hn::Gt(y, x);
  const VF major = hn::IfThenElse(turned, y, x), minor = hn::IfThenElse(turned, x, y);
  RowRays r;
  r.per_major = hn::Div(hn::Set(df, 1), major);
  const VF m = hn::Mul(minor, r.per_major);
  r.s = hn::Mul(gz, r.per_major);
  // False for NaN.
  r.taken = hn::And(hn::And(hn::Gt(major, hn::Set(df, 0x1p-60f)), hn::Lt(major, hn::Set(df, scales.most_major))),
                    hn::And(hn::Le(m, hn::Set(df, 2)), hn::Lt(hn::Abs(r.s), hn::Set(df, scales.steepest))));
  r.m = hn::Min(m, hn::Set(df, 1));
  const auto bit = [&](MF set, std::int32_t value)
                       HWY_ATTR { return hn::IfThenElseZero(hn::RebindMask(di, set), hn::Set(di, value)); };
  r.octant = hn::Or(bit(turned, 1), hn::Or(bit(hn::Lt(gx, zero), 2), bit(hn::Lt(gy, zero), 4)));
  return r;
}

// Octants of the rays that are taken, as bits.
HWY_INLINE VI octant_bit(const RowRays& r) {
  return hn::IfThenElseZero(hn::RebindMask(di, r.taken), hn::Shl(hn::Set(di, 1), r.octant));
}
HWY_INLINE std::int32_t bits_of_lanes(VI v) {
  alignas(64) std::int32_t lanes[N];
  hn::Store(v, di, lanes);
  std::int32_t all = 0;
  for (const std::int32_t one : lanes) all |= one;
  return all;
}

// Rounding of m and s, and of the comparison: numerics.md, Fans.
constexpr float kLinkRounding = 1.25f * 0x1p-20f;

// Whether the second ray is above the ground wherever the first one is, over ground of this relief.
HWY_INLINE MF inherits(VF m0, VF s0, VF m1, VF s1, VF relief) {
  const VF aside = hn::Mul(hn::Mul(relief, hn::Set(df, 1 + 0x1p-18f)), hn::Abs(hn::Sub(m1, m0)));
  const VF rounds = hn::Add(hn::Add(hn::Abs(s0), hn::Abs(s1)), relief);
  return hn::Ge(hn::Sub(s1, s0), hn::MulAdd(rounds, hn::Set(df, kLinkRounding), aside));
}
inline bool inherits(float m0, float s0, float m1, float s1, float relief) {
  return s1 - s0 >=
         relief * (1 + 0x1p-18f) * std::abs(m1 - m0) + kLinkRounding * (std::abs(s0) + std::abs(s1) + relief);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#endif
