// SPDX-License-Identifier: MIT
// Intervals of doubles that include rounding errors. For proofs, not for speed.
#pragma once

#include <algorithm>
#include <boost/numeric/interval.hpp>
#include <cmath>

namespace scarp {

// Rounds outwards by widening each result, without changing the processor's rounding mode: 2^-52 of a result is at
// least one unit in its last place, and 2^-1000 exceeds any subnormal.
struct Outwards : boost::numeric::interval_lib::rounded_arith_exact<double> {
  using unprotected_rounding = Outwards;
  static double down(double x) { return x - (std::abs(x) * 0x1p-52 + 0x1p-1000); }
  static double up(double x) { return x + (std::abs(x) * 0x1p-52 + 0x1p-1000); }
  template <class T>
  double conv_down(const T& x) {
    return down(static_cast<double>(x));
  }
  template <class T>
  double conv_up(const T& x) {
    return up(static_cast<double>(x));
  }
  double add_down(double a, double b) { return down(a + b); }
  double add_up(double a, double b) { return up(a + b); }
  double sub_down(double a, double b) { return down(a - b); }
  double sub_up(double a, double b) { return up(a - b); }
  double mul_down(double a, double b) { return down(a * b); }
  double mul_up(double a, double b) { return up(a * b); }
  double div_down(double a, double b) { return down(a / b); }
  double div_up(double a, double b) { return up(a / b); }
  double sqrt_down(double a) { return std::max(0.0, down(std::sqrt(a))); }
  double sqrt_up(double a) { return up(std::sqrt(a)); }
};
using OutwardPolicies =
    boost::numeric::interval_lib::policies<boost::numeric::interval_lib::save_state_nothing<Outwards>,
                                           boost::numeric::interval_lib::checking_base<double>>;
using Interval = boost::numeric::interval<double, OutwardPolicies>;

}  // namespace scarp
