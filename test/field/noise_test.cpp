// SPDX-License-Identifier: MIT
// Noise: the same bits everywhere, derivatives match finite differences, bounds hold for any lattice.
#include "scarp/field/noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace scarp::test {
namespace {

constexpr NoiseKind kKinds[] = {NoiseKind::value, NoiseKind::perlin, NoiseKind::simplex};

class Random {
 public:
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }

 private:
  std::mt19937_64 engine_{7};
};

TEST(Noise, LatticeUsesOnlyIntegers) {
  EXPECT_EQ(lattice_hash(0, 0, 0), 0u);
  EXPECT_EQ(lattice_hash(1, 2, 3), lattice_hash(1, 2 + (std::int64_t{1} << 32), 3));
  EXPECT_NE(lattice_hash(1, 2, 3), lattice_hash(1, 3, 2));
  EXPECT_NE(octave_seed(1, 0), octave_seed(1, 1));
  EXPECT_NE(octave_seed(1, 0), octave_seed(std::uint64_t{1} << 32, 0));
}

TEST(Noise, DerivativesMatchFiniteDifferences) {
  Random random;
  for (const NoiseKind kind : kKinds) {
    for (int i = 0; i < 20000; ++i) {
      const double x = random.between(-50, 50), y = random.between(-50, 50), h = 1e-5;
      const NoiseJet jet = noise_jet(kind, 3, x, y);
      EXPECT_EQ(jet.n, noise(kind, 3, x, y));
      const NoiseJet east = noise_jet(kind, 3, x + h, y), west = noise_jet(kind, 3, x - h, y);
      const NoiseJet north = noise_jet(kind, 3, x, y + h), south = noise_jet(kind, 3, x, y - h);
      // The error of the difference is h^2 / 6 times the third derivative, some 1e-8. For second derivatives across a
      // line of the lattice, where the third derivative of some kinds jumps, it is h / 2 times the third derivative.
      EXPECT_NEAR(jet.x, (east.n - west.n) / (2 * h), 1e-7);
      EXPECT_NEAR(jet.y, (north.n - south.n) / (2 * h), 1e-7);
      EXPECT_NEAR(jet.xx, (east.x - west.x) / (2 * h), 1e-2);
      EXPECT_NEAR(jet.xy, (east.y - west.y) / (2 * h), 1e-2);
      EXPECT_NEAR(jet.yy, (north.y - south.y) / (2 * h), 1e-2);
    }
  }
}

TEST(Noise, StaysWithinItsBounds) {
  Random random;
  for (const NoiseKind kind : kKinds) {
    const NoiseBound bound = bound_of(kind);
    for (int i = 0; i < 300000; ++i) {
      const NoiseJet jet = noise_jet(kind, 4, random.between(-1e5, 1e5), random.between(-1e5, 1e5));
      ASSERT_LE(std::abs(jet.n), bound.height);
      ASSERT_LE(std::hypot(jet.x, jet.y), bound.slope);
      const double middle = 0.5 * (jet.xx + jet.yy), away = std::hypot(0.5 * (jet.xx - jet.yy), jet.xy);
      ASSERT_LE(std::abs(middle) + away, bound.curvature);
    }
  }
}

TEST(Noise, AcceptsAnyPosition) {
  for (const NoiseKind kind : kKinds) {
    for (const double x : {1e300, -1e300, 0x1p53, -0x1p52, std::numeric_limits<double>::infinity(), std::nan("")}) {
      EXPECT_LE(std::abs(noise(kind, 1, x, 0.25)), 4);
      EXPECT_LE(std::abs(noise(kind, 1, 0.25, x)), 4);
    }
  }
}

}  // namespace
}  // namespace scarp::test
