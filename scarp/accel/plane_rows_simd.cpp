// SPDX-License-Identifier: MIT
#include "scarp/accel/plane_rows.h"

// Compiled once per instruction set.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scarp/accel/plane_rows_simd.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h must come first.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<float, 16> df;
constexpr hn::RebindToSigned<decltype(df)> di;
constexpr hn::RebindToUnsigned<decltype(df)> du;
constexpr std::size_t N = hn::MaxLanes(df);
using VF = hn::Vec<decltype(df)>;
using VI = hn::Vec<decltype(di)>;
using VU = hn::Vec<decltype(du)>;
static_assert(2 * N + 1 <= kPlaneRowPadding);

// Rounds up by more than the rounding errors of a fit: numerics.md.
constexpr float kUp = 1.125f;

HWY_INLINE VI clamped(const PlaneFit& fit, VI slope) {
  return hn::Max(hn::Min(slope, hn::Set(di, fit.most)), hn::Set(di, -fit.most));
}

HWY_INLINE VF steps(const PlaneFit& fit, VI slope) { return hn::Mul(hn::ConvertTo(df, slope), hn::Set(df, fit.unit)); }

HWY_INLINE void put(VF middle, VI slope_x, VI slope_y, const float* flat, std::uint32_t* entries) {
  const VI zero = hn::Zero(di), byte = hn::Set(di, 255);
  const VI up = hn::ConvertTo(di, hn::Add(middle, hn::Set(df, kUp))), highest = hn::ConvertTo(di, hn::LoadU(df, flat));
  const auto tilted = hn::Lt(up, highest);
  const VI x = hn::And(hn::IfThenElse(tilted, slope_x, zero), byte);
  const VI y = hn::And(hn::IfThenElse(tilted, slope_y, zero), byte);
  const VI slopes = hn::Or(hn::ShiftLeft<16>(x), hn::ShiftLeft<24>(y));
  hn::StoreU(hn::BitCast(du, hn::Or(hn::Min(up, highest), slopes)), du, entries);
}

void fit_first(const PlaneFit& fit, const float* north, const float* middle, const float* south, const float* flat,
               std::size_t count, std::uint32_t* entries) {
  const VF per_unit = hn::Set(df, 0.25f / fit.unit);
  for (std::size_t i = 0; i < count; i += N) {
    struct Columns {
      VF west, middle, east;
    };
    const auto load = [&](const float* row) HWY_ATTR {
      Columns c;
      VF unused;
      hn::LoadInterleaved2(df, row + 2 * i, c.west, c.middle);
      hn::LoadInterleaved2(df, row + 2 * i + 2, c.east, unused);
      return c;
    };
    const Columns n = load(north), m = load(middle), s = load(south);
    const auto slope = [&](VF from_a, VF from_b, VF to_a, VF to_b) HWY_ATTR {
      return clamped(fit, hn::NearestInt(hn::Mul(hn::Sub(hn::Add(to_a, to_b), hn::Add(from_a, from_b)), per_unit)));
    };
    const VI slope_x = slope(n.west, s.west, n.east, s.east), slope_y = slope(n.west, n.east, s.west, s.east);
    const VF x = steps(fit, slope_x), y = steps(fit, slope_y);
    const auto highest = [&](const Columns& c)
                             HWY_ATTR { return hn::Max(c.middle, hn::Max(hn::Add(c.west, x), hn::Sub(c.east, x))); };
    put(hn::Max(highest(m), hn::Max(hn::Add(highest(n), y), hn::Sub(highest(s), y))), slope_x, slope_y, flat + i,
        entries + i);
  }
}

struct Planes {
  VF middle;
  VI x, y;  // slopes

  explicit HWY_INLINE Planes(VU entries) {
    const VI all = hn::BitCast(di, entries);
    middle = hn::ConvertTo(df, hn::And(all, hn::Set(di, 0xffff)));
    x = hn::ShiftRight<24>(hn::ShiftLeft<8>(all)), y = hn::ShiftRight<24>(all);
  }
};

void fit_coarser(const PlaneFit& fit, const std::uint32_t* north, const std::uint32_t* south, const float* flat,
                 std::size_t count, std::uint32_t* entries) {
  const VF half = hn::Set(df, fit.half);
  for (std::size_t i = 0; i < count; i += N) {
    VU nw_entries, ne_entries, sw_entries, se_entries;
    hn::LoadInterleaved2(du, north + 2 * i, nw_entries, ne_entries);
    hn::LoadInterleaved2(du, south + 2 * i, sw_entries, se_entries);
    const Planes nw(nw_entries), ne(ne_entries), sw(sw_entries), se(se_entries);
    const auto mean = [&](VI a, VI b, VI c, VI d) HWY_ATTR {
      const VI sum = hn::Add(hn::Add(a, b), hn::Add(c, d));
      return clamped(fit, hn::ShiftRight<2>(hn::Add(sum, hn::Set(di, 2))));
    };
    const VI slope_x = mean(nw.x, ne.x, sw.x, se.x), slope_y = mean(nw.y, ne.y, sw.y, se.y);
    const VF x = hn::Mul(steps(fit, slope_x), half), y = hn::Mul(steps(fit, slope_y), half);
    // Highest above the new slopes: at one of a child's corners.
    const auto above = [&](const Planes& child) HWY_ATTR {
      const VI tilt = hn::Add(hn::Abs(hn::Sub(child.x, slope_x)), hn::Abs(hn::Sub(child.y, slope_y)));
      return hn::MulAdd(steps(fit, tilt), half, child.middle);
    };
    const VF west = hn::Max(hn::Add(above(nw), y), hn::Sub(above(sw), y));
    const VF east = hn::Max(hn::Add(above(ne), y), hn::Sub(above(se), y));
    put(hn::Max(hn::Add(west, x), hn::Sub(east, x)), slope_x, slope_y, flat + i, entries + i);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace scarp {
namespace {

HWY_EXPORT(fit_first);
HWY_EXPORT(fit_coarser);

}  // namespace

void fit_first_planes(const PlaneFit& fit, const float* north, const float* middle, const float* south,
                      const float* flat, std::size_t count, std::uint32_t* entries) {
  HWY_DYNAMIC_DISPATCH(fit_first)(fit, north, middle, south, flat, count, entries);
}

void fit_coarser_planes(const PlaneFit& fit, const std::uint32_t* north, const std::uint32_t* south, const float* flat,
                        std::size_t count, std::uint32_t* entries) {
  HWY_DYNAMIC_DISPATCH(fit_coarser)(fit, north, south, flat, count, entries);
}

}  // namespace scarp
#endif
