// SPDX-License-Identifier: MIT
// Steps of max_mip_simd.cpp: rays in vector lanes, through blocks and cells. Compiled once per instruction set.
#if defined(SCARP_MARCH_MAX_MIP_SIMD_LANES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SCARP_MARCH_MAX_MIP_SIMD_LANES_H
#undef SCARP_MARCH_MAX_MIP_SIMD_LANES_H
#else
#define SCARP_MARCH_MAX_MIP_SIMD_LANES_H
#endif

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

#include "hwy/highway.h"
#include "scarp/accel/block_planes.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<float, 16> df;
constexpr hn::RebindToSigned<decltype(df)> di;
constexpr std::size_t N = hn::MaxLanes(df);
constexpr hn::CappedTag<double, N> dd;
constexpr hn::Rebind<float, decltype(dd)> df_part;
constexpr hn::Rebind<std::int32_t, decltype(dd)> di_part;
using VF = hn::Vec<decltype(df)>;
using VI = hn::Vec<decltype(di)>;
using MI = hn::Mask<decltype(di)>;
using VD = hn::Vec<decltype(dd)>;

constexpr float kNever = 0x1p100f;
// Rounding of positions and line times, per cell of the ray's path, and of heights, in codes: numerics.md.
constexpr double kSideways = 0x1p-21, kUpright = 0.25;
// Margin of a tilted plane: a multiple of its rise over the rounding error of a position (numerics.md).
constexpr double kTiltMargins = 8;
constexpr int kSlopeBits = BlockPlanes::kSlopeBits, kDepthBits = BlockPlanes::kDepthBits;
// Times half a block's side and far_slope, these are the heights above its plane from which a ray rises by two levels
// and by three.
constexpr float kHigh = 2, kHigher = 8;
constexpr double kUnit = 0x1p-53, kRoundings = 64;  // four times rounding_of_clearance()

// kAlone: not for vector code.
enum Status : std::int32_t { kWalking, kMiss, kHit, kUnsure, kAlone };

HWY_INLINE std::uint64_t bits_of(MI mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(di, mask, bytes);
  std::uint64_t bits;
  std::memcpy(&bits, bytes, sizeof bits);
  return bits;
}

// Rays of one vector in memory. Each has its own frame: x and y run along the ray, mirrored where it goes backwards;
// time T is in cells along the longer axis, from the ray's start over the field; positions are relative to the cell
// there; heights are codes, minus the margin. seen: 1 if the ray has been above the ground. doubt: time at which it
// entered the first cell that floats did not decide, or kNever.
struct Lanes {
  alignas(64) float ox[N], oy[N], dx[N], dy[N], per_x[N], per_y[N], z[N], dz[N], margin[N], end[N], T[N], doubt[N];
  alignas(64) std::int32_t x[N], y[N], level[N], mirror_x[N], mirror_y[N], begin_x[N], begin_y[N], last_x[N], last_y[N],
      seen[N], status[N];
  double t_begin[N], t_per_cell[N];
  std::int32_t ray[N];                // -1: none
  std::int32_t copy_x[N], copy_y[N];  // copy of a wrapped ground
};

// The ground in the form that vector code needs.
template <class T>
struct VectorGround {
  const std::uint32_t* blocks;  // MaxPyramid::blocks()
  const T* samples;
  std::ptrdiff_t stride;
  std::int32_t last_col, last_row, top;
  alignas(64) std::int32_t level_begin[32];
  float base, per_step, offset;         // a sample's code is (sample - base) * per_step + offset
  float margin_per_cell;                // twice that of the heights
  float far_slope;                      // twice the steepest of planes, in codes per cell
  float unit, depth_unit, tilt_margin;  // steps of slopes and of depths; margin of planes per cell of the path
  float maxima_scale, maxima_shift;     // from codes of maxima to those of planes
  bool triangles;
  std::int32_t seam_col, seam_row;  // the first column and row follow after these; -1 if the ground is not wrapped

  // Offset from a sample to the next one east, and south.
  HWY_INLINE std::ptrdiff_t east(std::int32_t col) const { return col == seam_col ? -col : 1; }
  HWY_INLINE std::ptrdiff_t south(std::int32_t row) const { return row == seam_row ? -row * stride : stride; }
};

