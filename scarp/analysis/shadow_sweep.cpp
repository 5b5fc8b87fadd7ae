// SPDX-License-Identifier: MIT
#include "scarp/analysis/shadow_sweep.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <mutex>

#include "scarp/analysis/ring_sweep.h"
#include "scarp/analysis/sight_rays.h"
#include "scarp/analysis/sun_edges.h"
#include "scarp/base/parallel.h"
#include "scarp/base/progress_part.h"

namespace scarp {
namespace {

// Strips along the rays that are swept separately.
constexpr std::int64_t kStrips = 16;
constexpr double kUnit = static_cast<double>(SunRay::kUnit);

// Rings across the direction of the sun; u in 1/kUnit sides.
template <class T>
class ShadowStrip : public RingSweep<ShadowStrip<T>, T> {
  using Base = RingSweep<ShadowStrip<T>, T>;
  using Base::frame_, Base::grid_, Base::high_, Base::horizon_, Base::lone_, Base::low_, Base::now_, Base::previous_,
      Base::ring_, Base::statistics_, Base::kStrip;

 public:
  static constexpr bool kTestsAll = false;

  // Nodes with low <= u < high.
  ShadowStrip(const SightGround& ground, const SampleGrid<T>& grid, const SunRay& ray, const SweptSun& sun,
              const BlockMaxima& maxima, double low, double high, Shade* codes)
      : Base(grid, sun.frame, edges_, low, high, 0),
        ground_(ground),
        ray_(ray),
        sun_(sun),
        maxima_(maxima),
        codes_(codes),
        edges_(ground, sun),
        across_(static_cast<double>(sun.across)),
        rise_(sun.rise / kUnit) {}

  const SunEdges& edges() const { return edges_; }

  double height(T sample, Node) const { return ground_.field().height_from_sample(static_cast<double>(sample)); }
  void begin_ring(int ring) {
    x_ = frame_.x(ring);
    u_of_ring_ = x_ * across_;
    s_of_ring_ = x_ * rise_;
  }
  bool is_beyond(int) const { return false; }
  SideRange sides_of(int ring) const {
    const double start = frame_.x(ring) * across_;
    const double low = std::ceil((low_ - start) / kUnit) - 1, high = std::floor((high_ - start) / kUnit) + 1;
    const double sides = frame_.sides();
    return {static_cast<int>(std::clamp(low, 0.0, sides)), static_cast<int>(std::clamp(high, -1.0, sides - 1)) + 1};
  }
  double u(int side) const { return side * kUnit + u_of_ring_; }
  double s(double height) const { return height + s_of_ring_; }
  double s_previous(double height) const { return height + (s_of_ring_ - rise_); }
  double s_error(double s) const { return kSweepRounding * (std::abs(s) + s_of_ring_); }
  int about_side(double u) const { return static_cast<int>((u - u_of_ring_) / kUnit); }
  double sides_per_u() const { return 1 / kUnit; }
  bool has_previous() const { return x_ > 1; }
  // Known from the previous ring's edge on the spoke's side, which is also in the part.
  bool is_inner_known(int side) const { return across_ > 0 ? side + 1 < frame_.sides() : side > 0; }
  bool spoke_is_right(int) const { return across_ < 0; }

  RingLine ring_line(const HorizonLine& line, double error) const {
    if (!line.is_ground()) return {kNoGround, 0, 0};
    const double to_ring = u_of_ring_ - line.u0;  // exact
    const double terms = std::abs(line.s0) + s_of_ring_ + std::abs(line.slope) * (std::abs(to_ring) + 2 * kUnit);
    return {line.s0 + line.slope * to_ring - s_of_ring_, line.slope * kUnit, 4 * (error + kSweepRounding * terms)};
  }
  double height_of_slack(double slack) const { return 2 * slack; }

