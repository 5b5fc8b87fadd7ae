// SPDX-License-Identifier: MIT
#include "scarp/render/light/fog_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "scarp/base/error.h"

namespace scarp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Ray ray(const dvec3& origin, const dvec3& direction) {
  Ray r;
  r.origin = origin;
  r.direction = normalize(direction);
  return r;
}

FogSettings high_fog() {
  FogSettings settings;
  settings.kind = FogKind::height;
  settings.visibility = 3000;
  settings.base = 200;
  settings.falloff = 150;
  return settings;
}

TEST(Fog, ByHeightMatchesTheIntegralAlongTheRay) {
  const FogSettings settings = high_fog();
  const Sky sky({}, {0, 0, 1}, 0);
  const Fog fog(settings, sky);
  const double per_metre = std::log(50.0) / settings.visibility;
  int judged = 0;
  for (const double z : {150.0, 200.0, 700.0}) {
    for (const double rise : {-1.0, -0.3, -1e-3, -1e-9, 0.0, 1e-12, 1e-4, 0.2, 1.0}) {
      for (const double t : {1.0, 90.0, 400.0}) {
        const Ray r = ray({3, 4, z}, {1, 1, rise});
        const auto density = [&](double s) {
          return per_metre * std::exp(-(r.at(s).z - settings.base) / settings.falloff);
        };
        constexpr int kHalves = 200;
        const double h = t / (2 * kHalves);
        double sum = density(0) + density(t);
        for (int i = 1; i < 2 * kHalves; ++i) sum += (i % 2 ? 4 : 2) * density(i * h);
        const double depth = sum * h / 3;
        // Simpson's rule is off by t h^4 / 180 times the largest fourth derivative, which is the density's own times
        // (rise / falloff)^4.
        const double fourth = std::pow(r.direction.z / settings.falloff, 4) * std::max(density(0), density(t));
        const double bound = t * std::pow(h, 4) / 180 * fourth + 1e-13 * depth;
        const double expected = std::exp(-depth);
        EXPECT_LE(std::abs(transmittance(settings, r, t) - expected), expected * std::expm1(bound) + 1e-15)
            << z << " " << rise << " " << t;
        ++judged;
      }
    }
  }
  EXPECT_EQ(judged, 81);
  // A ray that goes all the way up: the integral of the fog above.
  const Ray up = ray({0, 0, 350}, {0, 1, 2});
  const double above = per_metre * std::exp(-1.0) * settings.falloff / up.direction.z;
  EXPECT_NEAR(transmittance(settings, up, kInfinity), std::exp(-above), 1e-14);
  EXPECT_EQ(transmittance(settings, ray({0, 0, 350}, {1, 0, 0}), kInfinity), 0);
}

TEST(Fog, ByDistanceTransmitsTwoPercentAtTheVisibility) {
  FogSettings settings;
  settings.kind = FogKind::distance;
  settings.visibility = 1234;
  const Sky sky({}, {0, 0, 1}, 0);
  const Fog fog(settings, sky);
  const Ray r = ray({0, 0, 0}, {1, 2, 3});
  EXPECT_NEAR(transmittance(settings, r, 1234), 0.02, 1e-15);
  EXPECT_EQ(transmittance(settings, r, 0), 1);
  EXPECT_EQ(transmittance(settings, r, kInfinity), 1) << "the sky stays";
  const vec3 black(0.0f), seen = fog(r, 1234, black);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(seen[i], 0.98 * fog.colour(r.direction)[i], 1e-6);
}

TEST(Fog, IsWarmOnlyTowardsTheSun) {
  FogSettings settings = high_fog();
  settings.sun_tint = 1;
  const dvec3 to_sun = normalize(dvec3(1, 0, 1));
  const Sky sky({}, to_sun, 0);
  const Fog fog(settings, sky);
  const vec3 towards = fog.colour(to_sun), away = fog.colour(-to_sun);
  EXPECT_GT(towards.x - towards.z, 0.3f);
  EXPECT_LT(away.x, away.z);
  settings.sun_tint = 0;
  EXPECT_EQ(Fog(settings, sky).colour(to_sun), away);
}

TEST(Fog, ByIterationsIsProportional) {
  FogSettings settings;
  settings.kind = FogKind::iterations;
  const Sky sky({}, {0, 0, 1}, 0);
  const Fog fog(settings, sky);
  const Ray r = ray({0, 0, 0}, {1, 0, 0});
  const vec3 ground(0.1f, 0.2f, 0.3f);
  EXPECT_EQ(fog(r, 1e9, ground), ground);
  EXPECT_EQ(fog.by_share(r, 0, ground), ground);
  EXPECT_EQ(fog.by_share(r, 2, ground), fog.colour(r.direction));
  EXPECT_NEAR(fog.by_share(r, 0.25, ground).x, 0.75 * 0.1 + 0.25 * fog.colour(r.direction).x, 1e-6);
}

TEST(Fog, RejectsValuesOutOfRange) {
  EXPECT_THROW(find_fog("mist"), Error);
  EXPECT_EQ(find_fog("height"), FogKind::height);
  for (const auto& spoil : {+[](FogSettings& s) { s.visibility = 0; }, +[](FogSettings& s) { s.falloff = -1; },
                            +[](FogSettings& s) { s.base = kInfinity; }, +[](FogSettings& s) { s.sun_tint = 1.5; }}) {
    FogSettings settings = high_fog();
    validate(settings);
    spoil(settings);
    EXPECT_THROW(validate(settings), Error);
  }
}

}  // namespace
}  // namespace scarp
