// SPDX-License-Identifier: MIT
// Fraction of the sky and of the sun's disc visible from a surface point, sampled with any-hit rays. The rays start on
// the surface without an offset, so nothing is lit through a ridge and a plane does not shade itself.
//
//   ask_...(point, ..., rays)  appends rays    ──▶  Scene::occluded  ──▶    sky_occlusion, sun_cosine of the results
//
// Two normals are involved. Visibility depends on the surface alone: the sky is above its tangent plane, and rays below
// it are blocked. Brightness depends on the shading normal, which is continuous from cell to cell. Occlusion around the
// surface's normal changes little from cell to cell: the two sides of a concave crease hide the same fraction of each
// other's sky, and the two sides of a ridge hide nothing. Around the shading normal a ridge would be dark.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scarp/base/ray.h"
#include "scarp/render/light/sample_pattern.h"
#include "scarp/scene/scene.h"

namespace scarp {

/// A point on a surface, in world space.
struct LightPoint {
  dvec3 position;
  dvec3 normal;              ///< unit, of the surface
  dvec3 shading_normal;      ///< unit
  double openness = 1;       ///< fraction of the sky that is visible, if it is not sampled
  std::uint32_t object = 0;  ///< start of rays from the point: Ray::start_object and start_cell
  Cell cell{};
};

/// The point that was hit.
LightPoint light_point(const SceneSurface& surface, const Hit& hit);

/// Samples of one picture sample: points [first, first + count) of a pixel. count >= 1.
struct PatternRange {
  PixelPoints points;
  std::uint32_t first = 0;
  std::uint32_t count = 1;
};

/// Appends one ray per sample to the sky above the tangent plane, cosine-weighted, of length `distance` metres.
void ask_sky(const LightPoint& point, double distance, const PatternRange& samples, std::vector<Ray>& rays);
/// Ambient occlusion: the cosine-weighted fraction of the sky above the tangent plane that ground closer than
/// `distance` hides; 0..1. `blocked` holds the results of the rays of ask_sky, at least one. The standard error is at
/// most 1 / (2 sqrt(count)), that of unstratified samples.
double sky_occlusion(std::span<const std::uint8_t> blocked);

/// Appends rays to the sun's disc, of angular radius `radius` in radians around the unit vector `to_sun`; one to its
/// centre if the radius is 0. Omits directions behind the shading normal.
void ask_sun(const LightPoint& point, const dvec3& to_sun, double radius, const PatternRange& samples,
             std::vector<Ray>& rays);
/// Returns the mean over the sun's disc of the cosine between shading normal and ray, 0..1; hidden parts and parts
/// behind the normal contribute zero. `rays` are those of ask_sun for `radius` and `count` samples, `blocked` their
/// results.
double sun_cosine(const LightPoint& point, double radius, std::uint32_t count, std::span<const Ray> rays,
                  std::span<const std::uint8_t> blocked);

}  // namespace scarp
