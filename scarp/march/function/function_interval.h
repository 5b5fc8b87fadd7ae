// SPDX-License-Identifier: MIT
// Positions along a ray in sound intervals, and bisection: shared by the references for functions and shapes.
#pragma once

#include <vector>

#include "scarp/field/outward_interval.h"
#include "scarp/march/function/function_exhaustive.h"

namespace scarp::judge {

using boost::numeric::square;
using scarp::Interval;

// A position along the ray: base + rate * t + more. Rotating and scaling it loses nothing; a warp goes into `more`.
struct Position {
  Interval base, rate, more;
  Interval over(const Interval& t) const { return base + rate * t + more; }
};
inline Position operator+(const Position& a, const Position& b) {
  return {a.base + b.base, a.rate + b.rate, a.more + b.more};
}
inline Position operator*(const Interval& k, const Position& a) { return {k * a.base, k * a.rate, k * a.more}; }

/// Finds the first point between t_enter and t_exit where `clearance`, evaluated over intervals of t, is not positive:
/// halves intervals down to 1e-9 of the whole, leftmost first.
template <class Clearance>
FunctionJudgement first_crossing(double t_enter, double t_exit, double t_max, int most_evaluations,
                                 const Clearance& clearance) {
  FunctionJudgement judgement{FunctionVerdict::clear, t_max, t_max};
  if (!(t_enter <= t_exit)) return judgement;
  const double shortest = 1e-9 * (t_exit - t_enter);
  // Intervals yet to be judged, leftmost last.
  std::vector<Interval> open{Interval(t_enter, t_exit)};
  while (!open.empty()) {
    const Interval t = open.back();
    open.pop_back();
    const bool used_up = --most_evaluations < 0;
    const Interval h = clearance(t);
    if (h.lower() > 0 && !used_up) continue;
    const bool clear_so_far = judgement.verdict == FunctionVerdict::clear;
    if (width(t) <= shortest || used_up) {
      if (clear_so_far) judgement.clear_until = t.lower();
      judgement.verdict = FunctionVerdict::undecided;
      judgement.crossed_by = t.upper();
      if (used_up) return judgement;
      if (clearance(Interval(t.upper())).upper() < 0) {
        judgement.verdict = FunctionVerdict::crossing;
        return judgement;
      }
      continue;
    }
    const double middle = median(t);
    open.emplace_back(middle, t.upper());
    open.emplace_back(t.lower(), middle);
  }
  return judgement;
}

/// Height of a function over an interval of t.
Interval height_over(const Function& function, FunctionUse use, const Position& x, const Position& y,
                     const Interval& t);

}  // namespace scarp::judge