  // From the sample (ring, side) to the next one. Positions are exact.
  HorizonLine ring_edge(int side) const {
    const double a = now_[side], b = now_[side + 1];
    HorizonLine line;
    line.u0 = u(side);
    line.s0 = s(a);
    line.slope = (b - a) / kUnit;
    line.error = kSweepRounding * (std::abs(a) + std::abs(b) + s_of_ring_);
    line.from = {ring_, side};
    line.to = {ring_, side + 1};
    return line;
  }
  // From the sample (ring, side) to the previous ring.
  bool fill_spoke(int side, HorizonSegment& segment) const {
    if (across_ == 0) return false;
    const double outer = now_[side], inner = previous_[side];
    HorizonLine& line = segment.line;
    line.u0 = u(side);
    line.s0 = s(outer);
    line.slope = (outer - inner + rise_) / across_;
    line.error = kSweepRounding * (std::abs(outer) + std::abs(inner) + s_of_ring_);
    line.from = {ring_, side};
    line.to = {ring_ - frame_.sign(), side};
    const bool right = spoke_is_right(side);
    segment.begin = right ? line.u0 : line.u0 - across_;
    segment.end = right ? line.u0 - across_ : line.u0;
    segment.first = right ? line.from : line.to;
    segment.last = right ? line.to : line.from;
    return true;
  }
  void find_more_spokes(const SideRange&) {}

  bool may_skip(int first) const { return frame_.x(first) > 1; }
  bool is_below(const HorizonBins& bins, int first, int last, int block) const {
    const Node at = frame_.node(first / kStrip, block);
    const double near = frame_.x(first) - 1, far = frame_.x(last);
    const double maximum = maxima_.maximum(at.col, at.row), s = maximum + far * rise_;
    const double left = (block * kStrip - 1) * kUnit + std::min(near * across_, far * across_);
    const double right = (block + 1) * kStrip * kUnit + std::max(near * across_, far * across_);
    return s + kSweepRounding * (std::abs(maximum) + far * rise_) < bins.minimum(left, right);
  }

  void is_above(int side) {
    if (!is_target(side)) return;
    if (!lone_.empty()) return test(horizon_.find(u(side)), side);
    Shade& code = code_of(side);
    if (code == Shade::cast_shadow) code = Shade::lit;
  }
  void test(std::size_t i, int side) {
    if (!is_target(side)) return;
    Shade& code = code_of(side);
    if (code != Shade::cast_shadow) return;
    const HorizonSample sample{ring_, side};
    const double at = u(side), level = s(now_[side]);
    const HorizonEnvelope::Answer answer = horizon_.test(i, at, level, s_error(level), sample);
    if (answer == HorizonEnvelope::Answer::blocked) return;
    if (answer == HorizonEnvelope::Answer::unsure) {
      ++statistics_.walked;
      if (shade(ground_, ray_, frame_.node(sample)) != Shade::lit) return;
    } else if (const auto lone = lone_.find(at); lone != lone_.end() && edges_.sample_above(lone->second, sample)) {
      return;
    }
    code = Shade::lit;
  }
  void test_all(std::size_t, int) {}

 private:
  bool is_target(int side) const {
    const double at = u(side);
    return at >= low_ && at < high_;
  }
  Shade& code_of(int side) {
    const Node node = frame_.node(ring_, side);
    return codes_[static_cast<std::ptrdiff_t>(node.row) * grid_.cols + node.col];
  }

