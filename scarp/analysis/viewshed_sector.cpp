// SPDX-License-Identifier: MIT
#include "scarp/analysis/viewshed_sector.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <vector>

#include "scarp/analysis/horizon_bins.h"
#include "scarp/analysis/horizon_envelope.h"
#include "scarp/analysis/sight_rays.h"

namespace scarp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// Bound of the rounding of a line at u, in parts of its terms: at most eight operations, each off by half of kEpsilon.
constexpr double kRounding = 8 * kEpsilon;
constexpr int kStrip = BlockMaxima::kSide;  // rings loaded together: a line of the cache, where rings are columns

template <class T>
class Sector {
 public:
  Sector(const Viewpoint& view, const SampleGrid<T>& grid, const SectorPart& part, const SectorMaps& maps)
      : view_(view),
        grid_(grid),
        part_(part),
        maps_(maps),
        frame_(view.ground().field(), view.observer(), part.direction),
        edges_(view, frame_),
        horizon_(edges_),
        bins_(part.low, part.high),
        heights_(static_cast<std::size_t>(kStrip + 1) * static_cast<std::size_t>(frame_.sides())) {}

  SweepStatistics run() {
    int ring = frame_.ring(1);
    while (ring >= 0 && ring < frame_.rings()) {
      // To the end of the block of kStrip rings.
      const int block = ring / kStrip * kStrip;
      const int last = frame_.sign() > 0 ? std::min(block + kStrip, frame_.rings()) - 1 : block;
      strip(ring, last);
      ring = last + frame_.sign();
    }
    return statistics_;
  }

 private:
  struct Range {
    int begin, end;  // [begin, end)
  };
  // Samples of a ring that edges of the part end in: one beyond the part to each side.
  Range ring_range(int ring) const {
    const int x = frame_.x(ring);
    const double low = std::ceil(part_.low * x) - 1, high = std::floor(part_.high * x) + 1;
    return {std::clamp(frame_.side(static_cast<int>(low)), 0, frame_.sides()),
            std::clamp(frame_.side(static_cast<int>(high)), -1, frame_.sides() - 1) + 1};
  }
  double* ring_heights(int slot) { return heights_.data() + static_cast<std::ptrdiff_t>(slot) * frame_.sides(); }

  double height_above_eye(int ring, int side) const {
    const Node node = frame_.node(ring, side);
    const T sample = grid_.at(node.col, node.row);
    if (grid_.is_nodata(sample)) return -kInfinity;
    const SightGround& ground = view_.ground();
    return ground.lowered(ground.field().height_from_sample(static_cast<double>(sample)), node.col, node.row) -
           view_.eye();
  }

  // Rings of one row of blocks.
  void strip(int first, int last) {
    const int before = first - frame_.sign(), count = std::abs(last - first) + 1;
    find_active(first, last);
    for (const Range& active : active_) load(active, before, count);
    for (int slot = 1; slot <= count; ++slot) {
      ring(before + slot * frame_.sign(), ring_heights(slot - 1), ring_heights(slot));
    }
  }

  // Finds the blocks that may rise above the horizon: of the others, neither samples nor edges do.
  void find_active(int first, int last) {
    const Range a = ring_range(first), b = ring_range(last);
    const Range range{std::min(a.begin, b.begin), std::max(a.end, b.end)};
    active_.clear();
    if (range.begin >= range.end) return;
    const bool may_skip = maps_.maxima != nullptr && frame_.x(first) > 1;
    if (may_skip) bins_.update(horizon_);
    for (int block = range.begin / kStrip; block * kStrip < range.end; ++block) {
      if (may_skip && is_below(first, last, block)) continue;
      // Edges to the next block's first sample lie in both.
      const Range active{std::max(block * kStrip - 1, range.begin), std::min((block + 1) * kStrip + 1, range.end)};
      if (!active_.empty() && active_.back().end >= active.begin) {
        active_.back().end = active.end;
      } else {
        active_.push_back(active);
      }
    }
  }
  bool is_below(int first, int last, int block) const {
    const Node at = frame_.node(first / kStrip, block);
    const double near = frame_.x(first) - 1, far = frame_.x(last);
    // The samples are lowered by at least as much as one straight ahead, in the nearest ring.
    const Node ahead = frame_.node(first - frame_.sign(), frame_.side(0));
    const double drop = view_.ground().drop(ahead.col, ahead.row);
    const double maximum = maps_.maxima->maximum(at.col, at.row), raise = view_.settings().target_height;
    double top = maximum - drop + raise - view_.eye();
    top += kRounding * (std::abs(maximum) + drop + raise + std::abs(view_.eye()));
    const double s = top / (top > 0 ? near : far);
    const double left = frame_.y(block * kStrip - 1), right = frame_.y((block + 1) * kStrip);
    return s + kRounding * std::abs(s) <
           bins_.minimum(left / (left > 0 ? far : near), right / (right > 0 ? near : far));
  }