struct Packet {
  VF ox, oy, dx, dy, per_x, per_y, z, dz, margin, end, T, doubt;
  VI x, y, level, mirror_x, mirror_y, begin_x, begin_y, last_x, last_y, seen, status;

  HWY_INLINE void load(const Lanes& a) {
    ox = hn::Load(df, a.ox), oy = hn::Load(df, a.oy), dx = hn::Load(df, a.dx), dy = hn::Load(df, a.dy);
    per_x = hn::Load(df, a.per_x), per_y = hn::Load(df, a.per_y), z = hn::Load(df, a.z), dz = hn::Load(df, a.dz);
    margin = hn::Load(df, a.margin), end = hn::Load(df, a.end), T = hn::Load(df, a.T);
    doubt = hn::Load(df, a.doubt), x = hn::Load(di, a.x), y = hn::Load(di, a.y), level = hn::Load(di, a.level);
    mirror_x = hn::Load(di, a.mirror_x), mirror_y = hn::Load(di, a.mirror_y);
    begin_x = hn::Load(di, a.begin_x), begin_y = hn::Load(di, a.begin_y);
    last_x = hn::Load(di, a.last_x), last_y = hn::Load(di, a.last_y);
    seen = hn::Load(di, a.seen), status = hn::Load(di, a.status);
  }
  // Copies lanes: lane j from lane from[j] of `a`.
  HWY_INLINE void take(const Lanes& a, const std::int32_t* from, const std::int32_t* taken) {
    const auto at = hn::SetTableIndices(di, from);
    const auto at_places = hn::SetTableIndices(df, from);
    const MI into = hn::Ne(hn::Load(di, taken), hn::Zero(di));
    const auto place = [&](VF& to, const float* v) HWY_ATTR {
      to = hn::IfThenElse(hn::RebindMask(df, into), hn::TableLookupLanes(hn::Load(df, v), at_places), to);
    };
    const auto whole = [&](VI& to, const std::int32_t* v)
                           HWY_ATTR { to = hn::IfThenElse(into, hn::TableLookupLanes(hn::Load(di, v), at), to); };
    place(ox, a.ox), place(oy, a.oy), place(dx, a.dx), place(dy, a.dy), place(per_x, a.per_x), place(per_y, a.per_y);
    place(z, a.z), place(dz, a.dz), place(margin, a.margin), place(end, a.end), place(T, a.T), place(doubt, a.doubt);
    whole(x, a.x), whole(y, a.y), whole(level, a.level), whole(mirror_x, a.mirror_x), whole(mirror_y, a.mirror_y);
    whole(begin_x, a.begin_x), whole(begin_y, a.begin_y), whole(last_x, a.last_x), whole(last_y, a.last_y);
    whole(seen, a.seen), whole(status, a.status);
  }
  // Stores the members that steps change or answers need.
  HWY_INLINE void store(Lanes& a) const {
    hn::Store(mirror_x, di, a.mirror_x), hn::Store(mirror_y, di, a.mirror_y);
    hn::Store(T, df, a.T), hn::Store(doubt, df, a.doubt), hn::Store(x, di, a.x), hn::Store(y, di, a.y);
    hn::Store(level, di, a.level), hn::Store(seen, di, a.seen), hn::Store(status, di, a.status);
  }

  HWY_INLINE MI walking() const { return hn::Eq(status, hn::Zero(di)); }

