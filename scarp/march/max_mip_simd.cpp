// SPDX-License-Identifier: MIT
#include "scarp/march/max_mip_simd.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "scarp/march/max_mip.h"
#include "scarp/march/max_mip_resume.h"
#include "scarp/march/rounding.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE SCARP_SELF
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#ifndef LAB_LANES
#define LAB_LANES 8
#endif
constexpr hn::CappedTag<float, LAB_LANES> df;
constexpr hn::RebindToSigned<decltype(df)> di;
constexpr hn::RebindToUnsigned<decltype(df)> du;
using VF = hn::Vec<decltype(df)>;
using VI = hn::Vec<decltype(di)>;
using MF = hn::Mask<decltype(df)>;
using MI = hn::Mask<decltype(di)>;
constexpr std::size_t N = hn::MaxLanes(df);

constexpr float kNever = 0x1p100f;
enum Status : std::int32_t { kWalking = 0, kMiss = 1, kHit = 2, kUnsure = 3 };

struct Lanes {
  alignas(64) float ox[N], oy[N], dx[N], dy[N], ix[N], iy[N], z[N], dz[N], m2[N], tend[N], T[N], doubt[N];
  alignas(64) std::int32_t X[N], Y[N], l[N], mx[N], my[N], bx[N], by[N], xl[N], yl[N], seen[N], st[N];
  double t0[N], t_per_tau[N];
  std::int32_t ray[N];
};

template <class T>
struct Ground {
  const std::uint32_t* words;
  const std::uint16_t *maxima, *minima;
  const T* samples;
  std::int32_t stride, cols_1, rows_1, top;
  double base, per_step;
  float m1x2;
  alignas(64) std::int32_t begin[32];
};

struct Packet {
  VF ox, oy, dx, dy, ix, iy, z, dz, m2, tend, T, doubt;
  VI X, Y, l, mx, my, bx, by, xl, yl, seen, st;

  HWY_INLINE void load(const Lanes& a) {
    ox = hn::Load(df, a.ox), oy = hn::Load(df, a.oy), dx = hn::Load(df, a.dx), dy = hn::Load(df, a.dy);
    ix = hn::Load(df, a.ix), iy = hn::Load(df, a.iy), z = hn::Load(df, a.z), dz = hn::Load(df, a.dz);
    m2 = hn::Load(df, a.m2), tend = hn::Load(df, a.tend), T = hn::Load(df, a.T);
    doubt = hn::Load(df, a.doubt);
    X = hn::Load(di, a.X), Y = hn::Load(di, a.Y), l = hn::Load(di, a.l), mx = hn::Load(di, a.mx);
    my = hn::Load(di, a.my), bx = hn::Load(di, a.bx), by = hn::Load(di, a.by), xl = hn::Load(di, a.xl);
    yl = hn::Load(di, a.yl), seen = hn::Load(di, a.seen), st = hn::Load(di, a.st);
  }
  HWY_INLINE void store(Lanes& a) const {
    hn::Store(T, df, a.T);
    hn::Store(doubt, df, a.doubt);
    hn::Store(X, di, a.X), hn::Store(Y, di, a.Y), hn::Store(l, di, a.l), hn::Store(seen, di, a.seen);
    hn::Store(st, di, a.st);
  }

  struct Exit {
    VI kx, ky;
    VF tx, ty, te;
  };
  HWY_INLINE Exit exit() const {
    const VI one = hn::Set(di, 1);
    const VI s = hn::Sub(hn::Shl(one, l), one);
    Exit e;
    e.kx = hn::Add(hn::Or(X, s), one), e.ky = hn::Add(hn::Or(Y, s), one);
    e.tx = hn::Mul(hn::Sub(hn::ConvertTo(df, hn::Sub(e.kx, bx)), ox), ix);
    e.ty = hn::Mul(hn::Sub(hn::ConvertTo(df, hn::Sub(e.ky, by)), oy), iy);
    // A ray leaves the field at its end, not at a line.
    const VF never = hn::Set(df, kNever);
    e.tx = hn::IfThenElse(hn::RebindMask(df, hn::Gt(e.kx, xl)), never, e.tx);
    e.ty = hn::IfThenElse(hn::RebindMask(df, hn::Gt(e.ky, yl)), never, e.ty);
    e.te = hn::Min(hn::Min(e.tx, e.ty), tend);
    return e;
  }
  HWY_INLINE VF height(VF t) const { return hn::MulAdd(dz, t, z); }

  // Lanes of `on` go on to the next block.
  HWY_INLINE void advance(MI on, const Exit& e, VI top) {
    const VI one = hn::Set(di, 1);
    const VI fx = hn::Max(hn::Add(hn::ConvertTo(di, hn::MulAdd(dx, e.te, ox)), bx), X);
    const VI fy = hn::Max(hn::Add(hn::ConvertTo(di, hn::MulAdd(dy, e.te, oy)), by), Y);
    const VI nx = hn::Min(hn::IfThenElse(hn::RebindMask(di, hn::Le(e.tx, e.te)), e.kx, fx), xl);
    const VI ny = hn::Min(hn::IfThenElse(hn::RebindMask(di, hn::Le(e.ty, e.te)), e.ky, fy), yl);
    const VI l1 = hn::Add(l, one);
    const VI crossed = hn::Shr(hn::Or(hn::Xor(X, nx), hn::Xor(Y, ny)), l1);
    const MI up = hn::And(on, hn::Gt(crossed, hn::Zero(di)));
    l = hn::IfThenElse(up, hn::Min(l1, top), l);
    X = hn::IfThenElse(on, nx, X);
    Y = hn::IfThenElse(on, ny, Y);
    T = hn::IfThenElse(hn::RebindMask(df, on), e.te, T);
  }
};

