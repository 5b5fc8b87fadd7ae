// SPDX-License-Identifier: MIT
// What a ray of the camera meets, and the colour that it has in the look `shaded`.
#pragma once

#include <optional>
#include <string_view>

#include "scarp/render/camera.h"
#include "scarp/render/film.h"
#include "scarp/render/light.h"
#include "scarp/render/picture.h"
#include "scarp/render/plinth.h"
#include "scarp/render/ramp.h"
#include "scarp/render/sample_pattern.h"
#include "scarp/scene/terrain_scene.h"

namespace scarp {

/// The name of the ramp in the settings, or what suits the look.
std::string_view ramp_of(const PictureSettings& settings);

/// Throws Error when the field has nothing to see: no cells, no valid samples.
void require_ground(const HeightField& field);

/// What a ray of the camera meets: ground, or else perhaps a wall.
struct Sight {
  Hit hit;
  std::optional<Plinth::Wall> wall;
};

/// Nothing when the settings want none.
std::optional<Plinth> plinth_of(const HeightField& field, const PictureSettings& settings);

/// Rays are not marched where the block hides the field: below its base and behind its outer walls. `stats`, when
/// given, is overwritten by rays that are marched.
Sight look(const TerrainScene& scene, const std::optional<Plinth>& plinth, Ray ray, MarchStats* stats = nullptr);

/// Everything that one point of a picture in the look `shaded` needs. Refers to scene, camera and settings.
class Shader {
 public:
  Shader(const TerrainScene& scene, const Camera& camera, double grid_north_azimuth, const PictureSettings& settings);

  /// In linear light.
  vec3 colour(const PicturePoint& point) const;

 private:
  double ground_height(const Hit& hit) const;
  vec3 wall_colour(const dvec3& normal) const;
  vec3 light_on(const Ray& ray, const Hit& hit, const PicturePoint& point) const;
  vec3 in_haze(vec3 colour, double t) const;

  const TerrainScene& scene_;
  const HeightField& field_;
  const Camera& camera_;
  const PictureSettings& settings_;
  Ramp ramp_;
  Light light_;
  SamplePattern pattern_;
  double ao_distance_;
  vec3 earth_;
  std::optional<Plinth> plinth_;
  double clear_distance_ = 0;
  double haze_per_metre_ = 0;
};

}  // namespace scarp
