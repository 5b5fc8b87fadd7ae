// SPDX-License-Identifier: MIT
#include "scarp/analysis/viewshed_sector.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "scarp/analysis/ring_sweep.h"
#include "scarp/analysis/sight_rays.h"

namespace scarp {
namespace {

// Rings of a sector around the observer: u = y / x, s = height / x, heights above the eye.
template <class T, bool kLeast>
class Sector : public RingSweep<Sector<T, kLeast>, T> {
  using Base = RingSweep<Sector<T, kLeast>, T>;
  using Base::frame_, Base::grid_, Base::high_, Base::horizon_, Base::lone_, Base::low_, Base::now_, Base::previous_,
      Base::ring_, Base::statistics_, Base::target_raise_, Base::uncertain_, Base::kStrip;

 public:
  static constexpr bool kTestsAll = kLeast;

  Sector(const Viewpoint& view, const SampleGrid<T>& grid, const SectorPart& part, const SectorMaps& maps)
      : Base(grid, {view.ground().field(), view.observer(), part.direction}, edges_, part.low, part.high,
             view.settings().target_height),
        view_(view),
        maps_(maps),
        edges_(view, frame_) {}

  const SightEdges& edges() const { return edges_; }

  double height(T sample, Node node) const {
    const SightGround& ground = view_.ground();
    return ground.lowered(ground.field().height_from_sample(static_cast<double>(sample)), node.col, node.row) -
           view_.eye();
  }
  void begin_ring(int ring) {
    x_ = frame_.x(ring);
    x_previous_ = x_ - 1;
  }
  // Decided by the distance of the node straight ahead: rounding preserves the order of distances.
  bool is_beyond(int ring) const {
    const Node ahead = frame_.node(ring, frame_.side(0));
    const double limit = view_.settings().max_distance;
    return view_.ground().square_distance(ahead.col, ahead.row) > limit * limit;
  }
  SideRange sides_of(int ring) const {
    const int x = frame_.x(ring);
    const double low = std::ceil(low_ * x) - 1, high = std::floor(high_ * x) + 1;
    return {std::clamp(frame_.side(static_cast<int>(low)), 0, frame_.sides()),
            std::clamp(frame_.side(static_cast<int>(high)), -1, frame_.sides() - 1) + 1};
  }
  double u(int side) const { return frame_.y(side) / x_; }
  double s(double height) const { return height / x_; }
  double s_previous(double height) const { return x_previous_ > 0 ? height / x_previous_ : kNoGround; }
  double s_error(double s) const { return kSweepRounding * std::abs(s); }
  int about_side(double u) const { return static_cast<int>(u * x_) + frame_.side(0); }
  double sides_per_u() const { return x_; }
  bool has_previous() const { return true; }
  bool spoke_is_right(int side) const { return frame_.y(side) > 0; }

  // The margin is the piece's error with room for the operations here.
  RingLine ring_line(const HorizonLine& line, double error) const {
    if (!line.is_ground()) return {kNoGround, 0, 0};
    return {(line.s0 - line.slope * line.u0) * x_, line.slope,
            4 * x_ * (error + kSweepRounding * std::abs(line.slope))};
  }
  double height_of_slack(double slack) const { return 2 * slack * x_; }

  // From the sample (ring, side) to the next one.
  HorizonLine ring_edge(int side) const {
    const double a = now_[side], b = now_[side + 1];
    HorizonLine line;
    line.u0 = u(side);
    line.s0 = a / x_;
    line.slope = b - a;
    // Half a unit each for both ends, the slope and the positions; samples lie one beyond the sector at most.
    const double ends = std::abs(a) + std::abs(b);
    line.error = kSweepRounding * (ends / x_ + std::abs(line.slope) * (1 + 1 / x_));
    line.from = {ring_, side};
    line.to = {ring_, side + 1};
    return line;
  }
  // From the sample (ring, side) towards the observer, to the previous ring. On that ring, s = inner / x; if it is the
  // observer's ring, the line is that of the plane through the observer and both samples.
  HorizonLine spoke(int side) const {
    const double y = frame_.y(side), outer = now_[side], inner = previous_[side], rise = outer - inner;
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
    line.error = kSweepRounding * (ends + std::abs(line.slope) * reach + terms * (reach - std::abs(line.u0)));
    line.from = {ring_, side};
    line.to = {ring_ - frame_.sign(), side};
    return line;
  }
  bool fill_spoke(int side, HorizonSegment& segment) const {
    const int y = frame_.y(side);
    if (y == 0) return false;
    const bool cut = x_previous_ == 0;
    const double outer = u(side), inner = cut ? std::copysign(kCut, y) : y / x_previous_;
    if (std::abs(outer) >= kCut) return false;
    segment.begin = std::min(outer, inner);
    segment.end = std::max(outer, inner);
    segment.line = spoke(side);
    segment.first = y > 0 ? segment.line.from : segment.line.to;
    segment.last = y > 0 ? segment.line.to : segment.line.from;
    segment.end_cut = cut && y > 0;
    segment.begin_cut = cut && y < 0;
    return true;
  }

