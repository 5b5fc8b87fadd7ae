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

constexpr hn::ScalableTag<float> df;
constexpr hn::RebindToSigned<decltype(df)> di;
constexpr hn::RebindToUnsigned<decltype(df)> du;
using VF = hn::Vec<decltype(df)>;
using VI = hn::Vec<decltype(di)>;
using MF = hn::Mask<decltype(df)>;
using MI = hn::Mask<decltype(di)>;
constexpr std::size_t N = hn::MaxLanes(df);

enum Status : std::int32_t { kWalking = 0, kMiss = 1, kHit = 2, kUnsure = 3 };

// What a ray is to the vector walk.
struct Prepared {
  float ox, oy, dx, dy, ix, iy, z, dz, m2, tend;
  std::int32_t X, Y, l, mx, my, xl, yl, seen;
  double t0, t_per_tau;
  std::int32_t ray;
};

struct Lanes {
  alignas(64) float ox[N], oy[N], dx[N], dy[N], ix[N], iy[N], z[N], dz[N], m2[N], tend[N], T[N];
  alignas(64) std::int32_t X[N], Y[N], l[N], mx[N], my[N], bx[N], by[N], xl[N], yl[N], seen[N], st[N];
  double t0[N], t_per_tau[N];
  std::int32_t ray[N];
};

template <class T>
struct Ground {
  const std::uint32_t* words;
  const T* samples;
  std::int32_t stride, cols_1, rows_1, top;
  double base, per_step;
  alignas(64) std::int32_t begin[32];
};

struct Packet {
  VF ox, oy, dx, dy, ix, iy, z, dz, m2, tend, T;
  VI X, Y, l, mx, my, bx, by, xl, yl, seen, st;

  HWY_INLINE void load(const Lanes& a) {
    ox = hn::Load(df, a.ox), oy = hn::Load(df, a.oy), dx = hn::Load(df, a.dx), dy = hn::Load(df, a.dy);
    ix = hn::Load(df, a.ix), iy = hn::Load(df, a.iy), z = hn::Load(df, a.z), dz = hn::Load(df, a.dz);
    m2 = hn::Load(df, a.m2), tend = hn::Load(df, a.tend), T = hn::Load(df, a.T);
    X = hn::Load(di, a.X), Y = hn::Load(di, a.Y), l = hn::Load(di, a.l), mx = hn::Load(di, a.mx);
    my = hn::Load(di, a.my), bx = hn::Load(di, a.bx), by = hn::Load(di, a.by), xl = hn::Load(di, a.xl);
    yl = hn::Load(di, a.yl), seen = hn::Load(di, a.seen), st = hn::Load(di, a.st);
  }
  HWY_INLINE void store(Lanes& a) const {
    hn::Store(T, df, a.T);
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
    const VF never = hn::Set(df, 0x1p100f);
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

template <class T>
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
  } else {
    begin = hn::GatherIndex(di, g.begin, lm);
  }
  const VI at = hn::Add(begin, hn::Add(hn::Mul(row, cols), col));
  const VI word = hn::GatherIndex(di, reinterpret_cast<const std::int32_t*>(g.words), at);
  const VF highest = hn::ConvertTo(df, hn::BitCast(di, hn::ShiftRight<16>(hn::BitCast(du, word))));
  const VF lowest = hn::ConvertTo(df, hn::And(word, hn::Set(di, 0xffff)));
  const MI clear = hn::And(walking, hn::RebindMask(di, hn::Gt(low, highest)));
  const MI hit = hn::And(hn::And(walking, hn::Ne(p.seen, zero)), hn::RebindMask(di, hn::Lt(hn::Add(low, p.m2), lowest)));
  const MI ends = hn::And(clear, hn::RebindMask(di, hn::Ge(e.te, p.tend)));
  const MI on = hn::AndNot(ends, clear);
  const MI down = hn::AndNot(hn::Or(clear, hit), walking);
  p.st = hn::IfThenElse(ends, one, p.st);
  p.st = hn::IfThenElse(hit, hn::Set(di, kHit), p.st);
  p.seen = hn::IfThenElse(clear, one, p.seen);
  p.l = hn::IfThenElse(down, hn::Sub(p.l, one), p.l);
  p.advance(on, e, hn::Set(di, g.top));
}

HWY_INLINE VF sample_codes(const Ground<float>& g, VI at) {
  const VF h = hn::GatherIndex(df, g.samples, at);
  return hn::Mul(hn::Sub(h, hn::Set(df, static_cast<float>(g.base))), hn::Set(df, static_cast<float>(g.per_step)));
}