// Loads of their own instead of a gather, which takes more than twice the time of as many loads on Zen 4.
HWY_INLINE VI fetch(const std::uint32_t* HWY_RESTRICT from, VI at) {
  if (lab.gather) return hn::GatherIndex(di, reinterpret_cast<const std::int32_t*>(from), at);
  alignas(64) std::int32_t index[N];
  alignas(64) std::uint32_t word[N];
  hn::Store(at, di, index);
  for (std::size_t j = 0; j < N; ++j) {
    std::uint32_t w = from[index[j]];
    asm volatile("" : "+r"(w));
    word[j] = w;
  }
  return hn::Load(di, reinterpret_cast<const std::int32_t*>(word));
}

template <bool any, class T>
HWY_INLINE void node_step(const Ground<T>& g, Packet& p) {
  const VI zero = hn::Zero(di), one = hn::Set(di, 1);
  const MI walking = hn::And(hn::Eq(p.st, zero), hn::Gt(p.l, zero));
  const Packet::Exit e = p.exit();
  const VF low = hn::Min(p.height(p.T), p.height(e.te));
  const VI lm = hn::Max(p.l, one);
  const VI col = hn::Shr(hn::Xor(p.X, p.mx), lm), row = hn::Shr(hn::Xor(p.Y, p.my), lm);
  const VI cols = hn::Add(hn::Shr(hn::Set(di, g.cols_1), lm), one);
  VI begin;
  if constexpr (N >= 16) {
    begin = hn::TableLookupLanes(hn::Load(di, g.begin), hn::IndicesFromVec(di, hn::And(lm, hn::Set(di, 15))));
  } else if constexpr (N == 8) {
    const auto of_eight = hn::IndicesFromVec(di, hn::And(lm, hn::Set(di, 7)));
    begin = hn::IfThenElse(hn::Gt(lm, hn::Set(di, 7)), hn::TableLookupLanes(hn::Load(di, g.begin + 8), of_eight),
                           hn::TableLookupLanes(hn::Load(di, g.begin), of_eight));
  } else {
    begin = hn::GatherIndex(di, g.begin, lm);
  }
  const VI at = hn::Add(begin, hn::Add(hn::Mul(row, cols), col));
  VI word = at;
  VF highest;
  if (lab.planes) {
    highest = hn::ConvertTo(df, hn::And(hn::GatherOffset(di, reinterpret_cast<const std::int32_t*>(g.maxima), hn::Add(at, at)), hn::Set(di, 0xffff)));
    if (any) word = hn::GatherOffset(di, reinterpret_cast<const std::int32_t*>(g.minima), hn::Add(at, at));
  } else {
    word = fetch(g.words, at);
    highest = hn::ConvertTo(df, hn::BitCast(di, hn::ShiftRight<16>(hn::BitCast(du, word))));
  }
  const MI clear = hn::And(walking, hn::RebindMask(di, hn::Gt(low, highest)));
  const MI ends = hn::And(clear, hn::RebindMask(di, hn::Ge(e.te, p.tend)));
  const MI on = hn::AndNot(ends, clear);
  p.st = hn::IfThenElse(ends, one, p.st);
  MI down = hn::AndNot(clear, walking);
  if constexpr (any) {
    const VF lowest = hn::ConvertTo(df, hn::And(word, hn::Set(di, 0xffff)));
    const VF margin = hn::MulAdd(hn::Set(df, g.m1x2), e.te, p.m2);
    const MI hit = hn::And(hn::And(walking, hn::Ne(p.seen, zero)), hn::RebindMask(di, hn::Lt(hn::Add(low, margin), lowest)));
    p.st = hn::IfThenElse(hit, hn::Set(di, kHit), p.st);
    down = hn::AndNot(hit, down);
  }
  p.seen = hn::IfThenElse(clear, one, p.seen);
  p.l = hn::IfThenElse(down, hn::Sub(p.l, one), p.l);
  p.advance(on, e, hn::Set(di, g.top));
}

HWY_INLINE VF sample_codes(const Ground<float>& g, VI at) {
  const VF h = hn::GatherIndex(df, g.samples, at);
  return hn::Mul(hn::Sub(h, hn::Set(df, static_cast<float>(g.base))), hn::Set(df, static_cast<float>(g.per_step)));
}

