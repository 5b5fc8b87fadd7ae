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

/// A sky; +z is up. A plain sky has `scattering` 0 and uses only `to_sun`.
struct ScarpSky {
  int scattering;
  vec3 to_sun;  ///< unit
  // Perez's coefficients of the luminance Y and the chromaticities x and y.
  vec3 a;
  vec3 b;
  vec3 c;
  vec3 d;
  vec3 e;
  vec3 zenith;        ///< Y, x, y at the zenith, divided by Perez's formula at the zenith
  vec3 horizon;       ///< mean colour of the horizon, linear light
  vec3 ground;        ///< pale ground below the horizon, linear light
  vec3 disc;          ///< radiance of the sun's disc, linear light
  float disc_square;  ///< squared chord of the disc's angular radius on the unit sphere; 0: invisible
};

/// Minimum sine of the elevation in Perez's formula, which divides by it.
const float kScarpLowestSky = 1e-3f;

/// Perez's formula. `up`: sine of the elevation; `angle`: angle to the sun; `cosine`: its cosine.
SCARP_FN float scarp_perez(float a, float b, float c, float d, float e, real up, real angle, real cosine) {
  return float((real(1.0) + real(a) * exp(real(b) / up)) *
               (real(1.0) + real(c) * exp(real(d) * angle) + real(e) * cosine * cosine));
}

/// Converts luminance Y and chromaticities x, y to linear sRGB (CIE 1931; IEC 61966-2-1), clamped to >= 0.
SCARP_FN vec3 scarp_linear_from_luminance(float luminance, float x, float y) {
  float cx = luminance * x / y;
  float cz = luminance * (1.0f - x - y) / y;
  return vec3(max(0.0f, 3.2406f * cx - 1.5372f * luminance - 0.4986f * cz),
              max(0.0f, -0.9689f * cx + 1.8758f * luminance + 0.0415f * cz),
              max(0.0f, 0.0557f * cx - 0.2040f * luminance + 1.0570f * cz));
}

SCARP_FN vec3 scarp_scattered(ScarpSky sky, real3 direction) {
  real up = max(direction.z, real(kScarpLowestSky));
  real cosine = clamp(dot(direction, real3(sky.to_sun)), real(-1.0), real(1.0));
  real angle = acos(cosine);
  vec3 z = sky.zenith;
  return scarp_linear_from_luminance(z.x * scarp_perez(sky.a.x, sky.b.x, sky.c.x, sky.d.x, sky.e.x, up, angle, cosine),
                                     z.y * scarp_perez(sky.a.y, sky.b.y, sky.c.y, sky.d.y, sky.e.y, up, angle, cosine),
                                     z.z * scarp_perez(sky.a.z, sky.b.z, sky.c.z, sky.d.z, sky.e.z, up, angle, cosine));
}

/// Colour of the sky at the horizon, in linear light, in the direction of a unit vector. Towards zenith and nadir,
/// where horizontal directions converge, it becomes the mean of all.
SCARP_FN vec3 scarp_horizon_colour(ScarpSky sky, real3 direction) {
  if (sky.scattering == 0) return kScarpHorizon;
  real square = min(direction.x * direction.x + direction.y * direction.y, real(1.0));
  if (square < real(1e-12)) return sky.horizon;
  real level = sqrt(square);
  vec3 there = scarp_scattered(sky, real3(direction.x / level, direction.y / level, real(0.0)));
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
