// SPDX-License-Identifier: MIT
// Terrain functions: gradients match finite differences, bounds are never exceeded, settings are checked.
#include "scarp/field/height_function.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>

#include "base/refusal.h"
#include "cases.h"
#include "field/terrain_functions.h"
#include "scarp/base/error.h"

namespace scarp::test {
namespace {

const int kSamples = cases(1'000'000, 100'000, 20'000);
constexpr double kSizes[] = {0.1, 1, 10, 100, 1000};

TEST(HeightFunction, GradientsMatchFiniteDifferences) {
  for (const NamedFunction& named : terrain_functions()) {
    const HeightFunction function(named.function);
    FunctionRandom random(1);
    int creases = 0;
    for (int i = 0; i < 3000; ++i) {
      const double x = random.between(-5000, 5000), y = random.between(-5000, 5000);
      // The error of a central difference is h^2 / 6 times the third derivative, so the difference between those with
      // steps h and 2 h is three times the error of the finer one.
      const auto differences = [&](double h) {
        return dvec2(function.value(x + h, y) - function.value(x - h, y),
                     function.value(x, y + h) - function.value(x, y - h)) /
               (2 * h);
      };
      constexpr double kH = 1e-3;
      const dvec2 coarse = differences(2 * kH), fine = differences(kH);
      const double off = length(coarse - fine);
      // Rounding: two heights over 2 h, in both coordinates, of the fine difference and half as much of the coarse one:
      // at most 4 / h times the error of a height. That error is the height's own rounding plus the slope times the
      // rounding of the position x + h, 2^-53 of it. The gradient itself takes fewer than 2^10 roundings of numbers no
      // larger than 1 + slope.
      const FunctionBound near = function.bound({x - 1, x + 1, y - 1, y + 1});
      const double height_off = near.rounding + 0x1p-53 * (std::abs(x) + std::abs(y) + 1) * near.slope;
      const double rounding = 4 * height_off / kH + 0x1p-43 * (1 + near.slope);
      const double error = length(function.gradient(x, y, FunctionUse::march) - fine);
      if (error <= off + rounding) continue;
      ++creases;
      if (named.smooth) ADD_FAILURE() << named.name << " at " << x << ", " << y << ": off by " << error;
    }
    EXPECT_LE(creases, 30) << named.name;  // one position in a hundred is closer than 2 mm to a crease: too many
  }
}

// All quantities bounded over [x, x + size] x [y, y + size].
struct Seen {
  double low = 1e300, high = -1e300, slope = 0;
};

TEST(HeightFunction, RectangleBoundsHold) {
  for (const NamedFunction& named : terrain_functions()) {
    const HeightFunction function(named.function);
    std::string tightness = named.name + ": range, slope bound over seen";
    for (const double size : kSizes) {
      FunctionRandom random(2);
      const int rectangles = kSamples / 2000;
      double range = 0, slope = 0;
      int counted = 0;
      for (int r = 0; r < rectangles; ++r) {
        const double x = random.between(-5000, 5000), y = random.between(-5000, 5000);
        const FunctionBound bound = function.bound({x, x + size, y, y + size});
        Seen seen;
        for (int i = 0; i < 2000; ++i) {
          const double px = random.between(x, x + size), py = random.between(y, y + size);
          const double h = function.value(px, py);
          seen.low = std::min(seen.low, h), seen.high = std::max(seen.high, h);
          if (i % 8 == 0) seen.slope = std::max(seen.slope, length(function.gradient(px, py, FunctionUse::march)));
        }
        ASSERT_GE(seen.low, bound.low - bound.rounding) << named.name << ", size " << size;
        ASSERT_LE(seen.high, bound.high + bound.rounding) << named.name << ", size " << size;
        // Gradients as computed, a thousand roundings of doubles.
        ASSERT_LE(seen.slope, bound.slope + 0x1p-43 * (1 + bound.slope)) << named.name << ", size " << size;
        if (seen.high - seen.low > 1e-3 * size && seen.slope > 0) {
          range += (bound.high - bound.low) / (seen.high - seen.low);
          slope += bound.slope / seen.slope;
          ++counted;
        }
      }
      if (counted) tightness += fmt::format(";  {} m {:.2f}, {:.2f}", size, range / counted, slope / counted);
    }
    fmt::print("{}\n", tightness);
  }
}

TEST(HeightFunction, SegmentBoundsHold) {
  for (const NamedFunction& named : terrain_functions()) {
    const HeightFunction function(named.function);
    std::string tightness = named.name + ": range, line over seen";
    for (const double size : kSizes) {
      FunctionRandom random(3);
      const int segments = kSamples / 500;
      double range = 0, line = 0;
      int counted = 0;
      for (int s = 0; s < segments; ++s) {
        const dvec2 origin(random.between(-5000, 5000), random.between(-5000, 5000));
        const double angle = random.between(0, 6.28), t0 = random.between(-2000, 2000), t1 = t0 + size;
        const dvec2 direction(std::cos(angle), std::sin(angle));
        const SegmentBound bound = function.along(origin, direction, t0, t1);
        const dvec2 slope = function.slope_along(origin, direction, t0, t1);
        Seen seen;
        for (int i = 0; i < 500; ++i) {
          const double t = random.between(t0, t1), q = (t - 0.5 * (t0 + t1)) / (0.5 * size);
          // t, t1 and the middle are rounded numbers below 2^12: three roundings of 2^-42, over half the size.
          const double rounding_of_q = 3 * 0x1p-42 / (0.5 * size);
          const dvec2 p = origin + direction * t;
          const double h = function.value(p.x, p.y);
          seen.low = std::min(seen.low, h), seen.high = std::max(seen.high, h);
          ASSERT_LE(std::abs(h - (bound.mid + bound.slope * q)),
                    bound.rest + bound.rounding + rounding_of_q * std::abs(bound.slope))
              << named.name << ", size " << size;
          if (i % 8 == 0) {
            const double along = dot(function.gradient(p.x, p.y, FunctionUse::march), direction);
            ASSERT_GE(along, slope.x - 0x1p-43 * (1 + std::abs(slope.x))) << named.name << ", size " << size;
            ASSERT_LE(along, slope.y + 0x1p-43 * (1 + std::abs(slope.y))) << named.name << ", size " << size;
          }
        }
        ASSERT_GE(seen.low, bound.low - bound.rounding) << named.name << ", size " << size;
        ASSERT_LE(seen.high, bound.high + bound.rounding) << named.name << ", size " << size;
        if (seen.high - seen.low > 1e-3 * size) {
          range += (bound.high - bound.low) / (seen.high - seen.low);
          line += 2 * bound.rest / (seen.high - seen.low);
          ++counted;
        }
      }
      if (counted) tightness += fmt::format(";  {} m {:.2f}, {:.2f}", size, range / counted, line / counted);
    }
    fmt::print("{}\n", tightness);
  }
}

TEST(HeightFunction, HeightsStayWithinTheGlobalBound) {
  for (const NamedFunction& named : terrain_functions()) {
    const HeightFunction function(named.function);
    for (const FunctionUse use : {FunctionUse::march, FunctionUse::shadow, FunctionUse::normal}) {
      const FunctionBound& all = function.bound_everywhere(use);
      FunctionRandom random(4);
      for (int i = 0; i < 20000; ++i) {
        const double reach = std::exp2(random.between(-10, 30));
        const double x = random.between(-reach, reach), y = random.between(-reach, reach);
        const double h = function.value(x, y, use);
        ASSERT_TRUE(h >= all.low - all.rounding && h <= all.high + all.rounding) << named.name << ": " << h;
      }
    }
  }
}

TEST(HeightFunction, OctavesDependOnUse) {
  const HeightFunction function(make_function(Fractal{.octaves = {3, 2, 5}}));
  EXPECT_NE(function.value(10, 20), function.value(10, 20, FunctionUse::shadow));
  const HeightFunction coarse(make_function(Fractal{.octaves = {2, 2, 2}}));
  EXPECT_EQ(function.value(10, 20, FunctionUse::shadow), coarse.value(10, 20));
}

std::uint64_t bits(double x) {
  std::uint64_t b = 0;
  std::memcpy(&b, &x, sizeof b);
  return b;
}

TEST(HeightFunction, HeightsAreBitIdenticalEverywhere) {
  // Hashes of 1000 heights, as first computed; sines are the C library's and left out.
  const std::map<std::string, std::uint64_t> known{{"perlin fbm", 3542965959583933750u},
                                                   {"simplex ridged", 9851071123495928902u},
                                                   {"damped fbm", 15668961169119412477u}};
  int compared = 0;
  for (const NamedFunction& named : terrain_functions()) {
    const auto entry = known.find(named.name);
    if (entry == known.end()) continue;
    const HeightFunction function(named.function);
    std::uint64_t hash = 0;
    for (int i = 0; i < 1000; ++i) hash = hash * 31 + bits(function.value(i * 7.25 - 3000, i * -3.5 + 900));
    EXPECT_EQ(hash, entry->second) << named.name;
    ++compared;
  }
  EXPECT_EQ(compared, 3);
}

std::string refusal(FunctionShape shape) {
  return test::refusal([&] { make_function(std::move(shape)); });
}

TEST(HeightFunction, RejectsValuesOutOfRange) {
  const double nan = std::nan("");
  const Function plane = make_function(Plane{});
  EXPECT_EQ(refusal(Plane{nan}), "terrain function: plane height is nan (must be between -2^30 and 2^30)");
  EXPECT_EQ(refusal(Fractal{.octaves = {0, 1, 1}}),
            "terrain function: fractal octaves of the march is 0 (must be 1 to 24)");
  EXPECT_EQ(refusal(SmoothMinimum{plane, plane, -1}),
            "terrain function: smooth minimum radius is -1 (must be between 2^-20 and 2^30)");
  EXPECT_EQ(refusal(Minimum{plane, nullptr}), "terrain function: minimum operand b is missing (must be a function)");
  EXPECT_EQ(refusal(Sines{}), "terrain function: sines without waves (at least one required)");
  EXPECT_NE(refusal(Fractal{.wavelength = 0}), "");
  EXPECT_NE(refusal(Fractal{.wavelength = 1, .lacunarity = 8, .octaves = {9, 9, 9}}), "");
  EXPECT_NE(refusal(Fractal{.height = -1}), "");
  EXPECT_NE(refusal(Fractal{.gain = 0}), "");
  EXPECT_NE(refusal(Fractal{.turn = {1, 1}}), "");
  EXPECT_NE(refusal(Fractal{.damping = nan}), "");
  EXPECT_NE(refusal(RadialMask{{0, 0}, 5, 5}), "");
  EXPECT_NE(refusal(Terraces{plane, 10, 0}), "");
  EXPECT_THROW(HeightFunction(nullptr), Error);
}

TEST(HeightFunction, RejectsTreesThatAreTooDeepOrLarge) {
  Function deep = make_function(Plane{});
  for (int i = 1; i < kDeepestFunction; ++i) deep = make_function(Sum{deep, deep, 0.5, 0.5, 0});
  // Shared nodes are computed once: 2^255 paths, 256 instructions.
  EXPECT_EQ(HeightFunction(deep).value(1, 2), 0);
  EXPECT_EQ(refusal(Sum{deep, deep}),
            fmt::format("terrain function: nested {} deep (limited to {})", kDeepestFunction + 1, kDeepestFunction));
  Function warped = make_function(Fractal{});
  for (int i = 0; i < 12; ++i) warped = make_function(Warp{warped, warped, warped});
  EXPECT_THROW(HeightFunction{warped}, Error);
}

}  // namespace
}  // namespace scarp::test
