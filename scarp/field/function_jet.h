// SPDX-License-Identifier: MIT
// Terrain function instructions on a number with M derivatives (forward-mode differentiation): analytic gradients for
// plain numbers, slope bounds for Taylor models.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>

#include "scarp/field/function_numbers.h"
#include "scarp/field/function_taylor.h"

namespace scarp::function {

template <class T, std::size_t M>
struct Jet {
  T v{};
  std::array<T, M> d{};
};

/// Which of a and b is known to be smaller; over a segment it may be either.
enum class Order { first, second, either };
inline Order order_of(double a, double b) { return a <= b ? Order::first : Order::second; }
template <std::size_t N>
Order order_of(const Taylor<N>& a, const Taylor<N>& b) {
  return a.high <= b.low ? Order::first : b.high <= a.low ? Order::second : Order::either;
}
inline double either(double a, double) { return a; }
template <std::size_t N>
Taylor<N> either(const Taylor<N>& a, const Taylor<N>& b) {
  return from_range<N>(std::min(a.low, b.low), std::max(a.high, b.high), std::max(a.error, b.error));
}
template <class T>
T chosen(Order order, const T& first, const T& second) {
  return order == Order::first ? first : order == Order::second ? second : either(first, second);
}
template <class T>
T constant_of(double k) {
  if constexpr (std::is_same_v<T, double>) {
    return k;
  } else {
    T t{};
    t.mid = t.low = t.high = k;
    return t;
  }
}

template <class T, std::size_t M>
Jet<T, M> combine(double k0, const Jet<T, M>& a, double k1, const Jet<T, M>& b, double k2) {
  Jet<T, M> out{combine(k0, a.v, k1, b.v, k2), {}};
  for (std::size_t i = 0; i < M; ++i) out.d[i] = combine(k0, a.d[i], k1, b.d[i], 0);
  return out;
}
template <class T, std::size_t M>
Jet<T, M> turned_place(double k0, const Jet<T, M>& a, double k1, const Jet<T, M>& b) {
  Jet<T, M> out{turned_place(k0, a.v, k1, b.v), {}};
  for (std::size_t i = 0; i < M; ++i) out.d[i] = combine(k0, a.d[i], k1, b.d[i], 0);
  return out;
}
/// Returns v with the derivatives f1 * a'.
template <class T, std::size_t M>
Jet<T, M> chained(const T& v, const T& f1, const Jet<T, M>& a) {
  Jet<T, M> out{v, {}};
  for (std::size_t i = 0; i < M; ++i) out.d[i] = multiply(f1, a.d[i]);
  return out;
}
/// Returns v with the derivatives fa * a' + fb * b'.
template <class T, std::size_t M>
Jet<T, M> chained(const T& v, const T& fa, const Jet<T, M>& a, const T& fb, const Jet<T, M>& b) {
  Jet<T, M> out{v, {}};
  for (std::size_t i = 0; i < M; ++i) out.d[i] = combine(1, multiply(fa, a.d[i]), 1, multiply(fb, b.d[i]), 0);
  return out;
}
template <class T, std::size_t M>
Jet<T, M> multiply(const Jet<T, M>& a, const Jet<T, M>& b) {
  return chained(multiply(a.v, b.v), b.v, a, a.v, b);
}
template <class T, std::size_t M>
Jet<T, M> square(const Jet<T, M>& a) {
  return chained(square(a.v), combine(2, a.v, 0, a.v, 0), a);
}
template <class T, std::size_t M>
Jet<T, M> absolute(const Jet<T, M>& a) {
  Jet<T, M> out{absolute(a.v), {}};
  const Order order = order_of(constant_of<T>(0), a.v);
  for (std::size_t i = 0; i < M; ++i) out.d[i] = chosen(order, a.d[i], combine(-1, a.d[i], 0, a.d[i], 0));
  return out;
}
template <class T, std::size_t M>
Jet<T, M> clamp(const Jet<T, M>& a, double low, double high) {
  Jet<T, M> out{clamp(a.v, low, high), {}};
  const Order above = order_of(constant_of<T>(low), a.v), below = order_of(a.v, constant_of<T>(high));
  for (std::size_t i = 0; i < M; ++i) {
    out.d[i] = chosen(below, chosen(above, a.d[i], constant_of<T>(0)), constant_of<T>(0));
  }
  return out;
}
template <class T, std::size_t M>
Jet<T, M> sine(const Jet<T, M>& a) {
  return chained(sine(a.v), cosine(a.v), a);
}
template <class T, std::size_t M>
Jet<T, M> minimum(const Jet<T, M>& a, const Jet<T, M>& b) {
  Jet<T, M> out{minimum(a.v, b.v), {}};
  const Order order = order_of(a.v, b.v);
  for (std::size_t i = 0; i < M; ++i) out.d[i] = chosen(order, a.d[i], b.d[i]);
  return out;
}
template <class T, std::size_t M>
Jet<T, M> maximum(const Jet<T, M>& a, const Jet<T, M>& b) {
  Jet<T, M> out{maximum(a.v, b.v), {}};
  const Order order = order_of(b.v, a.v);
  for (std::size_t i = 0; i < M; ++i) out.d[i] = chosen(order, a.d[i], b.d[i]);
  return out;
}
template <class T, std::size_t M>
Jet<T, M> smooth_minimum(const Jet<T, M>& a, const Jet<T, M>& b, double radius) {
  const T share = smooth_share(a.v, b.v, radius);
  return chained(smooth_minimum(a.v, b.v, radius), share, a, combine(-1, share, 0, share, 1), b);
}
template <class T, std::size_t M>
Jet<T, M> reciprocal(const Jet<T, M>& a) {
  const T v = reciprocal(a.v);
  return chained(v, combine(-1, square(v), 0, v, 0), a);
}
template <class T, std::size_t M>
Jet<T, M> terrace(const Jet<T, M>& a, double step, double rise) {
  return chained(terrace(a.v, step, rise), terrace_slope(a.v, step, rise), a);
}
template <class T, std::size_t M>
Jet<T, M> radial(const Jet<T, M>& x, const Jet<T, M>& y, const FunctionInstruction& in) {
  T slope_x{}, slope_y{};
  radial_slope(x.v, y.v, in, slope_x, slope_y);
  return chained(radial(x.v, y.v, in), slope_x, x, slope_y, y);
}
template <class T, std::size_t M>
Jet<T, M> noise_value(const FunctionInstruction& in, const Jet<T, M>& a, const Jet<T, M>& b) {
  T n{}, x{}, y{};
  noise_slope(in, a.v, b.v, n, x, y);
  return chained(n, x, a, y, b);
}
template <class T, std::size_t M>
void noise_slope(const FunctionInstruction& in, const Jet<T, M>& a, const Jet<T, M>& b, Jet<T, M>& n, Jet<T, M>& x,
                 Jet<T, M>& y) {
  T v{}, vx{}, vy{}, xx{}, xy{}, yy{};
  noise_curvature(in, a.v, b.v, v, vx, vy, xx, xy, yy);
  n = chained(v, vx, a, vy, b);
  x = chained(vx, xx, a, xy, b);
  y = chained(vy, xy, a, yy, b);
}

}  // namespace scarp::function
