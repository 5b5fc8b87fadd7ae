// SPDX-License-Identifier: MIT
#include "scarp/march/height/max_mip_simd.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "scarp/accel/block_planes.h"
#include "scarp/march/height/max_mip.h"
#include "scarp/march/height/max_mip_fan_walk.h"
#include "scarp/march/height/max_mip_resume.h"
#include "scarp/march/height/rounding.h"
#include "scarp/march/height/short_rays.h"

// Compiled once per instruction set. Vectors whose length is unknown at compile time cannot be members.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scarp/march/height/max_mip_simd.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h must come first.
#include "hwy/cache_control.h"
#include "hwy/highway.h"
#include "scarp/march/height/max_mip_simd_beam.h"
#include "scarp/march/height/max_mip_simd_cells.h"
#include "scarp/march/height/max_mip_simd_lanes.h"
#include "scarp/march/height/max_mip_simd_rays.h"
#include "scarp/march/height/max_mip_simd_together.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

// Fills all lanes with rays.
HWY_NOINLINE void prepare(const FieldFrame& f, const GridRays& r, Lanes& a) {
  for (std::size_t part = 0; part < N; part += hn::MaxLanes(dd)) prepare_part(dd, f, r, part, a);
  for (std::size_t j = 0; j < N; ++j) {
    a.begin_x[j] = a.x[j], a.begin_y[j] = a.y[j], a.T[j] = 0, a.doubt[j] = kNever;
    if (a.status[j] == kWalking) a.seen[j] |= r.seen[j];
  }
}

// Traverses many rays, one batch on one thread.
template <bool any, class T>
class VectorWalk {
 public:
  using Answer = std::conditional_t<any, std::uint8_t, Hit>;

  VectorWalk(const HeightTarget& target, const SampleGrid<T>& grid, std::span<const Ray> rays, Answer* answers,
             const VectorOptions& options)
      : target_(target), field_(*target.field), rays_(rays), answers_(answers), options_(options) {
    const MaxPyramid& pyramid = *target.pyramid;
    const BlockPlanes& planes = pyramid.planes();
    const HeightCode& code = planes.code();
    g_ = {};
    g_.blocks = pyramid.blocks();
    g_.unit = planes.unit(), g_.depth_unit = BlockPlanes::kDepthUnits * planes.unit();
    g_.tilt_margin = static_cast<float>(kTiltMargins * kSideways * planes.steepest());
    g_.far_slope = 2 * planes.steepest();
    g_.maxima_scale = planes.scale(), g_.maxima_shift = planes.shift();
    g_.samples = grid.data, g_.stride = grid.row_stride;
    g_.last_col = grid.cell_cols - 1, g_.last_row = grid.cell_rows - 1, g_.top = pyramid.top_level();
    for (int level = 1; level <= g_.top; ++level) {
      g_.level_begin[level] = static_cast<std::int32_t>(pyramid.levels()[static_cast<std::size_t>(level - 1)].begin);
    }
    g_.base = static_cast<float>(code.base), g_.per_step = static_cast<float>(code.per_step);
    g_.offset = static_cast<float>((static_cast<double>(g_.base) - code.base) * code.per_step);
    g_.triangles = field_.settings().surface == Surface::triangles;
    g_.seam_col = field_.wraps() ? g_.last_col : -1, g_.seam_row = field_.wraps() ? g_.last_row : -1;
    // At least one bit: a mask of 0 would not show what is mirrored.
    const auto cells = static_cast<unsigned>(std::max({grid.cell_cols, grid.cell_rows, 2}));
    f_ = field_frame(target, code, std::bit_width(cells - 1), std::max(g_.top - 3, 0));
    g_.margin_per_cell = static_cast<float>(4 * kSideways * f_.cell_relief * code.per_step);
  }

  void run(VectorStats& stats) {
    Packet packets[kPackets];
    for (int k = 0; k < kPackets; ++k) {
      Lanes& lanes = lanes_[k];
      lanes = {};
      std::fill_n(lanes.ray, N, -1);
      std::fill_n(lanes.status, N, kMiss);
      packets[k].load(lanes);
      refill(packets[k], lanes);
    }
    for (bool live = true; live;) {
      live = false;
      for (Packet& p : packets) block_step(g_, p);
      for (int k = 0; k < kPackets; ++k) live = follow_up(packets[k], lanes_[k]) || live;
    }
    if constexpr (!any) {
      if (candidates_.count > 0) find_hits();
    }
    add_to(stats);
  }

