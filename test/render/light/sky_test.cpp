// SPDX-License-Identifier: MIT
#include "scarp/render/light/sky_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/trigonometric.hpp>
#include <limits>
#include <numbers>

#include "scarp/base/error.h"
#include "scarp/render/light/sky_fit.h"
#include "scarp/render/surface/water.glsl.h"

namespace scarp {
namespace {

constexpr double kSunRadius = 0.00465;

// Degrees above the horizon; the sun is in the east.
dvec3 direction(double altitude, double from_sun = 0) {
  const double up = glm::radians(altitude), turn = glm::radians(from_sun);
  return {std::cos(up) * std::cos(turn), std::cos(up) * std::sin(turn), std::sin(up)};
}

Sky scattering(double altitude, double turbidity = 3) {
  return Sky({SkyKind::scattering, turbidity}, direction(altitude), kSunRadius);
}

float luminance(vec3 c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

TEST(Sky, PlainSkyIsBlueAtTheZenithAndPaleAtTheHorizon) {
  const Sky sky({}, direction(30), kSunRadius);
  const vec3 zenith = sky.colour({0, 0, 1}), horizon = sky.colour({1, 0, 0});
  EXPECT_GT(zenith.z, 3 * zenith.x);
  EXPECT_GT(horizon.x, 2 * zenith.x);
  EXPECT_EQ(sky.disc(direction(30)), vec3(0.0f));
}

TEST(Sky, HasNoEdgeAtTheHorizon) {
  for (const Sky& sky : {Sky({}, direction(30), kSunRadius), scattering(30)})
    EXPECT_LT(length(sky.colour(normalize(dvec3(1, 0, 1e-6))) - sky.colour(normalize(dvec3(1, 0, -1e-6)))), 1e-3f);
}

// F. Kasten, "A new table and approximation formula for the relative optical air mass", 1965.
TEST(Atmosphere, HasKastensAirMass) {
  const Atmosphere atmosphere(3, 0.5);
  for (const double altitude : {60.0, 30.0, 20.0, 10.0}) {
    const double mass = 1 / (std::sin(glm::radians(altitude)) + 0.15 * std::pow(altitude + 3.885, -1.253));
    for (int i = 0; i < 3; ++i) {
      const double depth = -std::log(atmosphere.sunlight(glm::radians(altitude))[i]),
                   vertical = -std::log(atmosphere.sunlight(std::numbers::pi / 2)[i]);
      EXPECT_NEAR(depth / vertical, mass, 0.07 * mass) << altitude;
    }
  }
}

TEST(Atmosphere, GroundReceivesLessLightThanEnters) {
  for (const double turbidity : {2.0, 10.0}) {
    for (const double degrees : {10.0, 45.0, 90.0}) {
      const double altitude = glm::radians(degrees);
      const Atmosphere atmosphere(turbidity, altitude);
      dvec3 sum(0.0);
      constexpr int kUp = 16, kAround = 16;
      for (int i = 0; i < kUp; ++i) {
        const double level = std::sqrt((i + 0.5) / kUp), up = std::sqrt(1 - level * level);
        for (int j = 0; j < kAround; ++j) {
          const double turn = 2 * std::numbers::pi * (j + 0.5) / kAround;
          sum += atmosphere.radiance({level * std::cos(turn), level * std::sin(turn), up});
        }
      }
      const dvec3 sky = sum * (std::numbers::pi / (kUp * kAround)),
                  sun = atmosphere.sunlight(altitude) * std::sin(altitude);
      for (int i = 0; i < 3; ++i) {
        EXPECT_LT(sky[i] + sun[i], std::sin(altitude)) << turbidity << ", " << degrees;
        EXPECT_GT(sky[i], 0.02 * sun[i]) << turbidity << ", " << degrees;
      }
    }
  }
}

// The errors that sky_fit.h states, over directions between those of the fit.
TEST(Sky, FormulaMatchesTheAtmosphere) {
  for (const double turbidity : {2.0, 3.0, 10.0}) {
    for (const double degrees : {90.0, 45.0, 20.0, 5.0, 0.0, -4.0, -6.0}) {
      const Atmosphere atmosphere(turbidity, glm::radians(degrees));
      glsl::ScarpSky sky{};
      sky.to_sun = vec3(atmosphere.to_sun());
      fit_sky(atmosphere, sky);
      double squares = 0;
      int count = 0;
      for (double up = 1.5; up < 90; up += 6) {
        for (double turn = 7; turn < 360; turn += 19, ++count) {
          const dvec3 towards = direction(up, turn), truth = atmosphere.radiance(towards);
          const dvec3 error = dvec3(glsl::scarp_scattered(sky, towards)) - truth;
          squares += dot(error, error) / dot(truth, truth);
        }
      }
      EXPECT_LT(std::sqrt(squares / count), degrees >= 20 ? 0.01 : 0.1) << turbidity << ", " << degrees;
    }
  }
}

TEST(Sky, SunlightIsWhiteAtNoon) {
  const vec3 sun = scattering(60).sunlight();
  EXPECT_NEAR(sun.x, sun.y, 1e-5);
  EXPECT_NEAR(sun.z, sun.y, 1e-5);
}

TEST(Sky, HorizonIsNoRedderThanBlueByDay) {
  for (const double altitude : {20.0, 40.0, 60.0}) {
    const Sky sky = scattering(altitude);
    for (const double from_sun : {60.0, 90.0, 180.0}) {
      const vec3 horizon = sky.colour(direction(0, from_sun));
      EXPECT_LE(horizon.x, horizon.z) << altitude << ", " << from_sun;
      EXPECT_LE(horizon.x, 1.02f * horizon.y) << "mauve: " << altitude << ", " << from_sun;
    }
  }
}

TEST(Sky, TwilightDarkensAndIsBlue) {
  float before = luminance(scattering(0).skylight());
  for (const double altitude : {-2.0, -4.0, -6.0}) {
    const Sky sky = scattering(altitude);
    EXPECT_EQ(sky.sunlight(), vec3(0.0f)) << altitude;
    const float now = luminance(sky.skylight());
    EXPECT_LT(now, before) << altitude;
    EXPECT_GT(now, 0) << altitude;
    before = now;
    const vec3 zenith = sky.colour({0, 0, 1}), glow = sky.colour(direction(2));
    EXPECT_GT(zenith.z, 1.2f * zenith.x) << altitude;
    EXPECT_GT(glow.x / glow.z, 1.5f * zenith.x / zenith.z) << altitude;
  }
}

TEST(Sky, LowSunTurnsSkyAndSunlightOrange) {
  const Sky low = scattering(5), high = scattering(60);
  EXPECT_GT(low.sunlight().x, 4 * low.sunlight().z);
  EXPECT_LT(high.sunlight().x, 2 * high.sunlight().z);
  EXPECT_GT(low.skylight().z, low.skylight().x) << "what is in shadow is blue";
  const vec3 beside = low.colour(direction(5, 10));
  EXPECT_GT(beside.x, 1.2f * beside.z);
}

TEST(Sky, IsBrightestAroundTheSun) {
  for (const double altitude : {5.0, 30.0, 60.0}) {
    const Sky sky = scattering(altitude);
    float before = luminance(sky.colour(direction(altitude)));
    for (const double from_sun : {5.0, 15.0, 40.0, 90.0}) {
      const float now = luminance(sky.colour(direction(altitude, from_sun)));
      EXPECT_LT(now, before) << altitude << ": " << from_sun;
      before = now;
    }
  }
}

TEST(Sky, ShowsTheDiscAtItsTrueSize) {
  const Sky sky = scattering(30);
  const double radius = glm::degrees(kSunRadius);
  for (const double side : {-1.0, 1.0}) {
    EXPECT_GT(luminance(sky.disc(direction(30 + 0.98 * side * radius))), 0.99f * kBrightest);
    EXPECT_EQ(sky.disc(direction(30 + 1.02 * side * radius)), vec3(0.0f));
  }
}

TEST(Sky, LightsLevelGroundWithOneUnderAHighSun) {
  for (const double altitude : {45.0, 60.0, 90.0}) {
    const Sky sky = scattering(altitude);
    const float light =
        luminance(sky.skylight() + sky.sunlight() * std::sin(static_cast<float>(glm::radians(altitude))));
    EXPECT_NEAR(light, 1, 1e-5) << altitude;
  }
}

TEST(Sky, IsFiniteAndNonNegativeEverywhere) {
  for (const double turbidity : {2.0, 10.0}) {
    for (const double sun : {-6.0, -0.1, 0.01, 3.0, 45.0, 90.0}) {
      const Sky sky = scattering(sun, turbidity);
      for (double altitude = -90; altitude <= 90; altitude += 7.5) {
        for (double turn = 0; turn < 360; turn += 45) {
          const vec3 colour = sky.colour(direction(altitude, turn));
          for (int i = 0; i < 3; ++i) EXPECT_TRUE(colour[i] >= 0 && colour[i] < 1e3f) << turbidity << ", " << sun;
        }
      }
    }
  }
}

// Straight down, directions of all azimuths meet, and so must their colours.
TEST(Sky, HasOneColourTowardsTheNadir) {
  const glsl::ScarpSky sky = scattering(5).numbers();
  const vec3 down = glsl::scarp_sky_beyond(sky, {0, 0, -1});
  for (double turn = 0; turn < 360; turn += 30)
    EXPECT_LT(length(glsl::scarp_sky_beyond(sky, direction(-89, turn)) - down), 1e-3f) << turn;
  EXPECT_GT(length(glsl::scarp_sky_beyond(sky, direction(-5)) - glsl::scarp_sky_beyond(sky, direction(-5, 180))), 0.1f);
}

// Haze scatters less light away from the sun: its glow does not reach down over the ground.
TEST(Sky, GlowBelowTheHorizonFadesWithTheAngleToTheSun) {
  for (const double altitude : {2.0, 5.0, 20.0}) {
    const glsl::ScarpSky sky = scattering(altitude).numbers();
    const auto haze = [&](double up) { return glsl::scarp_sky_beyond(sky, direction(up)); };
    EXPECT_LT(length(haze(-0.001) - haze(0)), 1e-3f * length(haze(0))) << altitude;
    for (double up = 0; up > -40; up -= 5)
      EXPECT_LT(luminance(haze(up - 5)), luminance(haze(up))) << altitude << ", " << up;
    // The colour of the horizon at the same angle to the sun, with the mean that is mixed in towards the nadir.
    const double turn =
        glm::degrees(std::acos(std::cos(glm::radians(20 + altitude)) / std::cos(glm::radians(altitude))));
    const auto share = static_cast<float>(std::pow(std::cos(glm::radians(20.0)), 4));
    const vec3 expected = share * glsl::scarp_sky_beyond(sky, direction(0, turn)) + (1 - share) * sky.horizon;
    EXPECT_LT(length(haze(-20) - expected), 1e-5f * length(expected)) << altitude;
  }
}

TEST(Sky, RejectsValuesOutOfRange) {
  EXPECT_THROW(find_sky("clear"), Error);
  EXPECT_EQ(find_sky("scattering"), SkyKind::scattering);
  for (const double turbidity : {1.9, 10.1, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(validate(SkySettings{SkyKind::scattering, turbidity}), Error);
}

// Water that reflects all light loses no sunlight: the sum over all eyes above it equals the incoming light.
TEST(Glitter, ConservesSunlight) {
  for (const double altitude : {40.0, 70.0}) {
    glsl::ScarpSky sky = scattering(altitude).numbers();
    sky.disc = vec3(1e9f);
    constexpr int kUp = 400, kAround = 800;
    double sum = 0;
    for (int i = 0; i < kUp; ++i) {
      const double up = (i + 0.5) / kUp, level = std::sqrt(1 - up * up);
      for (int j = 0; j < kAround; ++j) {
        const double turn = 2 * std::numbers::pi * (j + 0.5) / kAround;
        const dvec3 to_eye(level * std::cos(turn), level * std::sin(turn), up);
        sum += up * glsl::scarp_glitter(sky, vec3(1.0f), -to_eye, {0, 0, 1}, 0.01, 1).x;
      }
    }
    const double seen = sum * 2 * std::numbers::pi / (kUp * kAround);
    EXPECT_NEAR(seen / (std::numbers::pi * std::sin(glm::radians(altitude))), 1, 0.02) << altitude;
  }
}

TEST(Glitter, IsNoBrighterThanTheSunDisc) {
  const Sky sky = scattering(30);
  const dvec3 mirrored(std::cos(glm::radians(30.0)), 0, -0.5);
  const vec3 seen = glsl::scarp_glitter(sky.numbers(), sky.sunlight(), mirrored, {0, 0, 1}, 0, 0.5);
  EXPECT_EQ(seen, sky.numbers().disc);
  const Sky plain({}, direction(30), kSunRadius);
  EXPECT_EQ(glsl::scarp_glitter(plain.numbers(), plain.sunlight(), mirrored, {0, 0, 1}, 0.01, 0.5), vec3(0.0f));
}

}  // namespace
}  // namespace scarp
