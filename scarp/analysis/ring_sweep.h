// SPDX-License-Identifier: MIT
// Sweeps over rings of samples, outwards from an observer or from the sun, with a rising horizon: shared by viewsheds
// (viewshed_sector.cpp) and shadows (shadow_sweep.cpp). They differ in the projection of samples to (u, s).
//
//      previous ring    Q ----- o ----- o       s = f(height, ring), u = g(side, ring), both linear along an edge
//                       |       |       |
//      this ring        P ----- o ----- o       P-Q: a spoke; P-o: an edge of the ring
//
// Ring by ring: test the samples against the horizon, then merge the spokes to the previous ring, then the edges of the
// ring. Most samples need only one comparison of heights: samples below the horizon by more than the rounding change
// nothing; edges between two samples above it replace the horizon there.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <map>
#include <vector>

#include "scarp/analysis/block_maxima.h"
#include "scarp/analysis/horizon_bins.h"
#include "scarp/analysis/horizon_envelope.h"
#include "scarp/analysis/ring_frame.h"
#include "scarp/analysis/sweep_statistics.h"
#include "scarp/base/prefetch.h"
#include "scarp/field/sample_grid.h"

namespace scarp {

inline constexpr double kNoGround = -std::numeric_limits<double>::infinity();  ///< height of a hole
/// Bound of the rounding of s on a line at u, relative to its terms: at most eight operations, each off by half a unit.
inline constexpr double kSweepRounding = 8 * std::numeric_limits<double>::epsilon();

/// Sides [begin, end).
struct SideRange {
  int begin, end;
};

/// Heights of a ring on a line of the horizon: level + slope * y, off by at most margin.
struct RingLine {
  double level, slope, margin;
};

/// `Projection` derives from it and has
///   height(sample value, node)      height that the sweep uses, in metres
///   begin_ring(ring)                selects the ring for all following calls
///   is_beyond(ring)                 whether no node from this ring on matters
///   sides_of(ring)                  samples of the part, and one more on each side
///   u(side), s(height), s_previous(height), s_error(s)
///   height_of_slack(slack)          a bound of HorizonEnvelope's slack, in heights of the ring
///   about_side(u)                   the first side at or after u, to within one or two
///   sides_per_u()                   along a ring
///   ring_line(line, error)          a line of the horizon, in heights of the ring
///   ring_edge(side)                 the edge from a sample to the next one
///   fill_spoke(side, segment)       the edge to the previous ring; returns whether there is one
///   spoke_is_right(side)            whether the spoke runs from the outer sample to larger u
///   has_previous()                  whether there is a ring before this one
///   is_inner_known(side)            whether the horizon is not below the spoke's inner end, if the field has no holes
///   find_more_spokes(range)         more samples whose spoke may be above the horizon
///   may_skip(ring), is_below(bins, first ring, last ring, block)
///                                   whether all samples and edges of a block are below the horizon
///   is_above(side)                  called for each sample that is certainly above the horizon,
///   test(piece, side)               and for each that may be;
///   test_all(piece, side)           instead of both, for each sample, if kTestsAll
///   edges()                         exact comparisons
template <class Projection, class T>
class RingSweep {
 public:
  SweepStatistics run() {
    int ring = frame_.ring(1);
    while (ring >= 0 && ring < frame_.rings() && !self().is_beyond(ring)) {
      // To the end of the block of kStrip rings.
      const int block = ring / kStrip * kStrip;
      const int last = frame_.sign() > 0 ? std::min(block + kStrip, frame_.rings()) - 1 : block;
      sweep_strip(ring, last);
      ring = last + frame_.sign();
    }
    return statistics_;
  }

 protected:
  static constexpr int kLine = 64 / sizeof(double);  // doubles per cache line
  static constexpr int kStrip = BlockMaxima::kSide;  // rings loaded together: a line of the cache if they are columns

  /// [low, high]: the part of the horizon that matters. `target_raise`: height of targets above samples.
  RingSweep(const SampleGrid<T>& grid, const RingFrame& frame, const HorizonEdges& edges, double low, double high,
            double target_raise)
      : grid_(grid),
        frame_(frame),
        low_(low),
        high_(high),
        target_raise_(target_raise),
        horizon_(edges),
        bins_(low, high),
        stride_(((frame.sides() + kLine - 1) / kLine | 1) * kLine),
        heights_(static_cast<std::size_t>(kStrip + 1) * static_cast<std::size_t>(stride_)),
        clear_(static_cast<std::size_t>(frame.sides())) {}