template <bool any, class T>
HWY_INLINE void leaf_step(const Ground<T>& g, Packet& p) {
  const VI zero = hn::Zero(di), one = hn::Set(di, 1);
  const MI leaf = hn::And(hn::Eq(p.st, zero), hn::Eq(p.l, zero));
  const Packet::Exit e = p.exit();
  const VI nx = hn::And(p.mx, one), ny = hn::And(p.my, one);
  const VI col = hn::Xor(p.X, p.mx), row = hn::Xor(p.Y, p.my), stride = hn::Set(di, g.stride);
  // Inside the field: a lane without a ray has anything.
  const VI corner = hn::IfThenElseZero(leaf, hn::Add(hn::Mul(hn::Add(row, ny), stride), hn::Add(col, nx)));
  const VI step_x = hn::Sub(one, hn::Add(nx, nx));
  const VI step_y = hn::IfThenElse(hn::Eq(ny, zero), stride, hn::Neg(stride));
  const VI along_x = hn::IfThenElseZero(leaf, step_x), along_y = hn::IfThenElseZero(leaf, step_y);
  VF h00, h10, h01, h11;
  if (lab.gather) {
    h00 = sample_codes(g, corner), h10 = sample_codes(g, hn::Add(corner, along_x));
    h01 = sample_codes(g, hn::Add(corner, along_y));
    h11 = sample_codes(g, hn::Add(hn::Add(corner, along_x), along_y));
  } else {
    alignas(64) std::int32_t index[N];
    alignas(64) float q00[N], q10[N], q01[N], q11[N];
    hn::Store(hn::Add(hn::Mul(row, stride), col), di, index);
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(di, leaf, bytes);
    std::uint64_t bits;
    std::memcpy(&bits, bytes, 8);
    for (; bits; bits &= bits - 1) {
      const auto j = static_cast<std::size_t>(std::countr_zero(bits));
      const T *north = g.samples + index[j], *south = north + g.stride;
      q00[j] = static_cast<float>(north[0]), q10[j] = static_cast<float>(north[1]);
      q01[j] = static_cast<float>(south[0]), q11[j] = static_cast<float>(south[1]);
    }
    const auto code = [&](const float* q) HWY_ATTR {
      return hn::Mul(hn::Sub(hn::Load(df, q), hn::Set(df, static_cast<float>(g.base))),
                     hn::Set(df, static_cast<float>(g.per_step)));
    };
    const VF w0 = code(q00), w1 = code(q10), w2 = code(q01), w3 = code(q11);
    const MF back_x = hn::RebindMask(df, hn::Ne(nx, zero)), back_y = hn::RebindMask(df, hn::Ne(ny, zero));
    const VF n0 = hn::IfThenElse(back_x, w1, w0), n1 = hn::IfThenElse(back_x, w0, w1);
    const VF s0 = hn::IfThenElse(back_x, w3, w2), s1 = hn::IfThenElse(back_x, w2, w3);
    h00 = hn::IfThenElse(back_y, s0, n0), h10 = hn::IfThenElse(back_y, s1, n1);
    h01 = hn::IfThenElse(back_y, n0, s0), h11 = hn::IfThenElse(back_y, n1, s1);
  }
  const VF a = hn::Sub(h10, h00), b = hn::Sub(h01, h00), c = hn::Sub(hn::Sub(h11, h01), a);
  const VF rx = hn::Sub(p.ox, hn::ConvertTo(df, hn::Sub(p.X, p.bx)));
  const VF ry = hn::Sub(p.oy, hn::ConvertTo(df, hn::Sub(p.Y, p.by)));
  const VF f0 = hn::Zero(df), f1 = hn::Set(df, 1.0f);
  const VF u0 = hn::Min(hn::Max(hn::MulAdd(p.dx, p.T, rx), f0), f1), u1 = hn::Min(hn::Max(hn::MulAdd(p.dx, e.te, rx), f0), f1);
  const VF v0 = hn::Min(hn::Max(hn::MulAdd(p.dy, p.T, ry), f0), f1), v1 = hn::Min(hn::Max(hn::MulAdd(p.dy, e.te, ry), f0), f1);
  const VF s0 = hn::MulAdd(u0, hn::MulAdd(v0, c, a), hn::MulAdd(v0, b, h00));
  const VF s1 = hn::MulAdd(u1, hn::MulAdd(v1, c, a), hn::MulAdd(v1, b, h00));
  const VF in = hn::Sub(p.height(p.T), s0), out = hn::Sub(p.height(e.te), s1);
  // Below the chord by at most a quarter of the curvature times the length squared: (u1 - u0) (v1 - v0) c / 4.
  const VF bend = hn::Mul(hn::Mul(hn::Sub(u1, u0), hn::Sub(v1, v0)), hn::Mul(c, hn::Set(df, -0.25f)));
  const VF least = hn::Sub(hn::Min(in, out), hn::Max(bend, f0));
  const MI clear = hn::And(leaf, hn::RebindMask(di, hn::Gt(least, f0)));
  if constexpr (!any) {
    p.seen = hn::IfThenElse(clear, one, p.seen);
    const MI ends = hn::And(clear, hn::RebindMask(di, hn::Ge(e.te, p.tend)));
    p.st = hn::IfThenElse(ends, one, p.st);
    p.st = hn::IfThenElse(hn::AndNot(clear, leaf), hn::Set(di, kUnsure), p.st);
    p.advance(hn::AndNot(ends, clear), e, hn::Set(di, g.top));
    return;
  }
  const MI above = hn::And(leaf, hn::RebindMask(di, hn::Gt(in, f0)));
  p.seen = hn::IfThenElse(above, one, p.seen);
  const MI hit = hn::And(hn::And(leaf, hn::Ne(p.seen, zero)), hn::RebindMask(di, hn::Lt(hn::Add(out, hn::MulAdd(hn::Set(df, g.m1x2), e.te, p.m2)), f0)));
  const MI unsure = hn::AndNot(hn::Or(clear, hit), leaf), seen = hn::Ne(p.seen, zero);
  p.doubt = hn::IfThenElse(hn::RebindMask(df, hn::And(unsure, seen)), hn::Min(p.doubt, p.T), p.doubt);
  const MI on = hn::Or(clear, hn::And(unsure, seen));
  const MI ends = hn::And(on, hn::RebindMask(di, hn::Ge(e.te, p.tend)));
  p.st = hn::IfThenElse(ends, one, p.st);
  p.st = hn::IfThenElse(hit, hn::Set(di, kHit), p.st);
  p.st = hn::IfThenElse(hn::AndNot(seen, unsure), hn::Set(di, kUnsure), p.st);
  p.advance(hn::AndNot(ends, on), e, hn::Set(di, g.top));
}


