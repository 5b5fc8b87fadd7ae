// SPDX-License-Identifier: MIT
#include "scarp/field/noise.h"

#include <cmath>

namespace scarp {
namespace {

// Twelve directions on the circle: those of the 3-4-5 triangle and of the axes.
constexpr double kDirections[12][2] = {{1, 0},  {0.8, 0.6},   {0.6, 0.8},   {0, 1},  {-0.6, 0.8}, {-0.8, 0.6},
                                       {-1, 0}, {-0.8, -0.6}, {-0.6, -0.8}, {0, -1}, {0.6, -0.8}, {0.8, -0.6}};

constexpr double kSkew = 0.3660254037844386;    // (sqrt(3) - 1) / 2
constexpr double kUnskew = 0.2113248654051871;  // (3 - sqrt(3)) / 6

constexpr std::uint32_t mix(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}

// NaN becomes the lower limit: the result must convert to an integer.
double within_reach(double p) { return p > -kLatticeReach ? (p < kLatticeReach ? p : kLatticeReach) : -kLatticeReach; }

std::int64_t floor_of(double p) {
  const auto i = static_cast<std::int64_t>(p);
  return i - (p < static_cast<double>(i) ? 1 : 0);
}

double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }
double fade_slope(double t) { return 30 * (t * t) * ((t - 1) * (t - 1)); }
double fade_curvature(double t) { return 60 * t * (t * 2 - 1) * (t - 1); }
double lerp(double a, double b, double t) { return a + t * (b - a); }

// The four lattice points around a position, and the position between them.
struct Square {
  std::uint32_t hash[4];  // west and east of the south side, then of the north side
  double dx, dy, u, v;

  Square(std::uint32_t seed, double x, double y) {
    const std::int64_t i = floor_of(x), j = floor_of(y);
    const std::uint32_t west = mix(seed + static_cast<std::uint32_t>(i));
    const std::uint32_t east = mix(seed + static_cast<std::uint32_t>(i + 1));
    const auto south = static_cast<std::uint32_t>(j), north = static_cast<std::uint32_t>(j + 1);
    hash[0] = mix(west + south), hash[1] = mix(east + south);
    hash[2] = mix(west + north), hash[3] = mix(east + north);
    dx = x - static_cast<double>(i), dy = y - static_cast<double>(j);
    u = fade(dx), v = fade(dy);
  }
};

template <bool jet>
NoiseJet value_noise(std::uint32_t seed, double x, double y) {
  const Square s(seed, x, y);
  const double a = lattice_value(s.hash[0]), b = lattice_value(s.hash[1]);
  const double c = lattice_value(s.hash[2]), d = lattice_value(s.hash[3]);
  NoiseJet out;
  out.n = lerp(lerp(a, b, s.u), lerp(c, d, s.u), s.v);
  if constexpr (jet) {
    const double du = fade_slope(s.dx), dv = fade_slope(s.dy);
    const double east = lerp(b - a, d - c, s.v), north = lerp(c - a, d - b, s.u);
    out.x = du * east;
    out.y = dv * north;
    out.xx = fade_curvature(s.dx) * east;
    out.yy = fade_curvature(s.dy) * north;
    out.xy = du * dv * ((d - c) - (b - a));
  }
  return out;
}

template <bool jet>
NoiseJet perlin_noise(std::uint32_t seed, double x, double y) {
  const Square s(seed, x, y);
  const double *a = lattice_direction(s.hash[0]), *b = lattice_direction(s.hash[1]);
  const double *c = lattice_direction(s.hash[2]), *d = lattice_direction(s.hash[3]);
  const double na = a[0] * s.dx + a[1] * s.dy, nb = b[0] * (s.dx - 1) + b[1] * s.dy;
  const double nc = c[0] * s.dx + c[1] * (s.dy - 1), nd = d[0] * (s.dx - 1) + d[1] * (s.dy - 1);
  const double u = s.u, v = s.v;
  NoiseJet out;
  out.n = kPerlinScale * lerp(lerp(na, nb, u), lerp(nc, nd, u), v);
  if constexpr (jet) {
    const double du = kPerlinScale * fade_slope(s.dx), dv = kPerlinScale * fade_slope(s.dy);
    const double east = lerp(nb - na, nd - nc, v), north = lerp(nc - na, nd - nb, u);
    out.x = kPerlinScale * lerp(lerp(a[0], b[0], u), lerp(c[0], d[0], u), v) + du * east;
    out.y = kPerlinScale * lerp(lerp(a[1], b[1], u), lerp(c[1], d[1], u), v) + dv * north;
    out.xx = 2 * du * lerp(b[0] - a[0], d[0] - c[0], v) + kPerlinScale * fade_curvature(s.dx) * east;
    out.yy = 2 * dv * lerp(c[1] - a[1], d[1] - b[1], u) + kPerlinScale * fade_curvature(s.dy) * north;
    out.xy = dv * lerp(c[0] - a[0], d[0] - b[0], u) + du * lerp(b[1] - a[1], d[1] - c[1], v) +
             du * fade_slope(s.dy) * ((nd - nc) - (nb - na));
  }
  return out;
}

template <bool jet>
NoiseJet simplex_noise(std::uint32_t seed, double x, double y) {
  const double skew = (x + y) * kSkew;
  const std::int64_t i = floor_of(x + skew), j = floor_of(y + skew);
  const double unskew = (static_cast<double>(i) + static_cast<double>(j)) * kUnskew;
  const double x0 = x - (static_cast<double>(i) - unskew), y0 = y - (static_cast<double>(j) - unskew);
  const int east = x0 > y0 ? 1 : 0;  // which of the two triangles of the rhombus
  NoiseJet out;
  for (int corner = 0; corner < 3; ++corner) {
    const int di = corner == 0 ? 0 : corner == 2 ? 1 : east, dj = corner == 0 ? 0 : corner == 2 ? 1 : 1 - east;
    const double dx = x0 - di + corner * kUnskew, dy = y0 - dj + corner * kUnskew;
    const double m = 0.5 - dx * dx - dy * dy;
    if (m <= 0) continue;
    const double* g = lattice_direction(lattice_hash(seed, i + di, j + dj));
    const double plane = kSimplexScale * (g[0] * dx + g[1] * dy), m2 = m * m;
    out.n += m2 * m2 * plane;
    if constexpr (jet) {
      const double gx = kSimplexScale * g[0], gy = kSimplexScale * g[1], k = 8 * m2 * m;
      out.x += m2 * m2 * gx - k * dx * plane;
      out.y += m2 * m2 * gy - k * dy * plane;
      out.xx += (48 * m2 * dx * dx - k) * plane - 2 * k * dx * gx;
      out.yy += (48 * m2 * dy * dy - k) * plane - 2 * k * dy * gy;
      out.xy += 48 * m2 * dx * dy * plane - k * (dx * gy + dy * gx);
    }
  }
  return out;
}

template <bool jet>
NoiseJet any_noise(NoiseKind kind, std::uint32_t seed, double x, double y) {
  x = within_reach(x), y = within_reach(y);
  switch (kind) {
    case NoiseKind::value:
      return value_noise<jet>(seed, x, y);
    case NoiseKind::perlin:
      return perlin_noise<jet>(seed, x, y);
    case NoiseKind::simplex:
      break;
  }
  return simplex_noise<jet>(seed, x, y);
}

}  // namespace