  const SightGround& ground_;
  const SunRay& ray_;
  const SweptSun& sun_;
  const BlockMaxima& maxima_;
  Shade* codes_;
  SunEdges edges_;
  double across_, rise_;  // change per ring towards the sun
  double x_ = 0, u_of_ring_ = 0, s_of_ring_ = 0;
};

// Writes hole, self_shaded or, for all others, cast_shadow. The first line that a ray crosses is the next ring.
template <class T>
void mark_self_shaded(const SampleGrid<T>& grid, const HeightField& field, const SunRay& ray, Shade* codes,
                      const Progress& progress) {
  const bool along_cols = std::abs(ray.col) >= std::abs(ray.row);
  const int towards = (along_cols ? ray.col : ray.row) > 0 ? 1 : -1;
  const std::int64_t across = along_cols ? ray.row : ray.col;
  const std::int64_t whole = across >= 0 ? across / SunRay::kUnit : -((-across + SunRay::kUnit - 1) / SunRay::kUnit);
  const std::int64_t part = across - whole * SunRay::kUnit;
  CrossingTerms terms{};
  terms.w0 = static_cast<double>(SunRay::kUnit - part);
  terms.w1 = static_cast<double>(part);
  terms.v0 = kUnit;
  terms.r = ray.rise;
  terms.v1 = 1;
  const int step = static_cast<int>(whole), more = part > 0 ? 1 : 0;
  const int first_col = along_cols ? towards : step, first_row = along_cols ? step : towards;
  const int second_col = along_cols ? 0 : more, second_row = along_cols ? more : 0;
  const auto inside = [](int i, int count) { return i >= 0 && i < count; };
  const auto height = [&](T sample) { return field.height_from_sample(static_cast<double>(sample)); };
  parallel_for(
      grid.rows, 16,
      [&](std::int64_t begin, std::int64_t end) {
        for (int row = static_cast<int>(begin); row < end; ++row) {
          Shade* out = codes + static_cast<std::ptrdiff_t>(row) * grid.cols;
          const int r0 = row + first_row, r1 = r0 + second_row;
          const bool rows_inside = inside(r0, grid.rows) && inside(r1, grid.rows);
          const T *here = grid.row(row), *first = rows_inside ? grid.row(r0) : here,
                  *second = rows_inside ? grid.row(r1) : here;
          CrossingTerms at = terms;
          for (int col = 0; col < grid.cols; ++col) {
            out[col] = Shade::cast_shadow;
            if (grid.is_nodata(here[col])) {
              out[col] = Shade::hole;
              continue;
            }
            const int c0 = col + first_col, c1 = c0 + second_col;
            if (!rows_inside || !inside(c0, grid.cols) || !inside(c1, grid.cols)) continue;
            if (grid.is_nodata(first[c0]) || grid.is_nodata(second[c1])) continue;
            at.g0 = height(first[c0]);
            at.g1 = height(second[c1]);
            at.e = height(here[col]);
            if (sign_of(at) > 0) out[col] = Shade::self_shaded;
          }
        }
      },
      progress);
}

}  // namespace

SweepStatistics sweep_shadow(const SightGround& ground, const SunRay& ray, Shade* codes, const Progress& progress) {
  const HeightField& field = ground.field();
  const BlockMaxima maxima(field);
  const SweptSun sun(field, ray);
  SweepStatistics all;
  std::mutex mutex;
  field.visit([&]<class T>(const SampleGrid<T>& grid) {
    mark_self_shaded(grid, field, ray, codes, progress_part(progress, 0, 2));
    // All u of the field.
    const std::int64_t rings = sun.frame.rings(), last_side = (sun.frame.sides() - 1) * SunRay::kUnit;
    const std::int64_t low = std::min(sun.across, rings * sun.across);
    const std::int64_t high = last_side + std::max(sun.across, rings * sun.across) + 1;
    parallel_for(
        kStrips, 1,
        [&](std::int64_t begin, std::int64_t end) {
          for (std::int64_t i = begin; i < end; ++i) {
            const std::int64_t width = (high - low) / kStrips + 1;
            ShadowStrip<T> strip(ground, grid, ray, sun, maxima, static_cast<double>(low + i * width),
                                 static_cast<double>(low + (i + 1) * width), codes);
            const SweepStatistics counts = strip.run();
            const std::lock_guard lock(mutex);
            all.add(counts);
          }
        },
        progress_part(progress, 1, 2));
  });
  return all;
}

}  // namespace scarp
