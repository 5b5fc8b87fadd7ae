// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "scarp/base/kept_memory.h"
#include "scarp/march/height/max_mip_fan.h"
#include "scarp/march/height/max_mip_fan_walk.h"
#include "scarp/march/height/max_mip_resume.h"
#include "scarp/march/height/rounding.h"

// Compiled once per instruction set. Vectors whose length the compiler does not know cannot be members.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scarp/march/height/max_mip_fan_simd.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h must come first.
#include "hwy/highway.h"
#include "scarp/march/height/max_mip_fan_answers.h"
#include "scarp/march/height/max_mip_fan_lines.h"
#include "scarp/march/height/max_mip_fan_pass.h"
#include "scarp/march/height/max_mip_fan_rays.h"
#include "scarp/march/height/max_mip_fan_step.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

template <class Sample>
class FanWalk {
 public:
  FanWalk(const HeightTarget& target, const SampleGrid<Sample>& grid, const Fan& fan, const FanHits& hits,
          FanSight* sights, const FanOptions& options, std::vector<max_mip::FanRest>& rest, FanStats& stats)
      : field_(*target.field),
        pyramid_(*target.pyramid),
        grid_(grid),
        fan_(fan),
        hits_(hits),
        sights_(sights),
        options_(options),
        rest_(rest),
        stats_(stats) {
    Ray ray;
    ray.origin = fan.origin;
    const dvec3 at = field_.grid_from_world(ray).origin;
    const bool wraps = field_.wraps();
    origin_ = at;
    if (wraps) {
      origin_.x -= std::floor(at.x / grid.cell_cols) * grid.cell_cols;
      origin_.y -= std::floor(at.y / grid.cell_rows) * grid.cell_rows;
    }
    for (int i = 0; i < 8; ++i) octants_[i] = octant(grid, wraps, origin_, pyramid_.relief().lowest(), i);
    const HeightField::GridScales scales = field_.grid_scales();
    scales_.per_x = static_cast<float>(scales.per_cell_x), scales_.per_y = static_cast<float>(-scales.per_cell_y);
    scales_.per_z = static_cast<float>(scales.per_scale);
    // march_max_mip() counts cells: rays whose hits are wanted end where it can.
    scales_.most_major = wraps && !sights ? static_cast<float>(std::min(0x1p60, 0x1p40 / fan.t_max)) : 0x1p60f;
    triangles_ = field_.settings().surface == Surface::triangles;
    const double low = field_.min_sample(), high = field_.max_sample();
    // Rays are above all ground there, whatever rounding does to their height.
    heights_.highest = static_cast<float>(high - origin_.z + 0x1p-19 * (std::abs(high - origin_.z) + high - low));
    heights_.lowest = static_cast<float>(low - origin_.z);
    const double tall = std::max({high - low, std::abs(origin_.z - low), std::abs(origin_.z - high)});
    scales_.steepest = static_cast<float>(std::clamp(tall * 0x1p18, 0x1p-60, 0x1p90));
    // Rounding of doubles, for any ray over the field: four times rounding_of_clearance(), for the signs of both
    // marches.
    const double wide =
        std::abs(at.x) + std::abs(at.y) + field_.cell_cols() + field_.cell_rows() + (wraps ? 2 * kMostLines : 0);
    const GridRay far{{wide, wide, std::abs(origin_.z)}, {0, 0, std::abs(low) + std::abs(high) + std::abs(origin_.z)}};
    doubt_ = static_cast<float>(4 * rounding_of_clearance(field_, far, 1));
    rounding_ = kFanRounding * options.margin;
    const double relief = grid.has_holes ? high - low : pyramid_.cell_relief() * pyramid_.code().step;
    cell_relief_ = static_cast<float>(relief) * (1 + 0x1p-20f);
    planes_ = fan_planes(pyramid_, origin_.z);
    origin_cell_ = {static_cast<std::int32_t>(std::floor(origin_.x)), static_cast<std::int32_t>(std::floor(origin_.y))};
    in_cell_x_ = static_cast<float>(origin_.x - origin_cell_.col);
    in_cell_y_ = static_cast<float>(origin_.y - origin_cell_.row);
    const auto rows = static_cast<std::size_t>(fan.rows);
    m_.resize((rows + 1) * N), s_.resize((rows + 1) * N), T_.resize(rows * N), cell_.resize(rows * N);
  }

  void run(int begin, int end) {
    for (int column = begin; column < end; column += N) strip(column, std::min<int>(N, end - column));
  }

  double share_to_walk() {
    std::int64_t walked = 0;
    for (int column = 0; column < fan_.columns; column += N) {
      set_strip(column, std::min<int>(N, fan_.columns - column));
      const VI octants = hn::Set(di, worthwhile_octants());
      for (int i = 0; i < fan_.rows; ++i) {
        const MF walks = hn::RebindMask(df, hn::Ne(hn::And(octant_bit(row(i)), octants), hn::Zero(di)));
        walked += std::popcount(bits_of(walks) & ((std::uint64_t{1} << width_) - 1));
      }
    }
    return static_cast<double>(walked) / (static_cast<double>(fan_.columns) * fan_.rows);
  }

