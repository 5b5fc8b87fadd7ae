// SPDX-License-Identifier: MIT
// Converts rays and fields to the form that the single-precision marches use (march/height/ray_frame.glsl.h), and
// converts results back.
//
//   Ray, double, world ──▶ clipped to the field, cell + place, two floats per number ──▶ march in floats ──▶ Hit
//
// Everything that needs doubles is done here, once per ray: for the march, a ray from 10^7 m away starts where it
// reaches the field.
#pragma once

#include "scarp/march/height/height_target.h"
#include "scarp/march/height/lean_place.glsl.h"
#include "scarp/march/height/ray_frame.glsl.h"

namespace scarp {

/// Returns the field in the form of shaders; top_level and codes are 0 without a pyramid. The field must have cells and
/// valid samples.
glsl::ScarpField device_field(const HeightField& field, const MaxPyramid* pyramid);
/// Returns the field's numbers for the lean pass of max-mip.
glsl::ScarpLeanCodes device_codes(const HeightField& field, const MaxPyramid& pyramid);

/// A ray prepared for a single-precision march.
struct DeviceRay {
  DeviceRay() {
    ray.exit = -1;
    ray.flags = glsl::kScarpAbove;
  }

  glsl::ScarpRay ray{};  ///< ends before it starts, unless it marches
  double begin = 0;      ///< t = (begin + time) * per_time for a time returned by the march
  double per_time = 1;   ///< a power of two
  bool marches = false;  ///< whether there is anything to march; otherwise `known` is the result
  /// Whether the ray stays beside a border or the rim of a hole too long for floats to distinguish the two sides. Such
  /// a ray is left to the exhaustive march on the host.
  bool lingers = false;
  HitStatus known = HitStatus::miss;
};

/// Prepares a ray for max-mip, also clipped to the highest sample. `ray` must be valid (validate() of
/// march/height/queries.h). `seam` is HeightTarget::seam.
DeviceRay device_ray(const HeightField& field, const Ray& ray, double seam = 0);
/// Prepares a ray for the sampling marches: it starts where they do, at the border or where its range starts.
/// `clip_at_top`: it ends where it rises above the highest sample, which changes no other point.
DeviceRay sampled_device_ray(const HeightField& field, const Ray& ray, bool clip_at_top = false);

/// Returns the result for a ray.
Hit hit_from_device(const Ray& ray, const DeviceRay& prepared, const glsl::ScarpHit& answer);

}  // namespace scarp
