// SPDX-License-Identifier: MIT
#include "scarp/analysis/horizon_envelope.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scarp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr int kUnsure = 2;
// Blurs are bounds; a position within twice the blur of a vertex counts as next to it.
constexpr double kBeside = 2;

}  // namespace

HorizonEnvelope::HorizonEnvelope(const HorizonEdges& edges) : edges_(edges) {
  Piece nothing;
  nothing.begin = -kInfinity;
  nothing.line.s0 = -kInfinity;
  pieces_.push_back(nothing);
  nothing.begin = kInfinity;
  nothing.line.from = {-1, -2};  // not merged with the previous piece
  pieces_.push_back(nothing);
}

std::size_t HorizonEnvelope::find(double u, std::size_t hint) const {
  // Callers advance by a few pieces at a time.
  for (int i = 0; i < 4; ++i, ++hint) {
    if (hint + 1 >= pieces_.size() || pieces_[hint + 1].begin > u) return hint;
  }
  std::size_t step = 1, low = hint;
  while (low + step < pieces_.size() && pieces_[low + step].begin <= u) {
    low += step;
    step *= 2;
  }
  const auto first = pieces_.begin() + static_cast<std::ptrdiff_t>(low);
  const auto last = pieces_.begin() + static_cast<std::ptrdiff_t>(std::min(low + step, pieces_.size()));
  const auto after = std::upper_bound(first, last, u, [](double at, const Piece& p) { return at < p.begin; });
  return static_cast<std::size_t>(after - pieces_.begin()) - 1;
}

bool HorizonEnvelope::is_sure(std::size_t i, double u) const {
  return !blurred(i, u) && pieces_[i].slack == 0 && (pieces_[i].begin != u || pieces_[i - 1].slack == 0);
}

// Whether u is so close to an end of the piece that rounding may have put it on the wrong side.
bool HorizonEnvelope::blurred(std::size_t i, double u) const {
  return (pieces_[i].blur > 0 && u - pieces_[i].begin <= kBeside * pieces_[i].blur) ||
         (pieces_[i + 1].blur > 0 && pieces_[i + 1].begin - u <= kBeside * pieces_[i + 1].blur);
}

HorizonEnvelope::Answer HorizonEnvelope::test(std::size_t i, double u, double s, double s_error,
                                              HorizonSample target) const {
  bool visible = true;
  const auto blocks = [&](const Piece& piece) {
    if (!piece.line.is_ground()) return false;
    const double difference = piece.line.at(u) - s, bound = piece.error + s_error;
    if (difference > bound) return true;
    if (difference < -(bound + piece.slack)) return false;
    if (piece.slack > 0) visible = false;
    return bound > 0 && edges_.edge_above_target(piece.line, target) > 0;
  };
  const Piece& piece = pieces_[i];
  if (blocks(piece)) return Answer::blocked;
  // Drops: the previous edge ends here and includes its end.
  if (piece.begin == u && blocks(pieces_[i - 1])) return Answer::blocked;
  if (blurred(i, u) && std::abs(piece.line.at(u) - s) <= piece.error + s_error) return Answer::unsure;
  return visible ? Answer::visible : Answer::unsure;
}

HorizonEnvelope::Comparison HorizonEnvelope::compare(const HorizonSegment& segment, std::size_t i, double u) const {
  const Piece& piece = pieces_[i];
  if (!piece.line.is_ground()) return {1, kInfinity, 0};
  Comparison result;
  result.difference = segment.line.at(u) - piece.line.at(u);
  result.bound = segment.line.error + piece.error;
  if (result.difference > result.bound) {
    result.sign = 1;
  } else if (result.difference < -result.bound) {
    result.sign = -1;
  } else if (result.bound > 0) {
    result.sign = kUnsure;
    const auto own_end = [&](HorizonSample sample) {
      if (blurred(i, u)) return kUnsure;
      if (sample == piece.line.from || sample == piece.line.to) return 0;
      return -edges_.edge_above(piece.line, sample);
    };
    if (u == segment.begin && !segment.begin_cut) {
      result.sign = own_end(segment.first);
    } else if (u == segment.end && !segment.end_cut) {
      result.sign = own_end(segment.last);
    } else if (u == piece.begin ? piece.blur == 0 : u == pieces_[i + 1].begin && pieces_[i + 1].blur == 0) {
      for (const HorizonSample& sample : {piece.line.from, piece.line.to}) {
        if (edges_.position(sample) == u) result.sign = edges_.edge_above(segment.line, sample);
      }
    }
  }
  return result;
}

void HorizonEnvelope::put(const Piece& piece) {
  // The last piece's own part has no width.
  if (merged_.back().begin == piece.begin) merged_.pop_back();
  merged_.push_back(piece);
}

void HorizonEnvelope::put_old(std::size_t i, double begin, double slack) {
  const Piece& old = pieces_[i];
  Piece& last = merged_.back();
  if (last.line.from == old.line.from && last.line.to == old.line.to) {
    last.slack = std::max({last.slack, old.slack, slack});
    last.error = std::max(last.error, old.error);
    return;
  }
  Piece piece = old;
  piece.begin = begin;
  if (begin != old.begin) piece.blur = 0;
  piece.slack = std::max(piece.slack, slack);
  put(piece);
}