  // Where the ray leaves its block.
  struct Exit {
    VI x, y;        // lines ahead
    VF to_x, to_y;  // from the ray's origin to them
    VF tx, ty, T;   // times of their crossings; the first of them, or the ray's end
  };
  HWY_INLINE Exit exit() const {
    const VI one = hn::Set(di, 1), inside = hn::Sub(hn::Shl(one, level), one);
    const VF never = hn::Set(df, kNever);
    Exit e;
    e.x = hn::Add(hn::Or(x, inside), one), e.y = hn::Add(hn::Or(y, inside), one);
    e.to_x = hn::Sub(hn::ConvertTo(df, hn::Sub(e.x, begin_x)), ox);
    e.to_y = hn::Sub(hn::ConvertTo(df, hn::Sub(e.y, begin_y)), oy);
    e.tx = hn::Mul(e.to_x, per_x), e.ty = hn::Mul(e.to_y, per_y);
    // The ray leaves the field at its end time, not through a line.
    e.tx = hn::IfThenElse(hn::RebindMask(df, hn::Gt(e.x, last_x)), never, e.tx);
    e.ty = hn::IfThenElse(hn::RebindMask(df, hn::Gt(e.y, last_y)), never, e.ty);
    // In floats, a line next to the start may have been crossed before it; both are then equal within rounding.
    e.T = hn::Max(T, hn::Min(hn::Min(e.tx, e.ty), end));
    return e;
  }
  HWY_INLINE VF height(VF t) const { return hn::MulAdd(dz, t, z); }

  // Whether the exit is certainly before the ray's end, which is rounded up.
  HWY_INLINE MI before_end(const Exit& e) const {
    const VF least = hn::MulSub(end, hn::Set(df, 1 - 0x1p-20f), hn::Set(df, static_cast<float>(4 * kSideways)));
    return hn::RebindMask(di, hn::Lt(e.T, least));
  }

  // Lanes of `clear` finish at their end, or continue to the next block: across the line ahead, and along the other
  // axis to their position, never back. Up to `rise` levels up, as far as the line is the border of coarser blocks.
  HWY_INLINE void leave(MI clear, const Exit& e, std::int32_t top, VI rise) {
    const MI ends = hn::And(clear, hn::RebindMask(di, hn::Ge(e.T, end))), on = hn::AndNot(ends, clear);
    status = hn::IfThenElse(ends, hn::Set(di, kMiss), status);
    const VI at_x = hn::Max(hn::Add(hn::ConvertTo(di, hn::MulAdd(dx, e.T, ox)), begin_x), x);
    const VI at_y = hn::Max(hn::Add(hn::ConvertTo(di, hn::MulAdd(dy, e.T, oy)), begin_y), y);
    const VI to_x = hn::Min(hn::IfThenElse(hn::RebindMask(di, hn::Le(e.tx, e.T)), e.x, at_x), last_x);
    const VI to_y = hn::Min(hn::IfThenElse(hn::RebindMask(di, hn::Le(e.ty, e.T)), e.y, at_y), last_y);
    // The coarsest level at which the block changes, from the exponent of a float.
    const VI crossed = hn::Or(hn::Xor(x, to_x), hn::Xor(y, to_y));
    const VI border = hn::Sub(hn::ShiftRight<23>(hn::BitCast(di, hn::ConvertTo(df, crossed))), hn::Set(di, 127));
    const VI up = hn::Min(hn::Min(hn::Add(level, rise), border), hn::Set(di, top));
    level = hn::IfThenElse(on, hn::Max(level, up), level);
    x = hn::IfThenElse(on, to_x, x);
    y = hn::IfThenElse(on, to_y, y);
    T = hn::IfThenElse(hn::RebindMask(df, on), e.T, T);
  }
};

// Offsets of the levels. The table stays in registers if these are wide enough and the levels few enough.
HWY_INLINE VI level_begin(const std::int32_t* table, VI level, bool many) {
  if (many) return hn::GatherIndex(di, table, level);
  if constexpr (N == 16) {
    return hn::TableLookupLanes(hn::Load(di, table), hn::IndicesFromVec(di, level));
  } else if constexpr (N == 8) {
    const auto of_eight = hn::IndicesFromVec(di, hn::And(level, hn::Set(di, 7)));
    return hn::IfThenElse(hn::Gt(level, hn::Set(di, 7)), hn::TableLookupLanes(hn::Load(di, table + 8), of_eight),
                          hn::TableLookupLanes(hn::Load(di, table), of_eight));
  } else {
    return hn::GatherIndex(di, table, level);
  }
}

