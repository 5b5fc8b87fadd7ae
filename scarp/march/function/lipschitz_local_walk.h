// SPDX-License-Identifier: MIT
// The march of lipschitz_local.h as a walk that issues queries: for bounds along a segment, for the rate of height gain
// there, or for a height. The caller answers them: lipschitz_local.cpp one ray after another, lipschitz_local_simd.cpp
// many walks at once, in vectors.
//
//   LocalWalk walk(ray, settings);
//   while (walk.question() != done) answer it
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "scarp/march/function/function_ray.h"

namespace scarp {

class LocalWalk {
 public:
  enum class Question : std::uint8_t {
    bound,   ///< SegmentBound over t0()..t1()
    gain,    ///< minimum and maximum slope of the ground there, dh/dt
    height,  ///< of the ground at t0()
    done,
  };

  LocalWalk() = default;
  LocalWalk(const HeightFunction& function, const Ray& ray, FunctionUse use, const MarchSettings& settings)
      : r_(function, ray, use, settings.function.reach, FunctionRay::Unrounded{}),
        tolerance_(settings.lipschitz_local.tolerance),
        most_(static_cast<std::uint32_t>(settings.lipschitz_local.max_steps)) {
    if (r_.begins_under) {
      end(r_.ended(HitStatus::below, r_.t_enter));
    } else if (!r_.crosses()) {
      end({});
    } else {
      shortest_ = kShortest * (r_.t_exit - r_.t_enter);
      ask(Question::bound, State::rounding, r_.t_enter, r_.t_exit);
    }
  }

  Question question() const { return question_; }
  double t0() const { return t0_; }
  double t1() const { return t1_; }
  const Ray& ray() const { return r_.ray(); }
  /// Result, once the walk is done.
  const Hit& hit() const { return hit_; }
  const MarchStats& stats() const { return stats_; }

  void answer(const SegmentBound& b) {
    if (state_ == State::rounding) {
      r_.set_rounding(b);
      t_ = r_.t_enter;
      if (ray().start == RayStart::on_surface && t_ == ray().t_min) {
        length_ = r_.t_exit - t_;
        ask(Question::gain, State::leaving, t_, t_ + length_);
      } else {
        ++stats_.cell_tests;
        ask(Question::height, State::beginning, t_, t_);
      }
      return;
    }
    const auto [free, sunk, clear] = proof_of(b, t_, end_);
    if (free == end_) {
      t_ = end_;
      const bool rises = ray().direction.z > 0;
      length_ = rises ? std::max(kRisingGrowth * length_, kRisingClear * clear / r_.metres_per_t()) : kGrowth * length_;
      return next_segment();
    }
    const double least = std::max(shortest_, tolerance_ * (t_ - ray().t_min));
    if (length_ <= least) {
      ++stats_.cell_tests;
      return ask(Question::height, State::last, end_, end_);
    }
    const double gained = free - t_;
    // The first crossing is before `sunk`; otherwise it may be anywhere in the rest of the segment, or nowhere.
    length_ = std::max(least, sunk < end_ ? std::min((sunk - free) * kBeyond, kShrink * length_)
                                          : std::max(gained, kShrink * (end_ - free)));
    t_ = free;
    next_segment();
  }

  // From the surface: finds until when the ray provably gains height; a hit if it loses height at once.
  void answer_gain(dvec2 slope) {
    ++stats_.steps;
    const double least = ray().direction.z - slope.y, most = ray().direction.z - slope.x;
    if (!(least > 0) && most < 0) return end(r_.hit(t_));
    // The ray provably neither gains nor loses height: it may run along the ground.
    if (least > 0 || length_ <= shortest_) {
      t_ += length_;
      length_ *= kLeft;
      return next_segment();
    }
    length_ *= kLeaving;
    ask(Question::gain, State::leaving, t_, t_ + length_);
  }

  void answer_height(double ground) {
    const double h = ray().origin.z + ray().direction.z * t0_ - ground;
    switch (state_) {
      case State::beginning:
        if (std::abs(h) <= r_.rounding()) return end(r_.hit(t_));
        if (h < 0) return end(r_.ended(HitStatus::below, r_.t_enter));
        length_ = r_.t_exit - t_;
        return next_segment();
      case State::last:
        if (h > 0) {
          // No known crossing; the bounds are only too wide for so little clearance: over a crease, or along steep
          // ground. Try shorter segments.
          if (length_ <= shortest_) return end(r_.hit(t_));
          length_ = std::max(shortest_, kShrink * length_);
          return next_segment();
        }
        h1_ = h;
        ++stats_.cell_tests;
        return ask(Question::height, State::above_end, t_, t_);
      case State::above_end:
        h0_ = h;
        return next_secant();
      default:
        break;
    }
    if (std::abs(h) <= r_.rounding()) return end(r_.hit(t0_));
    if (h > 0) {
      t_ = t0_, h0_ = h;
      if (kept_ == 1) h1_ *= 0.5;
      kept_ = 1;
    } else {
      end_ = t0_, h1_ = h;
      if (kept_ == -1) h0_ *= 0.5;
      kept_ = -1;
    }
    next_secant();
  }

