// SPDX-License-Identifier: MIT
// Cells in vectors of double, for max_mip_simd.cpp: hits as the scalar traversal computes them, and the first cells of
// rays, which may start closer to the ground than floats can resolve. Compiled once per instruction set.
#if defined(SCARP_MARCH_MAX_MIP_SIMD_CELLS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SCARP_MARCH_MAX_MIP_SIMD_CELLS_H
#undef SCARP_MARCH_MAX_MIP_SIMD_CELLS_H
#else
#define SCARP_MARCH_MAX_MIP_SIMD_CELLS_H
#endif

#include <cstddef>
#include <cstdint>
#include <limits>

#include "scarp/march/height/max_mip_fan.h"
#include "scarp/march/height/max_mip_simd_lanes.h"
#include "scarp/march/height/max_mip_simd_rays.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

using MD = hn::Mask<decltype(dd)>;

constexpr double kNearCell = 0x1p-20;  // of a cell, far beyond rounding

// One cell per lane, and its corners in sample units. `first`: the first lines of its copy of the ground; 0 if the
// ground is not wrapped, or rays are in the frame of the copy.
struct Cells {
  alignas(64) double col[N], row[N], h00[N], h10[N], h01[N], h11[N], first_x[N], first_y[N];

  template <class T>
  HWY_INLINE void load(const VectorGround<T>& g, std::size_t j, std::int32_t to_col, std::int32_t to_row,
                       double first_col = 0, double first_row = 0) {
    const T *north = g.samples + to_row * g.stride + to_col, *south = north + g.south(to_row);
    const std::ptrdiff_t east = g.east(to_col);
    first_x[j] = first_col, first_y[j] = first_row;
    col[j] = first_col + to_col, row[j] = first_row + to_row;
    h00[j] = static_cast<double>(north[0]), h10[j] = static_cast<double>(north[east]);
    h01[j] = static_cast<double>(south[0]), h11[j] = static_cast<double>(south[east]);
  }
};

// Rays that may hit in a cell; -1: none.
struct Candidates {
  std::size_t count = 0;
  std::int32_t ray[N], col[N], row[N], seen[N], copy_x[N], copy_y[N];
  alignas(64) double t_clear[N];

  HWY_INLINE void put(std::size_t i, const Lanes& a, std::size_t j) {
    ray[i] = a.ray[j], seen[i] = a.seen[j], copy_x[i] = a.copy_x[j], copy_y[i] = a.copy_y[j];
    col[i] = a.x[j] ^ a.mirror_x[j], row[i] = a.y[j] ^ a.mirror_y[j];
    t_clear[i] = a.t_begin[j] + static_cast<double>(a.T[j]) * a.t_per_cell[j];
  }
  HWY_INLINE void put(std::size_t i, std::size_t index, const FanSight& sight, double clear) {
    ray[i] = static_cast<std::int32_t>(index), seen[i] = 1, copy_x[i] = copy_y[i] = 0;
    col[i] = static_cast<std::int32_t>(sight.cell & 0xffff), row[i] = static_cast<std::int32_t>(sight.cell >> 16);
    t_clear[i] = clear;
  }
  // Over a wrapped ground: the copy that has the cell near where the ray is clear. Through a cell of another one the
  // ray does not come, and march_max_mip() answers.
  void put_copy(std::size_t i, const FieldFrame& f, const GridRay& local) {
    const auto copy = [&](int axis, std::int32_t cell, double cells) {
      const double off = local.origin[axis] + local.direction[axis] * t_clear[i] - cell - 0.5;
      return static_cast<std::int32_t>(std::clamp(std::round(off / cells), -kFarthestCopy, kFarthestCopy));
    };
    copy_x[i] = copy(0, col[i], f.cols), copy_y[i] = copy(1, row[i], f.rows);
  }
  HWY_INLINE void copy(std::size_t i, std::size_t j) {
    ray[i] = ray[j], seen[i] = seen[j], copy_x[i] = copy_x[j], copy_y[i] = copy_y[j];
    col[i] = col[j], row[i] = row[j], t_clear[i] = t_clear[j];
  }
};