 private:
  void strip(int column, int width) {
    ++stats_.strips;
    stats_.rays += static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(fan_.rows);
    set_strip(column, width);
    const std::int32_t walked = options_.always ? kAllOctants : worthwhile_octants();
    if (walked == 0 && sights_) return leave_strip();
    prepare(walked);
    sights_ ? answer_sights() : answer();
  }

  void set_strip(int column, int width) {
    const bool falls = slope_at(0, column + width / 2) > slope_at(fan_.rows - 1, column + width / 2);
    const int first = falls ? fan_.rows - 1 : 0;
    begin_ = max_mip::place_of(fan_, column, first);
    step_ = falls ? -fan_.row_stride : fan_.row_stride;
    width_ = width;
    // Whole vectors must not cross from a strip of 16 columns into memory of another.
    if (width == static_cast<int>(N) && column % kFanStrip + width <= kFanStrip) {
      rays_ = {fan_.dx + begin_, fan_.dy + begin_, fan_.dz + begin_, step_};
    } else {
      copy_rays();
    }
  }

  // Octants that are worth a walk, as bits, by some of the rows: links between rows that are far apart are about as
  // steep as those between neighbours.
  HWY_NOINLINE std::int32_t worthwhile_octants() {
    constexpr int kRows = 24;
    const int every = std::max(1, fan_.rows / kRows);
    VI seen = hn::Zero(di);
    for (int i = 0; i < fan_.rows; i += every) seen = hn::Or(seen, octant_bit(row(i)));
    std::int32_t worthwhile = 0;
    StripLanes lanes;
    lanes.m = m_.data(), lanes.s = s_.data();
    row_of_.resize(m_.size());
    for (std::int32_t all = bits_of_lanes(seen); all != 0; all &= all - 1) {
      const int o = std::countr_zero(static_cast<unsigned>(all));
      take(o, lanes, every);
      const std::int32_t end = std::max(end_line(octants_[o], lanes, fan_.t_max), 0);
      const std::int32_t first = std::max(first_line(octants_[o], lanes, heights_, end) - 1, 0);
      const auto last_line = [&](std::int32_t i) { return std::min(line_of_hit(i, lanes), end); };
      if (pass_pays(octants_[o], lanes, pyramid_.relief(), cell_relief_, first, last_line)) worthwhile |= 1 << o;
    }
    return worthwhile;
  }
  static constexpr std::int32_t kAllOctants = 0xff;
  // The line behind the hit of a ray in the middle of the lanes.
  std::int32_t line_of_hit(std::int32_t i, const StripLanes& lanes) const {
    constexpr std::size_t kLane = N / 2;
    if (i >= lanes.count[kLane]) return 0;
    const std::ptrdiff_t at = row_of_[static_cast<std::size_t>(i) * N + kLane] * rays_.stride + kLane;
    return line_behind_hit({&field_, &pyramid_}, fan_, {rays_.dx[at], rays_.dy[at], rays_.dz[at]}, scales_);
  }

  // Sights of a strip of which nothing is known.
  void leave_strip() {
    for (int i = 0; i < fan_.rows; ++i)
      std::fill_n(sights_ + begin_ + i * step_, width_, FanSight{-std::numeric_limits<float>::infinity(), 0});
  }

  float slope_at(int row, int column) const {
    const std::ptrdiff_t i = max_mip::place_of(fan_, column, row);
    return fan_.dz[i] / std::hypot(fan_.dx[i], fan_.dy[i]);
  }

  // The last columns, with copies of one of them.
  void copy_rays() {
    const auto rows = static_cast<std::size_t>(fan_.rows);
    copies_.resize(3 * rows * N);
    float* to = copies_.data();
    for (const float* from : {fan_.dx, fan_.dy, fan_.dz}) {
      for (int row = 0; row < fan_.rows; ++row) {
        for (int i = 0; i < static_cast<int>(N); ++i) *to++ = from[begin_ + row * step_ + std::min(i, width_ - 1)];
      }
    }
    rays_ = {copies_.data(), copies_.data() + rows * N, copies_.data() + 2 * rows * N, N};
  }

  HWY_INLINE RowRays row(int i) const { return row_rays(rays_, i, scales_); }