  const SampleGrid<T>& grid_;
  RingFrame frame_;
  double low_, high_, target_raise_;
  HorizonEnvelope horizon_;
  SweepStatistics statistics_;
  std::vector<int> uncertain_;            // samples whose spoke may be above the horizon, in no order
  std::map<double, HorizonSample> lone_;  // by u: the highest sample at that u at which no edge of a ring ends

  int ring_ = 0;  // the current ring
  SideRange range_{};
  const double* now_ = nullptr;       // heights of the ring
  const double* previous_ = nullptr;  // heights of the previous ring

 private:
  Projection& self() { return static_cast<Projection&>(*this); }
  const Projection& self() const { return static_cast<const Projection&>(*this); }
  double* ring_heights(int slot) { return heights_.data() + slot * stride_; }

  void sweep_strip(int first, int last) {
    const int before = first - frame_.sign(), count = std::abs(last - first) + 1;
    find_active(first, last);
    if (active_.empty()) {
      for (int ring = first;; ring += frame_.sign()) {
        const SideRange range = self().sides_of(ring);
        const std::int64_t samples = std::max(range.end - range.begin, 0);
        statistics_.samples += samples;
        statistics_.skipped += samples;
        if (ring == last) return;
      }
    }
    for (const SideRange& active : active_) load(active, before, count);
    for (int slot = 1; slot <= count; ++slot) {
      previous_ = ring_heights(slot - 1);
      now_ = ring_heights(slot);
      sweep_ring(before + slot * frame_.sign());
    }
  }

  // Finds the blocks that may rise above the horizon. Neither samples nor edges of all others do.
  void find_active(int first, int last) {
    const SideRange a = self().sides_of(first), b = self().sides_of(last);
    const SideRange range{std::min(a.begin, b.begin), std::max(a.end, b.end)};
    active_.clear();
    if (range.begin >= range.end) return;
    const bool may_skip = self().may_skip(first);
    if (may_skip) bins_.update(horizon_);
    for (int block = range.begin / kStrip; block * kStrip < range.end; ++block) {
      if (may_skip && self().is_below(bins_, first, last, block)) continue;
      // Edges to the next block's first sample belong to both.
      const SideRange active{std::max(block * kStrip - 1, range.begin), std::min((block + 1) * kStrip + 1, range.end)};
      if (!active_.empty() && active_.back().end >= active.begin) {
        active_.back().end = active.end;
      } else {
        active_.push_back(active);
      }
    }
  }

  double height(int ring, int side) const {
    const Node node = frame_.node(ring, side);
    const T sample = grid_.at(node.col, node.row);
    return grid_.is_nodata(sample) ? kNoGround : self().height(sample, node);
  }
  // Loads samples of the strip, with one more on each side to detect an edge beyond the last.
  void load(const SideRange& range, int before, int count) {
    const int begin = std::max(range.begin - 1, 0), end = std::min(range.end + 1, frame_.sides());
    const int first_slot = before >= 0 && before < frame_.rings() ? 0 : 1;
    if (frame_.along_cols()) {
      // Rows of the field lie across the rings.
      constexpr int kAhead = 8;  // rows that are fetched before they are needed
      const int lowest = std::max(std::min(before, before + count * frame_.sign()), 0);
      for (int side = begin; side < end; ++side) {
        if (side + kAhead < end) prefetch(grid_.row(side + kAhead) + lowest);
        for (int slot = first_slot; slot <= count; ++slot) {
          ring_heights(slot)[side] = height(before + slot * frame_.sign(), side);
        }
      }
    } else {
      for (int slot = first_slot; slot <= count; ++slot) {
        double* heights = ring_heights(slot);
        const int ring = before + slot * frame_.sign();
        for (int side = begin; side < end; ++side) heights[side] = height(ring, side);
      }
    }
  }

  void sweep_ring(int ring) {
    ring_ = ring;
    self().begin_ring(ring);
    range_ = self().sides_of(ring);
    if (range_.begin >= range_.end) return;
    risen_.clear();
    last_above_ = -2;
    std::int64_t tested = 0;
    for (const SideRange& active : active_) {
      const SideRange here{std::max(active.begin, range_.begin), std::min(active.end, range_.end)};
      if (here.begin >= here.end) continue;
      test_samples(here);
      find_uncertain_spokes(here);
      tested += here.end - here.begin;
    }
    statistics_.samples += range_.end - range_.begin;
    statistics_.skipped += range_.end - range_.begin - tested;
    merge_risen();
  }

