// SPDX-License-Identifier: MIT
// Noise in the plane: value, Perlin and simplex noise on a lattice of side 1, with gradient and second derivatives.
//
//   value    a number at each lattice point, blended by the quintic fade
//   perlin   a direction at each lattice point, its plane blended by the fade; 0 at the points
//   simplex  the same on triangles: each point's plane fades out with distance, three of them meet anywhere
//
// Bits: the lattice is hashed in 32-bit integers (modulo 2^32 in each coordinate), and all else is + - * of doubles and
// comparisons, so that every machine gets the same heights.
//
// Source: K. Perlin, "Improving noise", SIGGRAPH 2002, and "Noise hardware", SIGGRAPH course 2001 (simplex); the hash
// is "lowbias32" of C. Wellons, "Prospecting for hash functions", 2018.
#pragma once

#include <cstdint>

namespace scarp {

enum class NoiseKind : std::uint8_t { value, perlin, simplex };

/// Noise, its gradient and its second derivatives at a point.
struct NoiseJet {
  double n = 0;
  double x = 0, y = 0;
  double xx = 0, xy = 0, yy = 0;
};

/// What holds everywhere, for every seed.
struct NoiseBound {
  double height;     ///< |n| is at most this
  double slope;      ///< the gradient's length is at most this
  double curvature;  ///< |second derivative| in any direction is at most this
  double third;      ///< |third derivative| in any direction is at most this
};

/// Positions beyond this are taken as this, in lattice units: from there on doubles are whole numbers.
inline constexpr double kLatticeReach = 0x1p52;

/// The bounds of a kind: whatever the lattice holds, a derivative is at most the sum over its corners of the length
/// that the corner's direction (or number) is weighed with. The largest such sums over position and direction were
/// found on a grid of 400 x 400 x 180, and are rounded up by half a percent to one percent.
NoiseBound bound_of(NoiseKind kind);

/// How far rounding takes the noise, or one of its derivatives, as computed at (x, y) from its true value there: fewer
/// than 64 operations on numbers no larger than the sum of the bounds. The position in a square is exact; that in a
/// triangle is off by rounding of the corner's place, 3 u (|x| + |y|) with u = 2^-53.
double noise_rounding(NoiseKind kind, double x, double y);

/// Noise at a finite position, about -1 to 1.
double noise(NoiseKind kind, std::uint32_t seed, double x, double y);
/// The same number with its derivatives; the second derivatives of `perlin` and `value` are continuous, too.
NoiseJet noise_jet(NoiseKind kind, std::uint32_t seed, double x, double y);

/// The lattice's integers, for those who write the noise anew (the oracle, other back ends): a hash of a lattice point,
/// and the two things that noise makes of it.
std::uint32_t lattice_hash(std::uint32_t seed, std::int64_t i, std::int64_t j);
double lattice_value(std::uint32_t hash);                             ///< in [-1, 1), a multiple of 2^-31
const double* lattice_direction(std::uint32_t hash);                  ///< x and y, one of 12 of length 1
std::uint32_t octave_seed(std::uint64_t seed, std::uint32_t octave);  ///< mixes both

/// What brings the extremes to 1: of Perlin noise sqrt(1/2), of simplex noise 0.01008.
inline constexpr double kPerlinScale = 1.4142135623730951;
inline constexpr double kSimplexScale = 99;

}  // namespace scarp