  // Tables of m and s, and the walks: one per octant of `walked` that the strip's rays are in.
  HWY_NOINLINE void prepare(std::int32_t walked) {
    const RowRays first = row(0);
    VI seen = hn::Zero(di);
    bool all_taken = true;
    VF least = hn::Set(df, 2), most = hn::Zero(df), per_major = hn::Set(df, kNoTime);
    VI broken = hn::Set(di, -1);
    VF m0 = first.m, s0 = hn::Set(df, -kNoTime);
    const VF relief = hn::Set(df, cell_relief_);
    for (int i = 0; i < fan_.rows; ++i) {
      const RowRays r = row(i);
      const auto at = static_cast<std::size_t>(i) * N;
      hn::StoreU(r.m, df, m_.data() + at), hn::StoreU(r.s, df, s_.data() + at);
      const VI one = octant_bit(r);
      const MI walks = hn::Ne(hn::And(one, hn::Set(di, walked)), hn::Zero(di));
      const MF taken = hn::RebindMask(df, walks);
      hn::StoreU(hn::IfThenElse(taken, hn::Set(df, kNoTime), hn::Set(df, -kNoTime)), df, T_.data() + at);
      all_taken &= hn::AllTrue(df, taken);
      seen = hn::Or(seen, one);
      least = hn::Min(least, r.m), most = hn::Max(most, r.m), per_major = hn::Min(per_major, r.per_major);
      const MI breaks = hn::RebindMask(di, hn::Not(inherits(m0, s0, r.m, r.s, relief)));
      broken = hn::IfThenElse(breaks, hn::Set(di, i), broken);
      m0 = r.m, s0 = r.s;
    }
    std::int32_t all = bits_of_lanes(seen) & walked;
    StripLanes lanes;
    lanes.m = m_.data(), lanes.s = s_.data();
    if (all_taken && std::has_single_bit(static_cast<unsigned>(all))) {
      hn::Store(hn::Set(di, fan_.rows), di, lanes.count);
      for (std::size_t l = static_cast<std::size_t>(width_); l < N; ++l) lanes.count[l] = 0;
      hn::Store(broken, di, lanes.broken), hn::Store(least, df, lanes.least_m);
      lanes.strip_least_m = hn::GetLane(hn::MinOfLanes(df, least));
      lanes.strip_most_m = hn::GetLane(hn::MaxOfLanes(df, most));
      lanes.most_major = 1 / hn::GetLane(hn::MinOfLanes(df, per_major));
      rows_ = nullptr;
      walk(octants_[std::countr_zero(static_cast<unsigned>(all))], lanes);
      return;
    }
    row_of_.resize(m_.size());
    for (; all != 0; all &= all - 1) {
      const int o = std::countr_zero(static_cast<unsigned>(all));
      take(o, lanes, 1);
      rows_ = row_of_.data();
      walk(octants_[o], lanes);
    }
  }

  // Tables of the rays in one octant alone, of every `every`-th row.
  HWY_NOINLINE void take(int octant, StripLanes& lanes, int every) {
    std::fill_n(lanes.count, N, 0), std::fill_n(lanes.broken, N, -1), std::fill_n(lanes.least_m, N, 2.0f);
    std::fill_n(m_.begin(), N, 0.0f), std::fill_n(s_.begin(), N, 0.0f);
    float most = 0, least_per_major = kNoTime;
    alignas(64) float m[N], s[N], per_major[N];
    for (int i = 0; i < fan_.rows; i += every) {
      const RowRays r = row(i);
      const MF in = hn::And(r.taken, hn::RebindMask(df, hn::Eq(r.octant, hn::Set(di, octant))));
      std::uint64_t bits = bits_of(in) & ((std::uint64_t{1} << width_) - 1);
      if (bits == 0) continue;
      hn::Store(r.m, df, m), hn::Store(r.s, df, s), hn::Store(r.per_major, df, per_major);
      for (; bits != 0; bits &= bits - 1) {
        const auto l = static_cast<std::size_t>(std::countr_zero(bits));
        const auto count = static_cast<std::size_t>(lanes.count[l]++), to = count * N + l;
        m_[to] = m[l], s_[to] = s[l], row_of_[to] = i;
        if (count > 0 && !inherits(m_[to - N], s_[to - N], m[l], s[l], cell_relief_))
          lanes.broken[l] = static_cast<std::int32_t>(count);
        lanes.least_m[l] = std::min(lanes.least_m[l], m[l]);
        most = std::max(most, m[l]), least_per_major = std::min(least_per_major, per_major[l]);
      }
    }
    lanes.strip_least_m = *std::min_element(lanes.least_m, lanes.least_m + N);
    lanes.strip_most_m = most, lanes.most_major = 1 / least_per_major;
  }

  void walk(const Octant<Sample>& o, const StripLanes& lanes) {
    const std::int32_t end = end_line(o, lanes, fan_.t_max);
    // Rays that get to the end miss; wrapped ground goes on, and they are above it up to there.
    const std::int32_t far = o.wraps ? std::min(far_line(lanes, heights_), end) : end;
    const float last = !o.wraps ? kNoTime : far < end ? -kNoTime : -1 - o.T_at(end);
    triangles_ ? walk_over<true>(o, lanes, far, last) : walk_over<false>(o, lanes, far, last);
  }

