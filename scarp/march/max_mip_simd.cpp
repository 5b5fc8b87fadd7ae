// SPDX-License-Identifier: MIT
#include "scarp/march/max_mip_simd.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

#include "scarp/march/max_mip.h"
#include "scarp/march/max_mip_resume.h"

// This file is compiled once for each instruction set.
// Vectors of a length that the compiler does not know cannot be members.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scarp/march/max_mip_simd.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h comes first.
#include "hwy/highway.h"

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

constexpr int kPackets = 2;  // vectors of rays in turn: while one waits for memory, the other computes
constexpr float kNever = 0x1p100f;
// Rounding of positions and line times, per cell of the ray's way, and of heights, in codes: numerics.md.
constexpr double kSideways = 0x1p-21, kUpright = 0.25;
constexpr double kUnit = 0x1p-53, kRoundings = 64;  // four times rounding_of_clearance()

// kAlone: not for the vectors.
enum Status : std::int32_t { kWalking, kMiss, kHit, kUnsure, kAlone };

// The rays of one vector in memory. Each is in a frame of its own: x and y run along the ray, mirrored where it goes
// backwards; time T is in cells along the longer axis, from the ray's begin over the field; positions are relative to
// the cell there; heights are codes, less the margin.
struct Lanes {
  alignas(64) float ox[N], oy[N], dx[N], dy[N], per_x[N], per_y[N], z[N], dz[N], margin[N], end[N], T[N], doubt[N];
  alignas(64) std::int32_t x[N], y[N], level[N], mirror_x[N], mirror_y[N], begin_x[N], begin_y[N], last_x[N], last_y[N],
      seen[N], status[N];
  double t_begin[N], t_per_cell[N];
  std::int32_t ray[N];  // -1: none
};

// The ground as the vectors need it.
template <class T>
struct VectorGround {
  const std::uint16_t *maxima, *minima;
  const T* samples;
  std::ptrdiff_t stride;
  std::int32_t last_col, last_row, top;
  alignas(64) std::int32_t level_begin[32];
  float base, per_step, offset;  // a sample's code is (sample - base) * per_step + offset
  float margin_per_cell;         // twice that of the heights
  bool triangles;
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
  // What steps change.
  HWY_INLINE void store(Lanes& a) const {
    hn::Store(T, df, a.T), hn::Store(doubt, df, a.doubt), hn::Store(x, di, a.x), hn::Store(y, di, a.y);
    hn::Store(level, di, a.level), hn::Store(seen, di, a.seen), hn::Store(status, di, a.status);
  }

  // Where the ray leaves its block.
  struct Exit {
    VI x, y;       // the lines ahead
    VF tx, ty, T;  // when it crosses them; the first of them, or its end
  };
  HWY_INLINE Exit exit() const {
    const VI one = hn::Set(di, 1), inside = hn::Sub(hn::Shl(one, level), one);
    const VF never = hn::Set(df, kNever);
    Exit e;
    e.x = hn::Add(hn::Or(x, inside), one), e.y = hn::Add(hn::Or(y, inside), one);
    e.tx = hn::Mul(hn::Sub(hn::ConvertTo(df, hn::Sub(e.x, begin_x)), ox), per_x);
    e.ty = hn::Mul(hn::Sub(hn::ConvertTo(df, hn::Sub(e.y, begin_y)), oy), per_y);
    // It leaves the field at its end, not through a line.
    e.tx = hn::IfThenElse(hn::RebindMask(df, hn::Gt(e.x, last_x)), never, e.tx);
    e.ty = hn::IfThenElse(hn::RebindMask(df, hn::Gt(e.y, last_y)), never, e.ty);
    e.T = hn::Min(hn::Min(e.tx, e.ty), end);
    return e;
  }
  HWY_INLINE VF height(VF t) const { return hn::MulAdd(dz, t, z); }

  // Whether the way out is before the ray's end for certain, which is rounded up.
  HWY_INLINE MI before_end(const Exit& e) const {
    return hn::RebindMask(di, hn::Lt(e.T, hn::Mul(end, hn::Set(df, 1 - 0x1p-20f))));
  }

  // Lanes of `clear` are done at their end, or go on to the next block: over the line ahead, and along the other axis
  // to where they are, never back. One level up where the line is the border of a coarser block.
  HWY_INLINE void leave(MI clear, const Exit& e, std::int32_t top) {
    const VI one = hn::Set(di, 1);
    const MI ends = hn::And(clear, hn::RebindMask(di, hn::Ge(e.T, end))), on = hn::AndNot(ends, clear);
    status = hn::IfThenElse(ends, hn::Set(di, kMiss), status);
    const VI at_x = hn::Max(hn::Add(hn::ConvertTo(di, hn::MulAdd(dx, e.T, ox)), begin_x), x);
    const VI at_y = hn::Max(hn::Add(hn::ConvertTo(di, hn::MulAdd(dy, e.T, oy)), begin_y), y);
    const VI to_x = hn::Min(hn::IfThenElse(hn::RebindMask(di, hn::Le(e.tx, e.T)), e.x, at_x), last_x);
    const VI to_y = hn::Min(hn::IfThenElse(hn::RebindMask(di, hn::Le(e.ty, e.T)), e.y, at_y), last_y);
    const VI coarser = hn::Add(level, one);
    const VI crossed = hn::Shr(hn::Or(hn::Xor(x, to_x), hn::Xor(y, to_y)), coarser);
    const MI up = hn::And(on, hn::Gt(crossed, hn::Zero(di)));
    level = hn::IfThenElse(up, hn::Min(coarser, hn::Set(di, top)), level);
    x = hn::IfThenElse(on, to_x, x);
    y = hn::IfThenElse(on, to_y, y);
    T = hn::IfThenElse(hn::RebindMask(df, on), e.T, T);
  }
};