// Rays in grid units, as many as a packet holds.
struct Rays {
  alignas(64) double ox[N], oy[N], oz[N], dx[N], dy[N], dz[N], t_min[N], t_max[N];
  std::int32_t seen[N];
};

constexpr hn::CappedTag<double, N> dd;
constexpr hn::Rebind<float, decltype(dd)> df_half;
constexpr hn::Rebind<std::int32_t, decltype(dd)> di_half;
using VD = hn::Vec<decltype(dd)>;

// All that is the same for the rays of a field.
struct Frame {
  double cols, rows, highest, base, per_step, relief_codes, relief, upright, all_rows, relief_per_cell;
  std::int32_t mask, shift_x, shift_y, cols_1, rows_1, from_outside;
};

// Rays into packets; lanes with st of kUnsure are not for the vector walk.
HWY_NOINLINE void prepare(const Frame& f, const Rays& r, Lanes& a) {
  for (std::size_t h = 0; h < N; h += hn::MaxLanes(dd)) {
    const VD zero = hn::Zero(dd), one = hn::Set(dd, 1), cols = hn::Set(dd, f.cols), rows = hn::Set(dd, f.rows);
    const VD far = hn::Set(dd, HUGE_VAL);
    const VD ddx = hn::Load(dd, r.dx + h), ddy = hn::Load(dd, r.dy + h), dz = hn::Load(dd, r.dz + h);
    const VD oz = hn::Load(dd, r.oz + h), t_min = hn::Load(dd, r.t_min + h);
    const auto back_x = hn::Lt(ddx, zero), back_y = hn::Lt(ddy, zero);
    const VD dx = hn::Abs(ddx), dy = hn::Abs(ddy), longest = hn::Max(dx, dy);
    VD ox = hn::Load(dd, r.ox + h), oy = hn::Load(dd, r.oy + h);
    const VD sideways = hn::Add(hn::Abs(ox), hn::Abs(oy));
    ox = hn::IfThenElse(back_x, hn::Sub(cols, ox), ox);
    oy = hn::IfThenElse(back_y, hn::Sub(rows, oy), oy);
    const VD per_x = hn::Div(one, dx), per_y = hn::Div(one, dy), per_longest = hn::Min(per_x, per_y);
    const auto still_x = hn::Eq(dx, zero), still_y = hn::Eq(dy, zero);
    // A ray along an axis is within the strip or not.
    const auto in_x = hn::And(hn::Ge(ox, zero), hn::Le(ox, cols)), in_y = hn::And(hn::Ge(oy, zero), hn::Le(oy, rows));
    const VD in_strip_x = hn::IfThenElse(in_x, hn::Neg(far), far), in_strip_y = hn::IfThenElse(in_y, hn::Neg(far), far);
    const VD enter_x = hn::IfThenElse(still_x, in_strip_x, hn::Mul(hn::Neg(ox), per_x));
    const VD enter_y = hn::IfThenElse(still_y, in_strip_y, hn::Mul(hn::Neg(oy), per_y));
    const VD exit_x = hn::IfThenElse(still_x, far, hn::Mul(hn::Sub(cols, ox), per_x));
    const VD exit_y = hn::IfThenElse(still_y, far, hn::Mul(hn::Sub(rows, oy), per_y));
    VD t_in = hn::Max(t_min, hn::Max(enter_x, enter_y));
    VD t_end = hn::Min(hn::Load(dd, r.t_max + h), hn::Min(exit_x, exit_y));
    const VD t_border = t_in, t_exit = t_end;
    const VD highest = hn::Set(dd, f.highest);
    const auto falls = hn::Lt(dz, zero), from_above = hn::Gt(hn::Add(oz, hn::Mul(dz, t_in)), highest);
    const VD quotient = hn::Div(hn::Sub(highest, oz), dz);
    const VD t_top = hn::Sub(quotient, hn::Mul(hn::Set(dd, 0x1p-50), hn::Abs(quotient)));
    t_in = hn::IfThenElse(hn::And(from_above, falls), hn::Max(t_in, t_top), t_in);
    // rounding_of_clearance() at the end, four times.
    const VD t_far = hn::Max(hn::Abs(t_in), hn::Abs(t_end));
    const VD upright = hn::Add(hn::Set(dd, f.upright), hn::Add(hn::Abs(oz), hn::Abs(hn::Mul(dz, t_far))));
    const VD wide = hn::Add(hn::Add(sideways, hn::Set(dd, f.all_rows)), hn::Mul(hn::Add(dx, dy), t_far));
    const VD rounding = hn::Mul(hn::Set(dd, 64 * 0x1p-53), hn::Add(upright, hn::Mul(wide, hn::Set(dd, f.relief))));
    const VD t_over = hn::Div(hn::Sub(hn::Add(highest, rounding), oz), dz);
    t_end = hn::IfThenElse(hn::Gt(dz, zero), hn::Min(t_end, t_over), t_end);
    const auto sound = hn::And(hn::And(hn::Gt(longest, hn::Set(dd, 0x1p-300)), hn::Lt(longest, hn::Set(dd, 0x1p300))),
                               hn::Lt(hn::Mul(hn::Abs(dz), per_longest), hn::Set(dd, 0x1p30)));
    const auto good = hn::And(hn::And(hn::Lt(t_in, t_end), hn::Not(hn::AndNot(falls, from_above))), sound);
    // Above all ground from begin to end, or beside the field.
    const VD over = hn::Add(highest, rounding);
    const auto is_over = hn::And(hn::Gt(hn::Add(oz, hn::Mul(dz, t_in)), over), hn::Or(hn::Not(falls), hn::Gt(hn::Add(oz, hn::Mul(dz, t_end)), over)));
    const auto is_beside = hn::Gt(hn::Sub(t_border, t_exit), hn::Mul(hn::Set(dd, 0x1p-40), hn::Add(hn::Abs(t_border), hn::Abs(t_exit))));
    const auto misses = hn::And(sound, hn::Or(hn::And(is_over, hn::Lt(t_border, t_exit)), is_beside));
    const VD x = hn::Add(ox, hn::Mul(dx, t_in)), y = hn::Add(oy, hn::Mul(dy, t_in));
    const VD cell_x = hn::Min(hn::Max(hn::Floor(x), zero), hn::Sub(cols, one));
    const VD cell_y = hn::Min(hn::Max(hn::Floor(y), zero), hn::Sub(rows, one));
    const auto put = [&](VD v, float* to) HWY_ATTR { hn::Store(hn::DemoteTo(df_half, v), df_half, to + h); };
    put(hn::Min(hn::Max(hn::Sub(x, cell_x), zero), one), a.ox);
    put(hn::Min(hn::Max(hn::Sub(y, cell_y), zero), one), a.oy);
    put(hn::Mul(dx, per_longest), a.dx), put(hn::Mul(dy, per_longest), a.dy);
    const VD steepest = hn::Set(dd, 0x1p60);
    put(hn::Min(hn::Mul(longest, per_x), steepest), a.ix), put(hn::Min(hn::Mul(longest, per_y), steepest), a.iy);
    constexpr double kEps = 0x1p-21;
    const VD per_step = hn::Set(dd, f.per_step);
    const VD m0 = hn::Add(hn::Set(dd, 0.125 + 4 * f.relief_codes * kEps), hn::Mul(rounding, per_step));
    put(hn::Sub(hn::Mul(hn::Sub(hn::Add(oz, hn::Mul(dz, t_in)), hn::Set(dd, f.base)), per_step), m0), a.z);
    put(hn::Sub(hn::Mul(hn::Mul(dz, per_step), per_longest), hn::Set(dd, 2 * f.relief_codes * kEps)), a.dz);
    put(hn::Add(m0, m0), a.m2);
    put(hn::Mul(hn::Mul(hn::Sub(t_end, t_in), longest), hn::Set(dd, 1 + 0x1p-22)), a.tend);
    hn::Store(t_in, dd, a.t0 + h), hn::Store(per_longest, dd, a.t_per_tau + h);
    const auto put_whole = [&](VD v, std::int32_t* to) HWY_ATTR { hn::Store(hn::DemoteTo(di_half, v), di_half, to + h); };
    const VD mask = hn::Set(dd, f.mask);
    const VD shift_x = hn::IfThenElseZero(back_x, hn::Set(dd, f.shift_x)), shift_y = hn::IfThenElseZero(back_y, hn::Set(dd, f.shift_y));
    put_whole(hn::IfThenElseZero(back_x, mask), a.mx), put_whole(hn::IfThenElseZero(back_y, mask), a.my);
    put_whole(hn::Add(cell_x, shift_x), a.X), put_whole(hn::Add(cell_y, shift_y), a.Y);
    put_whole(hn::Add(shift_x, hn::Sub(cols, one)), a.xl), put_whole(hn::Add(shift_y, hn::Sub(rows, one)), a.yl);
    put_whole(hn::IfThenElseZero(hn::Ne(t_in, t_min), hn::Set(dd, f.from_outside)), a.l);
    put_whole(hn::IfThenElseZero(from_above, one), a.seen);
    put_whole(hn::IfThenElse(misses, hn::Set(dd, kMiss), hn::IfThenElse(good, zero, hn::Set(dd, kUnsure))), a.st);
  }
  for (std::size_t j = 0; j < N; ++j) {
    a.bx[j] = a.X[j], a.by[j] = a.Y[j], a.T[j] = 0, a.doubt[j] = kNever, a.seen[j] |= r.seen[j];
  }
}