  // Computes the hits of rays whose cells are known.
  void answer_seen(std::span<const FanSight> sights, VectorStats& stats) {
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      if (!(sights[i].clear >= 0 && sights[i].clear < std::numeric_limits<float>::infinity())) continue;
      const double t_clear = max_mip::clear_time(field_, rays_[i], sights[i]);
      if (field_.wraps() && t_clear > rays_[i].t_max) {
        answers_[i] = {};
        continue;
      }
      candidates_.put(candidates_.count, i, sights[i], t_clear);
      if (field_.wraps()) candidates_.put_copy(candidates_.count, f_, field_.grid_from_world(rays_[i]));
      if (++candidates_.count == N) find_hits();
    }
    if (candidates_.count > 0) find_hits();
    add_to(stats);
  }

 private:
  void add_to(VectorStats& stats) const {
    stats.block_lanes += stats_.block_lanes, stats.block_steps += stats_.block_steps;
    stats.cell_lanes += stats_.cell_lanes, stats.cell_steps += stats_.cell_steps;
    stats.handed_over += stats_.handed_over, stats.beam_rays += stats_.beam_rays;
    stats.together_rays += stats_.together_rays;
  }

  // Processes cells and new rays when enough lanes wait for them. Returns false if no lane has a ray and none are left.
  HWY_INLINE bool follow_up(Packet& p, Lanes& lanes) {
    const VI zero = hn::Zero(di);
    const MI walking = p.walking(), at_cells = hn::And(walking, hn::Eq(p.level, zero));
    const std::size_t busy = hn::CountTrue(di, walking), cells = hn::CountTrue(di, at_cells);
    stats_.block_steps += N;
    stats_.block_lanes += busy - cells;
    const std::size_t quorum = options_.wait ? kQuorum : 1;
    if (cells >= quorum || (cells > 0 && cells == busy)) {
      stats_.cell_steps += N;
      stats_.cell_lanes += cells;
      cell_step<any>(g_, put_off_all(), p);
    }
    if (busy == 0 || (N - busy >= (options_.refill && !together_ ? kFree : N) && !is_empty())) {
      return refill(p, lanes);
    }
    return true;
  }

  HWY_INLINE MI put_off_all() const { return hn::Ne(hn::Set(di, options_.put_off ? 1 : 0), hn::Zero(di)); }

  bool is_empty() const {
    return next_ >= rays_.size() && copies_.empty() &&
           std::all_of(waiting_, waiting_ + kFresh, [](std::uint64_t w) { return w == 0; });
  }

  // Stores the results of finished rays and puts new ones in their lanes. Returns false if no lane has a ray.
  HWY_NOINLINE bool refill(Packet& p, Lanes& a) {
    const std::uint64_t walking = bits_of(p.walking());
    std::uint64_t idle = ~walking & kAllLanes;
    p.store(a);
    answer(p, a, idle);
    for (std::uint64_t rest = idle; rest != 0; rest &= rest - 1) a.ray[std::countr_zero(rest)] = -1;
    bool live = walking != 0;
    while (idle != 0 && find_waiting()) {
      const Lanes& fresh = fresh_[fresh_at_];
      std::uint64_t& waiting = waiting_[fresh_at_];
      alignas(64) std::int32_t from[N] = {}, taken[N] = {};
      for (; idle != 0 && waiting != 0; idle &= idle - 1, waiting &= waiting - 1) {
        const int j = std::countr_zero(idle), i = std::countr_zero(waiting);
        from[j] = i, taken[j] = 1;
        a.ray[j] = fresh.ray[i], a.t_begin[j] = fresh.t_begin[i], a.t_per_cell[j] = fresh.t_per_cell[i];
        a.copy_x[j] = fresh.copy_x[i], a.copy_y[j] = fresh.copy_y[i];
      }
      p.take(fresh, from, taken);
      live = true;
    }
    return live;
  }

  // Whether rays wait for a lane, in fresh_[fresh_at_].
  bool find_waiting() {
    for (;;) {
      for (; fresh_at_ < kFresh; ++fresh_at_) {
        if (waiting_[fresh_at_] != 0) return true;
      }
      if (next_ >= rays_.size() && copies_.empty()) return false;
      take_rays();
    }
  }

  // Prepares the next rays in fresh_. Finishes those that need no traversal.
  HWY_NOINLINE void take_rays() {
    fresh_at_ = 0;
    for (std::size_t k = 0; k < kFresh; ++k) take_rays(fresh_[k], r_[k]);
    if constexpr (!any) {
      if (options_.beam) go_together();
    }
    for (std::size_t k = 0; k < kFresh; ++k) {
      Packet p;
      p.load(fresh_[k]);
      waiting_[k] = bits_of(p.walking());
      answer(p, fresh_[k], ~waiting_[k] & kAllLanes);
    }
  }

  // Follows coherent rays through the pyramid together, or as a beam up to where its rays diverge.
  void go_together() {
    const std::size_t rays = options_.together ? walk_together(g_, fresh_, kFresh) : 0;
    const std::size_t beam_rays = rays > 0 ? 0 : follow_beam(g_, fresh_, kFresh, beam_length_);
    stats_.together_rays += rays, stats_.beam_rays += beam_rays;
    together_ = rays + beam_rays > 0;
    if (rays == 0 || field_.wraps()) return;
    for (std::size_t k = 0; k < kFresh; ++k) find_hits_in_place(k);
  }

  // Rays leave their first cells here, when all lanes are busy. Any-hit rays usually start next to the ground: doubles
  // are used at once where floats would be unsure of most.
  void take_rays(Lanes& fresh, GridRays& r) {
    if (field_.wraps()) {
      take_endless(fresh, r);
    } else {
      take_bounded(fresh, r);
    }
    prepare(f_, r, fresh);
    if (!options_.doubles || g_.triangles || !begins_over_field(fresh)) return;
    if constexpr (any) {
      leave_first_cells<any>(g_, f_, r, fresh);
    } else {
      Packet p;
      p.load(fresh);
      cell_step<any>(g_, put_off_all(), p);
      p.store(fresh);
      leave_first_cells<any>(g_, f_, r, fresh);
    }
  }

  // Prefetches the rays of a vector. Each ray is read once, so all come from memory, and hardware prefetchers stop at
  // page boundaries.
  void prefetch_rays(std::size_t first) const {
    if (first + N > rays_.size()) return;
    const auto* bytes = reinterpret_cast<const std::byte*>(&rays_[first]);
    for (std::size_t i = 0; i < N * sizeof(Ray); i += kCacheLine) hwy::Prefetch(bytes + i);
  }

  void take_bounded(Lanes& fresh, GridRays& r) {
    const std::size_t first = next_, count = std::min(N, rays_.size() - first);
    next_ += count;
    for (std::size_t j = count; j < N; ++j) fresh.ray[j] = -1;
    if (count == 0) {
      std::fill_n(r.dx, N, 0), std::fill_n(r.dy, N, 0);
      return;
    }
    prefetch_rays(first + kAhead);
    r.load(f_, [&](std::size_t j) -> const Ray& { return rays_[first + std::min(j, count - 1)]; });
    bool all_free = true;
    for (std::size_t j = 0; j < count; ++j) {
      fresh.ray[j] = static_cast<std::int32_t>(first + j), r.seen[j] = fresh.copy_x[j] = fresh.copy_y[j] = 0;
      all_free &= rays_[first + j].start == RayStart::free;
    }
    for (std::size_t j = count; j < N; ++j) r.dx[j] = r.dy[j] = 0;
    if (!all_free) start_on_surface(first, count, fresh, r);
  }
  void start_on_surface(std::size_t first, std::size_t count, Lanes& fresh, GridRays& r) {
    alignas(64) std::int32_t decided[N] = {};
    if (!g_.triangles) {
      Cells cells;
      alignas(64) double on_surface[N] = {};
      for (std::size_t j = 0; j < N; ++j) {
        const Ray& ray = rays_[first + std::min(j, count - 1)];
        const bool exists = ray.start_cell.col >= 0 && ray.start_cell.col <= g_.last_col && ray.start_cell.row >= 0 &&
                            ray.start_cell.row <= g_.last_row;
        on_surface[j] = j < count && exists && ray.start == RayStart::on_surface;
        cells.load(g_, j, exists ? ray.start_cell.col : 0, exists ? ray.start_cell.row : 0);
      }
      leave_surface(f_, cells, on_surface, r, decided);
    }
    for (std::size_t j = 0; j < count; ++j) {
      if (rays_[first + j].start != RayStart::on_surface) continue;
      if (decided[j] == kLeaves) {
        r.seen[j] = 1;
      } else if (decided[j] == kNoHit || (any && decided[j] == kFalls)) {
        fresh.ray[j] = -1, r.dx[j] = r.dy[j] = 0;
        Hit hit;
        if (decided[j] == kFalls) hit.status = HitStatus::hit;
        put_answer(first + j, hit);
      } else {
        take_on_surface(j, first + j, fresh, r);
      }
    }
  }
  void take_on_surface(std::size_t j, std::size_t index, Lanes& fresh, GridRays& r) {
    const Ray& ray = rays_[index];
    const SurfaceStart start = begin_on_surface(ray, field_.grid_from_world(ray));
    if (start.decided) {
      fresh.ray[j] = -1, r.dx[j] = r.dy[j] = 0;
      put_answer(index, start.hit);
    } else {
      r.oz[j] = start.z, r.t_min[j] = start.t, r.seen[j] = start.above;
    }
  }
  void take_endless(Lanes& fresh, GridRays& r) {
    for (std::size_t j = 0; j < N; ++j) {
      fresh.ray[j] = -1, fresh.copy_x[j] = fresh.copy_y[j] = 0;
      r.dx[j] = r.dy[j] = 0;
      if (!copies_.empty()) {
        take_copy(j, copies_.back(), fresh, r);
        copies_.pop_back();
      } else if (next_ < rays_.size()) {
        begin_endless(j, next_++, fresh, r);
      }
    }
  }

  static bool begins_over_field(const Lanes& fresh) {
    for (std::size_t j = 0; j < N; ++j) {
      if (fresh.status[j] == kWalking && fresh.level[j] == 0) return true;
    }
    return false;
  }

  // The scalar traversal trusts the start cell, vector code trusts positions: vector code continues where both agree
  // and the cell is not left before the ray starts.
  HWY_NOINLINE SurfaceStart begin_on_surface(const Ray& ray, const GridRay& local) const {
    const auto is_in = [&](double o, double d, int cell) {
      return std::abs(o + d * ray.t_min - cell - 0.5) < 0.5 + kNearCell;
    };
    if (is_in(local.origin.x, local.direction.x, ray.start_cell.col) &&
        is_in(local.origin.y, local.direction.y, ray.start_cell.row)) {
      const SurfaceStart start = start_max_mip(target_, ray);
      if (start.decided || start.t >= ray.t_min) return start;
    }
    SurfaceStart decided;
    decided.decided = true;
    decided.hit = march_max_mip(target_, ray);
    return decided;
  }

  static void put_ray(GridRays& to, std::size_t j, const Ray& ray, const GridRay& local) {
    to.ox[j] = local.origin.x, to.oy[j] = local.origin.y, to.oz[j] = local.origin.z;
    to.dx[j] = local.direction.x, to.dy[j] = local.direction.y, to.dz[j] = local.direction.z;
    to.t_min[j] = ray.t_min, to.t_max[j] = ray.t_max, to.seen[j] = 0;
  }

  void put_answer(std::size_t index, const Hit& hit) {
    if constexpr (any) {
      answers_[index] = hit.status == HitStatus::hit;
    } else {
      answers_[index] = hit;
    }
  }
  HWY_NOINLINE void answer_alone(std::size_t index) {
    ++stats_.handed_over;
    if constexpr (any) {
      answers_[index] = occluded_max_mip(target_, rays_[index]);
    } else {
      answers_[index] = march_max_mip(target_, rays_[index]);
    }
  }

  // Wrapped ground is traversed copy by copy, each as a separate ground with the ray in the copy's frame. The rounding
  // of heights is within the margin, see kFarthestCopy. Nothing may be in doubt in the first copy, so rays that start
  // next to a border are left to the scalar traversal, which supports more kinds of start and counts farther.
  void begin_endless(std::size_t j, std::size_t index, Lanes& fresh, GridRays& r) {
    const Ray& ray = rays_[index];
    const GridRay local = field_.grid_from_world(ray);
    if (ray.start == RayStart::on_surface || !is_near(local.origin.x, local.origin.y) ||
        !max_mip::countable(local, ray)) {
      return answer_alone(index);
    }
    // As in the scalar traversal, moves down to the highest sample at once, across any number of copies.
    double t = ray.t_min;
    if (local.direction.z < 0 && local.origin.z + local.direction.z * t > f_.highest) {
      const double quotient = (f_.highest - local.origin.z) / local.direction.z;
      const double t_top = quotient + rounding_of_clearance(field_, local, quotient) / local.direction.z;
      if (t_top > ray.t_max) return put_answer(index, {});
      t = std::max(t, t_top);
    }
    const auto begin = [t](double o, double d, double cells) {
      const double place = o + d * t, copy = std::floor(place / cells), within = place - copy * cells;
      const bool inside = within > kNearCell && within < cells - kNearCell;
      return std::pair{copy, inside};
    };
    const auto [x, inside_x] = begin(local.origin.x, local.direction.x, f_.cols);
    const auto [y, inside_y] = begin(local.origin.y, local.direction.y, f_.rows);
    if (!inside_x || !inside_y || !is_near(x * f_.cols, y * f_.rows)) return answer_alone(index);
    take_copy(j, {index, static_cast<std::int32_t>(x), static_cast<std::int32_t>(y), false}, fresh, r);
  }
  static bool is_near(double x, double y) { return std::abs(x) < kFarthestCopy && std::abs(y) < kFarthestCopy; }
  void take_copy(std::size_t j, const CopyRay& copy, Lanes& fresh, GridRays& r) {
    const Ray& ray = rays_[copy.ray];
    put_ray(r, j, ray, field_.grid_from_world(ray));
    r.ox[j] -= copy.x * f_.cols, r.oy[j] -= copy.y * f_.rows, r.seen[j] = copy.seen;
    fresh.ray[j] = static_cast<std::int32_t>(copy.ray);
    fresh.copy_x[j] = copy.x, fresh.copy_y[j] = copy.y;
  }
  // A ray without a hit in its copy continues in the next, if it extends that far. If borders of both axes are crossed
  // almost at once, either may come first.
  HWY_NOINLINE void leave_copy(const Lanes& a, std::size_t j) {
    CopyRay copy{static_cast<std::size_t>(a.ray[j]), a.copy_x[j], a.copy_y[j], a.seen[j] != 0};
    const Ray& ray = rays_[copy.ray];
    const GridRay local = field_.grid_from_world(ray);
    const auto exit = [](double o, double d, double from, double cells) {
      return d == 0 ? std::numeric_limits<double>::infinity() : ((d > 0 ? from + cells : from) - o) / d;
    };
    const double x = exit(local.origin.x, local.direction.x, copy.x * f_.cols, f_.cols);
    const double y = exit(local.origin.y, local.direction.y, copy.y * f_.rows, f_.rows);
    const double t = std::min(x, y), dz = local.direction.z, height = local.origin.z + dz * t;
    const double upright = f_.upright + std::abs(local.origin.z) + std::abs(dz * t);
    const double doubt = kRoundings * kUnit * (upright + f_.sample_rows * f_.relief);
    const bool ends = !(t < ray.t_max) || (dz >= 0 && height > f_.highest + doubt);
    if (ends) {
      put_answer(copy.ray, {});
      return;
    }
    if (x <= y) copy.x += local.direction.x > 0 ? 1 : -1;
    if (!(x <= y)) copy.y += local.direction.y > 0 ? 1 : -1;
    is_near(copy.x * f_.cols, copy.y * f_.rows) ? copies_.push_back(copy) : answer_alone(copy.ray);
  }

  // Stores the results of some lanes of p, which are also in memory.
  HWY_INLINE void answer(const Packet& p, const Lanes& a, std::uint64_t lanes) {
    if constexpr (any) {
      const MI hits = hn::Eq(p.status, hn::Set(di, kHit)), misses = hn::Eq(p.status, hn::Set(di, kMiss));
      const MI certain = hn::RebindMask(di, hn::Ge(p.doubt, hn::Set(df, kNever)));
      const std::uint64_t hit = bits_of(hits), sure = bits_of(hn::Or(hits, hn::And(misses, certain)));
      for (std::uint64_t rest = lanes & sure; rest != 0; rest &= rest - 1) {
        const int j = std::countr_zero(rest);
        if (a.ray[j] < 0) continue;
        if (field_.wraps() && !(hit >> j & 1)) {
          leave_copy(a, static_cast<std::size_t>(j));
        } else {
          answers_[a.ray[j]] = hit >> j & 1;
        }
      }
      lanes &= ~sure;
    }
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto j = static_cast<std::size_t>(std::countr_zero(lanes));
      if (a.ray[j] >= 0) answer(a, j);
    }
  }
  void answer(const Lanes& a, std::size_t j) {
    const std::int32_t ray = a.ray[j];
    if constexpr (any) {
      const double doubt = a.t_begin[j] + static_cast<double>(a.doubt[j]) * a.t_per_cell[j];
      ++stats_.handed_over;
      answers_[ray] = resume_occluded_max_mip(target_, rays_[static_cast<std::size_t>(ray)],
                                              a.doubt[j] < kNever ? doubt : max_mip::kNotClear);
    } else {
      if (a.status[j] == kMiss) {
        if (field_.wraps()) {
          leave_copy(a, j);
        } else {
          answers_[ray] = Hit{};
        }
        return;
      }
      if (a.status[j] == kAlone) {
        answer_alone(static_cast<std::size_t>(ray));
        return;
      }
      candidates_.put(candidates_.count++, a, j);
      if (candidates_.count == N) find_hits();
    }
  }

  // Finds the hits of rays traced together, without gathering them first, because most are at cells.
  HWY_INLINE void find_hits_in_place(std::size_t k) {
    Lanes& a = fresh_[k];
    const MI taken = hn::Gt(hn::LoadU(di, a.ray), hn::Set(di, -1));
    const MI at_cells = hn::And(taken, hn::Eq(hn::Load(di, a.status), hn::Set(di, kUnsure)));
    const std::uint64_t lanes = bits_of(at_cells);
    if (lanes == 0 || static_cast<std::size_t>(std::popcount(lanes)) < N / 2) return;
    Candidates c;
    const auto some = static_cast<std::size_t>(std::countr_zero(lanes));
    for (std::size_t j = 0; j < N; ++j) {
      const bool used = lanes >> j & 1;
      c.put(j, a, used ? j : some);
      if (!used) c.ray[j] = -1;
      if (used) a.ray[j] = -1;
    }
    c.count = N;
    find_hits(c, r_[k]);
  }

  // Finds the hits of candidates_.
  HWY_NOINLINE void find_hits() {
    Candidates& c = candidates_;
    // Fills the vector with copies whose results are discarded.
    for (std::size_t i = c.count; i < N; ++i) c.copy(i, 0);
    GridRays rays;
    rays.load(f_, [&](std::size_t i) -> const Ray& { return rays_[static_cast<std::size_t>(c.ray[i])]; });
    find_hits(c, rays);
    c.count = 0;
  }

  // Finds hits in the cells of the candidates as march_max_mip() does, bit for bit: the same operations in the same
  // order, for the common path through a cell. Other paths, and cells without a hit, fall back to march_max_mip().
  HWY_NOINLINE void find_hits(const Candidates& c, const GridRays& rays) {
    Cells cells;
    alignas(64) double t[N], u[N], v[N], height[N], found[N];
    for (std::size_t i = 0; i < N; ++i) {
      cells.load(g_, i, c.col[i], c.row[i], c.copy_x[i] * f_.cols, c.copy_y[i] * f_.rows);
    }
    for (std::size_t h = 0; h < N; h += hn::MaxLanes(dd)) {
      const VD zero = hn::Zero(dd), one = hn::Set(dd, 1);
      const CellRays r(rays, cells, h);
      const VD vt_min = hn::Load(dd, rays.t_min + h), vt_max = hn::Load(dd, rays.t_max + h);
      const VD tx = r.x_out(), ty = r.y_out();
      const VD first_x = hn::Load(dd, cells.first_x + h), first_y = hn::Load(dd, cells.first_y + h);
      const VD last_x = hn::IfThenElse(r.back_x, first_x, hn::Add(first_x, hn::Set(dd, f_.cols)));
      const VD last_y = hn::IfThenElse(r.back_y, first_y, hn::Add(first_y, hn::Set(dd, f_.rows)));
      const VD exit_x = CellRays::line(last_x, r.ox, r.per_x), exit_y = CellRays::line(last_y, r.oy, r.per_y);
      const VD t_in = hn::Max(vt_min, hn::Max(r.x_in(), r.y_in()));
      const VD t_end = hn::Min(vt_max, hn::Min(exit_x, exit_y));
      const VD t_line = hn::Min(tx, ty), t_out = hn::Min(t_line, t_end);
      const VD z_in = r.height(t_in), z_out = r.height(t_out);
      const VD out = r.clearance_out(t_out, hn::Le(tx, ty));
      const CellMeeting m = g_.triangles ? meet_triangles(r, t_in, t_out, out) : meet_bilinear(r, t_in, t_out, out);
      const VD t_far = hn::Max(hn::Abs(t_in), hn::Abs(t_out));
      const VD doubt = rounding(dd, f_, r.ox, r.oy, r.oz, r.dx, r.dy, r.dz, t_far);
      // Above until it enters the cell: known up to t_clear, and from there on by the maximum slope of the ground.
      const VD gap = hn::Max(hn::Sub(t_in, hn::Load(dd, c.t_clear + h)), zero);
      const VD steepest =
          hn::Add(hn::Abs(r.dz), hn::Mul(hn::Add(hn::Abs(r.dx), hn::Abs(r.dy)), hn::Set(dd, f_.cell_relief)));
      // Where a ray enters, it may have touched the rim before, within the allowance.
      const VD cols = hn::Set(dd, f_.cols), rows = hn::Set(dd, f_.rows);
      const VD enter_x = CellRays::line(hn::IfThenElse(r.back_x, hn::Add(first_x, cols), first_x), r.ox, r.per_x);
      const VD enter_y = CellRays::line(hn::IfThenElse(r.back_y, hn::Add(first_y, rows), first_y), r.oy, r.per_y);
      const auto late = [&](VD lines, VD o, VD d, VD per) HWY_ATTR {
        const VD off = rounding_of_line(dd, o, lines, f_.seam);
        return hn::IfThenElseZero(hn::Ne(d, zero), hn::Mul(off, hn::Abs(per)));
      };
      const VD before = hn::IfThenElseZero(hn::Ge(hn::Max(enter_x, enter_y), t_in),
                                           hn::Max(late(cols, r.ox, r.dx, r.per_x), late(rows, r.oy, r.dy, r.per_y)));
      const auto above = hn::Gt(m.in, hn::Add(hn::Mul(hn::Add(gap, before), steepest), doubt));
      // march_max_mip() starts where the ray descends to the highest sample, not before.
      const VD quotient = hn::Div(hn::Sub(hn::Set(dd, f_.highest), r.oz), r.dz);
      const VD t_top = hn::Sub(quotient, hn::Mul(hn::Set(dd, 2 * kUnit), hn::Abs(quotient)));
      const auto begun = hn::Or(hn::Ge(r.dz, zero), hn::Ge(t_line, t_top));
      const auto visited = hn::And(hn::And(hn::Lt(t_in, t_line), hn::Le(t_line, t_end)), hn::And(begun, r.moves()));
      const auto usual = hn::And(above, visited);
      const VD highest = hn::Max(hn::Max(r.h00, r.h10), hn::Max(r.h01, r.h11));
      const VD lowest = hn::IfThenElse(hn::Lt(r.dz, zero), z_out, z_in);
      const auto hit = hn::And(hn::And(usual, hn::Not(hn::Gt(lowest, highest))), m.meets);
      // As std::min() and std::max() order zeros of both signs.
      const VD inside = hn::Add(t_in, m.s), by_end = hn::IfThenElse(hn::Lt(t_out, inside), t_out, inside);
      const VD time = hn::IfThenElse(hn::Lt(by_end, vt_min), vt_min, by_end);
      hn::Store(time, dd, t + h);
      hn::Store(r.u(time), dd, u + h), hn::Store(r.v(time), dd, v + h), hn::Store(r.height(time), dd, height + h);
      hn::Store(hn::IfThenElseZero(hit, one), dd, found + h);
    }
    const bool usual = options_.find_hits;
    for (std::size_t i = 0; i < c.count; ++i) {
      if (c.ray[i] < 0) continue;
      const Ray& ray = rays_[static_cast<std::size_t>(c.ray[i])];
      Hit& to = answers_[c.ray[i]];
      if (usual && found[i] != 0 && ray.start == RayStart::free) {
        to = {.status = HitStatus::hit,
              .t = t[i],
              .cell = {c.col[i], c.row[i]},
              .u = u[i],
              .v = v[i],
              .height = field_.height_from_sample(height[i])};
      } else {
        ++stats_.handed_over;
        to = resume_max_mip(target_, ray, c.seen[i] ? c.t_clear[i] : max_mip::kNotClear);
      }
    }
  }

  // From a search over the rays of scarp-bench (doc/dev/decisions/march.md): number of waiting lanes that triggers
  // their processing.
  static constexpr std::size_t kQuorum = std::max<std::size_t>(1, any ? N / 4 : N * 3 / 8);
  static constexpr std::size_t kFree = std::max<std::size_t>(1, any ? N / 4 : N / 2);
  static constexpr int kPackets = any ? 3 : 2;   // vectors in turn: while one waits for memory, others compute
  static constexpr std::size_t kAhead = 64;      // rays prefetched ahead
  static constexpr std::size_t kCacheLine = 64;  // bytes; with longer lines some are requested twice
  static constexpr std::size_t kFresh = any ? 1 : std::max<std::size_t>(1, 64 / N);  // vectors that form a beam
  static constexpr std::uint64_t kAllLanes = (std::uint64_t{1} << N) - 1;

  const HeightTarget& target_;
  const HeightField& field_;
  std::span<const Ray> rays_;
  Answer* answers_;
  const VectorOptions& options_;
  VectorGround<T> g_;
  FieldFrame f_;
  GridRays r_[kFresh];
  Lanes fresh_[kFresh], lanes_[kPackets];
  std::size_t next_ = 0, fresh_at_ = kFresh;
  std::vector<CopyRay> copies_;         // waiting to be traversed
  std::uint64_t waiting_[kFresh] = {};  // lanes of fresh_ whose rays wait for a lane in lanes_
  float beam_length_ = 0;               // length of the last beam
  bool together_ = false;               // whether the rays in fresh_ form a beam: they start and end together
  Candidates candidates_;
  VectorStats stats_;
};