// Where the levels begin, a table that stays in registers where they are wide enough.
HWY_INLINE VI level_begin(const std::int32_t* table, VI level) {
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

HWY_INLINE VI entries(const std::uint16_t* codes, VI at) {
  return hn::And(hn::GatherOffset(di, reinterpret_cast<const std::int32_t*>(codes), hn::Add(at, at)),
                 hn::Set(di, 0xffff));
}

// One step of the lanes that are at blocks.
template <bool any, class T>
HWY_INLINE void block_step(const VectorGround<T>& g, bool minima, Packet& p) {
  const VI zero = hn::Zero(di), one = hn::Set(di, 1);
  const MI walking = hn::And(hn::Eq(p.status, zero), hn::Gt(p.level, zero));
  const Packet::Exit e = p.exit();
  const VF low = hn::Min(p.height(p.T), p.height(e.T));
  // Lanes that are elsewhere look at level 1.
  const VI level = hn::Max(p.level, one);
  const VI col = hn::Shr(hn::Xor(p.x, p.mirror_x), level), row = hn::Shr(hn::Xor(p.y, p.mirror_y), level);
  const VI cols = hn::Add(hn::Shr(hn::Set(di, g.last_col), level), one);
  const VI at = hn::Add(level_begin(g.level_begin, level), hn::Add(hn::Mul(row, cols), col));
  const VF highest = hn::ConvertTo(df, entries(g.maxima, at));
  // if (low > highest) above all of the block
  const MI clear = hn::And(walking, hn::RebindMask(di, hn::Gt(low, highest)));
  MI down = hn::AndNot(clear, walking);
  if (any && minima) {
    // if (lowest != MaxPyramid::kNoMinimum && low + margin < lowest) under all of it
    const VF lowest = hn::ConvertTo(df, entries(g.minima, at));
    const VF margin = hn::MulAdd(hn::Set(df, g.margin_per_cell), e.T, p.margin);
    const MI under = hn::RebindMask(di, hn::Lt(hn::Max(hn::Add(low, margin), hn::Zero(df)), lowest));
    const MI hit = hn::And(hn::And(down, hn::Ne(p.seen, zero)), hn::And(under, p.before_end(e)));
    p.status = hn::IfThenElse(hit, hn::Set(di, kHit), p.status);
    down = hn::AndNot(hit, down);
  }
  p.seen = hn::IfThenElse(clear, one, p.seen);
  p.level = hn::IfThenElse(down, hn::Sub(p.level, one), p.level);
  p.leave(clear, e, g.top);
}

// The heights of each lane's cell as codes.
struct CellCodes {
  VF h00, h10, h01, h11;
};
template <class T>
HWY_INLINE CellCodes cell_codes(const VectorGround<T>& g, VI col, VI row, MI cells) {
  alignas(64) std::int32_t cols[N], rows[N];
  alignas(64) float h00[N] = {}, h10[N] = {}, h01[N] = {}, h11[N] = {};
  hn::Store(col, di, cols), hn::Store(row, di, rows);
  // Loads lane by lane: a gather takes as long for few lanes as for all.
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(di, cells, bytes);
  std::uint64_t bits;
  std::memcpy(&bits, bytes, sizeof bits);
  for (; bits != 0; bits &= bits - 1) {
    const auto j = static_cast<std::size_t>(std::countr_zero(bits));
    const T *north = g.samples + rows[j] * g.stride + cols[j], *south = north + g.stride;
    h00[j] = static_cast<float>(north[0]), h10[j] = static_cast<float>(north[1]);
    h01[j] = static_cast<float>(south[0]), h11[j] = static_cast<float>(south[1]);
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

// A lower bound of the clearance on the way through a cell, and the clearance at its end.
struct Clearance {
  VF least, in, out;
};

HWY_INLINE Clearance bilinear_clearance(const CellCodes& h, VF u0, VF v0, VF u1, VF v1, VF z0, VF z1) {
  const VF in = hn::Sub(z0, bilinear(h, u0, v0)), out = hn::Sub(z1, bilinear(h, u1, v1));
  // Along the ray the clearance is below its chord by at most -twist (u1 - u0) (v1 - v0) / 4.
  const VF twist = hn::Sub(hn::Sub(h.h11, h.h01), hn::Sub(h.h10, h.h00));
  const VF bend = hn::Mul(hn::Mul(hn::Sub(u1, u0), hn::Sub(v1, v0)), hn::Mul(twist, hn::Set(df, -0.25f)));
  return {hn::Sub(hn::Min(in, out), hn::Max(bend, hn::Zero(df))), in, out};
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

// The cells of the lanes that have come down to one.
template <bool any, class T>
HWY_INLINE void cell_step(const VectorGround<T>& g, bool put_off, Packet& p) {
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
    if (put_off) {
      on = hn::Or(on, hn::And(unsure, seen));
      unsure = hn::AndNot(seen, unsure);
    }
  } else {
    p.seen = hn::IfThenElse(clear, one, p.seen);
  }
  p.status = hn::IfThenElse(unsure, hn::Set(di, kUnsure), p.status);
  p.leave(on, e, g.top);
}

// Rays in grid units, one for each lane.
struct GridRays {
  alignas(64) double ox[N], oy[N], oz[N], dx[N], dy[N], dz[N], t_min[N], t_max[N];
  std::int32_t seen[N];
};

// The field as the way into the vectors needs it; heights in sample units.
struct FieldFrame {
  double cols, rows, sample_rows, highest, base, per_step;
  double relief, cell_relief;  // of all samples, of a cell
  double upright;              // see rounding_of_clearance()
  double mask;                 // of mirrored cells: column c is column mask - c
  double from_outside;         // the level of rays from above or outside
};

// Four times rounding_of_clearance() of a ray up to time t.
HWY_INLINE VD rounding(const FieldFrame& f, VD ox, VD oy, VD oz, VD dx, VD dy, VD dz, VD t) {
  const VD upright = hn::Add(hn::Set(dd, f.upright), hn::Add(hn::Abs(oz), hn::Abs(hn::Mul(dz, t))));
  const VD sideways =
      hn::Add(hn::Add(hn::Abs(ox), hn::Abs(hn::Mul(dx, t))), hn::Add(hn::Abs(oy), hn::Abs(hn::Mul(dy, t))));
  const VD wide = hn::Mul(hn::Add(sideways, hn::Set(dd, f.sample_rows)), hn::Set(dd, f.relief));
  return hn::Mul(hn::Set(dd, kRoundings * kUnit), hn::Add(upright, wide));
}

// One axis of rays: mirrored so that they go forth, and when they are in the field.
struct AxisSpan {
  VD origin, direction, per, enter, exit;
  hn::Mask<decltype(dd)> back;
};
HWY_INLINE AxisSpan axis_span(VD o, VD d, VD cells) {
  const VD zero = hn::Zero(dd), far = hn::Set(dd, std::numeric_limits<double>::infinity());
  AxisSpan s;
  s.back = hn::Lt(d, zero);
  s.origin = hn::IfThenElse(s.back, hn::Sub(cells, o), o);
  s.direction = hn::Abs(d);
  s.per = hn::Div(hn::Set(dd, 1), s.direction);
  // A ray that does not move along the axis is within the field always or never.
  const auto still = hn::Eq(d, zero), within = hn::And(hn::Ge(o, zero), hn::Le(o, cells));
  s.enter = hn::IfThenElse(still, hn::IfThenElse(within, hn::Neg(far), far), hn::Mul(hn::Neg(s.origin), s.per));
  s.exit = hn::IfThenElse(still, far, hn::Mul(hn::Sub(cells, s.origin), s.per));
  return s;
}

// Rays into lanes: clipped to the field and to its highest sample, the first cell found. Lanes that the vectors cannot
// follow are kAlone.
HWY_NOINLINE void prepare(const FieldFrame& f, const GridRays& r, Lanes& a) {
  for (std::size_t part = 0; part < N; part += hn::MaxLanes(dd)) {
    const VD zero = hn::Zero(dd), one = hn::Set(dd, 1), cols = hn::Set(dd, f.cols), rows = hn::Set(dd, f.rows);
    const VD ox = hn::Load(dd, r.ox + part), oy = hn::Load(dd, r.oy + part), oz = hn::Load(dd, r.oz + part);
    const VD dx = hn::Load(dd, r.dx + part), dy = hn::Load(dd, r.dy + part), dz = hn::Load(dd, r.dz + part);
    const VD t_min = hn::Load(dd, r.t_min + part);
    const AxisSpan x = axis_span(ox, dx, cols), y = axis_span(oy, dy, rows);
    const VD longest = hn::Max(x.direction, y.direction), per_longest = hn::Min(x.per, y.per);
    const VD t_border = hn::Max(t_min, hn::Max(x.enter, y.enter));
    const VD t_exit = hn::Min(hn::Load(dd, r.t_max + part), hn::Min(x.exit, y.exit));
    // Down to the highest sample; up to where nothing is as high.
    const VD highest = hn::Set(dd, f.highest);
    const auto height = [&](VD t) HWY_ATTR { return hn::Add(oz, hn::Mul(dz, t)); };
    const auto falls = hn::Lt(dz, zero), from_above = hn::Gt(height(t_border), highest);
    const VD quotient = hn::Div(hn::Sub(highest, oz), dz);
    const VD t_top = hn::Sub(quotient, hn::Mul(hn::Set(dd, 4 * kUnit), hn::Abs(quotient)));
    const VD t_begin = hn::IfThenElse(hn::And(from_above, falls), hn::Max(t_border, t_top), t_border);
    const VD t_far = hn::Max(hn::Abs(t_begin), hn::Abs(t_exit));
    const VD doubt = rounding(f, ox, oy, oz, dx, dy, dz, t_far), over = hn::Add(highest, doubt);
    const VD t_over = hn::Div(hn::Sub(over, oz), dz);
    const VD t_end = hn::IfThenElse(hn::Gt(dz, zero), hn::Min(t_exit, t_over), t_exit);
    // Of usual lengths, and not so steep that a cell is more than 2^30 codes high: far from where floats end.
    const VD per_step = hn::Set(dd, f.per_step), slope = hn::Mul(hn::Mul(dz, per_step), per_longest);
    const auto sound =
        hn::And(hn::And(hn::Gt(longest, hn::Set(dd, 0x1p-300)), hn::Lt(longest, hn::Set(dd, 0x1p300))),
                hn::And(hn::Lt(hn::Abs(slope), hn::Set(dd, 0x1p30)), hn::Lt(t_far, hn::Set(dd, 0x1p300))));
    const auto climbs_from_above = hn::AndNot(falls, from_above);
    const auto followed = hn::And(sound, hn::AndNot(climbs_from_above, hn::Lt(t_begin, t_end)));
    // Beside the field, or above all ground from begin to end.
    const VD tie = hn::Mul(hn::Set(dd, 0x1p-40), hn::Add(hn::Abs(t_border), hn::Abs(t_exit)));
    const auto beside = hn::Gt(hn::Sub(t_border, t_exit), tie);
    const auto stays_above = hn::And(hn::And(hn::Gt(height(t_border), over), hn::Lt(t_border, t_exit)),
                                     hn::Or(hn::Not(falls), hn::Gt(height(t_exit), over)));
    const auto misses = hn::And(sound, hn::Or(beside, stays_above));
    const VD at_x = hn::Add(x.origin, hn::Mul(x.direction, t_begin)),
             at_y = hn::Add(y.origin, hn::Mul(y.direction, t_begin));
    const auto cell = [&](VD at, VD cells) HWY_ATTR {
      return hn::IfThenElseZero(followed, hn::Min(hn::Max(hn::Floor(at), zero), hn::Sub(cells, one)));
    };
    const VD cell_x = cell(at_x, cols), cell_y = cell(at_y, rows);
    const auto put = [&](VD v, float* to) HWY_ATTR { hn::Store(hn::DemoteTo(df_part, v), df_part, to + part); };
    put(hn::Min(hn::Max(hn::Sub(at_x, cell_x), zero), one), a.ox);
    put(hn::Min(hn::Max(hn::Sub(at_y, cell_y), zero), one), a.oy);
    put(hn::Mul(x.direction, per_longest), a.dx), put(hn::Mul(y.direction, per_longest), a.dy);
    const VD most = hn::Set(dd, 0x1p60);
    put(hn::Min(hn::Mul(longest, x.per), most), a.per_x), put(hn::Min(hn::Mul(longest, y.per), most), a.per_y);
    // Positions are known to kSideways (T + 2) along either axis.
    const double sideways = 2 * kSideways * f.cell_relief * f.per_step;
    const VD margin = hn::Add(hn::Set(dd, kUpright + 2 * sideways), hn::Mul(doubt, per_step));
    put(hn::Sub(hn::Mul(hn::Sub(height(t_begin), hn::Set(dd, f.base)), per_step), margin), a.z);
    put(hn::Sub(slope, hn::Set(dd, sideways)), a.dz);
    put(hn::Add(margin, margin), a.margin);
    put(hn::Mul(hn::Mul(hn::Sub(t_end, t_begin), longest), hn::Set(dd, 1 + 0x1p-22)), a.end);
    hn::Store(t_begin, dd, a.t_begin + part), hn::Store(per_longest, dd, a.t_per_cell + part);
    const auto put_whole = [&](VD v, std::int32_t* to)
                               HWY_ATTR { hn::Store(hn::DemoteTo(di_part, v), di_part, to + part); };
    const VD mask = hn::Set(dd, f.mask), last_x = hn::Sub(cols, one), last_y = hn::Sub(rows, one);
    const VD shift_x = hn::IfThenElseZero(x.back, hn::Sub(mask, last_x));
    const VD shift_y = hn::IfThenElseZero(y.back, hn::Sub(mask, last_y));
    put_whole(hn::IfThenElseZero(x.back, mask), a.mirror_x), put_whole(hn::IfThenElseZero(y.back, mask), a.mirror_y);
    put_whole(hn::Add(cell_x, shift_x), a.x), put_whole(hn::Add(cell_y, shift_y), a.y);
    put_whole(hn::Add(shift_x, last_x), a.last_x), put_whole(hn::Add(shift_y, last_y), a.last_y);
    const auto outside = hn::And(followed, hn::Ne(t_begin, t_min));
    put_whole(hn::IfThenElseZero(outside, hn::Set(dd, f.from_outside)), a.level);
    put_whole(hn::IfThenElseZero(hn::And(followed, from_above), one), a.seen);
    const VD status = hn::IfThenElse(followed, hn::Set(dd, kWalking), hn::Set(dd, kAlone));
    put_whole(hn::IfThenElse(misses, hn::Set(dd, kMiss), status), a.status);
  }
  for (std::size_t j = 0; j < N; ++j) {
    a.begin_x[j] = a.x[j], a.begin_y[j] = a.y[j], a.T[j] = 0, a.doubt[j] = kNever;
    if (a.status[j] == kWalking) a.seen[j] |= r.seen[j];
  }
}

// Rays that may hit in a cell.
struct Candidates {
  std::size_t count = 0;
  std::int32_t ray[N], col[N], row[N], seen[N];
  double t_clear[N];
};

// The walk of many rays, one batch on one thread.
template <bool any, class T>
class VectorWalk {
 public:
  using Answer = std::conditional_t<any, std::uint8_t, Hit>;

  VectorWalk(const HeightTarget& target, const SampleGrid<T>& grid, std::span<const Ray> rays, Answer* answers,
             const VectorIdeas& ideas)
      : target_(target), field_(*target.field), rays_(rays), answers_(answers), ideas_(ideas) {
    const MaxPyramid& pyramid = *target.pyramid;
    const HeightCode& code = pyramid.code();
    g_ = {};
    g_.maxima = pyramid.maxima(), g_.minima = pyramid.minima();
    g_.samples = grid.data, g_.stride = grid.row_stride;
    g_.last_col = grid.cell_cols - 1, g_.last_row = grid.cell_rows - 1, g_.top = pyramid.top_level();
    for (int level = 1; level <= g_.top; ++level) {
      g_.level_begin[level] = static_cast<std::int32_t>(pyramid.levels()[static_cast<std::size_t>(level - 1)].begin);
    }
    g_.base = static_cast<float>(code.base), g_.per_step = static_cast<float>(code.per_step);
    g_.offset = static_cast<float>((static_cast<double>(g_.base) - code.base) * code.per_step);
    g_.triangles = field_.settings().surface == Surface::triangles;
    const double low = field_.min_sample(), high = field_.max_sample(), relief = high - low;
    const double cell_relief = std::min(relief, pyramid.cell_relief() * code.step);
    g_.margin_per_cell = static_cast<float>(4 * kSideways * cell_relief * code.per_step);
    // No less than 2: a mask of 0 would not tell what is mirrored.
    const auto side = std::bit_ceil(static_cast<unsigned>(std::max({grid.cell_cols, grid.cell_rows, 2})));
    f_ = {.cols = static_cast<double>(grid.cell_cols),
          .rows = static_cast<double>(grid.cell_rows),
          .sample_rows = static_cast<double>(field_.rows()),
          .highest = high,
          .base = code.base,
          .per_step = code.per_step,
          .relief = relief,
          .cell_relief = cell_relief,
          .upright =
              std::max(std::abs(low), std::abs(high)) + std::abs(field_.settings().offset) / field_.settings().scale,
          .mask = static_cast<double>(side - 1),
          .from_outside = static_cast<double>(std::max(g_.top - 3, 0))};
  }

  void run(VectorStats& stats) {
    for (Lanes& lanes : lanes_) {
      lanes = {};
      std::fill_n(lanes.ray, N, -1);
      std::fill_n(lanes.status, N, kMiss);
      refill(lanes);
    }
    Packet packets[kPackets];
    for (int k = 0; k < kPackets; ++k) packets[k].load(lanes_[k]);
    for (bool live = true; live;) {
      live = false;
      for (Packet& p : packets) block_step<any>(g_, ideas_.minima, p);
      for (int k = 0; k < kPackets; ++k) live = follow_up(packets[k], lanes_[k]) || live;
    }
    if constexpr (!any) {
      if (candidates_.count > 0) find_hits();
    }
    stats.block_lanes += stats_.block_lanes, stats.block_steps += stats_.block_steps;
    stats.cell_lanes += stats_.cell_lanes, stats.cell_steps += stats_.cell_steps;
    stats.handed_over += stats_.handed_over;
  }

 private:
  // Cells and new rays, when enough lanes wait for them. False: no lane has a ray, and there are no more.
  HWY_INLINE bool follow_up(Packet& p, Lanes& lanes) {
    const VI zero = hn::Zero(di);
    const MI walking = hn::Eq(p.status, zero), at_cells = hn::And(walking, hn::Eq(p.level, zero));
    const std::size_t busy = hn::CountTrue(di, walking), cells = hn::CountTrue(di, at_cells);
    stats_.block_steps += N;
    stats_.block_lanes += busy - cells;
    const std::size_t company = ideas_.wait ? kCompany : 1;
    if (cells >= company || (cells > 0 && cells == busy)) {
      stats_.cell_steps += N;
      stats_.cell_lanes += cells;
      cell_step<any>(g_, ideas_.put_off, p);
    }
    if (busy == 0 || (N - busy >= (ideas_.refill ? kFree : N) && !is_empty())) {
      p.store(lanes);
      if (!refill(lanes)) return false;
      p.load(lanes);
    }
    return true;
  }

  bool is_empty() const { return next_ >= rays_.size() && fresh_next_ >= N; }

  // Answers the rays that are done and puts new ones into their lanes. False: no lane has a ray.
  HWY_NOINLINE bool refill(Lanes& a) {
    bool live = false;
    for (std::size_t j = 0; j < N; ++j) {
      if (a.status[j] != kWalking) {
        answer(a, j);
        a.ray[j] = -1;
        if (!next_fresh()) continue;
        move(fresh_, fresh_next_++, a, j);
      }
      live = true;
    }
    return live;
  }

  // Whether there is another ray, at fresh_next_. Rays that need no walk are answered on the way.
  bool next_fresh() {
    for (;;) {
      while (fresh_next_ < N && fresh_.status[fresh_next_] != kWalking) answer(fresh_, fresh_next_++);
      if (fresh_next_ < N) return true;
      if (next_ >= rays_.size()) return false;
      take_rays();
    }
  }

  static void move(const Lanes& from, std::size_t i, Lanes& to, std::size_t j) {
    to.ox[j] = from.ox[i], to.oy[j] = from.oy[i], to.dx[j] = from.dx[i], to.dy[j] = from.dy[i];
    to.per_x[j] = from.per_x[i], to.per_y[j] = from.per_y[i], to.z[j] = from.z[i], to.dz[j] = from.dz[i];
    to.margin[j] = from.margin[i], to.end[j] = from.end[i], to.T[j] = from.T[i], to.doubt[j] = from.doubt[i];
    to.x[j] = from.x[i], to.y[j] = from.y[i], to.level[j] = from.level[i];
    to.mirror_x[j] = from.mirror_x[i], to.mirror_y[j] = from.mirror_y[i];
    to.begin_x[j] = from.begin_x[i], to.begin_y[j] = from.begin_y[i];
    to.last_x[j] = from.last_x[i], to.last_y[j] = from.last_y[i];
    to.seen[j] = from.seen[i], to.status[j] = from.status[i];
    to.t_begin[j] = from.t_begin[i], to.t_per_cell[j] = from.t_per_cell[i], to.ray[j] = from.ray[i];
  }

  // The next rays into fresh_. The first steps of any-hit are taken here, where all lanes are busy: most rays begin
  // near the ground, at a cell.
  HWY_NOINLINE void take_rays() {
    const std::size_t count = std::min(N, rays_.size() - next_);
    for (std::size_t j = 0; j < N; ++j) {
      const bool taken = j < count && take_ray(j, rays_[next_ + j]);
      fresh_.ray[j] = taken ? static_cast<std::int32_t>(next_ + j) : -1;
      if (!taken) r_.dx[j] = r_.dy[j] = 0;
    }
    next_ += count;
    fresh_next_ = 0;
    prepare(f_, r_, fresh_);
    if (any && ideas_.first_cells) {
      Packet p;
      p.load(fresh_);
      for (int i = 0; i < kFirstSteps; ++i) {
        cell_step<any>(g_, ideas_.put_off, p);
        block_step<any>(g_, ideas_.minima, p);
      }
      p.store(fresh_);
    }
  }

  // The scalar walk believes in the start cell, the vectors in positions: they follow where the two agree.
  HWY_NOINLINE SurfaceStart begin_on_surface(const Ray& ray, const GridRay& local) const {
    const auto is_in = [&](double o, double d, int cell) {
      return std::abs(o + d * ray.t_min - cell - 0.5) < 0.5 + kNearCell;
    };
    if (is_in(local.origin.x, local.direction.x, ray.start_cell.col) &&
        is_in(local.origin.y, local.direction.y, ray.start_cell.row)) {
      return start_max_mip(target_, ray);
    }
    SurfaceStart decided{};
    decided.hit = march_max_mip(target_, ray);
    return decided;
  }

  // A ray into the grid. False: it is answered.
  bool take_ray(std::size_t j, const Ray& ray) {
    const GridRay local = field_.grid_from_world(ray);
    r_.ox[j] = local.origin.x, r_.oy[j] = local.origin.y, r_.oz[j] = local.origin.z;
    r_.dx[j] = local.direction.x, r_.dy[j] = local.direction.y, r_.dz[j] = local.direction.z;
    r_.t_min[j] = ray.t_min, r_.t_max[j] = ray.t_max, r_.seen[j] = 0;
    if (ray.start == RayStart::free) return true;
    const SurfaceStart start = begin_on_surface(ray, local);
    Answer& to = answers_[&ray - rays_.data()];
    if (start.decided) {
      if constexpr (any) {
        to = start.hit.status == HitStatus::hit;
      } else {
        to = start.hit;
      }
      return false;
    }
    r_.oz[j] = start.z, r_.t_min[j] = start.t, r_.seen[j] = start.above;
    return true;
  }

  void answer(const Lanes& a, std::size_t j) {
    const std::int32_t ray = a.ray[j];
    if (ray < 0) return;
    const auto time = [&](float cells) { return a.t_begin[j] + static_cast<double>(cells) * a.t_per_cell[j]; };
    if constexpr (any) {
      const bool doubtful = a.doubt[j] < kNever;
      bool hit = a.status[j] == kHit;
      if (!hit && (a.status[j] != kMiss || doubtful)) {
        ++stats_.handed_over;
        hit = resume_occluded_max_mip(target_, rays_[static_cast<std::size_t>(ray)],
                                      doubtful ? time(a.doubt[j]) : max_mip::kNotClear);
      }
      answers_[ray] = hit;
    } else {
      if (a.status[j] == kMiss) {
        answers_[ray] = Hit{};
        return;
      }
      if (a.status[j] == kAlone) {
        ++stats_.handed_over;
        answers_[ray] = march_max_mip(target_, rays_[static_cast<std::size_t>(ray)]);
        return;
      }
      Candidates& c = candidates_;
      c.ray[c.count] = ray, c.seen[c.count] = a.seen[j];
      c.col[c.count] = a.x[j] ^ a.mirror_x[j], c.row[c.count] = a.y[j] ^ a.mirror_y[j];
      c.t_clear[c.count] = time(a.T[j]);
      if (++c.count == N) find_hits();
    }
  }

  // Hits in the cells of the candidates as march_max_mip() computes them, bit for bit: the same operations in the same
  // order, for the usual way through a cell. It is asked where the way is another one, and where there is no hit.
  HWY_NOINLINE void find_hits() {
    Candidates& c = candidates_;
    alignas(64) double ox[N], oy[N], oz[N], dx[N], dy[N], dz[N], t_min[N], t_max[N], col[N], row[N], h00[N], h10[N],
        h01[N], h11[N], t_clear[N], t[N], u[N], v[N], height[N], found[N];
    for (std::size_t i = 0; i < N; ++i) {
      const std::size_t k = i < c.count ? i : 0;
      const Ray& ray = rays_[static_cast<std::size_t>(c.ray[k])];
      const GridRay local = field_.grid_from_world(ray);
      ox[i] = local.origin.x, oy[i] = local.origin.y, oz[i] = local.origin.z;
      dx[i] = local.direction.x, dy[i] = local.direction.y, dz[i] = local.direction.z;
      t_min[i] = ray.t_min, t_max[i] = ray.t_max, col[i] = c.col[k], row[i] = c.row[k], t_clear[i] = c.t_clear[k];
      const T *north = g_.samples + c.row[k] * g_.stride + c.col[k], *south = north + g_.stride;
      h00[i] = static_cast<double>(north[0]), h10[i] = static_cast<double>(north[1]);
      h01[i] = static_cast<double>(south[0]), h11[i] = static_cast<double>(south[1]);
    }
    for (std::size_t h = 0; h < N; h += hn::MaxLanes(dd)) {
      const auto at = [h](const double* from) HWY_ATTR { return hn::Load(dd, from + h); };
      const VD least = hn::Set(dd, 0x1p-1000), zero = hn::Zero(dd), one = hn::Set(dd, 1), two = hn::Set(dd, 2),
               four = hn::Set(dd, 4);
      const VD vox = at(ox), voy = at(oy), z = at(oz), vdx = at(dx), vdy = at(dy), vdz = at(dz);
      const VD vcol = at(col), vrow = at(row), vt_min = at(t_min), vt_max = at(t_max);
      const VD a00 = at(h00), a10 = at(h10), a01 = at(h01), a11 = at(h11);
      const auto back_x = hn::Lt(vdx, zero), back_y = hn::Lt(vdy, zero);
      const VD per_x = hn::Div(one, vdx), per_y = hn::Div(one, vdy);
      const auto line = [](VD k, VD o, VD per) HWY_ATTR { return hn::Mul(hn::Sub(k, o), per); };
      const VD next_x = hn::Add(vcol, one), next_y = hn::Add(vrow, one);
      const VD tx_in = line(hn::IfThenElse(back_x, next_x, vcol), vox, per_x);
      const VD ty_in = line(hn::IfThenElse(back_y, next_y, vrow), voy, per_y);
      const VD tx = line(hn::IfThenElse(back_x, vcol, next_x), vox, per_x);
      const VD ty = line(hn::IfThenElse(back_y, vrow, next_y), voy, per_y);
      const VD exit_x = line(hn::IfThenElse(back_x, zero, hn::Set(dd, f_.cols)), vox, per_x);
      const VD exit_y = line(hn::IfThenElse(back_y, zero, hn::Set(dd, f_.rows)), voy, per_y);
      const VD t_in = hn::Max(vt_min, hn::Max(tx_in, ty_in)), t_end = hn::Min(vt_max, hn::Min(exit_x, exit_y));
      const VD t_line = hn::Min(tx, ty), t_out = hn::Min(t_line, t_end), length = hn::Sub(t_out, t_in);
      const auto place = [&](VD o, VD d, VD time, VD cell) HWY_ATTR {
        return hn::Min(hn::Max(hn::Sub(hn::Add(o, hn::Mul(d, time)), cell), zero), one);
      };
      // CellQuadratic at t_in
      const VD u0 = place(vox, vdx, t_in, vcol), v0 = place(voy, vdy, t_in, vrow);
      const VD hu = hn::Sub(a10, a00), hv = hn::Sub(a01, a00), twist = hn::Sub(hn::Sub(a11, a01), hu);
      const VD a = hn::Mul(hn::Mul(hn::Sub(hn::Sub(a10, a00), hn::Sub(a11, a01)), vdx), vdy);
      const VD b = hn::Sub(vdz, hn::Add(hn::Add(hn::Mul(hu, vdx), hn::Mul(hv, vdy)),
                                        hn::Mul(twist, hn::Add(hn::Mul(u0, vdy), hn::Mul(v0, vdx)))));
      const VD surface =
          hn::Add(hn::Add(hn::Add(a00, hn::Mul(hu, u0)), hn::Mul(hv, v0)), hn::Mul(hn::Mul(twist, u0), v0));
      const VD z_in = hn::Add(z, hn::Mul(vdz, t_in)), z_out = hn::Add(z, hn::Mul(vdz, t_out));
      const VD cc = hn::Sub(z_in, surface);
      // clearance() where it leaves through a line
      const auto edge = [&](VD p, VD q, VD w) HWY_ATTR {
        return hn::Min(hn::Max(hn::Add(p, hn::Mul(w, hn::Sub(q, p))), hn::Min(p, q)), hn::Max(p, q));
      };
      const VD on_x =
          edge(hn::IfThenElse(back_x, a00, a10), hn::IfThenElse(back_x, a01, a11), place(voy, vdy, t_out, vrow));
      const VD on_y =
          edge(hn::IfThenElse(back_y, a00, a01), hn::IfThenElse(back_y, a10, a11), place(vox, vdx, t_out, vcol));
      const VD out = hn::Sub(z_out, hn::IfThenElse(hn::Le(tx, ty), on_x, on_y));
      const VD t_far = hn::Max(hn::Abs(t_in), hn::Abs(t_out));
      const VD doubt = rounding(f_, vox, voy, z, vdx, vdy, vdz, t_far);
      // Above until it comes into the cell: known up to t_clear, and from there on because of how steep ground is.
      const VD gap = hn::Max(hn::Sub(t_in, at(t_clear)), zero);
      const VD steepest =
          hn::Add(hn::Abs(vdz), hn::Mul(hn::Add(hn::Abs(vdx), hn::Abs(vdy)), hn::Set(dd, f_.cell_relief)));
      const auto above = hn::Gt(cc, hn::Add(hn::Mul(gap, steepest), doubt));
      // march_max_mip() begins where the ray comes down to the highest sample, not before.
      const VD quotient = hn::Div(hn::Sub(hn::Set(dd, f_.highest), z), vdz);
      const VD t_top = hn::Sub(quotient, hn::Mul(hn::Set(dd, 2 * kUnit), hn::Abs(quotient)));
      const auto begun = hn::Or(hn::Ge(vdz, zero), hn::Ge(t_line, t_top));
      const auto moves = hn::And(hn::Gt(hn::Abs(vdx), least), hn::Gt(hn::Abs(vdy), least));
      const auto visited = hn::And(hn::And(hn::Lt(t_in, t_line), hn::Le(t_line, t_end)), hn::And(begun, moves));
      const auto usual = hn::And(above, visited);
      const VD highest = hn::Max(hn::Max(a00, a10), hn::Max(a01, a11));
      const VD lowest = hn::IfThenElse(hn::Lt(vdz, zero), z_out, z_in);
      const VD square = hn::Mul(b, b), ac4 = hn::Mul(hn::Mul(four, a), cc);
      const auto dips = hn::And(hn::And(hn::Gt(a, zero), hn::Lt(b, zero)),
                                hn::And(hn::Lt(hn::Neg(b), hn::Mul(hn::Mul(two, a), length)), hn::Ge(square, ac4)));
      const auto hit = hn::And(hn::And(usual, hn::Not(hn::Gt(lowest, highest))), hn::Or(hn::Le(out, zero), dips));
      const VD root = hn::Sqrt(hn::Max(zero, hn::Sub(square, ac4)));
      const auto falls = hn::Lt(b, zero);
      const VD s = hn::Div(hn::IfThenElse(falls, hn::Mul(two, cc), hn::Neg(hn::Add(b, root))),
                           hn::IfThenElse(falls, hn::Sub(root, b), hn::Mul(two, a)));
      const VD in_cell = hn::IfThenElseZero(hn::Ge(s, zero), hn::Min(s, length));
      const VD time = hn::Min(hn::Max(hn::Add(t_in, in_cell), vt_min), vt_max);
      hn::Store(time, dd, t + h);
      hn::Store(place(vox, vdx, time, vcol), dd, u + h), hn::Store(place(voy, vdy, time, vrow), dd, v + h);
      hn::Store(hn::Add(z, hn::Mul(vdz, time)), dd, height + h);
      hn::Store(hn::IfThenElseZero(hit, one), dd, found + h);
    }
    const bool usual = ideas_.find_hits && !g_.triangles;
    for (std::size_t i = 0; i < c.count; ++i) {
      const Ray& ray = rays_[static_cast<std::size_t>(c.ray[i])];
      Hit& to = answers_[c.ray[i]];
      if (usual && found[i] != 0 && ray.start == RayStart::free) {
        to.status = HitStatus::hit, to.t = t[i], to.cell = {c.col[i], c.row[i]}, to.u = u[i], to.v = v[i];
        to.height = field_.height_from_sample(height[i]), to.wall = false;
      } else {
        ++stats_.handed_over;
        to = resume_max_mip(target_, ray, c.seen[i] ? c.t_clear[i] : max_mip::kNotClear);
      }
    }
    c.count = 0;
  }

  // From a search over the rays of scarp-bench (decisions.md): lanes that wait until they are served.
  static constexpr std::size_t kCompany = std::max<std::size_t>(1, any ? N / 4 : N * 3 / 8);
  static constexpr std::size_t kFree = std::max<std::size_t>(1, any ? N / 4 : N / 2);
  static constexpr int kFirstSteps = 2;
  static constexpr double kNearCell = 0x1p-20;  // of a cell, far beyond rounding

  const HeightTarget& target_;
  const HeightField& field_;
  std::span<const Ray> rays_;
  Answer* answers_;
  const VectorIdeas& ideas_;
  VectorGround<T> g_;
  FieldFrame f_;
  GridRays r_;
  Lanes fresh_, lanes_[kPackets];
  std::size_t next_ = 0, fresh_next_ = N;
  Candidates candidates_;
  VectorStats stats_;
};

template <bool any, class Answer>
void walk(const HeightTarget& target, std::span<const Ray> rays, Answer* answers, const VectorIdeas& ideas,
          VectorStats& stats) {
  target.field->visit([&](const auto& grid) {
    using T = std::remove_cvref_t<decltype(grid.data[0])>;
    VectorWalk<any, T>(target, grid, rays, answers, ideas).run(stats);
  });
}
void walk_closest(const HeightTarget& target, std::span<const Ray> rays, Hit* hits, const VectorIdeas& ideas,
                  VectorStats& stats) {
  walk<false>(target, rays, hits, ideas, stats);
}
void walk_any(const HeightTarget& target, std::span<const Ray> rays, std::uint8_t* blocked, const VectorIdeas& ideas,
              VectorStats& stats) {
  walk<true>(target, rays, blocked, ideas, stats);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace scarp {
namespace {

HWY_EXPORT(walk_closest);
HWY_EXPORT(walk_any);

thread_local VectorStats t_stats;

// Fields that the vectors do not walk over: those that wrap round, those with holes, where a ray that is above all
// ground may be below the rim of the next cell, and those beyond 32-bit offsets or floats.
bool walks_over(const HeightTarget& target) {
  const HeightField& field = *target.field;
  if (!field.has_cells() || field.nodata_count() > 0 || field.wraps()) return false;
  const HeightCode& code = target.pyramid->code();
  return target.pyramid->bytes() < (std::size_t{1} << 32) && code.per_step > 0x1p-100 && code.per_step < 0x1p100 &&
         std::abs(code.base) < 0x1p100;
}

}  // namespace

void closest_hits_max_mip_simd(const HeightTarget& target, std::span<const Ray> rays, std::span<Hit> hits,
                               const VectorIdeas& ideas) {
  if (walks_over(target)) {
    HWY_DYNAMIC_DISPATCH(walk_closest)(target, rays, hits.data(), ideas, t_stats);
  } else {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = march_max_mip(target, rays[i]);
  }
}

void occluded_max_mip_simd(const HeightTarget& target, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                           const VectorIdeas& ideas) {
  if (walks_over(target)) {
    HWY_DYNAMIC_DISPATCH(walk_any)(target, rays, blocked.data(), ideas, t_stats);
  } else {
    for (std::size_t i = 0; i < rays.size(); ++i) blocked[i] = occluded_max_mip(target, rays[i]);
  }
}

VectorStats take_vector_stats() { return std::exchange(t_stats, {}); }

}  // namespace scarp
#endif
