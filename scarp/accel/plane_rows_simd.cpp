// SPDX-License-Identifier: MIT
#include "scarp/accel/plane_rows.h"

#include "scarp/accel/block_planes.h"

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

constexpr int kSlopeBits = BlockPlanes::kSlopeBits, kDepthBits = BlockPlanes::kDepthBits;
constexpr float kDepthUnits = BlockPlanes::kDepthUnits;

constexpr hn::CappedTag<float, 16> df;
constexpr hn::RebindToSigned<decltype(df)> di;
constexpr hn::RebindToUnsigned<decltype(df)> du;
constexpr std::size_t N = hn::MaxLanes(df);
using VF = hn::Vec<decltype(df)>;
using VI = hn::Vec<decltype(di)>;
using VU = hn::Vec<decltype(du)>;
static_assert(2 * N + 1 <= kPlaneRowPadding);

// More than the rounding errors of a fit: numerics.md.
constexpr float kUp = 0.125f;

HWY_INLINE VI clamped(const PlaneFit& fit, VI slope) {
  return hn::Max(hn::Min(slope, hn::Set(di, fit.most)), hn::Set(di, -fit.most));
}

HWY_INLINE VF steps(const PlaneFit& fit, VI slope) { return hn::Mul(hn::ConvertTo(df, slope), hn::Set(df, fit.unit)); }

// Maxima of blocks, as codes of planes.
HWY_INLINE VF maxima(const PlaneFit& fit, VI blocks) {
  return hn::MulAdd(hn::ConvertTo(df, hn::And(blocks, hn::Set(di, 0xffff))), hn::Set(df, fit.scale),
                    hn::Set(df, fit.shift));
}

// Writes planes, given their heights in the middle and their slopes. `half`: half the block's side, in cells.
HWY_INLINE void put(const PlaneFit& fit, float half, VF middle, VI slope_x, VI slope_y, std::uint32_t* blocks) {
  const VI zero = hn::Zero(di), slope_bits = hn::Set(di, (1 << kSlopeBits) - 1);
  const VI maximum = hn::And(hn::BitCast(di, hn::LoadU(du, blocks)), hn::Set(di, 0xffff));
  const VF below = hn::Sub(hn::Sub(maxima(fit, maximum), middle), hn::Set(df, kUp));
  // Rounded down.
  const VI depth = hn::Min(hn::ConvertTo(di, hn::Mul(below, hn::Set(df, 1 / (kDepthUnits * fit.unit * half)))),
                           hn::Set(di, (1 << kDepthBits) - 1));
  const auto tilted = hn::Gt(depth, zero);
  const VI x = hn::ShiftLeft<16>(hn::And(slope_x, slope_bits));
  const VI y = hn::ShiftLeft<16 + kSlopeBits>(hn::And(slope_y, slope_bits));
  const VI plane = hn::Or(hn::Or(x, y), hn::ShiftLeft<16 + 2 * kSlopeBits>(depth));
  hn::StoreU(hn::BitCast(du, hn::Or(maximum, hn::IfThenElse(tilted, plane, zero))), du, blocks);
}

void fit_first(const PlaneFit& fit, const float* north, const float* middle, const float* south, std::size_t count,
               std::uint32_t* blocks) {
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
    put(fit, 2 * fit.half, hn::Max(highest(m), hn::Max(hn::Add(highest(n), y), hn::Sub(highest(s), y))), slope_x,
        slope_y, blocks + i);
  }
}

struct Planes {
  VF middle;
  VI x, y;  // slopes

  HWY_INLINE Planes(const PlaneFit& fit, VU blocks) {
    const VI all = hn::BitCast(di, blocks);
    const VI depth = hn::BitCast(di, hn::ShiftRight<16 + 2 * kSlopeBits>(blocks));
    middle = hn::NegMulAdd(hn::ConvertTo(df, depth), hn::Set(df, kDepthUnits * fit.unit * fit.half), maxima(fit, all));
    x = hn::ShiftRight<32 - kSlopeBits>(hn::ShiftLeft<16 - kSlopeBits>(all));
    y = hn::ShiftRight<32 - kSlopeBits>(hn::ShiftLeft<16 - 2 * kSlopeBits>(all));
  }
};

void fit_coarser(const PlaneFit& fit, const std::uint32_t* north, const std::uint32_t* south, std::size_t count,
                 std::uint32_t* blocks) {
  const VF half = hn::Set(df, fit.half);
  for (std::size_t i = 0; i < count; i += N) {
    VU nw_blocks, ne_blocks, sw_blocks, se_blocks;
    hn::LoadInterleaved2(du, north + 2 * i, nw_blocks, ne_blocks);
    hn::LoadInterleaved2(du, south + 2 * i, sw_blocks, se_blocks);
    const Planes nw(fit, nw_blocks), ne(fit, ne_blocks), sw(fit, sw_blocks), se(fit, se_blocks);
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
    put(fit, 2 * fit.half, hn::Max(hn::Add(west, x), hn::Sub(east, x)), slope_x, slope_y, blocks + i);
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
                      std::size_t count, std::uint32_t* blocks) {
  HWY_DYNAMIC_DISPATCH(fit_first)(fit, north, middle, south, count, blocks);
}

void fit_coarser_planes(const PlaneFit& fit, const std::uint32_t* north, const std::uint32_t* south, std::size_t count,
                        std::uint32_t* blocks) {
  HWY_DYNAMIC_DISPATCH(fit_coarser)(fit, north, south, count, blocks);
}

}  // namespace scarp
#endif
