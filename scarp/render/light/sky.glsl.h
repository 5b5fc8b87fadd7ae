// SPDX-License-Identifier: MIT
// The sky: a plain gradient, or one in which sunlight is scattered: the formulas of sky_model.h. Compiles as C++ and
// GLSL.
#ifndef SCARP_RENDER_SKY_GLSL_H
#define SCARP_RENDER_SKY_GLSL_H

#include "scarp/render/light/colour.glsl.h"

SCARP_GLSL_BEGIN

const vec3 kScarpZenith = vec3(0.12f, 0.30f, 0.66f);
const vec3 kScarpHorizon = vec3(0.80f, 0.87f, 0.93f);
const vec3 kScarpNadir = vec3(0.60f, 0.66f, 0.72f);

/// Coefficients of 1, the cosine of the angle to the sun, its square, and scarp_forward().
struct ScarpSkyPart {
  vec3 even;
  vec3 cosine;
  vec3 square;
  vec3 forward;
};

/// A sky; +z is up. A plain sky has `scattering` 0 and uses only `to_sun`.
struct ScarpSky {
  int scattering;
  vec3 to_sun;  ///< unit
  // The radiance in linear light: a part at all heights, and parts in layers above the horizon (kScarpSkyLayers).
  ScarpSkyPart all;
  ScarpSkyPart first;
  ScarpSkyPart second;
  ScarpSkyPart third;
  ScarpSkyPart fourth;
  vec3 horizon;       ///< mean colour of the horizon, linear light
  vec3 ground;        ///< pale ground below the horizon, linear light
  vec3 disc;          ///< radiance of the sun's disc, linear light
  float disc_square;  ///< squared chord of the disc's angular radius on the unit sphere; 0: invisible
};

/// Sines of the elevations over which the layers of the sky fade by the factor e. With half and twice these, the
/// largest error of the fit for a sun at 20 degrees or more (sky_fit.h) rises from 0.6 % to 1.9 % and 1.2 %.
const vec4 kScarpSkyLayers = vec4(0.02f, 0.07f, 0.2f, 0.6f);
SCARP_FN real scarp_sky_layer(real up, float thickness) { return exp(-up / real(thickness)); }

/// Light scattered by aerosols, by the cosine of the angle to the sun: Henyey and Greenstein with the asymmetry 0.76 of
/// the clear sky of Bruneton and Neyret (atmosphere.h), times 4 pi.
SCARP_FN real scarp_forward(real cosine) {
  real square = real(1.0 + 0.76 * 0.76) - real(2.0 * 0.76) * cosine;
  return real(1.0 - 0.76 * 0.76) / (square * sqrt(square));
}

SCARP_FN vec3 scarp_sky_part(ScarpSkyPart part, float cosine, float forward) {
  return part.even + cosine * (part.cosine + cosine * part.square) + forward * part.forward;
}

/// Radiance of the scattered light towards a unit vector with z >= 0, >= 0.
SCARP_FN vec3 scarp_scattered(ScarpSky sky, real3 direction) {
  real up = max(direction.z, real(0.0));
  real angle = clamp(dot(direction, real3(sky.to_sun)), real(-1.0), real(1.0));
  float cosine = float(angle);
  float forward = float(scarp_forward(angle));
  vec3 sum = scarp_sky_part(sky.all, cosine, forward);
  sum += float(scarp_sky_layer(up, kScarpSkyLayers.x)) * scarp_sky_part(sky.first, cosine, forward);
  sum += float(scarp_sky_layer(up, kScarpSkyLayers.y)) * scarp_sky_part(sky.second, cosine, forward);
  sum += float(scarp_sky_layer(up, kScarpSkyLayers.z)) * scarp_sky_part(sky.third, cosine, forward);
  sum += float(scarp_sky_layer(up, kScarpSkyLayers.w)) * scarp_sky_part(sky.fourth, cosine, forward);
  return max(sum, vec3(0.0f));
}

/// Colour of the sky at the horizon, in linear light, in the direction of a unit vector. Towards zenith and nadir,
/// where horizontal directions converge, it becomes the mean of all. Below the horizon the angle to the sun is that of
/// the vector, so the glow around a low sun fades downwards in haze as in the sky.
SCARP_FN vec3 scarp_horizon_colour(ScarpSky sky, real3 direction) {
  if (sky.scattering == 0) return kScarpHorizon;
  real square = min(direction.x * direction.x + direction.y * direction.y, real(1.0));
  if (square < real(1e-12)) return sky.horizon;
  real level = sqrt(square);
  real3 towards = direction.z < real(0.0) ? direction : real3(direction.x / level, direction.y / level, real(0.0));
  vec3 there = scarp_scattered(sky, towards);
  return scarp_between(sky.horizon, there, square * square);
}

/// Colour of the sky in linear light towards a unit vector, without the sun's disc. The plain gradient follows the 3rd
/// power of 1 - z; below the horizon it changes to pale ground by the power 1.5.
SCARP_FN vec3 scarp_sky_colour(ScarpSky sky, real3 direction) {
  real far = real(1.0) - min(abs(direction.z), real(1.0));
  bool scatters = sky.scattering != 0;
  if (direction.z < real(0.0)) {
    vec3 ground = scatters ? sky.ground : kScarpNadir;
    return scarp_between(scarp_horizon_colour(sky, direction), ground, real(1.0) - far * sqrt(far));
  }
  return scatters ? scarp_scattered(sky, direction)
                  : scarp_between(kScarpHorizon, kScarpZenith, real(1.0) - far * far * far);
}

/// The same for ground too far away to be visible: below the horizon it has the horizon's colour.
SCARP_FN vec3 scarp_sky_beyond(ScarpSky sky, real3 direction) {
  return direction.z < real(0.0) ? scarp_horizon_colour(sky, direction) : scarp_sky_colour(sky, direction);
}

/// Radiance of the sun's disc, to be added to scarp_sky_colour().
SCARP_FN vec3 scarp_sun_disc(ScarpSky sky, real3 direction) {
  real3 off = direction - real3(sky.to_sun);
  bool seen = direction.z >= real(0.0) && dot(off, off) < real(sky.disc_square);
  return seen ? sky.disc : vec3(0.0f);
}

SCARP_GLSL_END

#endif
