// SPDX-License-Identifier: MIT
// One step of a fan's lanes from a grid line to the next, and over a block. Compiled once per instruction set.
#if defined(SCARP_MARCH_MAX_MIP_FAN_STEP_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SCARP_MARCH_MAX_MIP_FAN_STEP_H
#undef SCARP_MARCH_MAX_MIP_FAN_STEP_H
#else
#define SCARP_MARCH_MAX_MIP_FAN_STEP_H
#endif

#include "scarp/accel/block_planes.h"
#include "scarp/accel/max_pyramid.h"
#include "scarp/march/height/max_mip_fan_lines.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

// Error bound of a clearance, a multiple of the quantities that are rounded: numerics.md, Fans.
constexpr float kFanRounding = 1.5f * 0x1p-20f;

// One ray per lane: at T cells along the major axis it is at fy + m T along the minor one, and s T above the origin.
struct FanRays {
  VF m, s, per_m;
};

HWY_INLINE VF per(VF m) { return hn::Div(hn::Set(df, 1), hn::Max(m, hn::Set(df, 0x1p-60f))); }

// Where a step takes place: from line k at T0 to the next at T1.
struct FanLine {
  float T0, T1, length, per_length;
  float y;      // the origin's place along minor, from the first node of the windows
  float aside;  // what rounding may move any ray to the side, and a little more
};

// The nodes around the way of each lane: at the line, and at the next one.
struct FanNodes {
  VF a0, a1, a2, b0, b1, b2;
};

// Places of a ray at both lines, in nodes from that before the first.
struct FanPlaces {
  VF y, node, w, q;
};
HWY_INLINE FanPlaces places(const FanLine& at, const FanRays& r) {
  FanPlaces p;
  p.y = hn::MulAdd(r.m, hn::Set(df, at.T0), hn::Set(df, at.y));
  p.node = hn::Floor(p.y);
  p.w = hn::Sub(p.y, p.node);
  p.q = hn::Sub(hn::MulAdd(r.m, hn::Set(df, at.T1), hn::Set(df, at.y)), p.node);
  return p;
}

// Two pieces of a step: up to the row line that the ray crosses, or the next line, and behind it. On a piece with the
// clearances p and r at its ends the clearance is p (1 - x) + r x + twist x (1 - x); over triangles it is linear from
// there to the diagonal and on.
struct FanStep {
  VF c0, ce, c1;      // at the line, between the pieces, at the next line
  VF twist1, twist2;  // bilinear
  VF d1, d2, x1, x2;  // triangles: clearance at the diagonal of each piece, and share of the step up to there
  VF u;               // share of the step that the first piece has
  VF low1, low2;      // lower bounds of both pieces
  VF h0, margin;
  MF crosses;
};

// A lower bound of a piece.
HWY_INLINE VF lowest(VF p, VF r, VF twist) {
  // A parabola that opens upwards is below its lower end by (|twist| - |r - p|)^2 / (4 |twist|) if that is above zero
  // before it is squared.
  const VF below = hn::Max(hn::Zero(df), hn::Neg(hn::Add(twist, hn::Abs(hn::Sub(r, p)))));
  return hn::NegMulAdd(below, hn::Set(df, 0.25f), hn::Min(p, r));
}