  // Excludes spokes in the observer's ring and outside the part.
  bool is_inner_known(int side) const {
    return x_previous_ > 0 && frame_.y(side) >= low_ * x_previous_ && frame_.y(side) <= high_ * x_previous_;
  }
  // Spokes from the observer's ring, and those whose inner end is outside the part.
  void find_more_spokes(const SideRange& range) {
    if (x_previous_ == 0) {
      for (int side = range.begin; side < range.end; ++side) uncertain_.push_back(side);
      return;
    }
    for (int side = range.begin; side < range.end && frame_.y(side) < low_ * x_previous_; ++side) {
      if (rises_at(side, low_)) uncertain_.push_back(side);
    }
    for (int side = range.end; side-- > range.begin && frame_.y(side) > high_ * x_previous_;) {
      if (rises_at(side, high_)) uncertain_.push_back(side);
    }
  }

  bool may_skip(int first) const { return maps_.maxima != nullptr && frame_.x(first) > 1; }
  bool is_below(const HorizonBins& bins, int first, int last, int block) const {
    const Node at = frame_.node(first / kStrip, block);
    const double near = frame_.x(first) - 1, far = frame_.x(last);
    // The samples are lowered by at least as much as one straight ahead, in the nearest ring.
    const Node ahead = frame_.node(first - frame_.sign(), frame_.side(0));
    const double drop = view_.ground().drop(ahead.col, ahead.row);
    const double maximum = maps_.maxima->maximum(at.col, at.row);
    double top = maximum - drop + target_raise_ - view_.eye();
    top += kSweepRounding * (std::abs(maximum) + drop + target_raise_ + std::abs(view_.eye()));
    const double s = top / (top > 0 ? near : far);
    const double left = frame_.y(block * kStrip - 1), right = frame_.y((block + 1) * kStrip);
    return s + kSweepRounding * std::abs(s) <
           bins.minimum(left / (left > 0 ? far : near), right / (right > 0 ? near : far));
  }

  void is_above(int side) {
    if (!is_target(side)) return;
    if (!lone_.empty()) return test(horizon_.find(u(side)), side);
    const Node node = frame_.node(ring_, side);
    if (is_asked(node)) mark_visible(node);
  }
  void test(std::size_t i, int side) {
    if (!is_target(side) || now_[side] == kNoGround) return;
    const HorizonSample sample{ring_, side};
    const Node node = frame_.node(sample);
    if (!is_asked(node)) return;
    const double at = u(side), target = view_.target(edges_.lowered(sample)), s = (target - view_.eye()) / x_;
    const HorizonEnvelope::Answer answer = horizon_.test(i, at, s, kSweepRounding * std::abs(s), sample);
    if (answer == HorizonEnvelope::Answer::blocked) return;
    if (answer == HorizonEnvelope::Answer::unsure) {
      ++statistics_.walked;
      if (!sees(view_.ground(), view_.observer(), view_.eye(), node, target)) return;
    } else if (const auto lone = lone_.find(at); lone != lone_.end()) {
      CrossingTerms terms = edges_.sample_terms(lone->second, sample);
      terms.r = target;
      if (sign_of(terms) > 0) return;
    }
    mark_visible(node);
  }

  void test_all(std::size_t i, int side) {
    if (!is_target(side)) return;
    const HorizonSample sample{ring_, side};
    const Node node = frame_.node(sample);
    double& least = maps_.least[index(node)];
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

 private:
  static constexpr double kCut = 2;  // beyond the sector: where spokes from the observer's ring are cut

  std::ptrdiff_t index(Node node) const { return static_cast<std::ptrdiff_t>(node.row) * grid_.cols + node.col; }
  // Whether the result is needed for a node that has a sample.
  bool is_asked(Node node) const {
    if (maps_.codes) return maps_.codes[index(node)] == Seen::hidden;
    return !view_.has_limits() || view_.in_range(node, view_.target(*view_.ground().lowered(node)));
  }
  void mark_visible(Node node) {
    if (maps_.codes) {
      maps_.codes[index(node)] = Seen::visible;
    } else {
      add_visible(maps_.counts[index(node)]);
    }
  }
  bool is_target(int side) const {
    const double y = frame_.y(side), low = low_ * x_, high = high_ * x_;
    if (y < low || y > high) return false;
    // Diagonals belong to the sectors to the east and west.
    if (y == low) return low_ > -1 || frame_.along_cols();
    return y < high || (high_ == 1 && frame_.along_cols());
  }
  // Whether a spoke may be above the horizon at an end of the part.
  bool rises_at(int side, double end) const {
    if (now_[side] == kNoGround || previous_[side] == kNoGround || frame_.y(side) == 0) return false;
    const HorizonLine line = spoke(side);
    const HorizonEnvelope::Piece& piece = horizon_.pieces()[horizon_.find(end)];
    return !(line.at(end) + line.error < piece.line.at(end) - piece.error);
  }

  const Viewpoint& view_;
  SectorMaps maps_;
  SightEdges edges_;
  double x_ = 0, x_previous_ = 0;
};

}  // namespace

SweepStatistics sweep_sector(const Viewpoint& view, const SectorPart& part, const SectorMaps& maps) {
  return view.ground().field().visit([&]<class T>(const SampleGrid<T>& grid) {
    return maps.least ? Sector<T, true>(view, grid, part, maps).run() : Sector<T, false>(view, grid, part, maps).run();
  });
}

}  // namespace scarp
