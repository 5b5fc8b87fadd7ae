// SPDX-License-Identifier: MIT
#include "scarp/render/sample_pattern.h"

#include <array>
#include <bit>
#include <utility>

namespace scarp {
namespace {

// Both coordinates of a pixel in 16 base-4 digits.
constexpr int kDigits = 16;
constexpr double kUnit = 1.0 / 4294967296.0;

// A bijection of 32 bits in which every bit of the result depends on all (Wellons 2018, "lowbias32").
std::uint32_t mix(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7feb352dU;
  x = (x ^ (x >> 15)) * 0x846ca68bU;
  return x ^ (x >> 16);
}
std::uint32_t mix(std::uint32_t x, std::uint32_t y) { return mix(x ^ mix(y + 0x9e3779b9U)); }

std::uint32_t reverse_bits(std::uint32_t x) {
  x = ((x & 0x55555555U) << 1) | ((x >> 1) & 0x55555555U);
  x = ((x & 0x33333333U) << 2) | ((x >> 2) & 0x33333333U);
  x = ((x & 0x0f0f0f0fU) << 4) | ((x >> 4) & 0x0f0f0f0fU);
  x = ((x & 0x00ff00ffU) << 8) | ((x >> 8) & 0x00ff00ffU);
  return (x << 16) | (x >> 16);
}

// Flips each bit or not as a function of all bits above it and of the seed: on the reversed number, where "above" is
// below, sums and products with constants do just that.
std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
  x = reverse_bits(x);
  x ^= x * 0x3d20adeaU;
  x += seed;
  x *= (seed >> 16) | 1U;
  x ^= x * 0x05526c56U;
  x ^= x * 0x53a22864U;
  return reverse_bits(x);
}

// The second dimension's generator matrix is Pascal's triangle modulo 2, column by column.
std::uint32_t sobol_y(std::uint32_t index) {
  std::uint32_t y = 0;
  for (std::uint32_t column = 1U << 31; index != 0; index >>= 1, column ^= column >> 1) {
    if (index & 1U) y ^= column;
  }
  return y;
}

// Where `digit` goes in a permutation of 0..3 that `random` selects.
std::uint32_t permuted(std::uint32_t digit, std::uint32_t random) {
  std::array<std::uint32_t, 4> to{0, 1, 2, 3};
  for (std::uint32_t i = 3; i > 0; --i, random >>= 8) std::swap(to[i], to[(random & 0xffU) % (i + 1)]);
  return to[digit];
}

}  // namespace

dvec2 PixelPoints::operator[](std::uint32_t i) const {
  // 64 bits: a shift by all 32 of them, for a pixel of one point, must give nothing.
  const int unused = 32 - index_bits_;
  const auto shuffled = owen_scramble(static_cast<std::uint32_t>(std::uint64_t{i} << unused), seed_order_);
  i = static_cast<std::uint32_t>(std::uint64_t{shuffled} >> unused);
  // Sobol's points are linear in the bits of their index over xor, so a block's first point is computed only once.
  const std::uint32_t x = x_ ^ reverse_bits(i), y = y_ ^ sobol_y(i);
  // Middles of 2^-32: no point is on the square's rim, which is where hemispheres touch the ground.
  return {(owen_scramble(x, seed_x_) + 0.5) * kUnit, (owen_scramble(y, seed_y_) + 0.5) * kUnit};
}

SamplePattern::SamplePattern(std::uint32_t seed, std::uint32_t points_per_pixel)
    : seed_(seed), index_bits_(std::bit_width(points_per_pixel - 1)) {}

PixelPoints SamplePattern::pixel(int x, int y, std::uint32_t purpose) const {
  const std::uint32_t random = mix(purpose, seed_);
  // A digit's permutation depends on the digits above it.
  std::uint64_t place = 0;
  std::uint32_t above = 0;
  for (int digit = kDigits - 1; digit >= 0; --digit) {
    const std::uint32_t quarter =
        (static_cast<std::uint32_t>(y) >> digit & 1U) << 1 | (static_cast<std::uint32_t>(x) >> digit & 1U);
    place = place << 2 | permuted(quarter, mix(above ^ mix(random, static_cast<std::uint32_t>(digit))));
    above = above << 2 | quarter;
  }
  // Beyond 2^32 points the sequence repeats: so do parts of large pictures that are far from one another.
  const auto first = static_cast<std::uint32_t>(place << index_bits_);
  PixelPoints points;
  points.x_ = reverse_bits(first);
  points.y_ = sobol_y(first);
  points.index_bits_ = index_bits_;
  points.seed_order_ = mix(mix(random, 3), static_cast<std::uint32_t>(place));
  points.seed_x_ = mix(random, 1);
  points.seed_y_ = mix(random, 2);
  return points;
}

}  // namespace scarp
