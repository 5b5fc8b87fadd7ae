// SPDX-License-Identifier: MIT
// The colour that a ray of the camera has in the look `shaded`, given what it meets and what is seen from there.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "scarp/render/camera.h"
#include "scarp/render/film.h"
#include "scarp/render/lighting.h"
#include "scarp/render/picture.h"
#include "scarp/render/ramp.h"
#include "scarp/render/sight.h"
#include "scarp/render/visibility.h"

namespace scarp {

/// The name of the ramp in the settings, or what suits the look.
std::string_view ramp_of(const PictureSettings& settings);

/// Throws Error when the field has nothing to see: no cells, no valid samples.
void require_ground(const HeightField& field);

/// Everything that a picture in the look `shaded` needs but rays. Refers to field, camera and settings.
class Shader {
 public:
  Shader(const HeightField& field, const Camera& camera, double grid_north_azimuth, const PictureSettings& settings);

  const HeightField& field() const { return field_; }
  const Lighting& lighting() const { return lighting_; }
  /// Of ground, in linear light; `rays` and their answers are those that `asked` refers to.
  vec3 ground_colour(const Hit& hit, const GroundPoint& ground, const LightRays& asked, std::span<const Ray> rays,
                     std::span<const std::uint8_t> blocked) const;
  /// Of what is not ground: walls and the sky, in linear light.
  vec3 colour_beside_ground(const Ray& ray, const Sight& sight) const;

 private:
  double ground_height(const Hit& hit) const;
  vec3 wall_colour(const dvec3& normal) const;
  vec3 in_haze(vec3 colour, double t) const;

  const HeightField& field_;
  Ramp ramp_;
  Lighting lighting_;
  vec3 earth_;
  double clear_distance_ = 0;
  double haze_per_metre_ = 0;
};

}  // namespace scarp