// One step of the lanes that are at blocks.
template <class T>
HWY_INLINE void block_step(const VectorGround<T>& g, Packet& p) {
  const VI zero = hn::Zero(di), one = hn::Set(di, 1);
  const MI walking = hn::And(hn::Eq(p.status, zero), hn::Gt(p.level, zero));
  const Packet::Exit e = p.exit();
  // Other lanes read level 1.
  const VI level = hn::Max(p.level, one);
  const VI col = hn::Shr(hn::Xor(p.x, p.mirror_x), level), row = hn::Shr(hn::Xor(p.y, p.mirror_y), level);
  const VI cols = hn::Add(hn::Shr(hn::Set(di, g.last_col), level), one);
  const VI at = hn::Add(level_begin(g.level_begin, level, g.top > 15), hn::Add(hn::Mul(row, cols), col));
  const VI block = hn::GatherIndex(di, reinterpret_cast<const std::int32_t*>(g.blocks), at);
  const VF half = hn::BitCast(df, hn::ShiftLeft<23>(hn::Add(level, hn::Set(di, 126))));
  const VI depth = hn::And(hn::ShiftRight<16 + 2 * kSlopeBits>(block), hn::Set(di, (1 << kDepthBits) - 1));
  const VF maximum = hn::MulAdd(hn::ConvertTo(df, hn::And(block, hn::Set(di, 0xffff))), hn::Set(df, g.maxima_scale),
                                hn::Set(df, g.maxima_shift));
  const VF middle = hn::NegMulAdd(hn::ConvertTo(df, depth), hn::Mul(half, hn::Set(df, g.depth_unit)), maximum);
  // The slope along the ray: where the ray runs backwards, it falls where the plane rises. Masks of mirrored lanes are
  // odd.
  const auto slope = [&](VI steps, VI mirror) HWY_ATTR {
    const VF sign = hn::BitCast(df, hn::ShiftLeft<31>(mirror));
    return hn::Xor(hn::Mul(hn::ConvertTo(df, hn::ShiftRight<32 - kSlopeBits>(steps)), hn::Set(df, g.unit)), sign);
  };
  const VF slope_x = slope(hn::ShiftLeft<16 - kSlopeBits>(block), p.mirror_x);
  const VF slope_y = slope(hn::ShiftLeft<16 - 2 * kSlopeBits>(block), p.mirror_y);
  // The ray is above the plane by above + rises T.
  const VF above =
      hn::MulAdd(slope_x, hn::Sub(e.to_x, half), hn::MulAdd(slope_y, hn::Sub(e.to_y, half), hn::Sub(p.z, middle)));
  const VF rises = hn::NegMulAdd(slope_x, p.dx, hn::NegMulAdd(slope_y, p.dy, p.dz));
  const VF least = hn::Min(hn::MulAdd(rises, p.T, above), hn::MulAdd(rises, e.T, above));
  const VF margin = hn::Mul(hn::Set(df, g.tilt_margin), hn::Add(e.T, hn::Set(df, 2)));
  // if (least > margin) above all of the block
  const MI clear = hn::And(walking, hn::RebindMask(di, hn::Gt(least, margin)));
  const MI down = hn::AndNot(clear, walking);
  p.seen = hn::IfThenElse(clear, one, p.seen);
  p.level = hn::IfThenElse(down, hn::Sub(p.level, one), p.level);
  // Far above the plane, longer steps are likely to be free.
  const VF height = hn::MulAdd(rises, e.T, above), tilt = hn::Mul(half, hn::Set(df, g.far_slope));
  const auto more = [&](float times) HWY_ATTR {
    return hn::IfThenElseZero(hn::RebindMask(di, hn::Gt(height, hn::Mul(tilt, hn::Set(df, times)))), one);
  };
  p.leave(clear, e, g.top, hn::Add(one, hn::Add(more(kHigh), more(kHigher))));
}

