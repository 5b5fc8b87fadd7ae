// SPDX-License-Identifier: MIT
// Ramps, light and sky.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/trigonometric.hpp>
#include <limits>
#include <string>

#include "scarp/base/error.h"
#include "scarp/render/film/film.h"
#include "scarp/render/light/colour.glsl.h"
#include "scarp/render/light/light.h"
#include "scarp/render/surface/ramp.h"
#include "scarp/render/surface/ramp_tables.h"

namespace scarp {
namespace {

bool bluish(vec3 c) { return c.z > c.x && c.z > c.y; }

std::uint32_t rgb_of(vec3 linear) {
  return static_cast<std::uint32_t>(srgb_byte(linear.x)) << 16 | static_cast<std::uint32_t>(srgb_byte(linear.y)) << 8 |
         srgb_byte(linear.z);
}

TEST(Ramp, HypsometricBreaksAtSeaLevel) {
  const Ramp ramp("hypsometric", -3000, 2000);
  EXPECT_TRUE(bluish(ramp(-3000)));
  EXPECT_TRUE(bluish(ramp(-1e-9)));
  EXPECT_TRUE(bluish(ramp(0))) << "elevation models store the sea as 0";
  EXPECT_FALSE(bluish(ramp(1e-9)));
  EXPECT_FALSE(bluish(ramp(2000)));
}

TEST(Ramp, HypsometricScalesLandAndSeaSeparately) {
  const auto same = [](vec3 a, vec3 b) { return length(a - b) < 1e-6f; };
  EXPECT_TRUE(same(Ramp("hypsometric", -10, 2000)(1000), Ramp("hypsometric", -9000, 2000)(1000)));
  EXPECT_TRUE(same(Ramp("hypsometric", 300, 700)(300), Ramp("hypsometric", -50, 700)(1e-12)))
      << "dry land starts at its lowest";
  EXPECT_TRUE(same(Ramp("hypsometric", -3000, -1000)(-3000), Ramp("hypsometric", -3000, 4000)(-3000)));
  EXPECT_TRUE(bluish(Ramp("hypsometric", 0, 0)(0))) << "nothing but sea";
}

TEST(Ramp, TablesSpanTheRange) {
  const Ramp ramp("viridis", 10, 20);
  EXPECT_EQ(rgb_of(ramp(10)), kViridis.front());
  EXPECT_EQ(rgb_of(ramp(20)), kViridis.back());
  EXPECT_EQ(rgb_of(ramp(10 + 10 * 100 / 255.0)), kViridis[100]);
  EXPECT_EQ(rgb_of(ramp(-5)), kViridis.front());
  EXPECT_EQ(rgb_of(ramp(25)), kViridis.back());
}

TEST(Ramp, EveryNameWorksOnEveryRange) {
  for (const std::string_view name : ramp_names()) {
    for (const auto& [low, high] :
         {std::pair(0.0, 0.0), {-5.0, -5.0}, {7.0, 7.0}, {-1.0, 1.0}, {-4.0, 0.0}, {0.0, 9.0}}) {
      const Ramp ramp(name, low, high);
      for (const double value : {low, high, 0.5 * (low + high)}) {
        const vec3 colour = ramp(value);
        for (int i = 0; i < 3; ++i) EXPECT_TRUE(colour[i] >= 0 && colour[i] <= 1) << name << " at " << value;
      }
    }
  }
}

TEST(Ramp, UnknownNameErrorListsTheKnownOnes) {
  try {
    Ramp("jet", 0, 1);
    FAIL() << "no error";
  } catch (const Error& error) {
    for (const std::string_view name : ramp_names()) EXPECT_NE(std::string(error.what()).find(name), std::string::npos);
  }
}

TEST(Ramp, BytesRoundTripThroughLinearLight) {
  for (int byte = 0; byte < 256; ++byte) {
    const auto s = static_cast<float>(byte) / 255.0f;
    EXPECT_EQ(srgb_byte(linear_from_srgb({s, s, s}).y), byte);
  }
}

// srgb_byte() uses a table: tests all floats near the thresholds between bytes, and some other floats.
TEST(Ramp, BytesMatchTheShaders) {
  const auto expect_same = [](float linear) { ASSERT_EQ(srgb_byte(linear), glsl::scarp_srgb_byte(linear)) << linear; };
  for (std::uint32_t bits = 0; bits < 0x40000000; bits += 4001) expect_same(std::bit_cast<float>(bits));
  for (std::uint32_t bits = 1; bits < 0x3f800000; bits += 1024) {
    const float here = std::bit_cast<float>(bits), next = std::bit_cast<float>(bits + 1024);
    if (srgb_byte(here) == srgb_byte(next)) continue;
    for (std::uint32_t i = 0; i < 1024; ++i) expect_same(std::bit_cast<float>(bits + i));
  }
  for (const float linear : {-1.0f, -0.0f, 1e30f, std::numeric_limits<float>::infinity()}) expect_same(linear);
}

TEST(Light, IsOneOnLevelGroundInFullSun) {
  for (const double altitude : {30.0, 45.0, 90.0}) {
    const vec3 light = Light({.azimuth_deg = 200, .altitude_deg = altitude}, 0.3).on({0, 0, 1}, true);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(light[i], 1, 1e-6) << altitude;
  }
}

TEST(Light, ShadowedSlopesKeepContrast) {
  const Light light({.azimuth_deg = 90, .altitude_deg = 30}, 0);
  const dvec3 east = normalize(dvec3(1, 0, 1)), west = normalize(dvec3(-1, 0, 1));
  EXPECT_GT(light.on(west, false).y, 0.05f);
  EXPECT_GT(light.on(east, false).y, 1.3f * light.on(west, false).y);
  EXPECT_LT(light.on(east, false).y, light.on(east, true).y);
}

TEST(Light, SunIsAtItsCompassAzimuth) {
  const double grid_north = glm::radians(-5.0);
  const Light light({.azimuth_deg = 85, .altitude_deg = 60}, grid_north);
  EXPECT_NEAR(light.to_sun().x, 0.5, 1e-12);
  EXPECT_NEAR(light.to_sun().y, 0, 1e-12);
}

TEST(Light, RejectsASunBelowTwilight) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double altitude : {std::nextafter(kLowestSun, -90.0), -10.0, 91.0, nan}) {
    EXPECT_THROW(validate(SunSettings{.altitude_deg = altitude}), Error) << altitude;
  }
  EXPECT_THROW(validate(SunSettings{.azimuth_deg = nan}), Error);
  EXPECT_NO_THROW(validate(SunSettings{.altitude_deg = kLowestSun}));
}

// Shades of a white hill-shade stay distinct, hues are kept, and dark colours do not change.
TEST(ToneCurve, CompressesOnlyBrightColours) {
  for (const vec3 dark : {vec3(0.0f), vec3(0.1f, 0.7f, 0.3f)}) EXPECT_EQ(toned(dark), dark);
  float before = toned(vec3(0.7f)).x;
  for (int i = 71; i <= 175; ++i) {
    const float now = toned(vec3(0.01f * static_cast<float>(i))).x;
    EXPECT_GT(now, before) << i;
    EXPECT_LE(now, 1.0f + 1e-6f) << i;
    before = now;
  }
  EXPECT_NEAR(toned(vec3(1.75f)).x, 1, 1e-6);
  const vec3 orange = toned({1.6f, 0.8f, 0.4f});
  EXPECT_NEAR(orange.y / orange.x, 0.5, 1e-6);
  EXPECT_NEAR(orange.z / orange.x, 0.25, 1e-6);
  const vec3 sun = toned({175, 80, 20});
  EXPECT_GT(sun.z, 0.98f) << "white beyond all channels";
  EXPECT_EQ(toned({std::numeric_limits<float>::infinity(), 1, 0}), vec3(1.0f));
}

}  // namespace
}  // namespace scarp