  template <bool triangles>
  HWY_NOINLINE void walk_over(const Octant<Sample>& o, const StripLanes& lanes, std::int32_t end, float last) {
    const bool rises = o.rises;
    const VI n = hn::Load(di, lanes.count), lane = hn::Iota(di, 0), one = hn::Set(di, 1);
    VI j = hn::Zero(di);
    MF active = hn::RebindMask(df, hn::Gt(n, j)), refused = hn::RebindMask(df, hn::Lt(n, j));
    FanRays r;
    r.m = hn::LoadU(df, m_.data()), r.s = hn::LoadU(df, s_.data()), r.per_m = per(r.m);
    VF m_ok = r.m, s_ok = r.s;
    // The rays behind these, early: they come from memory.
    VF m_next, s_next, per_next;
    const auto load_next = [&]() HWY_ATTR {
      const VI from = hn::Add(hn::ShiftLeft<kLaneBits>(hn::Min(hn::Add(j, one), hn::Set(di, fan_.rows))), lane);
      m_next = hn::GatherIndex(df, m_.data(), from), s_next = hn::GatherIndex(df, s_.data(), from);
      per_next = per(m_next);
    };
    load_next();
    const VF least_m = hn::Load(df, lanes.least_m);
    std::int32_t k = first_line(o, lanes, heights_, end);
    WedgeRelief<Sample> relief(o, pyramid_.relief(), std::max(k - 1, 0), static_cast<double>(lanes.strip_least_m),
                               static_cast<double>(lanes.strip_most_m));

    std::int32_t b = 0;
    bool wide = false;
    FanLine at;
    float low_y = -0x1p30f, high_y = 0x1p30f;  // the field's sides, if any, from the first node of the windows
    float doubt = 0;
    const Sample *line0 = nullptr, *line1 = nullptr;
    // Wide: the nodes of each lane from far_node on, one more at the next line.
    const VF zero = hn::Zero(df);
    FanNodes nodes{zero, zero, zero, zero, zero, zero};
    VI far_node = hn::Set(di, -1);
    VF b3 = zero;
    const auto set_window = [&](std::int32_t first) {
      b = first;
      at.y = static_cast<float>(o.fy - b);
      if (o.wraps) return;
      low_y = static_cast<float>(-o.node0 - b), high_y = static_cast<float>(o.minor_cells - o.node0 - b);
    };
    const auto set_line = [&] {
      at.T0 = o.T_at(k), at.T1 = o.T_at(k + 1);
      at.length = k == 0 ? at.T1 : 1, at.per_length = k == 0 ? 1 / at.T1 : 1;
      at.aside = 0x1p-10f + 0x1p-19f * (lanes.strip_most_m * at.T1);
      // The cut through the origin's cell is rounded as its whole sides are.
      doubt = k == 0 ? doubt_ + 4 * rounding_ * relief.up_to(1) : doubt_;
    };
    // The line through the origin: the ground that is cut off there is bilinear again.
    const auto cut = [&](float* window, const float* next) HWY_ATTR {
      for (int i = 0; i < kWindow; i += N) {
        const VF a = hn::Load(df, window + i), c = hn::Load(df, next + i);
        hn::Store(hn::MulAdd(hn::Sub(c, a), hn::Set(df, static_cast<float>(o.fx)), a), df, window + i);
      }
    };
    const auto load_lines = [&]() HWY_ATTR {
      load_window(o, k, b, window0_), load_window(o, k + 1, b, window1_);
      if (k == 0) cut(window0_, window1_);
    };
    // Windows from the least node of the lanes on; lanes that do not fit gather.
    const auto move_window = [&](FanPlaces& p) HWY_ATTR {
      const VF far = hn::IfThenElse(active, p.node, hn::Set(df, 0x1p30f));
      const float least = hn::GetLane(hn::MinOfLanes(df, far));
      set_window(b + static_cast<std::int32_t>(least));
      p = places(at, r);
      const MF out = hn::And(active, hn::Or(hn::Lt(p.node, hn::Zero(df)), hn::Gt(p.node, hn::Set(df, kWindow - 3))));
      wide = !hn::AllFalse(df, out);
      if (wide) {
        line0 = o.line(k), line1 = o.line(k + 1);
        far_node = hn::Set(di, std::numeric_limits<std::int32_t>::min());
      } else {
        load_lines();
      }
    };

    set_window(0);
    set_line();
    load_lines();
    int level = kLeastLevel;
    const int top = pyramid_.top_level();
    const auto& levels = pyramid_.levels();
    std::int32_t no_jump = options_.jumps && pyramid_.planes().exist() ? 1 : std::numeric_limits<std::int32_t>::max();
    for (;;) {
      if (k >= end) {
        end_lanes(active, j, m_ok, s_ok, relief, k, lanes, last);
        return;
      }
      // Over blocks.
      const std::int32_t real = o.back_major ? o.major_cells - o.field_line(k) : o.field_line(k);
      if (k >= no_jump && (real & ((1 << kLeastLevel) - 1)) == 0) {
        const int fits = real == 0 ? top : std::min(top, std::countr_zero(static_cast<unsigned>(real)));
        bool jumped = false;
        for (int l = std::min(level, fits); l >= kLeastLevel && !jumped; --l) {
          ++stats_.jump_tries;
          const std::int32_t left = o.wraps && !o.back_major ? o.major_cells - real : 1 << l;
          const std::int32_t lines = std::min(1 << l, left);
          const MF clear = clears_blocks(o, planes_, levels[static_cast<std::size_t>(l - 1)], l, lines, k, at, b, r,
                                         doubt_, rounding_);
          if (hn::AllTrue(df, hn::Or(clear, hn::Not(active)))) {
            ++stats_.jumps;
            k += lines;
            level = l + 1;
            jumped = true;
          } else {
            level = kLeastLevel;
          }
        }
        if (jumped) {
          if (k >= end) continue;
          wide = false;
          set_line();
          FanPlaces p = places(at, r);
          move_window(p);
          continue;
        }
      }
      ++stats_.lines;
      stats_.wide_lines += wide;
      FanPlaces p;
      for (;;) {
        ++stats_.turns;
        p = places(at, r);
        if (!wide) {
          const MF out =
              hn::And(active, hn::Or(hn::Lt(p.node, hn::Zero(df)), hn::Gt(p.node, hn::Set(df, kWindow - 3))));
          if (!hn::AllFalse(df, out)) move_window(p);
        }
        const VI node = hn::ConvertTo(di, p.node);
        if (!wide) {
          const VI i0 = hn::And(node, hn::Set(di, kWindow - 1)), i1 = hn::And(hn::Add(node, one), hn::Set(di, 15)),
                   i2 = hn::And(hn::Add(node, hn::Set(di, 2)), hn::Set(di, 15));
          nodes = {look_up(window0_, i0), look_up(window0_, i1), look_up(window0_, i2),
                   look_up(window1_, i0), look_up(window1_, i1), look_up(window1_, i2)};
        } else if (!hn::AllFalse(di, hn::And(hn::RebindMask(di, active), hn::Ne(node, far_node)))) {
          far_node = node;
          const VI i0 = hn::Add(node, hn::Set(di, o.node0 + b)), i1 = hn::Add(i0, one), i2 = hn::Add(i1, one);
          nodes = {look_far(o, line0, i0), look_far(o, line0, i1), look_far(o, line0, i2),
                   look_far(o, line1, i0), look_far(o, line1, i1), look_far(o, line1, i2)};
          b3 = look_far(o, line1, hn::Add(i2, one));
        }
        const FanStep e = step_over<triangles>(at, r, p, nodes, rises, doubt, rounding_);
        VF low = hn::Min(e.low1, e.low2);
        // The origin's cell was treated as bilinear, which may be a quarter of its twist above the triangles.
        if (triangles && k == 0) low = hn::Sub(low, hn::Set(df, 0.5f * relief.up_to(1)));
        const MF clear = hn::Gt(low, e.margin);
        const VF beyond = hn::Set(df, high_y + at.aside);
        const MF out = hn::AndNot(refused, hn::Gt(p.y, beyond));
        const MF above =
            hn::AndNot(refused, hn::And(hn::Ge(r.s, hn::Zero(df)), hn::Gt(e.h0, hn::Set(df, heights_.highest))));
        const MF go = hn::And(active, hn::Or(hn::Or(hn::Not(clear), out), hn::Or(above, refused)));
        if (hn::AllFalse(df, go)) break;
        const MF all_out = hn::And(out, hn::Gt(hn::MulAdd(least_m, hn::Set(df, at.T0), hn::Set(df, at.y)), beyond));
        const MF ends = hn::And(go, hn::Or(above, all_out));
        if (!hn::AllFalse(df, ends)) {
          end_lanes(ends, j, m_ok, s_ok, relief, k, lanes);
          active = hn::AndNot(ends, active);
        }
        const MF candidates = hn::AndNot(hn::Or(ends, out), go);
        if (!hn::AllFalse(df, candidates))
          put_hits<triangles>(o, k, b, at, low_y, high_y, p, e, candidates, refused, j);
        // The next rays of these lanes.
        const MF next = hn::AndNot(ends, go);
        j = hn::IfThenElse(hn::RebindMask(di, next), hn::Add(j, one), j);
        const MF left = hn::RebindMask(df, hn::Gt(n, j));
        active = hn::And(active, left);
        if (hn::AllFalse(df, active)) return;
        const MF replaced = hn::And(next, left);
        r.m = hn::IfThenElse(replaced, m_next, r.m), r.s = hn::IfThenElse(replaced, s_next, r.s);
        r.per_m = hn::IfThenElse(replaced, per_next, r.per_m);
        load_next();
        const MF linked = inherits(m_ok, s_ok, r.m, r.s, hn::Set(df, relief.up_to(k)));
        refused = hn::Or(hn::AndNot(replaced, refused), hn::AndNot(linked, replaced));
        const MF ok = hn::And(replaced, linked);
        m_ok = hn::IfThenElse(ok, r.m, m_ok), s_ok = hn::IfThenElse(ok, r.s, s_ok);
      }
      ++k;
      set_line();
      prefetch_line(o, k, lanes.strip_least_m, lanes.strip_most_m);
      if (wide) {
        // The nodes at the next line are already loaded, unless a lane moves sideways.
        const MF moves = hn::Ge(p.q, hn::Set(df, 1));
        nodes.a0 = hn::IfThenElse(moves, nodes.b1, nodes.b0), nodes.a1 = hn::IfThenElse(moves, nodes.b2, nodes.b1);
        nodes.a2 = hn::IfThenElse(moves, b3, nodes.b2);
        far_node = hn::Add(far_node, hn::IfThenElseZero(hn::RebindMask(di, moves), one));
        line0 = line1, line1 = o.line(k + 1);
        const VI i0 = hn::Add(far_node, hn::Set(di, o.node0 + b)), i1 = hn::Add(i0, one), i2 = hn::Add(i1, one);
        nodes.b0 = look_far(o, line1, i0), nodes.b1 = look_far(o, line1, i1), nodes.b2 = look_far(o, line1, i2);
        b3 = look_far(o, line1, hn::Add(i2, one));
      } else {
        for (int i = 0; i < kWindow; i += N) hn::Store(hn::Load(df, window1_ + i), df, window0_ + i);
        if (k == 1) {
          load_lines();
        } else {
          load_window(o, k + 1, b, window1_);
        }
      }
    }
  }
  static constexpr int kLaneBits = std::countr_zero(N);
  // Lowest level whose blocks are skipped; below it, stepping line by line is as fast.
  static constexpr int kLeastLevel = 3;

