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
#include "scarp/march/max_mip_simd_beam.h"
#include "scarp/march/max_mip_simd_lanes.h"
#include "scarp/march/max_mip_simd_rays.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

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
    g_.maxima = pyramid.maxima();
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
      for (Packet& p : packets) block_step(g_, p);
      for (int k = 0; k < kPackets; ++k) live = follow_up(packets[k], lanes_[k]) || live;
    }
    if constexpr (!any) {
      if (candidates_.count > 0) find_hits();
    }
    stats.block_lanes += stats_.block_lanes, stats.block_steps += stats_.block_steps;
    stats.cell_lanes += stats_.cell_lanes, stats.cell_steps += stats_.cell_steps;
    stats.handed_over += stats_.handed_over, stats.beam_rays += stats_.beam_rays;
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
    if (busy == 0 || (N - busy >= (ideas_.refill && !together_ ? kFree : N) && !is_empty())) {
      p.store(lanes);
      if (!refill(lanes)) return false;
      p.load(lanes);
    }
    return true;
  }

  bool is_empty() const { return next_ >= rays_.size() && fresh_next_ >= kFresh * N; }

  // Answers the rays that are done and puts new ones into their lanes. False: no lane has a ray.
  HWY_NOINLINE bool refill(Lanes& a) {
    if (together_ && std::find(a.status, a.status + N, kWalking) == a.status + N) return refill_all(a);
    return refill_lanes(a);
  }

  bool refill_lanes(Lanes& a) {
    bool live = false;
    for (std::size_t j = 0; j < N; ++j) {
      if (a.status[j] != kWalking) {
        answer(a, j);
        a.ray[j] = -1;
        if (!next_fresh()) continue;
        move(fresh_[fresh_next_ / N], fresh_next_ % N, a, j);
        ++fresh_next_;
      }
      live = true;
    }
    return live;
  }

  // The same where all rays are done: a whole vector of new rays is taken as it is, and no lane is moved alone.
  bool refill_all(Lanes& a) {
    for (std::size_t j = 0; j < N; ++j) answer(a, j);
    std::fill_n(a.ray, N, -1);
    if (!next_fresh()) return false;
    if (fresh_next_ % N != 0) return refill_lanes(a);
    a = fresh_[fresh_next_ / N];
    fresh_next_ += N;
    return true;
  }

  // Whether there is another ray, at fresh_next_. Rays that need no walk are answered on the way.
  bool next_fresh() {
    for (;;) {
      for (; fresh_next_ < kFresh * N; ++fresh_next_) {
        const Lanes& fresh = fresh_[fresh_next_ / N];
        if (fresh.status[fresh_next_ % N] == kWalking) return true;
        answer(fresh, fresh_next_ % N);
      }
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

  // The next rays into fresh_.
  HWY_NOINLINE void take_rays() {
    fresh_next_ = 0;
    for (Lanes& fresh : fresh_) take_rays(fresh);
    if (any || !ideas_.beam) return;
    const std::uint64_t rays = follow_beam(g_, fresh_, kFresh, beam_length_);
    stats_.beam_rays += rays;
    together_ = rays > 0;
  }

  // The first steps of any-hit are taken here, where all lanes are busy: most rays begin near the ground, at a cell.
  void take_rays(Lanes& fresh) {
    const std::size_t count = std::min(N, rays_.size() - next_);
    for (std::size_t j = 0; j < N; ++j) {
      const bool taken = j < count && take_ray(j, rays_[next_ + j]);
      fresh.ray[j] = taken ? static_cast<std::int32_t>(next_ + j) : -1;
      if (!taken) r_.dx[j] = r_.dy[j] = 0;
    }
    next_ += count;
    prepare(f_, r_, fresh);
    if (any && ideas_.first_cells) {
      Packet p;
      p.load(fresh);
      for (int i = 0; i < kFirstSteps; ++i) {
        cell_step<any>(g_, ideas_.put_off, p);
        block_step(g_, p);
      }
      p.store(fresh);
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
  static constexpr int kPackets = any ? 3 : 2;  // vectors in turn: while one waits for memory, others compute
  static constexpr int kFirstSteps = 2;
  static constexpr std::size_t kFresh = any ? 1 : std::max<std::size_t>(1, 64 / N);  // vectors that are a beam
  static constexpr double kNearCell = 0x1p-20;                                       // of a cell, far beyond rounding

  const HeightTarget& target_;
  const HeightField& field_;
  std::span<const Ray> rays_;
  Answer* answers_;
  const VectorIdeas& ideas_;
  VectorGround<T> g_;
  FieldFrame f_;
  GridRays r_;
  Lanes fresh_[kFresh], lanes_[kPackets];
  std::size_t next_ = 0, fresh_next_ = kFresh * N;
  float beam_length_ = 0;  // of the last beam
  bool together_ = false;  // whether the rays in fresh_ are a beam: as they start together they end together
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

void closest_hits_max_mip_simd(const HeightTarget& target, std::span<const Ray> rays, std::span<Hit> hits) {
  closest_hits_max_mip_simd(target, rays, hits, {});
}

void occluded_max_mip_simd(const HeightTarget& target, std::span<const Ray> rays, std::span<std::uint8_t> blocked) {
  occluded_max_mip_simd(target, rays, blocked, {});
}

VectorStats take_vector_stats() { return std::exchange(t_stats, {}); }

}  // namespace scarp
#endif