void HorizonEnvelope::put_new(const HorizonSegment& segment, std::size_t i, double begin, double slack) {
  Piece& last = merged_.back();
  if (last.line.from == segment.line.from && last.line.to == segment.line.to) {
    last.slack = std::max(last.slack, slack);
    return;
  }
  Piece piece;
  piece.begin = begin;
  piece.line = segment.line;
  piece.error = segment.line.error;
  piece.slack = slack;
  if (begin == pieces_[i].begin) piece.blur = pieces_[i].blur;
  put(piece);
}

void HorizonEnvelope::put_crossing(const HorizonSegment& segment, std::size_t i, double begin, double end,
                                   const Comparison& left, const Comparison& right) {
  const double bound = std::max(left.bound, right.bound), change = right.difference - left.difference;
  // Both differences have errors of at most `bound`, so the crossing has an error of `bound` over the difference of the
  // slopes.
  double at = begin - left.difference * ((end - begin) / change);
  double blur = end - begin;
  if (std::abs(change) > 4 * bound) {
    blur = std::min(blur, 2 * bound * ((end - begin) / std::abs(change)) + 4 * kEpsilon * std::abs(at));
  }
  if (!(at >= begin)) at = begin;
  if (!(at <= end)) at = end;
  const bool new_first = left.sign > 0;
  const double old_slack = pieces_[i].slack;
  if (at == begin || at == end) {
    // One of the two has no width in doubles: the other may be lower there.
    const bool new_remains = new_first == (at == end);
    if (new_remains) {
      put_new(segment, i, begin, std::max(old_slack, 4 * bound));
    } else {
      put_old(i, begin, 4 * bound);
    }
    return;
  }
  if (new_first) {
    put_new(segment, i, begin, old_slack);
    put_old(i, at, 0);
  } else {
    put_old(i, begin, 0);
    put_new(segment, i, at, old_slack);
  }
  Piece &before = merged_[merged_.size() - 2], &after = merged_.back();
  after.blur = blur;
  before.error = after.error = std::max(before.error, after.error);
}

void HorizonEnvelope::resolve(const HorizonSegment& segment, std::size_t i, double begin, double end) {
  const Comparison left = compare(segment, i, begin), right = compare(segment, i, end);
  const auto doubt = [](const Comparison& c) { return c.sign == kUnsure ? std::abs(c.difference) + c.bound : 0.0; };
  const double slack = std::max(doubt(left), doubt(right));
  const bool left_above = left.sign == 1, right_above = right.sign == 1;
  if (!left_above && !right_above) {
    put_old(i, begin, slack);
  } else if ((left_above && right.sign != -1) || (right_above && left.sign != -1)) {
    // The old piece's slack disappears where the new one is above it by more.
    const Piece& old = pieces_[i];
    const bool clears = std::min(left.difference - left.bound, right.difference - right.bound) > old.slack;
    put_new(segment, i, begin, std::max(slack, clears ? 0.0 : old.slack));
  } else {
    put_crossing(segment, i, begin, end, left, right);
  }
}

void HorizonEnvelope::merge(const std::vector<HorizonSegment>& segments) {
  if (segments.empty()) return;
  merged_.clear();
  merged_.push_back(pieces_.front());
  std::size_t i = 0;  // the piece at the current position; it is in merged_
  const auto copy_to = [&](std::size_t last) {
    merged_.insert(merged_.end(), pieces_.begin() + static_cast<std::ptrdiff_t>(i + 1),
                   pieces_.begin() + static_cast<std::ptrdiff_t>(last + 1));
    i = last;
  };
  for (std::size_t n = 0; n < segments.size(); ++n) {
    const HorizonSegment& segment = segments[n];
    if (!(segment.begin < segment.end)) continue;
    const std::size_t first = find(segment.begin, i);
    // A piece that starts at the start of the segment is merged with it.
    const std::size_t copied = pieces_[first].begin == segment.begin ? first - 1 : first;
    if (copied > i) {
      // Added by put() instead of copied: the previous piece may be the same edge, or have no width.
      put_old(i + 1, pieces_[i + 1].begin, 0);
      ++i;
      copy_to(copied);
    }
    i = first;
    if (segment.clear) {
      put_new(segment, i, segment.begin, 0);
      while (pieces_[i + 1].begin < segment.end) ++i;
    } else {
      for (double begin = segment.begin;;) {
        const double end = std::min(segment.end, pieces_[i + 1].begin);
        resolve(segment, i, begin, end);
        if (end == segment.end) break;
        begin = end;
        ++i;
      }
    }
    const bool goes_on = n + 1 < segments.size() && segments[n + 1].begin == segment.end;
    if (!goes_on && segment.end < pieces_[i + 1].begin) put_old(i, segment.end, 0);
  }
  if (i + 1 < pieces_.size()) {
    put_old(i + 1, pieces_[i + 1].begin, 0);
    ++i;
    copy_to(pieces_.size() - 1);
  }
  pieces_.swap(merged_);
}

}  // namespace scarp