  // Rays that hit for certain, and those that floats do not decide.
  template <bool triangles>
  HWY_INLINE void put_hits(const Octant<Sample>& o, std::int32_t k, std::int32_t b, const FanLine& at, float low_y,
                           float high_y, const FanPlaces& p, const FanStep& e, MF candidates, MF refused, VI j) {
    // Away from the sides, which rounding may place elsewhere: a ray along one may cross it much earlier or later.
    const VF low_side = hn::Set(df, low_y + at.aside), high_side = hn::Set(df, high_y - at.aside);
    const FanCrossing f = triangles ? triangle_crossing(e) : bilinear_crossing(e);
    const MF first = f.first;
    const VF ends = hn::Add(p.node, hn::IfThenElse(first, hn::Min(p.q, hn::Set(df, 1)), p.q));
    const MF within = hn::And(hn::Ge(p.y, low_side), hn::Le(ends, high_side));
    MF sure = hn::And(hn::AndNot(refused, candidates), hn::And(within, hn::And(hn::Gt(e.c0, e.margin), f.sure)));
    if (at.length < 0x1p-12f || (triangles && at.length < 1)) sure = hn::AndNot(sure, sure);
    // The hit, or where its piece begins.
    const VF share = sights_ ? hn::IfThenElse(first, hn::Zero(df), e.u) : f.share;
    const VF T = hn::MulAdd(share, hn::Set(df, at.length), hn::Set(df, at.T0));
    // Doubtful ones are clear up to T, stored as -1 - T. Beside the border the march must trace the whole ray, which
    // may cross it slowly.
    const MF beside = hn::Or(hn::Lt(p.y, low_side), hn::Gt(p.y, high_side));
    const VF until = hn::Set(df, grid_.has_holes ? -kNoTime : -1 - at.T0);
    const VF doubtful = hn::IfThenElse(hn::Or(refused, beside), hn::Set(df, -kNoTime), until);
    const VI cell =
        hn::Add(hn::ConvertTo(di, p.node), hn::IfThenElseZero(hn::RebindMask(di, hn::Not(first)), hn::Set(di, 1)));
    const VI number = hn::Add(cell, hn::Set(di, o.node0 + b));
    const VI mirrored = o.wraps ? in_copy(number, o.minor_cells) : number;
    const VI minor = o.back_minor ? hn::Sub(hn::Set(di, o.minor_cells - 1), mirrored) : mirrored;
    const std::int32_t line = o.field_line(k), major = o.back_major ? o.major_cells - 1 - line : line;
    const VI packed = o.turned
                          ? hn::Or(hn::Set(di, static_cast<std::int32_t>(static_cast<unsigned>(major) << 16)), minor)
                          : hn::Or(hn::ShiftLeft<16>(minor), hn::Set(di, major));
    alignas(64) float times[N];
    alignas(64) std::int32_t cells[N], rows[N];
    hn::Store(hn::IfThenElse(sure, T, doubtful), df, times);
    hn::Store(packed, di, cells), hn::Store(j, di, rows);
    for (std::uint64_t bits = bits_of(candidates); bits != 0; bits &= bits - 1) {
      const auto l = static_cast<std::size_t>(std::countr_zero(bits));
      const std::size_t to = slot(static_cast<std::size_t>(rows[l]), l);
      T_[to] = times[l], cell_[to] = cells[l];
      if (grid_.has_holes && times[l] >= 0 && beside_hole(cells[l] & 0xffff, cells[l] >> 16 & 0xffff))
        T_[to] = -kNoTime;
    }
  }
  bool beside_hole(int col, int row) const {
    return max_mip::any_cell_beside(field_, {col, row},
                                    [&](const Cell& cell) { return grid_.is_hole(cell.col, cell.row); });
  }
  std::size_t slot(std::size_t j, std::size_t lane) const {
    const std::size_t at = j * N + lane;
    return rows_ ? static_cast<std::size_t>(rows_[at]) * N + lane : at;
  }