// Heights of each lane's cell as codes.
struct CellCodes {
  VF h00, h10, h01, h11;
};
template <class T>
HWY_INLINE CellCodes cell_codes(const VectorGround<T>& g, VI col, VI row, MI cells) {
  alignas(64) std::int32_t cols[N], rows[N];
  alignas(64) float h00[N] = {}, h10[N] = {}, h01[N] = {}, h11[N] = {};
  hn::Store(col, di, cols), hn::Store(row, di, rows);
  // Loads lane by lane, because a gather takes as long for few lanes as for all.
  const auto load = [&](auto to_east, auto to_south) HWY_ATTR {
    for (std::uint64_t bits = bits_of(cells); bits != 0; bits &= bits - 1) {
      const auto j = static_cast<std::size_t>(std::countr_zero(bits));
      const T *north = g.samples + rows[j] * g.stride + cols[j], *south = north + to_south(rows[j]);
      const std::ptrdiff_t east = to_east(cols[j]);
      h00[j] = static_cast<float>(north[0]), h10[j] = static_cast<float>(north[east]);
      h01[j] = static_cast<float>(south[0]), h11[j] = static_cast<float>(south[east]);
    }
  };
  if (g.seam_col < 0) {
    load([](std::int32_t) HWY_ATTR { return 1; }, [&](std::int32_t) HWY_ATTR { return g.stride; });
  } else {
    load([&](std::int32_t c) HWY_ATTR { return g.east(c); }, [&](std::int32_t r) HWY_ATTR { return g.south(r); });
  }
  CellCodes h{hn::Load(df, h00), hn::Load(df, h10), hn::Load(df, h01), hn::Load(df, h11)};
  const VF base = hn::Set(df, g.base), per_step = hn::Set(df, g.per_step), offset = hn::Set(df, g.offset);
  const auto code = [&](VF v) HWY_ATTR { return hn::MulAdd(hn::Sub(v, base), per_step, offset); };
  return {code(h.h00), code(h.h10), code(h.h01), code(h.h11)};
}

HWY_INLINE VF in_cell(VF place) { return hn::Min(hn::Max(place, hn::Zero(df)), hn::Set(df, 1)); }

HWY_INLINE VF bilinear(const CellCodes& h, VF u, VF v) {
  const VF a = hn::Sub(h.h10, h.h00), b = hn::Sub(h.h01, h.h00), c = hn::Sub(hn::Sub(h.h11, h.h01), a);
  return hn::MulAdd(u, hn::MulAdd(v, c, a), hn::MulAdd(v, b, h.h00));
}

// A lower bound of the clearance on the path through a cell, and the clearance at its end.
struct Clearance {
  VF least, in, out;
};

HWY_INLINE Clearance bilinear_clearance(const CellCodes& h, VF u0, VF v0, VF u1, VF v1, VF z0, VF z1) {
  const VF in = hn::Sub(z0, bilinear(h, u0, v0)), out = hn::Sub(z1, bilinear(h, u1, v1));
  // Along the ray the clearance is a parabola, below its chord by at most -twist (u1 - u0) (v1 - v0) / 4; if its ends
  // differ by four times that, and by more than rounding, it is nowhere below both.
  const VF twist = hn::Sub(hn::Sub(h.h11, h.h01), hn::Sub(h.h10, h.h00));
  const VF bend = hn::Mul(hn::Mul(hn::Sub(u1, u0), hn::Sub(v1, v0)), hn::Mul(twist, hn::Set(df, -0.25f)));
  const VF steep = hn::MulAdd(bend, hn::Set(df, 4), hn::Set(df, static_cast<float>(kUpright)));
  const VF below = hn::IfThenZeroElse(hn::Ge(hn::Abs(hn::Sub(out, in)), steep), hn::Max(bend, hn::Zero(df)));
  return {hn::Sub(hn::Min(in, out), below), in, out};
}

// Over two triangles: at the ends and at the diagonal, linear in between.
HWY_INLINE Clearance triangle_clearance(const CellCodes& h, VF u0, VF v0, VF u1, VF v1, VF z0, VF z1) {
  const VF one = hn::Set(df, 1), zero = hn::Zero(df);
  const auto surface = [&](VF u, VF v) HWY_ATTR {
    const VF nw = hn::MulAdd(u, hn::Sub(h.h10, h.h00), hn::MulAdd(v, hn::Sub(h.h01, h.h00), h.h00));
    const VF se =
        hn::MulAdd(hn::Sub(one, u), hn::Sub(h.h01, h.h11), hn::MulAdd(hn::Sub(one, v), hn::Sub(h.h10, h.h11), h.h11));
    return hn::IfThenElse(hn::Le(hn::Add(u, v), one), nw, se);
  };
  const VF in = hn::Sub(z0, surface(u0, v0)), out = hn::Sub(z1, surface(u1, v1));
  const VF side0 = hn::Sub(hn::Add(u0, v0), one), side1 = hn::Sub(hn::Add(u1, v1), one);
  const VF share = hn::Div(side0, hn::Sub(side0, side1));
  const VF u = hn::MulAdd(share, hn::Sub(u1, u0), u0);
  const VF edge = hn::MulAdd(u, hn::Sub(h.h10, h.h01), h.h01);
  const VF middle = hn::Sub(hn::MulAdd(share, hn::Sub(z1, z0), z0), edge);
  const auto crosses = hn::Lt(hn::Mul(side0, side1), zero);
  return {hn::Min(hn::Min(in, out), hn::IfThenElse(crosses, middle, in)), in, out};
}