// `rises`: whether the diagonals of triangles run from the first corner of a cell to the last.
template <bool triangles>
HWY_INLINE FanStep step_over(const FanLine& at, const FanRays& r, const FanPlaces& p, const FanNodes& n, bool rises,
                             float doubt, float rounding) {
  const VF one = hn::Set(df, 1), zero = hn::Zero(df);
  FanStep e;
  const VF da0 = hn::Sub(n.a1, n.a0), da1 = hn::Sub(n.a2, n.a1), db0 = hn::Sub(n.b1, n.b0), db1 = hn::Sub(n.b2, n.b1);
  const VF across = hn::Sub(n.b1, n.a1);
  e.h0 = hn::Mul(r.s, hn::Set(df, at.T0));
  const VF h1 = hn::Mul(r.s, hn::Set(df, at.T1));
  const VF q1 = hn::Min(p.q, one), q2 = hn::Max(hn::Sub(p.q, one), zero);
  e.c0 = hn::Sub(e.h0, hn::MulAdd(p.w, da0, n.a0));
  e.c1 = hn::Sub(h1, hn::MulAdd(q2, db1, hn::MulAdd(q1, db0, n.b0)));
  e.crosses = hn::Gt(p.q, one);
  const VF to_node = hn::Mul(hn::Mul(hn::Sub(one, p.w), r.per_m), hn::Set(df, at.per_length));
  e.u = hn::IfThenElse(e.crosses, hn::Min(to_node, one), one);
  const VF rise = hn::Mul(r.s, hn::Set(df, at.length));
  e.ce = hn::IfThenElse(e.crosses, hn::Sub(hn::MulAdd(rise, e.u, e.h0), hn::MulAdd(e.u, across, n.a1)), e.c1);
  if constexpr (triangles) {
    const auto clearance = [&](VF x, VF ground) HWY_ATTR { return hn::Sub(hn::MulAdd(rise, x, e.h0), ground); };
    if (rises) {
      // In the first cell unless the ray leaves it through the row line.
      const VF within = hn::Max(hn::Sub(hn::Add(p.w, one), p.q), hn::Set(df, 0x1p-60f));
      e.x1 = hn::IfThenElse(e.crosses, e.u, hn::Min(hn::Div(p.w, within), one));
      const VF d1 = clearance(e.x1, hn::MulAdd(e.x1, hn::Sub(n.b1, n.a0), n.a0));
      e.d1 = hn::IfThenElse(e.crosses, e.ce, d1);
      e.x2 = one, e.d2 = e.c1;
    } else {
      const VF per = hn::Div(one, hn::Add(one, r.m)), rest = hn::Sub(one, p.w);
      e.x1 = hn::Mul(rest, per);
      e.d1 = clearance(e.x1, hn::MulAdd(hn::Sub(one, e.x1), hn::Sub(n.a1, n.b0), n.b0));
      e.x2 = hn::IfThenElse(e.crosses, hn::Min(hn::Mul(hn::Add(rest, one), per), one), one);
      const VF d2 = clearance(e.x2, hn::MulAdd(hn::Sub(one, e.x2), hn::Sub(n.a2, n.b1), n.b1));
      e.d2 = hn::IfThenElse(e.crosses, d2, e.c1);
    }
    e.low1 = hn::Min(hn::Min(e.c0, e.ce), e.d1), e.low2 = hn::Min(hn::Min(e.ce, e.c1), e.d2);
  } else {
    (void)rises;
    e.twist1 = hn::Mul(hn::Sub(db0, da0), hn::Mul(e.u, hn::Sub(q1, p.w)));
    e.twist2 = hn::Mul(hn::Sub(db1, da1), hn::Mul(hn::Sub(one, e.u), q2));
    e.low1 = lowest(e.c0, e.ce, e.twist1), e.low2 = lowest(e.ce, e.c1, e.twist2);
  }
  const VF steepest = hn::Max(hn::Max(hn::Abs(da0), hn::Abs(da1)), hn::Max(hn::Abs(db0), hn::Abs(db1)));
  const VF high = hn::Max(hn::Abs(e.h0), hn::Abs(h1));
  const VF way = hn::MulAdd(r.m, hn::Set(df, at.T1), hn::Set(df, 8));
  const VF sum = hn::MulAdd(way, steepest, hn::MulAdd(hn::Set(df, 4), hn::Abs(across), high));
  e.margin = hn::MulAdd(sum, hn::Set(df, rounding), hn::Set(df, doubt));
  return e;
}

// First crossing from above to below, as a share of the step, and whether it is in the first cell. `sure`: lanes in
// which a margin proves it.
struct FanCrossing {
  VF share;
  MF first, sure;
};

// Where a piece goes from above to below: share of the piece.
HWY_INLINE VF crossing(VF p, VF r, VF twist) {
  const VF zero = hn::Zero(df), one = hn::Set(df, 1);
  const VF b = hn::Add(hn::Sub(r, p), twist);
  const VF root = hn::Sqrt(hn::Max(hn::MulAdd(hn::Mul(hn::Set(df, 4), twist), p, hn::Mul(b, b)), zero));
  const auto falls = hn::Lt(b, zero);
  const VF over = hn::IfThenElse(falls, hn::Add(p, p), hn::Add(b, root));
  const VF under = hn::IfThenElse(falls, hn::Sub(root, b), hn::Add(twist, twist));
  return hn::Min(hn::Max(hn::Div(over, under), zero), one);
}

HWY_INLINE FanCrossing bilinear_crossing(const FanStep& e) {
  const VF below = hn::Neg(e.margin);
  FanCrossing f;
  f.first = hn::Lt(e.ce, below);
  f.sure = hn::Or(f.first, hn::And(hn::Gt(e.low1, e.margin), hn::Lt(e.c1, below)));
  const VF in = hn::IfThenElse(f.first, e.c0, e.ce), out = hn::IfThenElse(f.first, e.ce, e.c1);
  const VF x = crossing(in, out, hn::IfThenElse(f.first, e.twist1, e.twist2));
  f.share = hn::IfThenElse(f.first, hn::Mul(e.u, x), hn::MulAdd(hn::Sub(hn::Set(df, 1), e.u), x, e.u));
  return f;
}

