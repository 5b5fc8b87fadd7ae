// SPDX-License-Identifier: MIT
// Rays and fields as the marches in single precision want them (march/height/ray_frame.glsl.h), and their answers back.
//
//   Ray, double, world ──▶ clipped to the field, cell + place, two floats per number ──▶ march in floats ──▶ Hit
//
// All that needs doubles is done here, once per ray: a ray from 10^7 m away begins, for the march, where it comes over
// the field.
#pragma once

#include "scarp/march/height/height_target.h"
#include "scarp/march/height/ray_frame.glsl.h"

namespace scarp {

/// The field as shaders see it; top_level and codes are 0 without a pyramid. The field must have cells and samples that
/// are not nodata.
glsl::ScarpField device_field(const HeightField& field, const MaxPyramid* pyramid);

/// A ray on its way to a march in single precision.
struct DeviceRay {
  DeviceRay() {
    ray.exit = -1;
    ray.flags = glsl::kScarpAbove;
  }

  glsl::ScarpRay ray{};  ///< ends before it begins, unless it marches
  double begin = 0;      ///< t = (begin + time) * per_time for a time that the march tells
  double per_time = 1;   ///< a power of two
  bool marches = false;  ///< whether there is anything to march: else `known` is the answer
  /// Whether it stays beside a line too long for floats to tell the ground from a hole there: the exhaustive march on
  /// the host has the answer.
  bool lingers = false;
  HitStatus known = HitStatus::miss;
};

/// For max-mip, clipped to the highest sample, too. `ray` must be valid (validate() of march/height/queries.h).
DeviceRay device_ray(const HeightField& field, const Ray& ray);
/// For the marches that take samples along the ray: it begins where they do, at the border or where its range begins.
/// `clip_at_top`: it ends where it rises above the highest sample, which changes no other point.
DeviceRay sampled_device_ray(const HeightField& field, const Ray& ray, bool clip_at_top = false);

/// The answer that belongs to a ray.
Hit hit_from_device(const Ray& ray, const DeviceRay& prepared, const glsl::ScarpHit& answer);

}  // namespace scarp