  // Loads samples of the strip, with one more to each side: whether there is an edge beyond the last.
  void load(const Range& range, int before, int count) {
    const int begin = std::max(range.begin - 1, 0), end = std::min(range.end + 1, frame_.sides());
    if (frame_.along_cols()) {
      // Rows of the field lie across the rings.
      for (int side = begin; side < end; ++side) {
        for (int slot = 0; slot <= count; ++slot) {
          ring_heights(slot)[side] = height_above_eye(before + slot * frame_.sign(), side);
        }
      }
    } else {
      for (int slot = 0; slot <= count; ++slot) {
        double* heights = ring_heights(slot);
        const int ring = before + slot * frame_.sign();
        for (int side = begin; side < end; ++side) heights[side] = height_above_eye(ring, side);
      }
    }
  }

  void ring(int ring, const double* previous, const double* heights) {
    ring_ = ring;
    x_ = frame_.x(ring);
    x_previous_ = x_ - 1;
    previous_ = previous;
    heights_now_ = heights;
    range_ = ring_range(ring);
    risen_.clear();
    if (range_.begin >= range_.end) return;
    std::int64_t tested = 0;
    for (const Range& active : active_) {
      const Range here{std::max(active.begin, range_.begin), std::min(active.end, range_.end)};
      if (here.begin >= here.end) continue;
      test(here);
      find_uncertain_spokes(here);
      tested += here.end - here.begin;
    }
    statistics_.samples += range_.end - range_.begin;
    statistics_.skipped += range_.end - range_.begin - tested;
    merge_risen();
  }

  double u(int side) const { return frame_.y(side) / x_; }
  bool is_target(int side) const {
    const double y = frame_.y(side), low = part_.low * x_, high = part_.high * x_;
    if (y < low || y > high) return false;
    // Diagonals belong to the sectors to the east and west.
    if (y == low) return part_.low > -1 || frame_.along_cols();
    return y < high || (part_.high == 1 && frame_.along_cols());
  }

  // Tests the samples against the horizon and notes those that may rise above it.
  void test(const Range& range) {
    std::size_t i = horizon_.find(u(range.begin));
    int side = range.begin;
    while (side < range.end) {
      // Samples before the next vertex.
      const double next = horizon_.pieces()[i + 1].begin;
      int end = range.end;
      if (next <= u(end - 1)) {
        end = std::clamp(static_cast<int>(std::ceil(next * x_)) + frame_.side(0), side + 1, range.end);
        while (end > side + 1 && u(end - 1) >= next) --end;
        while (end < range.end && u(end) < next) ++end;
      }
      test_under(i, side, end);
      side = end;
      if (side == range.end) break;
      const std::size_t j = horizon_.find(u(side), i);
      if (vertex_dips(i, j, side)) {
        note(side - 1);
        note(side);
      }
      i = j;
    }
  }

  void test_under(std::size_t i, int begin, int end) {
    const HorizonEnvelope::Piece& piece = horizon_.pieces()[i];
    const HorizonLine& line = piece.line;
    // In heights: s x = a + b y. The bound is that of the piece with room for these three operations.
    const double a = (line.s0 - line.slope * line.u0) * x_, b = line.slope;
    const double margin = line.is_ground() ? 4 * x_ * (piece.error + kRounding * std::abs(line.slope)) : 0;
    const double low = a - margin;
    if (maps_.least != nullptr) {
      for (int side = begin; side < end; ++side) {
        if (is_target(side)) write_least(i, side);
        if (heights_now_[side] >= low + b * frame_.y(side)) note(side);
      }
      return;
    }
    const double raise = view_.settings().target_height, low_target = low - raise - kRounding * std::abs(raise);
    for (int side = begin; side < end; ++side) {
      const double over = heights_now_[side] - b * frame_.y(side);
      if (over < low_target) continue;
      ++statistics_.careful;
      if (is_target(side)) test_target(i, side);
      if (over >= low) note(side);
    }
  }

  void note(int side) {
    if (risen_.empty() || risen_.back() < side) risen_.push_back(side);
  }

  // Whether the ground between the samples side - 1 and side may rise above a vertex of the horizon between them, with
  // both samples below it.
  bool vertex_dips(std::size_t i, std::size_t j, int side) const {
    double top = std::max(heights_now_[side - 1], heights_now_[side]) / x_;
    if (x_previous_ > 0) {
      top = std::max(top, std::max(previous_[side - 1], previous_[side]) / x_previous_);
    }
    top += kRounding * std::abs(top);
    for (std::size_t v = i + 1; v <= j; ++v) {
      const auto &before = horizon_.pieces()[v - 1], &after = horizon_.pieces()[v];
      const double at = std::min(before.line.at(after.begin) - before.error, after.line.at(after.begin) - after.error);
      if (!(top < at)) return true;
    }
    return false;
  }