// Rays in their cells, with the operations of the scalar traversal in its order, so that results are bit-identical.
struct CellRays {
  VD ox, oy, oz, dx, dy, dz, per_x, per_y, col, row, next_col, next_row, h00, h10, h01, h11;
  MD back_x, back_y;

  HWY_INLINE CellRays(const GridRays& r, const Cells& c, std::size_t part) {
    const auto at = [part](const double* from) HWY_ATTR { return hn::Load(dd, from + part); };
    const VD zero = hn::Zero(dd), one = hn::Set(dd, 1);
    ox = at(r.ox), oy = at(r.oy), oz = at(r.oz), dx = at(r.dx), dy = at(r.dy), dz = at(r.dz);
    per_x = hn::Div(one, dx), per_y = hn::Div(one, dy);
    col = at(c.col), row = at(c.row), next_col = hn::Add(col, one), next_row = hn::Add(row, one);
    h00 = at(c.h00), h10 = at(c.h10), h01 = at(c.h01), h11 = at(c.h11);
    back_x = hn::Lt(dx, zero), back_y = hn::Lt(dy, zero);
  }

  // Whether rays are neither parallel to an axis, where line times are undefined, nor almost.
  static HWY_INLINE MD moves(VD d) { return hn::Gt(hn::Abs(d), hn::Set(dd, 0x1p-1000)); }
  HWY_INLINE MD moves_x() const { return moves(dx); }
  HWY_INLINE MD moves_y() const { return moves(dy); }
  HWY_INLINE MD moves() const { return hn::And(moves_x(), moves_y()); }
  static HWY_INLINE VD line(VD k, VD o, VD per) { return hn::Mul(hn::Sub(k, o), per); }
  HWY_INLINE VD x_in() const { return line(hn::IfThenElse(back_x, next_col, col), ox, per_x); }
  HWY_INLINE VD y_in() const { return line(hn::IfThenElse(back_y, next_row, row), oy, per_y); }
  HWY_INLINE VD x_out() const { return line(hn::IfThenElse(back_x, col, next_col), ox, per_x); }
  HWY_INLINE VD y_out() const { return line(hn::IfThenElse(back_y, row, next_row), oy, per_y); }
  HWY_INLINE VD height(VD t) const { return hn::Add(oz, hn::Mul(dz, t)); }

  static HWY_INLINE VD place(VD o, VD d, VD t, VD cell) {
    // Preserves the sign of zero.
    const VD at = hn::Sub(hn::Add(o, hn::Mul(d, t)), cell), zero = hn::Zero(dd), one = hn::Set(dd, 1);
    return hn::IfThenElse(hn::Lt(at, zero), zero, hn::IfThenElse(hn::Gt(at, one), one, at));
  }
  HWY_INLINE VD u(VD t) const { return place(ox, dx, t, col); }
  HWY_INLINE VD v(VD t) const { return place(oy, dy, t, row); }

  // CellQuadratic: the clearance s after t_in is c + b s + a s^2.
  struct Quadratic {
    VD a, b, c;
  };
  HWY_INLINE Quadratic clearance_from(VD t_in) const {
    const VD u0 = u(t_in), v0 = v(t_in);
    const VD hu = hn::Sub(h10, h00), hv = hn::Sub(h01, h00), twist = hn::Sub(hn::Sub(h11, h01), hu);
    Quadratic q;
    q.a = hn::Mul(hn::Mul(hn::Sub(hn::Sub(h10, h00), hn::Sub(h11, h01)), dx), dy);
    q.b = hn::Sub(dz, hn::Add(hn::Add(hn::Mul(hu, dx), hn::Mul(hv, dy)),
                              hn::Mul(twist, hn::Add(hn::Mul(u0, dy), hn::Mul(v0, dx)))));
    q.c = hn::Sub(height(t_in),
                  hn::Add(hn::Add(hn::Add(h00, hn::Mul(hu, u0)), hn::Mul(hv, v0)), hn::Mul(hn::Mul(twist, u0), v0)));
    return q;
  }

  // edge_height().
  static HWY_INLINE VD edge(VD p, VD q, VD w) {
    return hn::Min(hn::Max(hn::Add(p, hn::Mul(w, hn::Sub(q, p))), hn::Min(p, q)), hn::Max(p, q));
  }

