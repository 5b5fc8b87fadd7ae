// SPDX-License-Identifier: MIT
#include "march/sampling_easy_judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scarp/march/function/function_ray.h"
#include "scarp/march/sampling/shrink_factor.h"

namespace scarp::test {
namespace {

// Rounding unit of floats, 2^-24, including products of roundings: a number has at most 2^10 of them.
constexpr double kUnit = 0x1p-24 * (1 + 0x1p-10);
// Roundings, in units: of the length of the direction and its inverse; of lipschitz' factor.
constexpr double kLength = 2.5, kInverse = kLength + 1, kShrink = kLength + 3 + 2;

// A bound above this fraction of the range decides nothing: on steep ground, where the rule steps back and forth, small
// differences grow.
constexpr double kLost = 0x1p-10;

constexpr int kMiss = 0, kHit = 1, kBelow = 2, kExhausted = 3;

// Values at a time, and a bound on the difference of the shader's values if its time differs by `off`.
struct Point {
  double h, off;     // height above the ground, in metres
  double low, high;  // of dh/dt around the time
  double steepest() const { return std::max(std::abs(low), std::abs(high)); }
};

class Follower {
 public:
  Follower(const MarchSettings& settings, const HeightFunction& function, const Ray& ray)
      : settings_(settings), function_(function), ray_(ray), speed_(length(ray.direction)) {}

  bool may_hit_at(std::string_view march, double t) const;
  EasyAnswers naive();
  EasyAnswers relaxed();
  EasyAnswers lipschitz();
  EasyAnswers fixed_step();

 private:
  // The slopes are those of the ground around the position, or of the steepest ground.
  Point at(double t, double off, bool around) const {
    const dvec3 d = ray_.direction, p = ray_.at(t);
    // origin + t * direction: the product and the sum, on each axis.
    const auto rounded = [&](int axis) {
      return kUnit * (2 * std::abs((t + off) * d[axis]) + std::abs(ray_.origin[axis]));
    };
    const double x = rounded(0), y = rounded(1), z = rounded(2);
    Point point{};
    FunctionBound ground = function_.bound_everywhere();
    if (around) {
      const double wide = std::abs(d.x) * off + x, deep = std::abs(d.y) * off + y;
      ground = function_.bound({p.x - wide, p.x + wide, p.y - deep, p.y + deep});
      const dvec2 slope = function_.slope_along(dvec2(ray_.origin), dvec2(d), std::max(0.0, t - off), t + off);
      point.low = d.z - slope.y;
      point.high = d.z - slope.x;
    } else {
      const double rise = ground.slope * std::hypot(d.x, d.y);
      point.low = d.z - rise;
      point.high = d.z + rise;
    }
    const double height = function_.value(p.x, p.y), by_time = point.steepest() * off;
    point.h = p.z - height;
    // The ground at the displaced position, rounded, and the difference.
    point.off = by_time + z + ground.slope * std::hypot(x, y) + 2 * ground.rounding +
                kUnit * (std::abs(height) + by_time + std::abs(d.z) * off) + kUnit * (std::abs(point.h) + by_time);
    return point;
  }
  // Bound of a product with `share` that is rounded this often.
  static double scaled(const Point& point, double share, double roundings) {
    return share * point.off + roundings * kUnit * share * (std::abs(point.h) + point.off);
  }
  bool surely_over(double t, double off) const { return t - off > ray_.t_max; }
  bool maybe_over(double t, double off) const { return t + off > ray_.t_max; }

  // Records an answer that the shader may give, and the answer of the rule in double if it is the first one.
  void may(int status, double t, double off) { answers_.allowed.push_back({status, t, off}); }
  void does(int status, double t, double off = 0) {
    if (decided_) return;
    decided_ = true;
    answers_.exact = {status, t, off};
  }
  // Whether the march is over before its next point: out of range, or out of steps.
  bool ends(int step, int max_steps, double t, double off) {
    if (t > ray_.t_max) does(kMiss, t);
    if (maybe_over(t, off)) may(kMiss, t, 0);
    if (surely_over(t, off)) return true;
    if (off > kLost * ray_.t_max) {
      answers_.lost = true;
      return true;
    }
    if (step < max_steps) return false;
    does(kExhausted, t, off);
    may(kExhausted, t, off);
    return true;
  }
  // Records `status` where `value`, off by at most `off_value`, is below 0. Returns whether it surely is.
  bool stops(double value, double off_value, int status, double t, double off) {
    if (value < 0) does(status, t, off);
    if (value < off_value) may(status, t, off);
    return value < -off_value;
  }