  void test_target(std::size_t i, int side) {
    if (heights_now_[side] == -kInfinity) return;
    const HorizonSample sample{ring_, side};
    const Node node = frame_.node(sample);
    Seen& code = maps_.codes[static_cast<std::ptrdiff_t>(node.row) * grid_.cols + node.col];
    if (code != Seen::hidden) return;
    const double at = u(side), target = view_.target(edges_.lowered(sample)), s = (target - view_.eye()) / x_;
    const HorizonEnvelope::Answer answer = horizon_.test(i, at, s, kRounding * std::abs(s), sample);
    if (answer == HorizonEnvelope::Answer::blocked) return;
    if (answer == HorizonEnvelope::Answer::unsure) {
      ++statistics_.walked;
      if (!sees(view_.ground(), view_.observer(), view_.eye(), node, target)) return;
    } else if (const auto lone = lone_.find(at); lone != lone_.end()) {
      CrossingTerms terms = edges_.sample_terms(lone->second, sample);
      terms.r = target;
      if (sign_of(terms) > 0) return;
    }
    code = Seen::visible;
  }

  void write_least(std::size_t i, int side) {
    const HorizonSample sample{ring_, side};
    const Node node = frame_.node(sample);
    double& least = maps_.least[static_cast<std::ptrdiff_t>(node.row) * grid_.cols + node.col];
    if (std::isnan(least)) return;
    const double at = u(side);
    if (!horizon_.is_sure(i, at)) {
      ++statistics_.walked;
      least = least_visible(view_.ground(), view_.observer(), view_.eye(), node);
      return;
    }
    const auto raise = [&](const HorizonLine& line) {
      if (line.is_ground()) least = std::max(least, least_clearing(edges_.edge_terms(line, sample)));
    };
    const HorizonEnvelope::Piece& piece = horizon_.pieces()[i];
    raise(piece.line);
    if (piece.begin == at) raise(horizon_.pieces()[i - 1].line);
    if (const auto lone = lone_.find(at); lone != lone_.end()) {
      least = std::max(least, least_clearing(edges_.sample_terms(lone->second, sample)));
    }
  }

  bool stands_alone(const double* heights, int side) const {
    return heights[side] != -kInfinity && (side == 0 || heights[side - 1] == -kInfinity) &&
           (side + 1 == frame_.sides() || heights[side + 1] == -kInfinity);
  }

  // Spokes whose outer end is below the horizon lie below it, but where their inner end is not known to: an edge of the
  // previous ring is missing there on the spoke's side, or it is outside the part.
  void find_uncertain_spokes(const Range& range) {
    const bool gaps = grid_.has_holes || frame_.sides() == 1;
    if (gaps) {
      for (int side = range.begin; side < range.end; ++side) {
        if (stands_alone(heights_now_, side)) add_lone(side);
        if (previous_[side] == -kInfinity) continue;
        const int inwards = frame_.y(side) > 0 ? side - 1 : side + 1;
        if (inwards < 0 || inwards >= frame_.sides() || previous_[inwards] == -kInfinity) uncertain_.push_back(side);
      }
    }
    if (x_previous_ == 0) {
      for (int side = range.begin; side < range.end; ++side) uncertain_.push_back(side);
      return;
    }
    for (int side = range.begin; side < range.end && frame_.y(side) < part_.low * x_previous_; ++side) {
      if (rises_at(side, part_.low)) uncertain_.push_back(side);
    }
    for (int side = range.end; side-- > range.begin && frame_.y(side) > part_.high * x_previous_;) {
      if (rises_at(side, part_.high)) uncertain_.push_back(side);
    }
  }
  // Whether a spoke may be above the horizon at an end of the part.
  bool rises_at(int side, double end) const {
    if (heights_now_[side] == -kInfinity || previous_[side] == -kInfinity || frame_.y(side) == 0) return false;
    const HorizonLine line = spoke(side);
    const HorizonEnvelope::Piece& piece = horizon_.pieces()[horizon_.find(end)];
    return !(line.at(end) + line.error < piece.line.at(end) - piece.error);
  }

  // Samples that no edge along the ring ends in block lines of sight through them alone.
  void add_lone(int side) {
    const HorizonSample sample{ring_, side};
    const auto [place, is_new] = lone_.try_emplace(u(side), sample);
    if (is_new) return;
    CrossingTerms terms = edges_.sample_terms(place->second, sample);
    terms.r = edges_.lowered(sample);
    if (sign_of(terms) < 0) place->second = sample;
  }