// Tests the cells of the lanes that have reached one. `may_put_off`: lanes that may continue although they are unsure,
// if they have been above the ground; they are tested again if they miss.
template <bool any, class T>
HWY_INLINE void cell_step(const VectorGround<T>& g, MI may_put_off, Packet& p) {
  const VI zero = hn::Zero(di), one = hn::Set(di, 1);
  const VF f0 = hn::Zero(df);
  const MI cells = hn::And(hn::Eq(p.status, zero), hn::Eq(p.level, zero));
  const Packet::Exit e = p.exit();
  const CellCodes h = cell_codes(g, hn::Xor(p.x, p.mirror_x), hn::Xor(p.y, p.mirror_y), cells);
  const VF to_x = hn::Sub(p.ox, hn::ConvertTo(df, hn::Sub(p.x, p.begin_x)));
  const VF to_y = hn::Sub(p.oy, hn::ConvertTo(df, hn::Sub(p.y, p.begin_y)));
  const auto back_x = hn::RebindMask(df, hn::Ne(p.mirror_x, zero)),
             back_y = hn::RebindMask(df, hn::Ne(p.mirror_y, zero));
  const auto forth = [](auto back, VF place) HWY_ATTR {
    return hn::IfThenElse(back, hn::Sub(hn::Set(df, 1), in_cell(place)), in_cell(place));
  };
  const VF u0 = forth(back_x, hn::MulAdd(p.dx, p.T, to_x)), u1 = forth(back_x, hn::MulAdd(p.dx, e.T, to_x));
  const VF v0 = forth(back_y, hn::MulAdd(p.dy, p.T, to_y)), v1 = forth(back_y, hn::MulAdd(p.dy, e.T, to_y));
  const VF z0 = p.height(p.T), z1 = p.height(e.T);
  const Clearance f =
      g.triangles ? triangle_clearance(h, u0, v0, u1, v1, z0, z1) : bilinear_clearance(h, u0, v0, u1, v1, z0, z1);
  const MI clear = hn::And(cells, hn::RebindMask(di, hn::Gt(f.least, f0)));
  MI on = clear, unsure = hn::AndNot(clear, cells);
  if constexpr (any) {
    const MI above = hn::And(cells, hn::RebindMask(di, hn::Gt(f.in, f0)));
    p.seen = hn::IfThenElse(above, one, p.seen);
    const MI seen = hn::Ne(p.seen, zero), doubtful = hn::And(unsure, seen);
    const VF margin = hn::MulAdd(hn::Set(df, g.margin_per_cell), e.T, p.margin);
    const MI below = hn::And(hn::RebindMask(di, hn::Lt(hn::Add(f.out, margin), f0)), p.before_end(e));
    const MI hit = hn::And(doubtful, below);
    p.status = hn::IfThenElse(hit, hn::Set(di, kHit), p.status);
    unsure = hn::AndNot(hit, unsure);
    p.doubt = hn::IfThenElse(hn::RebindMask(df, doubtful), hn::Min(p.doubt, p.T), p.doubt);
    const MI put_off = hn::And(unsure, hn::And(seen, may_put_off));
    on = hn::Or(on, put_off);
    unsure = hn::AndNot(put_off, unsure);
  } else {
    p.seen = hn::IfThenElse(clear, one, p.seen);
  }
  p.status = hn::IfThenElse(unsure, hn::Set(di, kUnsure), p.status);
  p.leave(on, e, g.top, one);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#endif