template <class T>
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
  const VF h00 = sample_codes(g, corner), h10 = sample_codes(g, hn::Add(corner, along_x));
  const VF h01 = sample_codes(g, hn::Add(corner, along_y));
  const VF h11 = sample_codes(g, hn::Add(hn::Add(corner, along_x), along_y));
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
  const MI above = hn::And(leaf, hn::RebindMask(di, hn::Gt(in, f0)));
  p.seen = hn::IfThenElse(above, one, p.seen);
  const MI hit = hn::And(hn::And(leaf, hn::Ne(p.seen, zero)), hn::RebindMask(di, hn::Lt(hn::Add(out, p.m2), f0)));
  const MI ends = hn::And(clear, hn::RebindMask(di, hn::Ge(e.te, p.tend)));
  const MI unsure = hn::AndNot(hn::Or(clear, hit), leaf);
  p.st = hn::IfThenElse(ends, one, p.st);
  p.st = hn::IfThenElse(hit, hn::Set(di, kHit), p.st);
  p.st = hn::IfThenElse(unsure, hn::Set(di, kUnsure), p.st);
  p.advance(hn::AndNot(ends, clear), e, hn::Set(di, g.top));
}

// False: not for the vector walk.
template <class T>
bool prepare(const HeightField& field, const Ground<T>& g, const Ray& ray, double relief_codes, Prepared& out) {
  if (ray.start == RayStart::on_surface) return false;
  const GridRay local = field.grid_from_world(ray);
  const double ax = std::abs(local.direction.x), ay = std::abs(local.direction.y);
  const double longest = std::max(ax, ay);
  if (!(longest > 0x1p-500 && longest < 0x1p500 && std::abs(local.direction.z) < 0x1p500)) return false;
  const double cols = g.cols_1 + 1, rows = g.rows_1 + 1;
  double t_in = ray.t_min, t_end = ray.t_max;
  const bool back_x = local.direction.x < 0, back_y = local.direction.y < 0;
  const double dx = ax, dy = ay, ox = back_x ? cols - local.origin.x : local.origin.x;
  const double oy = back_y ? rows - local.origin.y : local.origin.y;
  const double per_x = 1 / dx, per_y = 1 / dy;
  if (dx > 0) {
    t_in = std::max(t_in, -ox * per_x), t_end = std::min(t_end, (cols - ox) * per_x);
  } else if (!(ox >= 0 && ox <= cols)) {
    return false;
  }
  if (dy > 0) {
    t_in = std::max(t_in, -oy * per_y), t_end = std::min(t_end, (rows - oy) * per_y);
  } else if (!(oy >= 0 && oy <= rows)) {
    return false;
  }
  if (!(t_in < t_end)) return false;
  const double highest = field.max_sample(), z = local.origin.z, dz = local.direction.z;
  const double z_in = z + dz * t_in;
  bool seen = false;
  if (z_in > highest) {
    if (!(dz < 0)) return false;
    seen = true;
    const double quotient = (highest - z) / dz, t_top = quotient - 0x1p-50 * std::abs(quotient);
    if (t_top > t_in) t_in = t_top;
    if (!(t_in < t_end)) return false;
  }
  const double rounding = 4 * rounding_of_clearance(field, local, t_end);
  if (dz > 0) t_end = std::min(t_end, (highest + rounding - z) / dz);
  const double per_longest = 1 / longest;
  const double x = ox + dx * t_in, y = oy + dy * t_in;
  const double cell_x = std::clamp(std::floor(x), 0.0, cols - 1), cell_y = std::clamp(std::floor(y), 0.0, rows - 1);
  out.ox = static_cast<float>(std::clamp(x - cell_x, 0.0, 1.0));
  out.oy = static_cast<float>(std::clamp(y - cell_y, 0.0, 1.0));
  out.dx = static_cast<float>(dx * per_longest), out.dy = static_cast<float>(dy * per_longest);
  out.ix = static_cast<float>(std::min(longest * per_x, 0x1p60));
  out.iy = static_cast<float>(std::min(longest * per_y, 0x1p60));
  const double tend = (t_end - t_in) * longest;
  constexpr double kEps = 0x1p-21;
  const double m0 = 0.125 + rounding * g.per_step + 4 * relief_codes * kEps, m1 = 2 * relief_codes * kEps;
  const double cz = (z + dz * t_in - g.base) * g.per_step, cdz = dz * g.per_step * per_longest;
  out.z = static_cast<float>(cz - m0), out.dz = static_cast<float>(cdz - m1);
  out.m2 = static_cast<float>(2 * (m0 + m1 * tend));
  out.tend = static_cast<float>(tend * (1 + 0x1p-22));
  // Mirrored, the last cell is the first.
  const std::int32_t mask = static_cast<std::int32_t>(std::bit_ceil(static_cast<unsigned>(std::max(g.cols_1, g.rows_1) + 1))) - 1;
  out.mx = back_x ? mask : 0, out.my = back_y ? mask : 0;
  const std::int32_t shift_x = back_x ? mask - g.cols_1 : 0, shift_y = back_y ? mask - g.rows_1 : 0;
  out.X = static_cast<std::int32_t>(cell_x) + shift_x, out.Y = static_cast<std::int32_t>(cell_y) + shift_y;
  out.xl = g.cols_1 + shift_x, out.yl = g.rows_1 + shift_y;
  out.l = t_in == ray.t_min ? 0 : std::max(g.top - 3, 0);
  out.seen = seen;
  out.t0 = t_in, out.t_per_tau = per_longest;
  return true;
}