  void merge_risen() {
    if (!uncertain_.empty()) {
      risen_.insert(risen_.end(), uncertain_.begin(), uncertain_.end());
      std::sort(risen_.begin(), risen_.end());
      risen_.erase(std::unique(risen_.begin(), risen_.end()), risen_.end());
      uncertain_.clear();
    }
    if (risen_.empty()) return;
    segments_.clear();
    for (const int side : risen_) add_spoke(side);
    horizon_.merge(segments_);
    segments_.clear();
    int last = -1;
    for (const int side : risen_) {
      if (side - 1 >= range_.begin && side - 1 != last) add_ring_edge(side - 1);
      if (side + 1 < range_.end) add_ring_edge(side);
      last = side;
    }
    horizon_.merge(segments_);
  }

  bool in_part(double begin, double end) const { return begin <= part_.high && end >= part_.low && begin < end; }

  // From the sample (ring, side) to the next one.
  HorizonLine ring_edge(int side) const {
    const double a = heights_now_[side], b = heights_now_[side + 1];
    HorizonLine line;
    line.u0 = u(side);
    line.s0 = a / x_;
    line.slope = b - a;
    const double reach = std::max({1.0, std::abs(line.u0), std::abs(u(side + 1))});
    line.error = kRounding * (std::abs(line.s0) + std::abs(b / x_) + std::abs(line.slope) * reach);
    line.from = {ring_, side};
    line.to = {ring_, side + 1};
    return line;
  }
  void add_ring_edge(int side) {
    if (heights_now_[side] == -kInfinity || heights_now_[side + 1] == -kInfinity) return;
    HorizonSegment segment;
    segment.begin = u(side);
    segment.end = u(side + 1);
    if (!in_part(segment.begin, segment.end)) return;
    segment.line = ring_edge(side);
    segment.first = segment.line.from;
    segment.last = segment.line.to;
    segments_.push_back(segment);
  }

  // From the sample (ring, side) towards the observer, to the previous ring. There s = inner / x, or, where that ring
  // is the observer's, the line is that of the plane through the observer and both samples.
  HorizonLine spoke(int side) const {
    const double y = frame_.y(side), outer = heights_now_[side], inner = previous_[side], rise = outer - inner;
    HorizonLine line;
    line.u0 = u(side);
    line.s0 = outer / x_;
    line.slope = (inner - x_previous_ * rise) / y;
    const double terms = (std::abs(inner) + x_previous_ * (std::abs(inner) + std::abs(outer))) / std::abs(y);
    double reach = kCut, ends = std::abs(line.s0);
    if (x_previous_ > 0) {
      reach = std::abs(y) / x_previous_;
      ends += std::abs(inner / x_previous_);
    }
    line.error = kRounding * (ends + std::abs(line.slope) * reach + terms * (reach - std::abs(line.u0)));
    line.from = {ring_, side};
    line.to = {ring_ - frame_.sign(), side};
    return line;
  }
  void add_spoke(int side) {
    const int y = frame_.y(side);
    if (y == 0 || heights_now_[side] == -kInfinity || previous_[side] == -kInfinity) return;
    HorizonSegment segment;
    const bool cut = x_previous_ == 0;
    const double outer = u(side), inner = cut ? std::copysign(kCut, y) : y / x_previous_;
    segment.begin = std::min(outer, inner);
    segment.end = std::max(outer, inner);
    if (!in_part(segment.begin, segment.end) || std::abs(outer) >= kCut) return;
    segment.line = spoke(side);
    segment.first = y > 0 ? segment.line.from : segment.line.to;
    segment.last = y > 0 ? segment.line.to : segment.line.from;
    segment.end_cut = cut && y > 0;
    segment.begin_cut = cut && y < 0;
    segments_.push_back(segment);
  }

  static constexpr double kCut = 2;  // beyond the sector: where spokes from the observer's ring are cut

  const Viewpoint& view_;
  const SampleGrid<T>& grid_;
  SectorPart part_;
  SectorMaps maps_;
  SectorFrame frame_;
  SightEdges edges_;
  HorizonEnvelope horizon_;
  HorizonBins bins_;
  std::vector<Range> active_;             // samples of the strip that are not skipped
  std::vector<double> heights_;           // of the strip and the ring before it, above the observer
  std::map<double, HorizonSample> lone_;  // by u: the highest sample there that no edge of a ring ends in
  SweepStatistics statistics_;

  // The ring at work.
  int ring_ = 0;
  double x_ = 0, x_previous_ = 0;
  Range range_{};
  const double* heights_now_ = nullptr;
  const double* previous_ = nullptr;
  std::vector<int> uncertain_;
  std::vector<int> risen_;  // samples that may be above the horizon, in order
  std::vector<HorizonSegment> segments_;
};

}  // namespace

SweepStatistics sweep_sector(const Viewpoint& view, const SectorPart& part, const SectorMaps& maps) {
  return view.ground().field().visit(
      [&]<class T>(const SampleGrid<T>& grid) { return Sector<T>(view, grid, part, maps).run(); });
}

}  // namespace scarp
