// SPDX-License-Identifier: MIT
// Light in water: the formulas of water.h. Compiles as C++ and GLSL.
#ifndef SCARP_RENDER_WATER_GLSL_H
#define SCARP_RENDER_WATER_GLSL_H

#include "scarp/render/light/sky.glsl.h"

SCARP_GLSL_BEGIN

/// The reflected fraction, by Schlick's formula. `cosine`: of the angle to the normal; `index`: index of refraction.
SCARP_FN real scarp_schlick(real cosine, real index) {
  real root = (index - real(1.0)) / (index + real(1.0));
  real r0 = root * root;
  real c = real(1.0) - clamp(cosine, real(0.0), real(1.0));
  return r0 + (real(1.0) - r0) * c * c * c * c * c;
}

/// Direction mirrored at a unit normal that points against it.
SCARP_FN real3 scarp_reflected(real3 direction, real3 normal) {
  return direction - real(2.0) * dot(direction, normal) * normal;
}
/// Direction refracted on entering the water (Snell).
SCARP_FN real3 scarp_refracted(real3 direction, real3 normal, real index) {
  real ratio = real(1.0) / index;
  real cosine = -dot(direction, normal);
  real inside = sqrt(real(1.0) - ratio * ratio * (real(1.0) - cosine * cosine));
  return normalize(ratio * direction + (ratio * cosine - inside) * normal);
}
/// The minimum sine by which mirrored rays rise: below it they would travel over a thousand metres per metre of height.
const float kScarpLeastMirroredRise = 1e-3f;

/// If waves would send a mirrored ray into the water, it runs along the surface instead.
SCARP_FN real3 scarp_kept_above(real3 mirrored) {
  real least = real(kScarpLeastMirroredRise);
  return mirrored.z < least ? normalize(real3(mirrored.x, mirrored.y, least)) : mirrored;
}

const int kScarpWaves = 7;

/// Visible fraction of a wave of this length where a pixel is `footprint` metres wide: 0 if it is two pixels long or
/// less, 1 if it is four or more.
SCARP_FN real scarp_wave_seen(real wavelength, real footprint) {
  return clamp(wavelength / (real(2.0) * footprint) - real(1.0), real(0.0), real(1.0));
}
/// The slope of wave i at a phase of `turns` from the origin, for waves with the total mean slope `slope`: the mean
/// slope of a cosine is its amplitude / sqrt(2), and squared slopes of different directions add up.
SCARP_FN real scarp_wave_slope(int i, real turns, real slope) {
  return slope * sqrt(real(2.0) / real(kScarpWaves)) * cos(real(6.283185307179586) * turns + real(i));
}

/// Mean square slope of the unresolved part of a wave whose fraction `seen` is resolved; it roughens the water.
SCARP_FN real scarp_wave_roughness(real seen, real slope) {
  return (real(1.0) - seen * seen) * slope * slope / real(kScarpWaves);
}

/// Sunlight that rough water reflects below a scattering sky, in linear light, at most as bright as the sun's disc.
/// Slopes are normally distributed around that of the unit normal, with the mean square `roughness` (C. Cox and W.
/// Munk, "Measurement of the roughness of the sea surface from photographs of the sun's glitter", JOSA 44, 1954).
/// `sunlight` is the light on a surface that faces the sun, `view` a unit vector from the eye.
SCARP_FN vec3 scarp_glitter(ScarpSky sky, vec3 sunlight, real3 view, real3 normal, real roughness, real reflectance) {
  // A facet turned by an angle turns the mirrored ray by twice that angle. The second term is the mean square over the
  // disc.
  real spread = roughness + real(sky.disc_square) / real(8.0);
  real3 facet = normalize(real3(sky.to_sun) - view);
  if (sky.scattering == 0 || spread == real(0.0) || facet.z <= real(0.0)) return vec3(0.0f);
  real x = facet.x / facet.z - normal.x / normal.z;
  real y = facet.y / facet.z - normal.y / normal.z;
  real square = facet.z * facet.z;
  real grazing = real(0.05);  // at lower angles waves hide one another
  real share =
      reflectance * exp(-(x * x + y * y) / spread) / (spread * real(4.0) * max(-view.z, grazing) * square * square);
  vec3 seen = sunlight * float(share);
  return vec3(min(seen.x, sky.disc.x), min(seen.y, sky.disc.y), min(seen.z, sky.disc.z));
}

/// The remaining fraction of light, per colour, after `metres` of water (Beer).
SCARP_FN vec3 scarp_left_after(vec3 per_metre, float metres) {
  return vec3(exp(-per_metre.x * metres), exp(-per_metre.y * metres), exp(-per_metre.z * metres));
}
/// The colour `behind`, seen through `metres` of water of the colour `deep`.
SCARP_FN vec3 scarp_through_water(vec3 behind, vec3 deep, vec3 per_metre, float metres) {
  vec3 left = scarp_left_after(per_metre, metres);
  return behind * left + deep * (vec3(1.0f) - left);
}
/// Length in metres of the path of sunlight through the water to a bottom `depth` metres below its level. Under water
/// the sun appears higher: its angle from the vertical has the sine cos(altitude) / n.
SCARP_FN real scarp_sun_way(real depth, real to_sun_z, real index) {
  real sideways = sqrt(max(real(0.0), real(1.0) - to_sun_z * to_sun_z)) / index;
  return max(real(0.0), depth) / sqrt(real(1.0) - sideways * sideways);
}

SCARP_GLSL_END

#endif