  // clearance() at t, where the ray leaves the cell through a line: of a column, or of a row.
  HWY_INLINE VD clearance_out(VD t, MD through_column) const {
    const VD on_x = edge(hn::IfThenElse(back_x, h00, h10), hn::IfThenElse(back_x, h01, h11), v(t));
    const VD on_y = edge(hn::IfThenElse(back_y, h00, h01), hn::IfThenElse(back_y, h10, h11), u(t));
    return hn::Sub(height(t), hn::IfThenElse(through_column, on_x, on_y));
  }

  // CellPlane over the triangle that the ray is over at t_side: the clearance s after t is c + b s.
  struct Linear {
    VD b, c;
  };
  HWY_INLINE Linear over_triangle(VD t_side, VD t) const {
    const VD one = hn::Set(dd, 1), u_at = u(t), v_at = v(t);
    const MD south_east = hn::Gt(hn::Add(u(t_side), v(t_side)), one);
    const VD hu = hn::IfThenElse(south_east, hn::Sub(h11, h01), hn::Sub(h10, h00));
    const VD hv = hn::IfThenElse(south_east, hn::Sub(h11, h10), hn::Sub(h01, h00));
    const VD nw = hn::Add(hn::Add(h00, hn::Mul(hu, u_at)), hn::Mul(hv, v_at));
    const VD se = hn::Sub(hn::Sub(h11, hn::Mul(hu, hn::Sub(one, u_at))), hn::Mul(hv, hn::Sub(one, v_at)));
    return {hn::Sub(dz, hn::Add(hn::Mul(hu, dx), hn::Mul(hv, dy))),
            hn::Sub(height(t), hn::IfThenElse(south_east, se, nw))};
  }
};

// Where a ray that enters its cell at t_in hits the surface before it leaves it at t_out, with clearance `out` there.
struct CellMeeting {
  VD in;  // clearance at t_in
  VD s;   // t - t_in, if it hits
  MD meets;
};

HWY_INLINE CellMeeting meet_bilinear(const CellRays& r, VD t_in, VD t_out, VD out) {
  const VD zero = hn::Zero(dd), two = hn::Set(dd, 2), length = hn::Sub(t_out, t_in);
  const auto [a, b, c] = r.clearance_from(t_in);
  const VD square = hn::Mul(b, b), ac4 = hn::Mul(hn::Mul(hn::Set(dd, 4), a), c);
  const MD dips = hn::And(hn::And(hn::Gt(a, zero), hn::Lt(b, zero)),
                          hn::And(hn::Lt(hn::Neg(b), hn::Mul(hn::Mul(two, a), length)), hn::Ge(square, ac4)));
  const VD root = hn::Sqrt(hn::Max(zero, hn::Sub(square, ac4)));
  const MD falls = hn::Lt(b, zero);
  const VD s = hn::Div(hn::IfThenElse(falls, hn::Mul(two, c), hn::Neg(hn::Add(b, root))),
                       hn::IfThenElse(falls, hn::Sub(root, b), hn::Mul(two, a)));
  return {c, hn::IfThenElseZero(hn::Ge(s, zero), hn::Min(s, length)), hn::Or(hn::Le(out, zero), dips)};
}

// At the diagonal, if it is crossed, or at the end.
HWY_INLINE CellMeeting meet_triangles(const CellRays& r, VD t_in, VD t_out, VD out) {
  const VD zero = hn::Zero(dd), half = hn::Set(dd, 0.5);
  const VD sum = hn::Add(hn::Add(r.col, r.row), hn::Set(dd, 1));
  const VD t_diagonal = hn::Div(hn::Sub(sum, hn::Add(r.ox, r.oy)), hn::Add(r.dx, r.dy));
  const MD crosses = hn::And(hn::Gt(t_diagonal, t_in), hn::Lt(t_diagonal, t_out));
  const VD crossing = hn::Sub(r.height(t_diagonal), CellRays::edge(r.h10, r.h01, r.v(t_diagonal)));
  const MD at_first = hn::And(crosses, hn::Le(crossing, zero));
  const VD begin = hn::IfThenElse(hn::AndNot(at_first, crosses), t_diagonal, t_in);
  const VD end = hn::IfThenElse(at_first, t_diagonal, t_out), length = hn::Sub(end, begin);
  const CellRays::Linear f = r.over_triangle(hn::Mul(half, hn::Add(begin, end)), begin);
  const VD s = hn::IfThenElseZero(hn::Gt(f.c, zero), hn::Div(hn::Neg(f.c), f.b));
  const VD within = hn::IfThenElse(hn::Ge(s, zero), hn::Min(s, length), length);
  return {r.over_triangle(t_in, t_in).c, hn::Add(hn::Sub(begin, t_in), within), hn::Or(at_first, hn::Le(out, zero))};
}