template <class T, int K>
class Batch {
 public:
  Batch(const HeightTarget& target, const SampleGrid<T>& grid, std::span<const Ray> rays, std::uint8_t* blocked)
      : target_(target), field_(*target.field), rays_(rays), blocked_(blocked) {
    const MaxPyramid& pyramid = *target.pyramid;
    g_.words = lab.words;
    g_.samples = grid.data;
    g_.stride = static_cast<std::int32_t>(grid.row_stride);
    g_.cols_1 = grid.cell_cols - 1, g_.rows_1 = grid.cell_rows - 1;
    g_.top = pyramid.top_level();
    g_.base = pyramid.code().base, g_.per_step = pyramid.code().per_step;
    for (int l = 1; l <= g_.top; ++l) g_.begin[l] = static_cast<std::int32_t>(pyramid.levels()[static_cast<std::size_t>(l - 1)].begin);
    relief_codes_ = lab.relief_per_cell * g_.per_step;
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
      for (int k = 0; k < K; ++k) node_step(g_, p[k]);
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
          leaf_step(g_, p[k]);
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
    lab.node_steps += steps_ * N * K, lab.node_lanes += node_lanes_, lab.leaf_steps += leaf_steps_ * N, lab.leaf_lanes += leaf_lanes_;
  }

 private:
  void refill(Lanes& a) {
    ++lab.refills;
    for (std::size_t j = 0; j < N; ++j) {
      if (a.st[j] == kWalking) continue;
      const std::int32_t ray = a.ray[j];
      if (ray >= 0) {
        bool hit = a.st[j] == kHit;
        if (a.st[j] == kUnsure) {
          ++lab.resumed;
          const double t_clear = a.seen[j] ? a.t0[j] + static_cast<double>(a.T[j]) * a.t_per_tau[j] : max_mip::kNotClear;
          hit = resume_occluded_max_mip(target_, rays_[static_cast<std::size_t>(ray)], t_clear);
        }
        blocked_[ray] = hit;
        a.ray[j] = -1;
      }
      Prepared q;
      for (;;) {
        if (next_ >= rays_.size()) {
          empty_ = true;
          a.st[j] = kMiss;
          break;
        }
        const std::size_t i = next_++;
        if (!prepare(field_, g_, rays_[i], relief_codes_, q)) {
          ++lab.unprepared;
          blocked_[i] = occluded_max_mip(target_, rays_[i]);
          continue;
        }
        a.ox[j] = q.ox, a.oy[j] = q.oy, a.dx[j] = q.dx, a.dy[j] = q.dy, a.ix[j] = q.ix, a.iy[j] = q.iy;
        a.z[j] = q.z, a.dz[j] = q.dz, a.m2[j] = q.m2, a.tend[j] = q.tend, a.T[j] = 0;
        a.X[j] = a.bx[j] = q.X, a.Y[j] = a.by[j] = q.Y, a.l[j] = q.l, a.mx[j] = q.mx, a.my[j] = q.my;
        a.xl[j] = q.xl, a.yl[j] = q.yl, a.seen[j] = q.seen, a.st[j] = kWalking;
        a.t0[j] = q.t0, a.t_per_tau[j] = q.t_per_tau;
        a.ray[j] = static_cast<std::int32_t>(i);
        break;
      }
    }
  }

  const HeightTarget& target_;
  const HeightField& field_;
  std::span<const Ray> rays_;
  std::uint8_t* blocked_;
  std::size_t next_ = 0;
  bool empty_ = false;
  Ground<T> g_;
  double relief_codes_;
  Lanes lanes_[K];
  std::uint64_t steps_ = 0, node_lanes_ = 0, leaf_steps_ = 0, leaf_lanes_ = 0;
};

void Occluded(const HeightTarget& target, std::span<const Ray> rays, std::uint8_t* blocked) {
  target.field->visit([&](const auto& grid) {
    using T = std::remove_cvref_t<decltype(grid.data[0])>;
    if constexpr (std::is_same_v<T, float>) {
      if (lab.packets == 2) {
        Batch<T, 2>(target, grid, rays, blocked).run();
      } else {
        Batch<T, 1>(target, grid, rays, blocked).run();
      }
    }
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace scarp {
SimdLab lab;
HWY_EXPORT(Occluded);
void occluded_max_mip_simd(const HeightTarget& target, std::span<const Ray> rays, std::uint8_t* blocked) {
  HWY_DYNAMIC_DISPATCH(Occluded)(target, rays, blocked);
}
}  // namespace scarp
#endif