// Linear from point to point.
HWY_INLINE FanCrossing triangle_crossing(const FanStep& e) {
  const VF below = hn::Neg(e.margin), zero = hn::Zero(df), one = hn::Set(df, 1);
  const MF none = hn::Lt(one, zero);
  FanCrossing f{zero, none, none};
  MF open = hn::Not(none);
  VF c = e.c0, x = zero;
  const auto pass = [&](VF next, VF at, bool first) HWY_ATTR {
    const MF falls = hn::And(open, hn::Lt(next, below));
    const VF there = hn::MulAdd(hn::Div(c, hn::Sub(c, next)), hn::Sub(at, x), x);
    f.share = hn::IfThenElse(falls, there, f.share);
    f.sure = hn::Or(f.sure, falls);
    if (first) f.first = hn::Or(f.first, falls);
    open = hn::And(open, hn::Gt(next, e.margin));
    c = next, x = at;
  };
  pass(e.d1, e.x1, true), pass(e.ce, e.u, true), pass(e.d2, e.x2, false), pass(e.c1, one, false);
  f.share = hn::Min(hn::Max(f.share, zero), one);
  return f;
}

// Tilted planes above blocks, as heights relative to the origin.
struct FanPlanes {
  const std::uint32_t* blocks;
  float scale, shift;  // of the codes of maxima
  float slope_step, depth_step;
  float margin;    // of codes
  float steepest;  // of planes and cells, per cell
};
inline FanPlanes fan_planes(const MaxPyramid& pyramid, double origin_z) {
  const BlockPlanes& planes = pyramid.planes();
  const HeightCode& code = planes.code();
  FanPlanes f;
  f.blocks = pyramid.blocks();
  f.scale = static_cast<float>(code.step * static_cast<double>(planes.scale()));
  f.shift = static_cast<float>(code.base + code.step * static_cast<double>(planes.shift()) - origin_z);
  f.slope_step = static_cast<float>(code.step * static_cast<double>(planes.unit()));
  f.depth_step = BlockPlanes::kDepthUnits * f.slope_step;
  f.margin = static_cast<float>(0.5 * code.step);
  f.steepest = static_cast<float>(code.step * static_cast<double>(planes.steepest()) +
                                  pyramid.cell_relief() * pyramid.code().step);
  return f;
}