// Handles rays in the cell that they start in, offset slightly from the ground as shadow rays are: they are within the
// margin of floats, which would leave each of them to the scalar traversal. Rays that are above the ground all the way
// through the cell continue behind it; any hit is decided for those that certainly fall below it. Closest hit: called
// where floats were unsure. Any hit: called at once, except for rays that are known to be above the ground (seen):
// floats can postpone a doubt about those.
template <bool any, class T>
HWY_NOINLINE void leave_first_cells(const VectorGround<T>& g, const FieldFrame& f, const GridRays& r, Lanes& a) {
  constexpr Status kConcerned = any ? kWalking : kUnsure;
  const auto concerns = [&](std::size_t j) {
    return a.status[j] == kConcerned && a.level[j] == 0 && !(any && a.seen[j]);
  };
  std::size_t concerned = 0;
  for (std::size_t j = 0; j < N; ++j) concerned += concerns(j);
  if (concerned == 0) return;
  Cells cells;
  for (std::size_t j = 0; j < N; ++j) cells.load(g, j, a.x[j] ^ a.mirror_x[j], a.y[j] ^ a.mirror_y[j]);
  for (std::size_t part = 0; part < N; part += hn::MaxLanes(dd)) {
    const auto whole = [part](const std::int32_t* from)
                           HWY_ATTR { return hn::PromoteTo(dd, hn::Load(di_part, from + part)); };
    const auto place = [part](const float* from) HWY_ATTR { return hn::PromoteTo(dd, hn::Load(df_part, from + part)); };
    const VD zero = hn::Zero(dd), one = hn::Set(dd, 1);
    const VD status = whole(a.status), seen = whole(a.seen), level = whole(a.level);
    const MD at_begin = hn::Eq(any ? hn::Add(level, seen) : level, zero);
    const CellRays c(r, cells, part);
    // A ray parallel to an axis reaches no line of that axis.
    const MD still_x = hn::Eq(c.dx, zero), still_y = hn::Eq(c.dy, zero);
    const VD never = hn::Set(dd, std::numeric_limits<double>::infinity());
    const VD t_in = hn::Load(dd, a.t_begin + part);
    // In small fields, rays from outside begin at level 0, too: they may touch the rim before.
    const MD starts = hn::And(at_begin, hn::Eq(t_in, hn::Load(dd, r.t_min + part)));
    const MD looked_at = hn::And(hn::Eq(status, hn::Set(dd, kConcerned)), starts);
    const VD tx = hn::IfThenElse(still_x, never, c.x_out()), ty = hn::IfThenElse(still_y, never, c.y_out());
    const MD moves = hn::Or(c.moves(), hn::Or(hn::And(still_x, c.moves_y()), hn::And(still_y, c.moves_x())));
    const VD t_out = hn::Max(hn::Min(tx, ty), t_in), length = hn::Sub(t_out, t_in);
    const MD over_column = hn::Le(tx, ty), over_row = hn::Le(ty, tx);
    const CellRays::Quadratic q = c.clearance_from(t_in);
    const VD out = c.clearance_out(t_out, over_column);
    const VD doubt = rounding(dd, f, c.ox, c.oy, c.oz, c.dx, c.dy, c.dz, hn::Max(hn::Abs(t_in), hn::Abs(t_out)));
    // The minimum of a parabola is at its ends or, if it opens upwards, between them. (A bound from its chord would
    // hide that rays which start this low rise from the ground.)
    const VD bottom = hn::Sub(q.c, hn::Div(hn::Mul(hn::Mul(q.b, q.b), hn::Set(dd, 0.25)), q.a));
    const MD between = hn::And(hn::And(hn::Gt(q.a, zero), hn::Lt(q.b, zero)),
                               hn::Lt(hn::Neg(q.b), hn::Mul(hn::Add(q.a, q.a), length)));
    const VD ends = hn::Min(q.c, out), least = hn::IfThenElse(between, hn::Min(ends, bottom), ends);
    const MD falls = hn::And(hn::Gt(q.c, doubt), hn::Lt(least, hn::Neg(doubt)));
    // Rounded down: the next test continues where the ray is known to be clear.
    const VD way = hn::Mul(hn::Div(length, hn::Load(dd, a.t_per_cell + part)), hn::Set(dd, 1 - 0x1p-22));
    const VD x = hn::Add(whole(a.x), hn::IfThenElseZero(over_column, one));
    const VD y = hn::Add(whole(a.y), hn::IfThenElseZero(over_row, one));
    // The ray may end in this cell, see Packet::before_end(): floats decide whether it is above up to there.
    const VD least_end = hn::Sub(hn::Mul(place(a.end), hn::Set(dd, 1 - 0x1p-20)), hn::Set(dd, 4 * kSideways));
    const MD leaves = hn::And(hn::And(hn::And(looked_at, moves), hn::Lt(way, least_end)),
                              hn::And(hn::Le(x, whole(a.last_x)), hn::Le(y, whole(a.last_y))));
    const MD clear = hn::And(leaves, hn::Gt(least, doubt));
    VD then = hn::IfThenElse(leaves, hn::Set(dd, kUnsure), status);
    if (any) then = hn::IfThenElse(hn::And(leaves, falls), hn::Set(dd, kHit), then);
    then = hn::IfThenElse(clear, hn::Set(dd, kWalking), then);
    const auto put_whole = [part](VD v, std::int32_t* to)
                               HWY_ATTR { hn::Store(hn::DemoteTo(di_part, v), di_part, to + part); };
    put_whole(then, a.status), put_whole(hn::IfThenElse(clear, one, seen), a.seen);
    const auto from_x = hn::Load(di_part, a.x + part), from_y = hn::Load(di_part, a.y + part);
    const auto to_x = hn::DemoteTo(di_part, hn::IfThenElse(clear, x, whole(a.x)));
    const auto to_y = hn::DemoteTo(di_part, hn::IfThenElse(clear, y, whole(a.y)));
    hn::Store(to_x, di_part, a.x + part), hn::Store(to_y, di_part, a.y + part);
    // One level up if the line is the border of a block, as in Packet::leave().
    const auto crossed = hn::ShiftRight<1>(hn::Or(hn::Xor(from_x, to_x), hn::Xor(from_y, to_y)));
    const auto up = hn::Min(crossed, hn::Set(di_part, 1));
    hn::Store(hn::Max(hn::Load(di_part, a.level + part), up), di_part, a.level + part);
    hn::Store(hn::DemoteTo(df_part, hn::IfThenElse(clear, way, place(a.T))), df_part, a.T + part);
  }
}

