// SPDX-License-Identifier: MIT
#include "scarp/analysis/crossing_sign.h"

#include <limits>

namespace scarp {
namespace {

// A number as a sum of doubles that do not overlap, smallest first.
class Expansion {
 public:
  void add(double b) {
    double q = b;
    for (std::size_t i = 0; i < size_; ++i) {
      const double a = parts_[i], sum = q + a, back = sum - q;
      parts_[i] = (q - (sum - back)) + (a - back);
      q = sum;
    }
    parts_[size_++] = q;
  }
  // The product and its rounding error, which fma() yields exactly.
  void add_product(double a, double b) {
    const double product = a * b;
    add(std::fma(a, b, -product));
    add(product);
  }
  // The largest part that is not zero has the sign of the sum.
  int sign() const {
    for (std::size_t i = size_; i-- > 0;)
      if (parts_[i] != 0) return parts_[i] > 0 ? 1 : -1;
    return 0;
  }

 private:
  std::array<double, 8> parts_{};  // two for each of four products
  std::size_t size_ = 0;
};

}  // namespace

int exact_sign(const CrossingTerms& t) {
  Expansion sum;
  sum.add_product(t.g0, t.w0);
  sum.add_product(t.g1, t.w1);
  sum.add_product(-t.e, t.v0);
  sum.add_product(-t.r, t.v1);
  return sum.sign();
}

namespace {

// least_clearing() in long doubles. Returns false if their rounding may change the answer: always where they are
// doubles.
bool quick_clearing(const CrossingTerms& t, double& least) {
  // Each difference, product, sum and quotient is off by half a unit; terms are relative to e, where they are small.
  constexpr long double kRounding = 4 * std::numeric_limits<long double>::epsilon();
  if (t.w0 + t.w1 != t.v0 + t.v1) return false;
  const long double a = (static_cast<long double>(t.g0) - t.e) * t.w0,
                    b = (static_cast<long double>(t.g1) - t.e) * t.w1;
  const long double r = t.e + (a + b) / t.v1;
  const long double error = kRounding * ((std::abs(a) + std::abs(b)) / t.v1 + std::abs(r));
  least = static_cast<double>(r);
  if (least < r) least = std::nextafter(least, std::numeric_limits<double>::infinity());
  return r + error <= least && r - error > std::nextafter(least, -std::numeric_limits<double>::infinity());
}

}  // namespace

double least_clearing(CrossingTerms t) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (double least; quick_clearing(t, least)) return least;
  t.r = (t.g0 * t.w0 + t.g1 * t.w1 - t.e * t.v0) / t.v1;
  // The quotient is a few units off; cancellation can make it more, so steps double until they bracket the answer.
  if (sign_of(t) > 0) {
    double low = t.r, step = std::nextafter(low, kInfinity) - low;
    while (t.r = low + step, sign_of(t) > 0) low = t.r, step *= 2;
    double high = t.r;
    while (std::nextafter(low, kInfinity) < high) {
      t.r = low + (high - low) / 2;
      (sign_of(t) > 0 ? low : high) = t.r;
    }
    return high;
  }
  double high = t.r, step = high - std::nextafter(high, -kInfinity);
  while (t.r = high - step, sign_of(t) <= 0) high = t.r, step *= 2;
  double low = t.r;
  while (std::nextafter(low, kInfinity) < high) {
    t.r = low + (high - low) / 2;
    (sign_of(t) > 0 ? low : high) = t.r;
  }
  return high;
}

}  // namespace scarp