// Rays that may hit in a cell.
struct Candidates {
  std::size_t count = 0;
  std::int32_t ray[N], col[N], row[N], seen[N];
  double t_clear[N];
};

template <bool any, class T, int K>
class Batch {
 public:
  using Answer = std::conditional_t<any, std::uint8_t, Hit>;
  Batch(const HeightTarget& target, const SampleGrid<T>& grid, std::span<const Ray> rays, Answer* answers)
      : target_(target), field_(*target.field), rays_(rays), answers_(answers) {
    const MaxPyramid& pyramid = *target.pyramid;
    bilinear_ = field_.settings().surface == Surface::bilinear;
    candidates_.count = 0;
    std::memset(candidates_.t_clear, 0, sizeof candidates_.t_clear);
    g_.words = lab.words;
    g_.maxima = pyramid.maxima(), g_.minima = pyramid.minima();
    g_.samples = grid.data;
    g_.stride = static_cast<std::int32_t>(grid.row_stride);
    g_.cols_1 = grid.cell_cols - 1, g_.rows_1 = grid.cell_rows - 1;
    g_.top = pyramid.top_level();
    g_.base = pyramid.code().base, g_.per_step = pyramid.code().per_step;
    for (int l = 1; l <= g_.top; ++l) g_.begin[l] = static_cast<std::int32_t>(pyramid.levels()[static_cast<std::size_t>(l - 1)].begin);
    const double relief_codes = lab.relief_per_cell * g_.per_step;
    g_.m1x2 = static_cast<float>(4 * relief_codes * 0x1p-21);
    const double low = field_.min_sample(), high = field_.max_sample();
    const std::int32_t side = static_cast<std::int32_t>(std::bit_ceil(static_cast<unsigned>(std::max(g_.cols_1, g_.rows_1) + 1)));
    f_ = {g_.cols_1 + 1.0, g_.rows_1 + 1.0, high, g_.base, g_.per_step, relief_codes, high - low,
          std::max(std::abs(low), std::abs(high)) + std::abs(field_.settings().offset) / field_.settings().scale,
          static_cast<double>(field_.rows()), lab.relief_per_cell, side - 1, side - 1 - g_.cols_1, side - 1 - g_.rows_1, g_.cols_1, g_.rows_1, std::max(g_.top - 3, 0)};
  }