  // Tests the samples against the horizon and notes those that may rise above it.
  void test_samples(const SideRange& range) {
    int side = range.begin;
    double at = self().u(side);
    const double last = self().u(range.end - 1);
    std::size_t i = horizon_.find(at);
    joined_ = false;
    for (;;) {
      // Samples before the next vertex.
      const double next = horizon_.pieces()[i + 1].begin;
      const bool on_vertex = at == horizon_.pieces()[i].begin;
      int end = range.end;
      if (next <= last) {
        end = std::clamp(self().about_side(next), side + 1, range.end - 1);
        at = self().u(end);
        while (end > side + 1 && self().u(end - 1) >= next) at = self().u(--end);
        while (at < next) at = self().u(++end);
      }
      test_under(i, side, end, on_vertex);
      side = end;
      if (side == range.end) return;
      const std::size_t j = horizon_.find(at, i);
      pass_vertices(i, j, side);
      i = j;
    }
  }

  // Compares samples with one piece of the horizon.
  // `on_vertex`: the first sample is where the piece starts, so the previous piece also counts there.
  void test_under(std::size_t i, int begin, int end, bool on_vertex) {
    const HorizonEnvelope::Piece& piece = horizon_.pieces()[i];
    const RingLine line = self().ring_line(piece.line, piece.error);
    const double low = line.level - line.margin;
    const double high = line.level + line.margin + self().height_of_slack(piece.slack);
    const double low_target = low - target_raise_ - kSweepRounding * target_raise_;
    const int y = frame_.y(0);
    for (int side = begin; side < end; ++side) {
      if constexpr (Projection::kTestsAll) self().test_all(i, side);
      const double over = now_[side] - line.slope * (y + side);
      if (over < low_target) {
        joined_ = true;
        on_vertex = false;
        continue;
      }
      ++statistics_.careful;
      if (over > high && (!on_vertex || clears_before(i, side))) {
        if (last_above_ == side - 1) clear_[static_cast<std::size_t>(side - 1)] = joined_;
        clear_[static_cast<std::size_t>(side)] = false;
        last_above_ = side;
        if constexpr (!Projection::kTestsAll) self().is_above(side);
        note(side);
      } else {
        if constexpr (!Projection::kTestsAll) self().test(i, side);
        if (over >= low) {
          clear_[static_cast<std::size_t>(side)] = false;
          note(side);
        }
      }
      joined_ = true;
      on_vertex = false;
    }
  }
  bool clears_before(std::size_t i, int side) const {
    const HorizonEnvelope::Piece& before = horizon_.pieces()[i - 1];
    const double s = self().s(now_[side]);
    return s - self().s_error(s) > before.line.at(self().u(side)) + before.error + before.slack;
  }

  void note(int side) {
    if (risen_.empty() || risen_.back() < side) risen_.push_back(side);
  }

  // Between the samples side - 1 and side lie the beginnings of the pieces i + 1 .. j. Where both samples are below the
  // horizon, the ground between them may still rise above such a vertex; where both are above, their edge may be below.
  void pass_vertices(std::size_t i, std::size_t j, int side) {
    const double left = self().s(now_[side - 1]), right = self().s(now_[side]);
    joined_ = last_above_ == side - 1;
    if (joined_ && right > kNoGround) {
      const double u0 = self().u(side - 1), slope = (right - left) * self().sides_per_u();
      const double error =
          self().s_error(left) + self().s_error(right) + kSweepRounding * (std::abs(right - left) + std::abs(slope));
      for (std::size_t v = i + 1; v <= j && joined_; ++v) {
        const auto &before = horizon_.pieces()[v - 1], &after = horizon_.pieces()[v];
        const double at = left + slope * (after.begin - u0) - error;
        joined_ = at > before.line.at(after.begin) + before.error + before.slack &&
                  at > after.line.at(after.begin) + after.error + after.slack;
      }
      // The edge from the previous sample is merged in any case; the spoke of this sample may also rise.
      note_unclear(side);
      return;
    }
    joined_ = false;
    double top = std::max(left, right);
    if (self().has_previous()) {
      top = std::max(top, std::max(self().s_previous(previous_[side - 1]), self().s_previous(previous_[side])));
    }
    top += self().s_error(top);
    for (std::size_t v = i + 1; v <= j; ++v) {
      const auto &before = horizon_.pieces()[v - 1], &after = horizon_.pieces()[v];
      const double at = std::min(before.line.at(after.begin) - before.error, after.line.at(after.begin) - after.error);
      if (!(top < at)) {
        note_unclear(side - 1);
        note_unclear(side);
        return;
      }
    }
  }
  void note_unclear(int side) {
    if (risen_.empty() || risen_.back() < side) {
      clear_[static_cast<std::size_t>(side)] = false;
      risen_.push_back(side);
    }
  }

