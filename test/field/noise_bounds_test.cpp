// SPDX-License-Identifier: MIT
// Proves the bounds of noise (NoiseBound): for any lattice values, a derivative of order k in a direction e is at most
// the sum, over the corners, of the length of the factor of the corner's direction g:
//
//   d^k/de^k  w(p) (g . d)  =  g . ( w^(k) d + k w^(k-1) e )        d: from the corner to the point, |g| = |e| = 1
//
// (for value noise: the sum of |w^(k)|). The largest such sum over positions and directions is found by subdivision
// with intervals: a box of positions and directions is done when the upper end of its sum is below the bound; otherwise
// it is halved.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "scarp/field/noise.h"
#include "scarp/field/outward_interval.h"

namespace scarp::test {
namespace {

using boost::numeric::square;

// Unoptimised builds prove looser bounds in the same way, which takes fewer boxes.
#ifdef NDEBUG
constexpr double kLooser = 1;
#else
constexpr double kLooser = 1.25;
#endif
constexpr int kMostBoxes = 20'000'000;

// The fade and its derivatives over a part of [0, 1/2]. There the fade and its first derivative grow, its third falls,
// and its second has its maximum at (3 - sqrt(3)) / 6.
using Derivatives = std::array<Interval, 4>;
Derivatives fade_over(const Interval& t) {
  const auto at = [](double p, int order) {
    const Interval q(p);
    if (order == 0) return q * q * q * (q * (q * 6.0 - 15.0) + 10.0);
    if (order == 1) return 30.0 * square(q) * square(q - 1.0);
    if (order == 2) return 60.0 * q * (q * 2.0 - 1.0) * (q - 1.0);
    return 60.0 * (q * 6.0 * (q - 1.0) + 1.0);
  };
  Derivatives d;
  for (int k = 0; k < 4; ++k) d[static_cast<std::size_t>(k)] = hull(at(t.lower(), k), at(t.upper(), k));
  const Interval top = (3.0 - sqrt(Interval(3.0))) / 6.0;
  if (t.lower() < top.upper() && t.upper() > top.lower()) {
    d[2] = hull(d[2], 60.0 * top * (top * 2.0 - 1.0) * (top - 1.0));
  }
  return d;
}
// The same for 1 - fade.
Derivatives rest_of(const Derivatives& d) { return {1.0 - d[0], -d[1], -d[2], -d[3]}; }

// A unit vector whose angle is in an interval of less than a right angle, with no axis inside, only at its ends.
struct Unit {
  Interval x, y;
};
Unit unit_over(const Interval& angle) {
  // The C library's functions are accurate to 2 units in the last place: 2^-51.
  const auto around = [](double v) { return Interval(v - 0x1p-51, v + 0x1p-51); };
  return {hull(around(std::cos(angle.lower())), around(std::cos(angle.upper()))),
          hull(around(std::sin(angle.lower())), around(std::sin(angle.upper())))};
}

// Derivatives of orders 0 to 3 of u(x) v(y) in the direction e.
Derivatives product_in(const Unit& e, const Derivatives& u, const Derivatives& v) {
  return {u[0] * v[0], e.x * u[1] * v[0] + e.y * u[0] * v[1],
          square(e.x) * u[2] * v[0] + 2.0 * e.x * e.y * u[1] * v[1] + square(e.y) * u[0] * v[2],
          e.x * square(e.x) * u[3] * v[0] + 3.0 * square(e.x) * e.y * u[2] * v[1] +
              3.0 * e.x * square(e.y) * u[1] * v[2] + e.y * square(e.y) * u[0] * v[3]};
}

struct Box {
  Interval x, y, angle;
};

// |w^(k) d + k w^(k-1) e|
Interval weighed(const Derivatives& w, std::size_t k, const Interval& dx, const Interval& dy, const Unit& e) {
  if (k == 0) return abs(w[0]) * sqrt(square(dx) + square(dy));
  const double times = static_cast<double>(k);
  return sqrt(square(w[k] * dx + times * w[k - 1] * e.x) + square(w[k] * dy + times * w[k - 1] * e.y));
}

// On the square lattice. Mirrored and swapped positions have the same sums, so x <= y <= 1/2 covers all positions.
Interval square_sum(NoiseKind kind, std::size_t k, const Box& box) {
  const Unit e = unit_over(box.angle);
  const Derivatives east = fade_over(box.x), west = rest_of(east), north = fade_over(box.y), south = rest_of(north);
  Interval sum(0.0);
  for (int corner = 0; corner < 4; ++corner) {
    const bool is_east = corner % 2 == 1, is_north = corner / 2 == 1;
    const Derivatives w = product_in(e, is_east ? east : west, is_north ? north : south);
    if (kind == NoiseKind::value) {
      sum += abs(w[k]);
    } else {
      sum += kPerlinScale * weighed(w, k, box.x - (is_east ? 1.0 : 0.0), box.y - (is_north ? 1.0 : 0.0), e);
    }
  }
  return sum;
}

// On the triangular lattice of side sqrt(2/3), with m = 1/2 - |d|^2, w = m^4 and s = d . e. Rotated and mirrored
// positions have the same sums, so the positions nearest to the first corner and on one side of its bisector cover all.
Interval simplex_sum(std::size_t k, const Box& box) {
  const Unit e = unit_over(box.angle);
  const Interval side = sqrt(Interval(2.0) / 3.0), height = sqrt(Interval(0.5));
  Interval sum(0.0);
  for (int corner = 0; corner < 3; ++corner) {
    const Interval dx = box.x - (corner == 0 ? Interval(0.0) : corner == 1 ? side : side / 2.0);
    const Interval dy = box.y - (corner == 2 ? height : Interval(0.0));
    const Interval m = max(Interval(0.0), 0.5 - square(dx) - square(dy)), s = dx * e.x + dy * e.y;
    const Derivatives w = {square(square(m)), -8.0 * m * square(m) * s,
                           48.0 * square(m) * square(s) - 8.0 * m * square(m),
                           144.0 * square(m) * s - 192.0 * m * s * square(s)};
    sum += kSimplexScale * weighed(w, k, dx, dy, e);
  }
  return sum;
}

bool counts(NoiseKind kind, const Box& box) {
  if (kind != NoiseKind::simplex) return box.x.lower() <= box.y.upper();
  // y <= x / sqrt(3), the bisector of the corner's 60 degrees; 0.58 is a little more.
  return box.y.lower() <= 0.58 * box.x.upper();
}

// Number of boxes that prove that no sum is above `bound`; 0 if it cannot be proven.
int boxes_to_prove(NoiseKind kind, std::size_t k, double bound) {
  std::vector<Box> open;
  constexpr int kQuadrants = 2;  // e and -e give the same sums
  for (int quadrant = 0; quadrant < kQuadrants; ++quadrant) {
    const double half_pi = std::numbers::pi / 2;
    // Half the side of the triangle, and the height of its centre, slightly enlarged.
    const Interval x = kind == NoiseKind::simplex ? Interval(0.0, 0.4083) : Interval(0.0, 0.5);
    const Interval y = kind == NoiseKind::simplex ? Interval(0.0, 0.2358) : Interval(0.0, 0.5);
    // The height itself (order 0) has no direction.
    const Interval angle =
        k == 0 ? Interval(0.0) : Interval(quadrant * half_pi, (quadrant + 1) * half_pi + (quadrant == 1 ? 1e-15 : 0));
    open.push_back({x, y, angle});
  }
  int boxes = 0;
  while (!open.empty()) {
    Box box = open.back();
    open.pop_back();
    if (!counts(kind, box)) continue;
    if (++boxes > kMostBoxes) return 0;
    const Interval sum = kind == NoiseKind::simplex ? simplex_sum(k, box) : square_sum(kind, k, box);
    if (sum.upper() <= bound) continue;
    if (sum.lower() > bound) return 0;
    Interval* widest = &box.x;
    for (Interval* side : {&box.y, &box.angle}) {
      if (width(*side) > width(*widest)) widest = side;
    }
    const Interval whole = *widest;
    *widest = Interval(whole.lower(), median(whole));
    open.push_back(box);
    *widest = Interval(median(whole), whole.upper());
    open.push_back(box);
  }
  return boxes;
}

// The largest sum at the points of a lattice.
double largest_found(NoiseKind kind, std::size_t k) {
  constexpr int kSide = 20;
  double most = 0;
  for (int i = 0; i <= kSide; ++i) {
    for (int j = 0; j <= kSide; ++j) {
      for (int n = 0; n < 2 * kSide; ++n) {
        const bool simplex = kind == NoiseKind::simplex;
        Box box{Interval((simplex ? 0.4082 : 0.5) * i / kSide), Interval((simplex ? 0.2357 : 0.5) * j / kSide),
                Interval(n * std::numbers::pi / (2 * kSide))};
        if (!counts(kind, box)) continue;
        most = std::max(most, (simplex ? simplex_sum(k, box) : square_sum(kind, k, box)).upper());
      }
    }
  }
  return most;
}

void expect_proven(NoiseKind kind) {
  const NoiseBound bound = bound_of(kind);
  const double bounds[] = {bound.height, bound.slope, bound.curvature, bound.third};
  for (std::size_t k = 0; k < 4; ++k) {
    // Numbers between -1 and 1, blended by weights whose sum is 1.
    if (kind == NoiseKind::value && k == 0) continue;
    const int boxes = boxes_to_prove(kind, k, kLooser * bounds[k]);
    EXPECT_GT(boxes, 0) << "order " << k;
    std::printf("order %d: %d boxes\n", static_cast<int>(k), boxes);
    // Checks that the proof uses the right sum: somewhere the sum nearly reaches the bound.
    EXPECT_GE(largest_found(kind, k), 0.95 * bounds[k]) << "order " << k;
  }
}

TEST(NoiseBounds, HoldForValueNoise) { expect_proven(NoiseKind::value); }
TEST(NoiseBounds, HoldForPerlinNoise) { expect_proven(NoiseKind::perlin); }
TEST(NoiseBounds, HoldForSimplexNoise) { expect_proven(NoiseKind::simplex); }

}  // namespace
}  // namespace scarp::test