  void run() {
    for (int k = 0; k < K; ++k) {
      std::memset(&lanes_[k], 0, sizeof lanes_[k]);
      for (std::size_t j = 0; j < N; ++j) lanes_[k].ray[j] = -1, lanes_[k].st[j] = kMiss;
      refill(lanes_[k]);
    }
    Packet p[K];
    for (int k = 0; k < K; ++k) p[k].load(lanes_[k]);
    const VI zero = hn::Zero(di);
    const std::size_t leaf_wait = static_cast<std::size_t>(lab.leaf_wait), wait_refill = static_cast<std::size_t>(lab.refill);
    for (;;) {
      for (int k = 0; k < K; ++k) node_step<any>(g_, p[k]);
      ++steps_;
      std::size_t live = 0;
      for (int k = 0; k < K; ++k) {
        const MI alive = hn::Eq(p[k].st, zero);
        const std::size_t n = hn::CountTrue(di, alive);
        const MI leaf = hn::And(alive, hn::Eq(p[k].l, zero));
        const std::size_t leaves = hn::CountTrue(di, leaf);
        node_lanes_ += n - leaves;
        if (leaves >= leaf_wait || (leaves > 0 && leaves == n)) {
          ++leaf_steps_;
          leaf_lanes_ += leaves;
          leaf_step<any>(g_, p[k]);
        }
        live += n;
        if (N - n >= wait_refill && (!empty_ || n == 0)) {
          p[k].store(lanes_[k]);
          refill(lanes_[k]);
          p[k].load(lanes_[k]);
        }
      }
      if (live == 0 && empty_) {
        bool done = true;
        for (int k = 0; k < K; ++k) {
          p[k].store(lanes_[k]);
          refill(lanes_[k]);
          for (std::size_t j = 0; j < N; ++j) done = done && lanes_[k].st[j] != 0;
        }
        if (done) break;
        for (int k = 0; k < K; ++k) p[k].load(lanes_[k]);
      }
    }
    if constexpr (!any) {
      if (candidates_.count > 0) find_hits();
    }
    lab.node_steps += steps_ * N * K, lab.node_lanes += node_lanes_, lab.leaf_steps += leaf_steps_ * N, lab.leaf_lanes += leaf_lanes_;
  }

 private:
  // The answer to the ray of a lane.
  void answer(const Lanes& a, std::size_t j) {
    const std::int32_t ray = a.ray[j];
    if (ray < 0) return;
    if constexpr (any) {
      bool hit = a.st[j] == kHit;
      const bool doubtful = a.doubt[j] < kNever;
      if (a.st[j] == kUnsure || (!hit && doubtful)) {
        ++lab.resumed;
        const double t_clear = doubtful ? a.t0[j] + static_cast<double>(a.doubt[j]) * a.t_per_tau[j] : max_mip::kNotClear;
        hit = resume_occluded_max_mip(target_, rays_[static_cast<std::size_t>(ray)], t_clear);
      }
      answers_[ray] = hit;
    } else {
      if (a.st[j] == kMiss) {
        answers_[ray] = Hit{};
        return;
      }
      Candidates& c = candidates_;
      const std::size_t i = c.count++;
      c.ray[i] = ray, c.col[i] = a.X[j] ^ a.mx[j], c.row[i] = a.Y[j] ^ a.my[j], c.seen[i] = a.seen[j];
      c.t_clear[i] = a.t0[j] + static_cast<double>(a.T[j]) * a.t_per_tau[j];
      if (c.count == N) find_hits();
    }
  }

