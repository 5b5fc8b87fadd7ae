// SPDX-License-Identifier: MIT
// How much of the sky and of the sun's disc a point of the ground sees, by sampling with any-hit rays. The rays start
// on the surface of their cell: no offset, so nothing is lit through a ridge and a plane does not shade itself.
//
// Two normals meet here. What is visible is a matter of the surface alone: the sky is that over its own tangent plane,
// and whatever ray goes below it is blocked. How bright visible light makes the ground is a matter of the shading
// normal, which is continuous from cell to cell. Occlusion round the surface's normal steps little from cell to cell:
// both sides of a hollow crease hide the same share of each other's sky, and those of a ridge hide nothing. Round the
// shading normal a ridge would be dark.
#pragma once

#include "scarp/render/sample_pattern.h"
#include "scarp/scene/terrain_scene.h"

namespace scarp {

/// A point on the ground, in world space.
struct GroundPoint {
  dvec3 position;
  Cell cell;
  dvec3 normal;          ///< unit, of the surface
  dvec3 shading_normal;  ///< unit
};

/// Of what is visible from a hit of a ray.
GroundPoint ground_point(const HeightField& field, const Ray& ray, const Hit& hit);

/// Samples of one picture sample: points [first, first + count) of a pixel. count >= 1.
struct PatternRange {
  PixelPoints points;
  std::uint32_t first = 0;
  std::uint32_t count = 1;
};

/// Ambient occlusion: the share of the sky over the tangent plane, weighted with the cosine to its normal, that ground
/// closer than `distance` metres hides; 0..1. The standard error is at most 1 / (2 sqrt(count)), that of unstratified
/// samples.
double sky_occlusion(const TerrainScene& scene, const GroundPoint& point, double distance, const PatternRange& samples);

/// The mean over the sun's disc, of angular radius `radius` in radians round the unit vector `to_sun`, of the cosine
/// between shading normal and ray, hidden parts and parts behind the normal counting nothing; 0..1. One ray to the
/// middle when the radius is 0.
double sun_cosine(const TerrainScene& scene, const GroundPoint& point, const dvec3& to_sun, double radius,
                  const PatternRange& samples);

/// Whether ground is between the point and something infinitely far in a direction.
bool hidden(const TerrainScene& scene, const GroundPoint& point, const dvec3& direction);

}  // namespace scarp