template <bool any, class Answer>
void walk(const HeightTarget& target, std::span<const Ray> rays, Answer* answers, const VectorOptions& options,
          VectorStats& stats) {
  target.field->visit([&](const auto& grid) {
    using T = std::remove_cvref_t<decltype(grid.data[0])>;
    VectorWalk<any, T>(target, grid, rays, answers, options).run(stats);
  });
}
void walk_closest(const HeightTarget& target, std::span<const Ray> rays, Hit* hits, const VectorOptions& options,
                  VectorStats& stats) {
  walk<false>(target, rays, hits, options, stats);
}
void answer_seen(const HeightTarget& target, std::span<const Ray> rays, std::span<const FanSight> sights, Hit* hits,
                 VectorStats& stats) {
  target.field->visit([&](const auto& grid) {
    using T = std::remove_cvref_t<decltype(grid.data[0])>;
    VectorWalk<false, T>(target, grid, rays, hits, {}).answer_seen(sights, stats);
  });
}
void walk_any(const HeightTarget& target, std::span<const Ray> rays, std::uint8_t* blocked,
              const VectorOptions& options, VectorStats& stats) {
  walk<true>(target, rays, blocked, options, stats);
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
HWY_EXPORT(answer_seen);

thread_local VectorStats t_stats;

// Rays over less than this many cells are faster one by one (scarp-bench calls).
constexpr double kFewCells = 1;

// Minimum width of copies of a wrapped ground: entering the next one takes as long as a few cells.
constexpr int kNarrowestCopy = 128;

// Excludes fields that vector code does not support: those with holes, where a ray above all ground may be below the
// rim of the next cell, and those beyond 32-bit offsets or floats.
bool walks_over(const HeightTarget& target) {
  require(target, HeightPart::pyramid);
  const HeightField& field = *target.field;
  if (field.nodata_count() > 0 || !target.pyramid->planes().exist()) return false;
  if (field.wraps() && std::min(field.cols(), field.rows()) < kNarrowestCopy) return false;
  const HeightCode& code = target.pyramid->planes().code();
  return code.per_step > 0x1p-100 && code.per_step < 0x1p100 && std::abs(code.base) < 0x1p100;
}

}  // namespace