  // Hits in the cells of the candidates as march_max_mip() computes them, bit for bit; where that needs more than the
  // usual way through a cell, it is asked.
  HWY_NOINLINE void find_hits() {
    Candidates& c = candidates_;
    alignas(64) double ox[N], oy[N], oz[N], dx[N], dy[N], dz[N], t_min[N], t_max[N], col[N], row[N], h00[N], h10[N],
        h01[N], h11[N], t[N], u[N], v[N], height[N], found[N];
    for (std::size_t i = 0; i < N; ++i) {
      const std::size_t k = i < c.count ? i : 0;
      const Ray& ray = rays_[static_cast<std::size_t>(c.ray[k])];
      const GridRay local = field_.grid_from_world(ray);
      ox[i] = local.origin.x, oy[i] = local.origin.y, oz[i] = local.origin.z;
      dx[i] = local.direction.x, dy[i] = local.direction.y, dz[i] = local.direction.z;
      t_min[i] = ray.t_min, t_max[i] = ray.t_max, col[i] = c.col[k], row[i] = c.row[k];
      const T *north = g_.samples + std::ptrdiff_t{c.row[k]} * g_.stride + c.col[k], *south = north + g_.stride;
      h00[i] = static_cast<double>(north[0]), h10[i] = static_cast<double>(north[1]);
      h01[i] = static_cast<double>(south[0]), h11[i] = static_cast<double>(south[1]);
    }
    for (std::size_t h = 0; h < N; h += hn::MaxLanes(dd)) {
      const auto at = [h](const double* from) HWY_ATTR { return hn::Load(dd, from + h); };
      const VD zero = hn::Zero(dd), one = hn::Set(dd, 1), two = hn::Set(dd, 2), four = hn::Set(dd, 4);
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
      const VD surface = hn::Add(hn::Add(hn::Add(a00, hn::Mul(hu, u0)), hn::Mul(hv, v0)), hn::Mul(hn::Mul(twist, u0), v0));
      const VD z_in = hn::Add(z, hn::Mul(vdz, t_in)), z_out = hn::Add(z, hn::Mul(vdz, t_out));
      const VD cc = hn::Sub(z_in, surface);
      // clearance() where it leaves through a line
      const auto edge = [&](VD p, VD q, VD w) HWY_ATTR {
        return hn::Min(hn::Max(hn::Add(p, hn::Mul(w, hn::Sub(q, p))), hn::Min(p, q)), hn::Max(p, q));
      };
      const VD on_x = edge(hn::IfThenElse(back_x, a00, a10), hn::IfThenElse(back_x, a01, a11), place(voy, vdy, t_out, vrow));
      const VD on_y = edge(hn::IfThenElse(back_y, a00, a01), hn::IfThenElse(back_y, a10, a11), place(vox, vdx, t_out, vcol));
      const VD out = hn::Sub(z_out, hn::IfThenElse(hn::Le(tx, ty), on_x, on_y));
      const VD t_far = hn::Max(hn::Abs(t_in), hn::Abs(t_out));
      const VD upright = hn::Add(hn::Set(dd, f_.upright), hn::Add(hn::Abs(z), hn::Abs(hn::Mul(vdz, t_far))));
      const VD sides = hn::Add(hn::Abs(vdx), hn::Abs(vdy));
      const VD wide = hn::Add(hn::Add(hn::Add(hn::Abs(vox), hn::Abs(voy)), hn::Set(dd, f_.all_rows)), hn::Mul(sides, t_far));
      const VD rounding = hn::Mul(hn::Set(dd, 64 * 0x1p-53), hn::Add(upright, hn::Mul(wide, hn::Set(dd, f_.relief))));
      // Above until it comes into the cell: known up to t_clear, and from there on because of how steep ground is.
      const VD gap = hn::Max(hn::Sub(t_in, at(c.t_clear)), zero);
      const VD steepest = hn::Add(hn::Abs(vdz), hn::Mul(sides, hn::Set(dd, f_.relief_per_cell)));
      const auto above = hn::Gt(cc, hn::Add(hn::Mul(gap, steepest), rounding));
      const auto usual = hn::And(hn::And(above, hn::Lt(t_in, t_line)), hn::And(hn::Le(t_line, t_end), hn::And(hn::Ne(vdx, zero), hn::Ne(vdy, zero))));
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
    for (std::size_t i = 0; i < c.count; ++i) {
      Hit& to = answers_[c.ray[i]];
      const Ray& ray = rays_[static_cast<std::size_t>(c.ray[i])];
      if (found[i] != 0 && ray.start == RayStart::free && bilinear_) {
        to.status = HitStatus::hit, to.t = t[i], to.cell = {c.col[i], c.row[i]}, to.u = u[i], to.v = v[i];
        to.height = field_.height_from_sample(height[i]), to.wall = false;
      } else {
        ++lab.resumed;
        to = resume_max_mip(target_, ray, c.seen[i] ? c.t_clear[i] : max_mip::kNotClear);
      }
    }
    c.count = 0;
  }

  // The next rays, through their first cell.
  HWY_NOINLINE void take_rays() {
    const std::size_t count = std::min(N, rays_.size() - next_);
    for (std::size_t j = 0; j < N; ++j) {
      if (j >= count) {
        r_.dx[j] = r_.dy[j] = r_.dz[j] = 0;
        fresh_.ray[j] = -1;
        continue;
      }
      const Ray& ray = rays_[next_ + j];
      const GridRay local = field_.grid_from_world(ray);
      r_.ox[j] = local.origin.x, r_.oy[j] = local.origin.y, r_.oz[j] = local.origin.z;
      r_.dx[j] = local.direction.x, r_.dy[j] = local.direction.y, r_.dz[j] = local.direction.z;
      r_.t_min[j] = ray.t_min, r_.t_max[j] = ray.t_max;
      r_.seen[j] = 0;
      fresh_.ray[j] = static_cast<std::int32_t>(next_ + j);
    }
    next_ += count;
    prepare(f_, r_, fresh_);
    Packet p;
    p.load(fresh_);
    if (any) {
      for (int i = 0; i < lab.first; ++i) {
        leaf_step<any>(g_, p);
        for (int k = 0; k < lab.first_nodes; ++k) node_step<any>(g_, p);
      }
    }
    p.store(fresh_);
    fresh_next_ = 0;
  }

  HWY_NOINLINE void refill(Lanes& a) {
    ++lab.refills;
    for (std::size_t j = 0; j < N; ++j) {
      if (a.st[j] == kWalking) continue;
      answer(a, j);
      a.ray[j] = -1;
      for (;;) {
        while (fresh_next_ < N && fresh_.st[fresh_next_] != kWalking) answer(fresh_, fresh_next_++);
        if (fresh_next_ < N) break;
        if (next_ >= rays_.size()) break;
        take_rays();
      }
      if (fresh_next_ >= N) {
        empty_ = true;
        a.st[j] = kMiss;
        continue;
      }
      const std::size_t i = fresh_next_++;
      const Lanes& q = fresh_;
      a.ox[j] = q.ox[i], a.oy[j] = q.oy[i], a.dx[j] = q.dx[i], a.dy[j] = q.dy[i], a.ix[j] = q.ix[i], a.iy[j] = q.iy[i];
      a.z[j] = q.z[i], a.dz[j] = q.dz[i], a.m2[j] = q.m2[i], a.tend[j] = q.tend[i], a.T[j] = q.T[i], a.doubt[j] = q.doubt[i];
      a.X[j] = q.X[i], a.Y[j] = q.Y[i], a.bx[j] = q.bx[i], a.by[j] = q.by[i], a.l[j] = q.l[i];
      a.mx[j] = q.mx[i], a.my[j] = q.my[i];
      a.xl[j] = q.xl[i], a.yl[j] = q.yl[i], a.seen[j] = q.seen[i], a.st[j] = kWalking;
      a.t0[j] = q.t0[i], a.t_per_tau[j] = q.t_per_tau[i];
      a.ray[j] = q.ray[i];
    }
  }

  const HeightTarget& target_;
  const HeightField& field_;
  std::span<const Ray> rays_;
  Answer* answers_;
  Candidates candidates_;
  std::size_t next_ = 0;
  bool empty_ = false;
  Ground<T> g_;
  Frame f_;
  bool bilinear_;
  Rays r_;
  Lanes fresh_;
  std::size_t fresh_next_ = N;
  Lanes lanes_[K];
  std::uint64_t steps_ = 0, node_lanes_ = 0, leaf_steps_ = 0, leaf_lanes_ = 0;
};

template <bool any, class Answer>
void trace(const HeightTarget& target, std::span<const Ray> rays, Answer* answers) {
  target.field->visit([&](const auto& grid) {
    using T = std::remove_cvref_t<decltype(grid.data[0])>;
    if constexpr (std::is_same_v<T, float>) {
      if (lab.packets == 1) Batch<any, T, 1>(target, grid, rays, answers).run();
      if (lab.packets == 2) Batch<any, T, 2>(target, grid, rays, answers).run();
      if (lab.packets == 3) Batch<any, T, 3>(target, grid, rays, answers).run();
    }
  });
}
void Occluded(const HeightTarget& target, std::span<const Ray> rays, std::uint8_t* blocked) {
  trace<true>(target, rays, blocked);
}
void Closest(const HeightTarget& target, std::span<const Ray> rays, Hit* hits) {
  trace<false>(target, rays, hits);
}

}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace scarp {
SimdLab lab;
HWY_EXPORT(Occluded);
HWY_EXPORT(Closest);
void closest_hits_max_mip_simd(const HeightTarget& target, std::span<const Ray> rays, Hit* hits) {
  HWY_DYNAMIC_DISPATCH(Closest)(target, rays, hits);
}
void occluded_max_mip_simd(const HeightTarget& target, std::span<const Ray> rays, std::uint8_t* blocked) {
  HWY_DYNAMIC_DISPATCH(Occluded)(target, rays, blocked);
}
}  // namespace scarp
#endif