 private:
  enum class State : std::uint8_t { rounding, leaving, beginning, walking, last, above_end, secants };

  // Shortest segment, as a fraction of the ray's part over the ground, for any tolerance: a ray that the bounds over
  // such a segment do not separate from the ground touches it.
  static constexpr double kShortest = 0x1p-40;
  // Lines are followed to slightly before they intersect the ray, by more than their rounding.
  static constexpr double kShort = 1 - 0x1p-20;
  // Length factors of the next segment after a free one, and after one that is not free. Rising rays leave the ground:
  // their segments are at least this factor times the distance known to be free. Among the values tried (1.1 to 4, 0.15
  // to 0.6, 0 to 5 times) these take the fewest bounds over fBm; doubling takes a fifth more.
  static constexpr double kGrowth = 1.3, kShrink = 0.5;
  static constexpr double kRisingGrowth = 1.5, kRisingClear = 3;
  // The same for segments that leave the surface, and for the first one after them.
  static constexpr double kLeaving = 0.1, kLeft = 4;
  static constexpr double kBeyond = 1 + 0x1p-10;  // slightly beyond where the ray is known to be below the ground
  static constexpr int kMostSecants = 100;        // far more than the 10 or so that smooth ground takes

  // Proven facts about a segment: the ray is above the ground until `free`, and below it at `sunk`, if finite.
  struct Proof {
    double free, sunk;
    double clear = 0;  // minimum height above the ground at t1, in metres
  };

  Proof proof_of(const SegmentBound& b, double t0, double t1) const {
    const double middle = 0.5 * (t0 + t1), half = 0.5 * (t1 - t0), slack = r_.rounding_of_height(t0, t1);
    Proof proof{t1, std::numeric_limits<double>::infinity()};
    const double least_height = ray().origin.z + ray().direction.z * (ray().direction.z < 0 ? t1 : t0);
    if (least_height - b.high > slack) {
      proof.clear = least_height - b.high;
      return proof;
    }
    // The clearance is within `wide` of mid + slope * s.
    const double mid = ray().origin.z + ray().direction.z * middle - b.mid, wide = b.rest + slack;
    const double slope = ray().direction.z * half - b.slope;
    const double begin = mid - slope - wide, end = mid + slope - wide;
    if (begin <= 0) {
      proof.free = t0;
    } else if (end <= 0) {
      proof.free = t0 + kShort * (t1 - t0) * begin / (begin - end);
    }
    proof.clear = std::max(0.0, end);
    const double begin_most = begin + 2 * wide, end_most = end + 2 * wide;
    if (end_most < 0) proof.sunk = begin_most > 0 ? t0 + (t1 - t0) * begin_most / (begin_most - end_most) : t0;
    return proof;
  }

  void ask(Question question, State state, double t0, double t1) {
    question_ = question, state_ = state, t0_ = t0, t1_ = t1;
  }
  void end(const Hit& hit) {
    hit_ = hit;
    question_ = Question::done;
  }
  void next_segment() {
    if (!(t_ < r_.t_exit)) return end({});
    if (stats_.steps >= most_) return end(r_.ended(HitStatus::exhausted, t_));
    ++stats_.steps;
    end_ = std::min(t_ + length_, r_.t_exit);
    ask(Question::bound, State::walking, t_, end_);
  }
  // Finds the crossing between t_, above the ground, and end_, on or below it: by secants that weigh the retained end
  // less and less ("Illinois"), until the clearance is within rounding error or no double is left in between.
  void next_secant() {
    const double t = t_ + (end_ - t_) * (h0_ / (h0_ - h1_));
    if (secants_ == kMostSecants || !(t > t_ && t < end_)) return end(r_.hit(end_));
    ++secants_;
    ++stats_.cell_tests;
    ask(Question::height, State::secants, t, t);
  }

  FunctionRay r_;
  double tolerance_ = 0, shortest_ = 0;
  double t0_ = 0, t1_ = 0;               // range of the query
  double t_ = 0, end_ = 0, length_ = 0;  // the segment
  double h0_ = 0, h1_ = 0;               // clearances at its ends
  std::uint32_t most_ = 0;
  int secants_ = 0, kept_ = 0;
  Question question_ = Question::done;
  State state_ = State::rounding;
  Hit hit_;
  MarchStats stats_;
};

}  // namespace scarp