// Outcomes of rays in the cell on whose surface they start. kUndecided: the scalar traversal decides.
enum FirstCell : std::int32_t { kUndecided, kLeaves, kNoHit, kFalls };

// For rays in `r` with `on_surface` 1 and start cells in `cells`: does what Walk::leave_start_cell() does, by the same
// operations in the same order, except within rounding of a hit and for rare paths. Rays that leave their cell get the
// height of the surface they start on and begin behind the cell.
HWY_NOINLINE void leave_surface(const FieldFrame& f, const Cells& cells, const double* on_surface, GridRays& r,
                                std::int32_t* first_cell) {
  for (std::size_t part = 0; part < N; part += hn::MaxLanes(dd)) {
    const VD zero = hn::Zero(dd), one = hn::Set(dd, 1), cols = hn::Set(dd, f.cols), rows = hn::Set(dd, f.rows);
    CellRays c(r, cells, part);
    const VD t_in = hn::Load(dd, r.t_min + part), t_max = hn::Load(dd, r.t_max + part);
    const VD tx = c.x_out(), ty = c.y_out(), t_line = hn::Min(tx, ty);
    const auto is_in = [](VD o, VD d, VD t, VD cell) HWY_ATTR {
      const VD off = hn::Sub(hn::Sub(hn::Add(o, hn::Mul(d, t)), cell), hn::Set(dd, 0.5));
      return hn::Lt(hn::Abs(off), hn::Set(dd, 0.5 + kNearCell));
    };
    const VD longest = hn::Max(hn::Abs(c.dx), hn::Abs(c.dy));
    const MD usual = hn::And(hn::Gt(longest, hn::Set(dd, 0x1p-300)), hn::Lt(longest, hn::Set(dd, 0x1p300)));
    const MD placed = hn::And(is_in(c.ox, c.dx, t_in, c.col), is_in(c.oy, c.dy, t_in, c.row));
    const MD known = hn::And(hn::And(hn::Eq(hn::Load(dd, on_surface + part), one), placed),
                             hn::And(hn::And(c.moves(), usual), hn::Gt(t_line, t_in)));
    const VD u = c.u(t_in), v = c.v(t_in), hu = hn::Sub(c.h10, c.h00), hv = hn::Sub(c.h01, c.h00);
    const VD twist = hn::Sub(hn::Sub(c.h11, c.h01), hu);
    const VD surface = hn::Add(hn::Add(hn::Add(c.h00, hn::Mul(hu, u)), hn::Mul(hv, v)), hn::Mul(hn::Mul(twist, u), v));
    c.oz = hn::Sub(surface, hn::Mul(c.dz, t_in));
    // Without the root at the start, the clearance s (a s + b) is negative right after it, or after the second root.
    const auto [a, b, at_start] = c.clearance_from(t_in);
    const VD length = hn::Sub(t_line, t_in);
    const MD dips = hn::And(hn::And(hn::Gt(a, zero), hn::Lt(b, zero)),
                            hn::Lt(hn::Neg(b), hn::Mul(hn::Mul(hn::Set(dd, 2), a), length)));
    const VD last = hn::Mul(length, hn::Add(hn::Mul(a, length), b));
    const VD bottom = hn::Div(hn::Mul(hn::Neg(b), b), hn::Mul(hn::Set(dd, 4), a));
    const VD lowest = hn::IfThenElse(dips, bottom, last);
    const MD may_fall = hn::Lt(lowest, zero);
    const VD doubt = rounding(dd, f, c.ox, c.oy, c.oz, c.dx, c.dy, c.dz, t_in);
    const VD root = hn::Div(b, hn::Neg(a));
    const VD s = hn::IfThenZeroElse(hn::Or(hn::Lt(b, zero), hn::Eq(a, zero)), root);
    const VD t_hit = hn::IfThenElse(hn::Gt(s, zero), hn::Min(hn::Add(t_in, s), t_line), t_in);
    const MD falls = hn::And(known, hn::Lt(lowest, hn::Neg(doubt))), hits = hn::And(falls, hn::Lt(t_hit, t_max));
    // At its border a ray leaves the field through a line that ends it.
    const VD exit_x = CellRays::line(hn::IfThenElse(c.back_x, zero, cols), c.ox, c.per_x);
    const VD exit_y = CellRays::line(hn::IfThenElse(c.back_y, zero, rows), c.oy, c.per_y);
    const VD t_end = hn::Min(t_max, hn::Min(exit_x, exit_y));
    const MD on = hn::AndNot(may_fall, known);
    const MD leaves = hn::And(on, hn::Lt(t_line, t_end));
    const auto number = [](MD where, FirstCell what) HWY_ATTR { return hn::IfThenElseZero(where, hn::Set(dd, what)); };
    const VD found = hn::Add(hn::Add(number(leaves, kLeaves), number(hits, kFalls)),
                             hn::Add(number(hn::AndNot(leaves, on), kNoHit), number(hn::AndNot(hits, falls), kNoHit)));
    hn::Store(hn::DemoteTo(di_part, found), di_part, first_cell + part);
    hn::Store(hn::IfThenElse(leaves, c.oz, hn::Load(dd, r.oz + part)), dd, r.oz + part);
    hn::Store(hn::IfThenElse(leaves, t_line, t_in), dd, r.t_min + part);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#endif