NoiseBound bound_of(NoiseKind kind) {
  switch (kind) {
    case NoiseKind::value:
      return {1, 3.77, 14.14, 120.6};
    case NoiseKind::perlin:
      return {1.001, 2.95, 13.2, 138.5};
    case NoiseKind::simplex:
      break;
  }
  return {1, 7.38, 56, 533};
}

double noise_rounding(NoiseKind kind, double x, double y) {
  const NoiseBound bound = bound_of(kind);
  const double reach = kind == NoiseKind::simplex ? 1 + std::abs(x) + std::abs(y) : 1;
  return 0x1p-53 * 72 * (bound.height + bound.slope + bound.curvature) * reach;
}

double noise(NoiseKind kind, std::uint32_t seed, double x, double y) { return any_noise<false>(kind, seed, x, y).n; }

NoiseJet noise_jet(NoiseKind kind, std::uint32_t seed, double x, double y) { return any_noise<true>(kind, seed, x, y); }

std::uint32_t lattice_hash(std::uint32_t seed, std::int64_t i, std::int64_t j) {
  return mix(mix(seed + static_cast<std::uint32_t>(i)) + static_cast<std::uint32_t>(j));
}

double lattice_value(std::uint32_t hash) { return static_cast<double>(hash) * 0x1p-31 - 1; }

const double* lattice_direction(std::uint32_t hash) {
  return kDirections[(static_cast<std::uint64_t>(hash) * 12) >> 32];
}

std::uint32_t octave_seed(std::uint64_t seed, std::uint32_t octave) {
  return mix(mix(mix(static_cast<std::uint32_t>(seed) + 0x9e3779b9u) + static_cast<std::uint32_t>(seed >> 32)) +
             octave);
}

}  // namespace scarp
