// SPDX-License-Identifier: MIT
#include "scarp/render/light/lighting.h"

#include <gtest/gtest.h>

#include <limits>

namespace scarp {
namespace {

vec3 light_on(double openness, int samples, std::uint8_t sky_blocked) {
  LightSettings settings;
  settings.samples = samples;
  settings.shadows = false;
  const Lighting lighting(settings, std::numeric_limits<double>::infinity());
  // Facing away from the sun: only skylight remains.
  const LightPoint ground{{0, 0, 0}, -lighting.to_sun(), -lighting.to_sun(), openness};
  std::vector<Ray> rays;
  const LightRays asked = lighting.ask(ground, {0.5, 0.5, 0, 0, 0}, rays);
  const std::vector<std::uint8_t> blocked(rays.size(), sky_blocked);
  return lighting.on(ground, asked, rays, blocked);
}

TEST(Lighting, OpennessScalesTheSkyLight) {
  const vec3 open = light_on(1, 0, 0);
  EXPECT_GT(open.x, 0);
  EXPECT_FLOAT_EQ(light_on(0.25, 0, 0).x, 0.25F * open.x);
  EXPECT_EQ(light_on(0, 0, 0), vec3(0.0F));
}

TEST(Lighting, OpennessIsIgnoredWhenTheSkyIsSampled) {
  EXPECT_EQ(light_on(0.25, 8, 0), light_on(1, 8, 0));
  EXPECT_EQ(light_on(1, 8, 1), vec3(0.0F));
}

}  // namespace
}  // namespace scarp