// Lanes that are above all ground from line k, the border of blocks of this level, to that `lines` on: 2^level, or
// fewer before a seam.
template <class Sample>
HWY_INLINE MF clears_blocks(const Octant<Sample>& o, const FanPlanes& f, const PyramidLevel& blocks, int level,
                            std::int32_t lines, std::int32_t k, const FanLine& at, std::int32_t b, const FanRays& r,
                            float doubt, float rounding) {
  const std::int32_t side = 1 << level, first = o.node0 + b;
  const std::int32_t line = o.field_line(k), cell = o.back_major ? o.major_cells - 1 - line : line;
  const std::int32_t major_block = cell >> level;
  const float length = static_cast<float>(lines), half = 0.5f * static_cast<float>(side), T0 = at.T0;
  const VF y = hn::MulAdd(r.m, hn::Set(df, T0), hn::Set(df, at.y));
  const VI number = hn::Add(hn::ConvertTo(di, hn::Floor(y)), hn::Set(di, first));
  // In the lane's copy, whose first node is `copy` from that of the windows.
  const VI node = o.wraps ? in_copy(number, o.minor_cells) : number;
  const VI copy = hn::Sub(hn::Sub(number, node), hn::Set(di, first));
  const VI last = hn::Set(di, o.minor_cells - 1), zero = hn::Zero(di);
  // Inside to the end: other rays inherit the way, and may be inside where this one has left. Beyond the side, planes
  // do not bound the ground that continues level. Lanes cross the seam of a wrapped field line by line.
  const VF side_y = hn::ConvertTo(df, hn::Add(copy, hn::Set(di, o.minor_cells)));
  const MF stays = hn::Le(hn::MulAdd(r.m, hn::Set(df, length), y), side_y);
  const MI inside = hn::AndNot(hn::Or(hn::Lt(node, zero), hn::Gt(node, last)), hn::RebindMask(di, stays));
  const VI real = o.back_minor ? hn::Sub(last, node) : node;
  const VI within = hn::Min(hn::Max(real, zero), last);
  const VI block = hn::ShiftRightSame(within, level);
  // The line of nodes through which a lane leaves its block, from the first of the windows.
  const VI in_field = o.back_minor ? hn::Sub(hn::Set(di, o.minor_cells), hn::ShiftLeftSame(block, level))
                                   : hn::ShiftLeftSame(hn::Add(block, hn::Set(di, 1)), level);
  const VI edge = hn::Add(copy, in_field);
  const VF to_edge = hn::Sub(hn::ConvertTo(df, edge), y);
  // Ways from the line: lines are exact, times are rounded.
  const VF begin = hn::Zero(df), end = hn::Set(df, length), to_leave = hn::Mul(to_edge, r.per_m);
  const VF middle_way = hn::Max(hn::Min(to_leave, end), begin), T_end = hn::Set(df, T0 + length);
  const VF high = hn::Max(hn::Abs(hn::Mul(r.s, hn::Set(df, T0))), hn::Abs(hn::Mul(r.s, T_end)));
  const VF way = hn::MulAdd(hn::MulAdd(r.m, T_end, hn::Set(df, 8)), hn::Set(df, 2 * f.steepest), high);
  const VF margin = hn::MulAdd(way, hn::Set(df, 2 * rounding), hn::Set(df, f.margin + doubt));
  // Least height above the plane of a block on the way `from` to `to`, which begins `from_edge` before its far edge.
  const auto above = [&](VI minor_block, VF from, VF to, VF from_edge) HWY_ATTR {
    const VI row = o.turned ? hn::Set(di, major_block) : minor_block;
    const VI col = o.turned ? minor_block : hn::Set(di, major_block);
    const VI entry = hn::Add(hn::Set(di, static_cast<std::int32_t>(blocks.begin)),
                             hn::Add(hn::Mul(row, hn::Set(di, blocks.cols)), col));
    const VI plane = hn::GatherIndex(di, reinterpret_cast<const std::int32_t*>(f.blocks), entry);
    const VI depth = hn::And(hn::ShiftRight<16 + 2 * kSlopeBits>(plane), hn::Set(di, (1 << kDepthBits) - 1));
    const VF maximum =
        hn::MulAdd(hn::ConvertTo(df, hn::And(plane, hn::Set(di, 0xffff))), hn::Set(df, f.scale), hn::Set(df, f.shift));
    const VF middle = hn::NegMulAdd(hn::ConvertTo(df, depth), hn::Set(df, half * f.depth_step), maximum);
    const auto slope = [&](VI steps, bool back) HWY_ATTR {
      return hn::Mul(hn::ConvertTo(df, hn::ShiftRight<32 - kSlopeBits>(steps)),
                     hn::Set(df, back ? -f.slope_step : f.slope_step));
    };
    const VI x_steps = hn::ShiftLeft<16 - kSlopeBits>(plane), y_steps = hn::ShiftLeft<16 - 2 * kSlopeBits>(plane);
    const VF along = slope(o.turned ? y_steps : x_steps, o.back_major);
    const VF aside = slope(o.turned ? x_steps : y_steps, o.back_minor);
    const auto clearance = [&](VF gone, VF beyond) HWY_ATTR {
      const VF x = hn::Sub(gone, hn::Set(df, half)), height = hn::Mul(r.s, hn::Add(hn::Set(df, T0), gone));
      return hn::Sub(height, hn::MulAdd(aside, beyond, hn::MulAdd(along, x, middle)));
    };
    const VF begins = hn::Sub(hn::Set(df, half), from_edge);
    return hn::Min(clearance(from, begins), clearance(to, hn::MulAdd(r.m, hn::Sub(to, from), begins)));
  };
  MF clear = hn::And(hn::RebindMask(df, inside), hn::Gt(above(block, begin, middle_way, to_edge), margin));
  const MF leaves = hn::And(clear, hn::Lt(to_leave, end));
  if (!hn::AllFalse(df, leaves)) {
    const VI next = o.back_minor ? hn::Sub(block, hn::Set(di, 1)) : hn::Add(block, hn::Set(di, 1));
    const VI count = hn::Set(di, o.turned ? blocks.cols : blocks.rows);
    const VI there = hn::Min(hn::Max(next, zero), hn::Sub(count, hn::Set(di, 1)));
    const MF low = hn::Not(hn::Gt(above(there, middle_way, end, end), margin));
    clear = hn::AndNot(hn::And(leaves, low), clear);
  }
  return clear;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#endif
