// SPDX-License-Identifier: MIT
// Haze, fog and the light of sun and sky: the formulas of fog.h and light.h. Compiles as C++ and GLSL.
#ifndef SCARP_RENDER_AIR_GLSL_H
#define SCARP_RENDER_AIR_GLSL_H

#include "scarp/render/light/sky.glsl.h"

SCARP_GLSL_BEGIN

const vec3 kScarpSunlight = vec3(1.0f, 0.83f, 0.58f);  ///< colour of fog towards the sun, below a plain sky

/// A colour seen through `metres` of haze along a ray with this unit direction. Haze has the colour of the sky behind
/// it, and that of the horizon below.
SCARP_FN vec3 scarp_in_haze(vec3 colour, ScarpSky sky, real3 direction, real per_metre, real metres) {
  real clear = exp(-per_metre * max(real(0.0), metres));
  return scarp_between(scarp_sky_beyond(sky, direction), colour, clear);
}

/// FogKind.
const int kScarpNoFog = 0;
const int kScarpFogByDistance = 1;
const int kScarpFogByHeight = 2;
const int kScarpFogByIterations = 3;

/// (1 - exp(-x)) / x, which is 1 at 0. Uses the series where the difference would cancel.
SCARP_FN real scarp_mean_of_decay(real x) {
  if (abs(x) >= real(0.0625)) return (real(1.0) - exp(-x)) / x;
  real sum = real(1.0);
  for (int n = 10; n > 1; --n) sum = real(1.0) - x / real(n) * sum;
  return sum;
}

/// Transmittance of fog over t metres along a ray that starts at height `z` and rises by `rise` per metre. `per_metre`
/// is the density at the height `base`; it decreases upwards by the factor e every `falloff` metres.
SCARP_FN real scarp_fog_transmittance(int kind, real per_metre, real base, real falloff, real z, real rise, real t) {
  if (kind == kScarpFogByDistance) return exp(-per_metre * t);
  if (kind != kScarpFogByHeight) return real(1.0);
  real here = per_metre * exp(-(z - base) / falloff);
  return exp(-here * t * scarp_mean_of_decay(t * (rise / falloff)));
}
/// The same for light from infinity.
SCARP_FN real scarp_fog_transmittance_of_sky(int kind, real per_metre, real base, real falloff, real z, real rise) {
  if (kind != kScarpFogByHeight) return real(1.0);
  real here = per_metre * exp(-(z - base) / falloff);
  return rise > real(0.0) ? exp(-here / (rise / falloff)) : real(0.0);
}

/// Colour of fog in linear light, looking along a unit vector: that of the sky at the horizon. Below a plain sky it is
/// warmer towards the sun, by the 8th power of the cosine of the angle to it.
SCARP_FN vec3 scarp_fog_colour(ScarpSky sky, real3 direction, real sun_tint) {
  if (sky.scattering != 0) return scarp_horizon_colour(sky, direction);
  real towards = max(real(0.0), dot(direction, real3(sky.to_sun)));
  towards *= towards;
  towards *= towards;
  towards *= towards;
  return scarp_between(kScarpHorizon, kScarpSunlight, sun_tint * towards);
}

/// The sine of the lowest sun that casts shadows over endless ground: 0.06 degrees, a ninth of its disc.
const float kScarpLeastSunRise = 1e-3f;

/// Light of the plain sky on level ground; the sun supplies the rest of white.
const vec3 kScarpSkylight = vec3(0.27f, 0.32f, 0.39f);

/// Light on a surface with this unit normal. `skylight` is the light of the sky on level ground; the sky is brightest
/// towards `sky_side`, and `sky_share` of it is visible. `sun` is the sunlight on a surface that faces the sun,
/// `sun_cosine` the mean cosine to the visible part of its disc.
SCARP_FN vec3 scarp_light(real3 normal, real3 sky_side, vec3 skylight, vec3 sun, real sun_cosine, real sky_share) {
  real sky = sky_share * (real(1.0) + dot(normal, sky_side)) / (real(1.0) + sky_side.z);
  return float(sky) * skylight + float(sun_cosine) * sun;
}

SCARP_GLSL_END

#endif