  // Ends lanes whose rays have left the field or are above all ground; later rays that inherit this also miss. `until`
  // below infinity: all these rays are above the ground up to there.
  HWY_NOINLINE void end_lanes(MF ends, VI j, VF m_ok, VF s_ok, WedgeRelief<Sample>& relief, std::int32_t k,
                              const StripLanes& lanes, float until = kNoTime) {
    alignas(64) std::int32_t rows[N];
    alignas(64) float m[N], s[N];
    hn::Store(j, di, rows), hn::Store(m_ok, df, m), hn::Store(s_ok, df, s);
    for (std::uint64_t bits = bits_of(ends); bits != 0; bits &= bits - 1) {
      const auto l = static_cast<std::size_t>(std::countr_zero(bits));
      const bool misses = until == kNoTime;
      if (misses && lanes.broken[l] <= rows[l]) continue;
      if (!misses) T_[slot(static_cast<std::size_t>(rows[l]), l)] = until;
      const float steepest = relief.up_to(k);
      for (std::int32_t i = rows[l] + 1; i < lanes.count[l]; ++i) {
        const std::size_t at = static_cast<std::size_t>(i) * N + l;
        if (inherits(m[l], s[l], m_[at], s_[at], steepest)) {
          m[l] = m_[at], s[l] = s_[at];
          if (!misses) T_[slot(static_cast<std::size_t>(i), l)] = until;
        } else {
          T_[slot(static_cast<std::size_t>(i), l)] = -kNoTime;
        }
      }
    }
  }

