// SPDX-License-Identifier: MIT
// Noise in the plane: value, Perlin and simplex noise on a lattice of side 1, with gradient and second derivatives.
//
//   value    a number at each lattice point, blended by the quintic fade
//   perlin   a direction at each lattice point, its plane blended by the fade; 0 at the points
//   simplex  the same on triangles: each point's plane fades out with distance; at most three overlap
//
// Bit-identical on all machines: the lattice is hashed in 32-bit integers (modulo 2^32 in each coordinate); everything
// else is + - * of doubles and comparisons.
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

/// Bounds that hold everywhere, for every seed.
struct NoiseBound {
  double height;     ///< maximum of |n|
  double slope;      ///< maximum length of the gradient
  double curvature;  ///< maximum of |second derivative| in any direction
  double third;      ///< maximum of |third derivative| in any direction
};

/// Coordinates are clamped to this, in lattice units: doubles beyond are integers.
inline constexpr double kLatticeReach = 0x1p52;

/// Returns the bounds of a kind. For any lattice, a derivative is at most the sum, over the lattice's corners, of the
/// weight's length. The maximum of these sums was found by a search over positions and directions on a grid of 400 x
/// 400 x 180, and rounded up by 0.5 % to 1 %.
NoiseBound bound_of(NoiseKind kind);

/// Returns a bound of the rounding error of the noise, or of one of its derivatives, as computed at (x, y): fewer than
/// 64 operations on numbers no larger than the sum of the bounds. Positions in a square are exact; positions in a
/// triangle have the rounding error of its corner, 3 u (|x| + |y|) with u = 2^-53.
double noise_rounding(NoiseKind kind, double x, double y);

/// Returns noise at a finite position, about -1 to 1.
double noise(NoiseKind kind, std::uint32_t seed, double x, double y);
/// Returns noise with its derivatives. The second derivatives of `perlin` and `value` are continuous.
NoiseJet noise_jet(NoiseKind kind, std::uint32_t seed, double x, double y);

/// The lattice, for independent implementations (the test oracle, other back ends): a hash of a lattice point, and the
/// two values derived from it.
std::uint32_t lattice_hash(std::uint32_t seed, std::int64_t i, std::int64_t j);
double lattice_value(std::uint32_t hash);                             ///< in [-1, 1), a multiple of 2^-31
const double* lattice_direction(std::uint32_t hash);                  ///< x and y, one of 12 of length 1
std::uint32_t octave_seed(std::uint64_t seed, std::uint32_t octave);  ///< mixes the two

/// Scales that map the extremes to 1; unscaled, they are sqrt(1/2) for Perlin noise and 0.01008 for simplex noise.
inline constexpr double kPerlinScale = 1.4142135623730951;
inline constexpr double kSimplexScale = 99;

}  // namespace scarp