  const MarchSettings& settings_;
  const HeightFunction& function_;
  const Ray& ray_;
  double speed_;
  bool decided_ = false;
  EasyAnswers answers_;
};

bool Follower::may_hit_at(std::string_view march, double t) const {
  const Point point = at(t, 0, true);
  if (march == "lipschitz") {
    const double shrink = 1 / (speed_ * std::hypot(1.0, function_.bound_everywhere().slope));
    return point.h * shrink - scaled(point, shrink, kShrink + 1) <= (1 + 2 * kUnit) * settings_.lipschitz.tolerance * t;
  }
  const bool naive = march == "naive";
  const double tolerance = naive ? settings_.naive.tolerance : settings_.relaxed.tolerance;
  const double h = (naive ? point.h : std::abs(point.h)) / speed_;
  return h - scaled(point, 1 / speed_, kInverse + 1) <= (1 + 2 * kUnit) * tolerance * t;
}

EasyAnswers Follower::naive() {
  const NaiveSettings& s = settings_.naive;
  const double per_metre = 1 / speed_, least = s.min_step * ray_.t_max;
  double t = 0, off = 0;
  for (int i = 0; !ends(i, s.max_steps, t, off); ++i) {
    const Point point = at(t, off, true);
    const double h = point.h * per_metre, h_off = scaled(point, per_metre, kInverse + 1);
    const double limit = s.tolerance * t, limit_off = s.tolerance * (off + 2 * kUnit * (t + off));
    if (stops(h - limit, h_off + limit_off, kHit, t, off)) break;
    const double by_height = s.step_factor * std::abs(h);
    const double by_height_off = s.step_factor * (h_off + 2 * kUnit * (std::abs(h) + h_off));
    const double least_off = 2 * kUnit * least, step = std::max(by_height, least);
    // How a difference of the time grows: by the slopes of t + step_factor |h|, or not at all by the minimum step.
    const double low = s.step_factor * point.low * per_metre, high = s.step_factor * point.high * per_metre;
    double growth = 0, rounding = 0;
    if (by_height + by_height_off >= least - least_off) {
      if (h + h_off > 0) growth = std::max({growth, std::abs(1 + low), std::abs(1 + high)});
      if (h - h_off < 0) growth = std::max({growth, std::abs(1 - low), std::abs(1 - high)});
      // The part of the bound that does not come from the time.
      rounding = by_height_off - s.step_factor * per_metre * point.steepest() * off;
    }
    if (by_height - by_height_off <= least + least_off) {
      growth = std::max(growth, 1.0);
      rounding = std::max(rounding, least_off);
    }
    t += step;
    off = growth * off + rounding;
    off += kUnit * (t + off);
  }
  return answers_;
}

EasyAnswers Follower::relaxed() {
  const RelaxedSettings& s = settings_.relaxed;
  const double per_metre = 1 / speed_;
  double t = 0, off = 0;
  for (int i = 0; !ends(i, s.max_steps, t, off); ++i) {
    const Point point = at(t, off, true);
    const double h = point.h * per_metre, h_off = scaled(point, per_metre, kInverse + 1);
    const double limit = s.tolerance * t, limit_off = s.tolerance * (off + 2 * kUnit * (t + off));
    if (stops(std::abs(h) - limit, h_off + limit_off, kHit, t, off)) break;
    if (i == 0 && stops(h, h_off, kBelow, t, off)) break;
    const double low = s.step_factor * point.low * per_metre, high = s.step_factor * point.high * per_metre;
    const double growth = std::max(std::abs(1 + low), std::abs(1 + high));
    const double rounding =
        s.step_factor * (h_off - per_metre * point.steepest() * off + 2 * kUnit * (std::abs(h) + h_off));
    t = std::max(t + s.step_factor * h, 0.0);
    off = growth * off + rounding;
    off += kUnit * (t + off);
  }
  return answers_;
}

EasyAnswers Follower::lipschitz() {
  const LipschitzSettings& s = settings_.lipschitz;
  const ShrinkFactor factor = shrink_factor(s, function_.bound_everywhere().slope, 0x1p-50);
  const double shrink = factor.factor / speed_;
  // The CPU subtracts its rounding, the shader does not.
  const double rounding = FunctionRay(function_, ray_, FunctionUse::march).rounding();
  double t = 0, off = 0;
  for (int i = 0; !ends(i, s.max_steps, t, off); ++i) {
    const Point point = at(t, off, true);
    if (stops(point.h + rounding, point.off + rounding, i == 0 ? kBelow : kExhausted, t, off)) break;
    const double f = (point.h - rounding) * factor.factor / speed_;
    const double f_off = scaled(point, shrink, kShrink + 1) + 2 * shrink * rounding;
    const double limit = s.tolerance * t, limit_off = s.tolerance * (off + 2 * kUnit * (t + off));
    if (stops(f - limit, f_off + limit_off, kHit, t, off)) break;
    const double growth = std::max(std::abs(1 + shrink * point.low), std::abs(1 + shrink * point.high));
    const double others = f_off - shrink * point.steepest() * off;
    t += f;
    off = growth * off + others;
    off += kUnit * (t + off);
  }
  return answers_;
}

EasyAnswers Follower::fixed_step() {
  const FixedStepSettings& s = settings_.fixed_step;
  const double dt = settings_.function.step / speed_;
  double t_before = 0, h_before = 0, off_before = 0, h_off_before = 0;
  bool may_be_above = false, is_above = false;  // the last sample, in the shader and in double
  bool may_begin_below = false, may_not = true, begins_below = false;
  double t = 0, off = 0;
  for (int i = 0; i < s.max_steps; ++i) {
    // The count is exact; the step has its roundings, and the product.
    const double counted = i * dt, counted_off = (kInverse + 2) * kUnit * counted;
    t = std::min(counted, ray_.t_max);
    off = counted - counted_off > ray_.t_max ? 0 : counted_off;
    // The steepest ground proves most samples to be above it.
    Point point = at(t, off, false);
    if (point.h <= point.off) {
      point = at(t, off, true);
      if (may_be_above) h_off_before = std::min(h_off_before, at(t_before, off_before, true).off);
    }
    const double h = point.h;
    if (h <= point.off && may_be_above && h_before > -h_off_before) {
      // The straight line: D = h_before - h, and both heights are off by at most `both`.
      const double both = std::max(h_off_before, point.off), fall = h_before - h, span = t - t_before;
      double hit_off = span + std::max(off, off_before);
      if (fall > 2 * both)
        hit_off = std::max(off, off_before) + (span + off + off_before) * (both / (fall - 2 * both) + 4 * kUnit) +
                  2 * kUnit * (t + off);
      const double met = fall > 0 ? t_before + span * std::clamp(h_before / fall, 0.0, 1.0) : t;
      if (h <= 0 && is_above) does(kHit, met, hit_off);
      may(kHit, met, hit_off);
      if (h < -point.off && h_before > h_off_before) return answers_;
    }
    if (i == 0) {
      if (h == 0) does(kHit, t, off);
      if (std::abs(h) <= point.off) may(kHit, t, off);
      begins_below = h < 0;
      may_begin_below = h < point.off;
      may_not = h > -point.off;
    }
    // The last point is at t_max itself.
    if (counted >= ray_.t_max) does(begins_below ? kBelow : kMiss, t);
    if (counted + counted_off >= ray_.t_max) {
      if (may_begin_below) may(kBelow, t, off);
      if (may_not) may(kMiss, t, off);
      if (counted - counted_off >= ray_.t_max) return answers_;
    }
    is_above = h > 0;
    may_be_above = h > -point.off;
    t_before = t, off_before = off;
    h_before = h, h_off_before = point.off;
  }
  does(kExhausted, t, off);
  may(kExhausted, t, off);
  return answers_;
}

}  // namespace

std::string EasyAnswers::objection(int status, double t) const {
  if (lost) return {};
  std::string all;
  for (const TimedStatus& answer : allowed) {
    const bool timed = status == kHit || status == kExhausted;
    if (answer.status == status && (!timed || std::abs(t - answer.t) <= answer.off)) return {};
    all += fmt::format("{}{} at t = {} +- {:.2g}", all.empty() ? "" : ", or ", answer.status, answer.t, answer.off);
  }
  return fmt::format("status {} at t = {}, not {}", status, t, all);
}

bool may_hit_at(std::string_view march, const MarchSettings& settings, const HeightFunction& function, const Ray& ray,
                double t) {
  return Follower(settings, function, ray).may_hit_at(march, t);
}

EasyAnswers easy_answers(std::string_view march, const MarchSettings& settings, const HeightFunction& function,
                         const Ray& ray) {
  Follower follower(settings, function, ray);
  if (march == "naive") return follower.naive();
  if (march == "relaxed") return follower.relaxed();
  if (march == "lipschitz") return follower.lipschitz();
  return follower.fixed_step();
}

}  // namespace scarp::test