  bool stands_alone(const double* heights, int side) const {
    return heights[side] != kNoGround && (side == 0 || heights[side - 1] == kNoGround) &&
           (side + 1 == frame_.sides() || heights[side + 1] == kNoGround);
  }
  // Spokes whose outer end is below the horizon are below it, unless their inner end may be above it: because an edge
  // of the previous ring is missing there on the spoke's side, or because of the projection.
  void find_uncertain_spokes(const SideRange& range) {
    if (grid_.has_holes || frame_.sides() == 1) {
      for (int side = range.begin; side < range.end; ++side) {
        if (stands_alone(now_, side)) add_lone(side);
        if (!self().has_previous() || previous_[side] == kNoGround) continue;
        const int inwards = self().spoke_is_right(side) ? side - 1 : side + 1;
        if (inwards < 0 || inwards >= frame_.sides() || previous_[inwards] == kNoGround) uncertain_.push_back(side);
      }
    }
    if (self().has_previous()) self().find_more_spokes(range);
  }
  // A sample at which no edge along the ring ends blocks only lines of sight through itself.
  void add_lone(int side) {
    const HorizonSample sample{ring_, side};
    const auto [place, is_new] = lone_.try_emplace(self().u(side), sample);
    if (!is_new && self().edges().sample_above(sample, place->second)) place->second = sample;
  }

  void add_uncertain() {
    if (uncertain_.empty()) return;
    std::sort(uncertain_.begin(), uncertain_.end());
    const auto noted = static_cast<std::ptrdiff_t>(risen_.size());
    for (const int side : uncertain_) {
      if (!std::binary_search(risen_.begin(), risen_.begin() + noted, side)) {
        clear_[static_cast<std::size_t>(side)] = false;
        risen_.push_back(side);
      }
    }
    uncertain_.clear();
    std::inplace_merge(risen_.begin(), risen_.begin() + noted, risen_.end());
    risen_.erase(std::unique(risen_.begin(), risen_.end()), risen_.end());
  }

  void merge_risen() {
    add_uncertain();
    if (risen_.empty()) return;
    if (self().has_previous()) {
      segments_.clear();
      bool clear_before = false;  // whether the edge from the previous risen sample is clear
      int risen_before = -1;
      for (const int side : risen_) {
        const bool is_clear = side + 1 < range_.end && clear_[static_cast<std::size_t>(side)];
        const bool beside_clear = self().spoke_is_right(side) ? is_clear : clear_before && risen_before == side - 1;
        clear_before = is_clear;
        risen_before = side;
        if (now_[side] == kNoGround || previous_[side] == kNoGround) continue;
        // The spoke's inner end is not above the horizon, and the horizon is not above the adjacent edge.
        if (beside_clear && !grid_.has_holes && self().is_inner_known(side)) continue;
        HorizonSegment& segment = segments_.emplace_back();
        if (!self().fill_spoke(side, segment) || !in_part(segment)) {
          segments_.pop_back();
        } else if (beside_clear) {
          clear_[static_cast<std::size_t>(self().spoke_is_right(side) ? side : side - 1)] = false;
        }
      }
      horizon_.merge(segments_);
    }
    segments_.clear();
    int last = -1;
    for (const int side : risen_) {
      if (side - 1 >= range_.begin && side - 1 != last) add_ring_edge(side - 1, false);
      if (side + 1 < range_.end) add_ring_edge(side, clear_[static_cast<std::size_t>(side)]);
      last = side;
    }
    horizon_.merge(segments_);
  }
  void add_ring_edge(int side, bool clear) {
    if (now_[side] == kNoGround || now_[side + 1] == kNoGround) return;
    HorizonSegment& segment = segments_.emplace_back();
    segment.begin = self().u(side);
    segment.end = self().u(side + 1);
    if (!in_part(segment)) return segments_.pop_back();
    segment.line = self().ring_edge(side);
    segment.first = segment.line.from;
    segment.last = segment.line.to;
    segment.clear = clear;
  }
  bool in_part(const HorizonSegment& segment) const {
    return segment.begin <= high_ && segment.end >= low_ && segment.begin < segment.end;
  }

  HorizonBins bins_;
  std::vector<SideRange> active_;  // samples of the strip that are not skipped
  std::ptrdiff_t stride_;          // an odd number of cache lines, so that rings do not evict one another
  std::vector<double> heights_;    // heights of the strip and the ring before it
  std::vector<int> risen_;         // samples of the ring that may be above the horizon, in order
  std::vector<char> clear_;  // per sample in risen_: whether the whole edge to the next sample is above the horizon
  int last_above_ = -2;      // the last sample that is certainly above it
  bool joined_ = false;      // whether the edge from it to the next sample is as far as the vertices between
  std::vector<HorizonSegment> segments_;
};

}  // namespace scarp