void closest_hits_max_mip_simd(const HeightTarget& target, std::span<const Ray> rays, std::span<Hit> hits,
                               const VectorOptions& options) {
  const auto alone = [&](const Ray& ray) { return march_max_mip(target, ray); };
  if (!walks_over(target)) return max_mip::answer_alone(rays, hits, alone);
  max_mip::answer_by_length(*target.field, kFewCells, rays, hits, alone, [&](auto some, auto answers) {
    HWY_DYNAMIC_DISPATCH(walk_closest)(target, some, answers.data(), options, t_stats);
  });
}

void occluded_max_mip_simd(const HeightTarget& target, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                           const VectorOptions& options) {
  const auto alone = [&](const Ray& ray) -> std::uint8_t { return occluded_max_mip(target, ray); };
  if (!walks_over(target)) return max_mip::answer_alone(rays, blocked, alone);
  max_mip::answer_by_length(*target.field, kFewCells, rays, blocked, alone, [&](auto some, auto answers) {
    HWY_DYNAMIC_DISPATCH(walk_any)(target, some, answers.data(), options, t_stats);
  });
}

void closest_hits_max_mip_simd(const HeightTarget& target, std::span<const Ray> rays, std::span<Hit> hits) {
  closest_hits_max_mip_simd(target, rays, hits, {});
}

void occluded_max_mip_simd(const HeightTarget& target, std::span<const Ray> rays, std::span<std::uint8_t> blocked) {
  occluded_max_mip_simd(target, rays, blocked, {});
}

void max_mip::answer_seen(const HeightTarget& target, std::span<const Ray> rays, std::span<const FanSight> sights,
                          std::span<Hit> hits) {
  if (walks_over(target)) {
    HWY_DYNAMIC_DISPATCH(answer_seen)(target, rays, sights, hits.data(), t_stats);
  } else {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (sights[i].clear >= 0 && sights[i].clear < std::numeric_limits<float>::infinity())
        hits[i] = resume_max_mip(target, rays[i], max_mip::clear_time(*target.field, rays[i], sights[i]));
    }
  }
}

VectorStats take_vector_stats() { return std::exchange(t_stats, {}); }

}  // namespace scarp
#endif
