// SPDX-License-Identifier: MIT
// The light on the ground: a sun at a compass azimuth and altitude, and the sky around it.
//
// Level ground in full sun has the brightness 1 (for a sun at 30 degrees or more): in every channel below a plain sky,
// so colours of a ramp are unchanged there; slopes are brighter or darker. Shadowed ground receives only the bluish
// light of the sky, and more of it on the sun's side, so shadowed slopes keep their contrast.
#pragma once

#include "scarp/base/vec.h"
#include "scarp/render/light/sky_model.h"
#include "scarp/render/light/sun.h"

namespace scarp {

class Light {
 public:
  /// The settings must be valid. `grid_north_azimuth`: radians clockwise from true north.
  Light(const SunSettings& settings, double grid_north_azimuth, const SkySettings& sky = {});

  /// Unit vector to the middle of the sun's disc.
  const dvec3& to_sun() const { return to_sun_; }
  /// Angular radius of the disc.
  double sun_radius() const { return sun_radius_; }
  /// Unit vector to the brightest side of the sky.
  const dvec3& sky_side() const { return sky_side_; }
  /// The sun's light on a surface that faces it.
  vec3 sun() const { return sky_.sunlight(); }
  /// The sky's light on level ground.
  vec3 skylight() const { return sky_.skylight(); }
  const Sky& sky() const { return sky_; }
  /// Light on a surface with this unit normal, in linear light.
  vec3 on(const dvec3& normal, bool in_sun) const;
  /// The same with given visibility: `sun_cosine` is the mean cosine to the visible part of the sun's disc, 0..1,
  /// `sky_share` the unoccluded fraction of the sky, 0..1.
  vec3 on(const dvec3& normal, double sun_cosine, double sky_share) const;

 private:
  dvec3 to_sun_;
  double sun_radius_;
  dvec3 sky_side_;
  Sky sky_;
};

}  // namespace scarp
