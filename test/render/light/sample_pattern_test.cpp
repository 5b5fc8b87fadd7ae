// SPDX-License-Identifier: MIT
#include "scarp/render/light/sample_pattern.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace scarp {
namespace {

// Whether 2^bits points have exactly one in every elementary interval, for all shapes of area 2^-bits.
testing::AssertionResult is_net(const std::vector<dvec2>& points, int bits) {
  for (int across = 0; across <= bits; ++across) {
    const auto cols = static_cast<std::size_t>(1) << across, rows = static_cast<std::size_t>(1) << (bits - across);
    std::vector<int> inside(cols * rows);
    for (const dvec2& p : points) {
      if (!(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1)) return testing::AssertionFailure() << p.x << ", " << p.y;
      ++inside[static_cast<std::size_t>(p.y * static_cast<double>(rows)) * cols +
               static_cast<std::size_t>(p.x * static_cast<double>(cols))];
    }
    for (const int count : inside) {
      if (count != 1) return testing::AssertionFailure() << count << " points in one of " << cols << " x " << rows;
    }
  }
  return testing::AssertionSuccess();
}

std::vector<dvec2> points_of(const PixelPoints& pixel, std::uint32_t first, std::uint32_t count) {
  std::vector<dvec2> points;
  for (std::uint32_t i = first; i < first + count; ++i) points.push_back(pixel[i]);
  return points;
}

TEST(SamplePattern, EveryRangeOfAPixelIsStratified) {
  const SamplePattern pattern(3, 256);
  for (const auto& [x, y] : {std::pair(0, 0), {1, 0}, {1599, 899}, {65535, 65535}}) {
    for (const std::uint32_t purpose : {0u, 1u, 7u}) {
      const PixelPoints pixel = pattern.pixel(x, y, purpose);
      for (int bits = 0; bits <= 8; ++bits) {
        const std::uint32_t count = 1u << bits;
        for (std::uint32_t first = 0; first + count <= 256; first += count) {
          ASSERT_TRUE(is_net(points_of(pixel, first, count), bits))
              << x << ", " << y << ": " << first << " + " << count;
        }
      }
    }
  }
}

TEST(SamplePattern, NeighbouringPixelsComplementEachOther) {
  const SamplePattern pattern(3, 16);
  for (const int side : {2, 4, 8}) {
    for (const auto& [x0, y0] : {std::pair(0, 0), {side, 0}, {7 * side, 12 * side}}) {
      std::vector<dvec2> points;
      for (int y = y0; y < y0 + side; ++y) {
        for (int x = x0; x < x0 + side; ++x) {
          for (const dvec2& p : points_of(pattern.pixel(x, y, 0), 0, 16)) points.push_back(p);
        }
      }
      int bits = 4;
      for (int s = side; s > 1; s /= 2) bits += 2;
      EXPECT_TRUE(is_net(points, bits)) << side << " x " << side << " pixels from " << x0 << ", " << y0;
    }
  }
}

TEST(SamplePattern, DiffersByPixelPurposeAndSeed) {
  std::set<double> seen;
  int asked = 0;
  for (const std::uint32_t seed : {0u, 1u}) {
    const SamplePattern pattern(seed, 5);
    for (const std::uint32_t purpose : {0u, 1u}) {
      for (int y = 0; y < 10; ++y) {
        for (int x = 0; x < 10; ++x, ++asked) seen.insert(pattern.pixel(x, y, purpose)[4].x);
      }
    }
  }
  EXPECT_EQ(static_cast<int>(seen.size()), asked);
}

}  // namespace
}  // namespace scarp