  // Answers of the strip, and the rays that are left.
  HWY_NOINLINE void answer() {
    const bool direct = width_ == static_cast<int>(N) && rays_.dx != copies_.data();
    const bool limited = fan_.t_min != 0 || fan_.t_max < std::numeric_limits<double>::infinity();
    for (int i = 0; i < fan_.rows; ++i) {
      const RowRays r = row(i);
      const VF zero = hn::Zero(df), one = hn::Set(df, 1), never = hn::Set(df, kNoTime);
      VF T = hn::LoadU(df, T_.data() + static_cast<std::size_t>(i) * N);
      if (limited) T = limit(fan_, T, r.per_major);
      const VI cell = hn::LoadU(di, cell_.data() + static_cast<std::size_t>(i) * N);
      const MF hit = hn::And(hn::Lt(T, never), hn::Ge(T, zero));
      const MI hits = hn::RebindMask(di, hit);
      const VF t = hn::IfThenElse(hit, hn::Mul(T, r.per_major), never);
      const VI col = hn::And(cell, hn::Set(di, 0xffff)), row_ = hn::And(hn::ShiftRight<16>(cell), hn::Set(di, 0xffff));
      const VF gx = hn::Mul(hn::LoadU(df, rays_.dx + i * rays_.stride), hn::Set(df, scales_.per_x));
      const VF gy = hn::Mul(hn::LoadU(df, rays_.dy + i * rays_.stride), hn::Set(df, scales_.per_y));
      const auto within = [&](VF g, float in_cell, VI number, std::int32_t origin, int cells) HWY_ATTR {
        VF way = hn::ConvertTo(df, hn::Sub(number, hn::Set(di, origin)));
        if (octants_[0].wraps) {
          // Distance to the copy of the field that contains the hit.
          const VF all = hn::Set(df, static_cast<float>(cells));
          const VF off = hn::Sub(hn::MulAdd(g, t, hn::Set(df, in_cell - 0.5f)), way);
          way = hn::MulAdd(hn::Round(hn::Div(off, all)), all, way);
        }
        const VF at = hn::MulAdd(g, t, hn::Sub(hn::Set(df, in_cell), way));
        return hn::IfThenElseZero(hit, hn::Min(hn::Max(at, zero), one));
      };
      const VF u = within(gx, in_cell_x_, col, origin_cell_.col, grid_.cell_cols);
      const VF v = within(gy, in_cell_y_, row_, origin_cell_.row, grid_.cell_rows);
      const VI none = hn::Set(di, -1);
      const std::ptrdiff_t to = begin_ + i * step_;
      put(t, hits_.t + to, direct, width_), put(u, hits_.u + to, direct, width_), put(v, hits_.v + to, direct, width_);
      put(hn::IfThenElse(hits, col, none), hits_.col + to, direct, width_);
      put(hn::IfThenElse(hits, row_, none), hits_.row + to, direct, width_);
      const std::uint64_t some = (std::uint64_t{1} << width_) - 1;
      if (hits_.status) {
        const std::uint64_t bits = bits_of(hit);
        for (int l = 0; l < width_; ++l) hits_.status[to + l] = bits >> l & 1 ? HitStatus::hit : HitStatus::miss;
      }
      std::uint64_t rest = bits_of(hn::Lt(T, zero)) & some;
      if (rest == 0) continue;
      alignas(64) float times[N], per_major[N];
      hn::Store(T, df, times), hn::Store(r.per_major, df, per_major);
      for (; rest != 0; rest &= rest - 1) {
        const int l = std::countr_zero(rest);
        const double until = -1 - static_cast<double>(times[l]), clear = until - 0x1p-20 * (until + 1);
        rest_.push_back({to + l, std::isfinite(until) && clear > 0 ? clear * static_cast<double>(per_major[l])
                                                                   : max_mip::kNotClear});
      }
    }
  }
  // Sights of the strip. Times are rounded down by more than the rounding of T, m and the distances computed in double.
  HWY_NOINLINE void answer_sights() {
    const VF zero = hn::Zero(df), one = hn::Set(df, 1), never = hn::Set(df, kNoTime), unknown = hn::Set(df, -kNoTime);
    alignas(64) float clear[N];
    alignas(64) std::int32_t cells[N];
    for (int i = 0; i < fan_.rows; ++i) {
      const VF T = hn::LoadU(df, T_.data() + static_cast<std::size_t>(i) * N);
      const MF hit = hn::Ge(T, zero), open = hn::And(hn::Lt(T, zero), hn::Gt(T, unknown));
      const VF until = hn::IfThenElse(open, hn::Sub(hn::Neg(one), T), T);
      const VF before = hn::NegMulAdd(hn::Add(until, one), hn::Set(df, 0x1p-20f), until);
      const VF seen = hn::IfThenElse(hn::Lt(T, never), hn::Max(before, zero), never);
      const VF doubtful = hn::IfThenElse(hn::And(open, hn::Gt(before, zero)), hn::Neg(before), unknown);
      hn::Store(hn::IfThenElse(hit, seen, doubtful), df, clear);
      hn::Store(hn::LoadU(di, cell_.data() + static_cast<std::size_t>(i) * N), di, cells);
      FanSight* to = sights_ + begin_ + i * step_;
      for (int l = 0; l < width_; ++l) to[l] = {clear[l], static_cast<std::uint32_t>(cells[l])};
    }
  }

