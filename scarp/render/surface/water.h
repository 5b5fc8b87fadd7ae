// SPDX-License-Identifier: MIT
// Still water over the ground, up to a level: where rays hit it, and its reflection, refraction and absorption.
//
//    eye \      / reflected        the level is a plane, intersected in closed form: a coast is where ground crosses
//   ______\____/_______            it, to the last bit, and no step size of a march can fray it
//          \  .'  .               R  = R0 + (1 - R0) (1 - cos)^5, R0 = ((n - 1) / (n + 1))^2     (Schlick 1994)
//           \    .                 the rest continues, refracted by Snell's law, to the bottom
//      ______\_.'__                 and comes back as bottom * exp(-c d) + the water's own colour * (1 - exp(-c d))
//                                                                                          (Beer; d as traced)
// Absorption is that of pure water at 650, 550 and 450 nm (Pope and Fry 1997), plus `turbidity` for suspended matter.
// Waves only tilt the normal: a sum of sines in different directions with slopes in closed form. Waves shorter than the
// width of a pixel are omitted; they widen the sun's reflection to glitter (Cox and Munk 1954).
//
// A bounded scene holds water in its box, like a basin whose sides are also hit; over unbounded ground the water is
// unbounded.
#pragma once

#include <optional>

#include "scarp/base/ray.h"
#include "scarp/scene/scene.h"

namespace scarp {

struct WaterSettings {
  double level = 0;                ///< metres, not exaggerated; finite
  double turbidity = 0.04;         ///< absorption per metre, the same for all colours; >= 0
  vec3 srgb{0.10f, 0.25f, 0.33f};  ///< colour of deep water, sRGB 0..1
  double waves = 0.02;             ///< mean slope of the surface (root mean square), 0..0.5; 0: a mirror
  double wavelength = 0;           ///< length of the longest wave in metres, >= 0; 0: two cells or voxels
  bool refraction = true;          ///< whether rays continue to the bottom; false: the water has one colour
  bool reflection = true;          ///< whether reflected rays are traced; false: they see only the sky
};

/// Throws Error naming the first setting out of range.
void validate(const WaterSettings& settings);

/// Refractive index from air to water.
constexpr double kWaterIndex = 1.333;

/// Returns the reflected fraction of light, 0..1, for this cosine of the angle between ray and normal.
double schlick(double cosine, double index = kWaterIndex);

class Water {
 public:
  /// The settings must be valid. Refers to the scene.
  Water(const WaterSettings& settings, const Scene& scene);

  const WaterSettings& settings() const { return settings_; }
  /// World z in metres, exaggerated like the terrain of the scene.
  double level() const { return level_; }

  struct Meeting {
    double t;                  ///< in lengths of the ray's direction
    dvec3 normal;              ///< unit, of the still water: up, or level at the sides of the basin
    std::optional<Hit> sea{};  ///< set where is_sea() is true: object and cell
  };
  /// Returns where a ray enters the water from outside, within its range; a surface may be hit before. Returns nullopt
  /// if the ray starts in the water, over holes of a terrain, and where the ground is above the level.
  std::optional<Meeting> meets(const Ray& ray) const;
  /// Whether a hit is on a cell of the scene's only terrain with all corners exactly at the level: a sea that the
  /// elevation model represents as flat ground, of unknown depth.
  bool is_sea(const Hit& hit) const;
  /// Returns where a ray in the water leaves the basin; infinite if it is unbounded.
  double leaves(const Ray& ray) const;

  /// Unit normal of the surface with its waves; `footprint` is the width of a pixel there in metres.
  dvec3 normal_at(const dvec3& position, double footprint) const;
  /// Mean square of the wave slopes that normal_at() omits.
  double roughness_at(double footprint) const;
  /// Returns the colour of the bottom, or of another surface, seen through `distance` metres of water, in linear light.
  vec3 through(vec3 behind, double distance) const;
  /// Returns the remaining fraction of sunlight per colour, `depth` metres below the surface; to_sun is a unit vector.
  vec3 sunlight(double depth, const dvec3& to_sun) const;
  /// Colour of water without a visible bottom.
  vec3 deep() const { return deep_; }

  /// Absorption per metre and colour.
  vec3 per_metre() const { return per_metre_; }
  /// Direction of wave i of glsl::kScarpWaves, a unit vector, and its length in metres.
  static dvec2 wave_direction(int i);
  double wavelength(int i) const;

 private:
  std::optional<Meeting> from_above(const Ray& ray, double t) const;
  bool is_sea(Cell cell) const;

  WaterSettings settings_;
  const Scene& scene_;
  const HeightField* field_;  // null: the scene has no terrain
  WorldBox basin_;
  double level_, wavelength_;
  vec3 deep_, per_metre_;
};

/// Returns the direction mirrored at a unit normal that points against it.
dvec3 reflected(const dvec3& direction, const dvec3& normal);
/// Returns the direction refracted on entering water from air (Snell). Both are unit vectors; `normal` points against
/// `direction`.
dvec3 refracted(const dvec3& direction, const dvec3& normal, double index = kWaterIndex);

}  // namespace scarp