  const HeightField& field_;
  const MaxPyramid& pyramid_;
  const SampleGrid<Sample> grid_;
  const Fan& fan_;
  const FanHits hits_;
  FanSight* sights_;  // null: hits
  const FanOptions& options_;
  std::vector<max_mip::FanRest>& rest_;
  FanStats& stats_;
  dvec3 origin_;
  Octant<Sample> octants_[8];
  FanPlanes planes_;
  RayScales scales_;
  FanHeights heights_;
  bool triangles_;
  float doubt_, rounding_, cell_relief_;
  Cell origin_cell_;
  float in_cell_x_, in_cell_y_;

  StripRays rays_;
  std::ptrdiff_t begin_ = 0, step_ = 0;  // of the strip's answers
  int width_ = 0;
  const std::int32_t* rows_ = nullptr;  // rows of the entries of the tables; null: the same
  alignas(64) float window0_[kWindow], window1_[kWindow];
  KeptVector<float> m_, s_, T_, copies_;
  KeptVector<std::int32_t> cell_, row_of_;
};

void walk(const HeightTarget& target, const Fan& fan, const FanHits& hits, int begin, int end,
          const FanOptions& options, std::vector<max_mip::FanRest>& rest, FanStats& stats) {
  target.field->visit([&](const auto& grid) {
    using Sample = std::remove_cvref_t<decltype(grid.data[0])>;
    FanWalk<Sample>(target, grid, fan, hits, nullptr, options, rest, stats).run(begin, end);
  });
}
void look(const HeightTarget& target, const Fan& fan, FanSight* sights, int begin, int end, const FanOptions& options,
          FanStats& stats) {
  std::vector<max_mip::FanRest> none;
  target.field->visit([&](const auto& grid) {
    using Sample = std::remove_cvref_t<decltype(grid.data[0])>;
    FanWalk<Sample>(target, grid, fan, {}, sights, options, none, stats).run(begin, end);
  });
}

double share(const HeightTarget& target, const Fan& fan) {
  std::vector<max_mip::FanRest> none;
  FanStats stats;
  return target.field->visit([&](const auto& grid) {
    using Sample = std::remove_cvref_t<decltype(grid.data[0])>;
    return FanWalk<Sample>(target, grid, fan, {}, nullptr, {}, none, stats).share_to_walk();
  });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace scarp {
namespace {

HWY_EXPORT(walk);
HWY_EXPORT(look);
HWY_EXPORT(share);

}  // namespace

void max_mip::walk_fan(const HeightTarget& target, const Fan& fan, const FanHits& hits, int begin, int end,
                       const FanOptions& options, std::vector<FanRest>& rest, FanStats& stats) {
  HWY_DYNAMIC_DISPATCH(walk)(target, fan, hits, begin, end, options, rest, stats);
}

double max_mip::share_to_walk(const HeightTarget& target, const Fan& fan) {
  return HWY_DYNAMIC_DISPATCH(share)(target, fan);
}

void max_mip::look_fan(const HeightTarget& target, const Fan& fan, FanSight* sights, int begin, int end,
                       const FanOptions& options, FanStats& stats) {
  HWY_DYNAMIC_DISPATCH(look)(target, fan, sights, begin, end, options, stats);
}

}  // namespace scarp
#endif
