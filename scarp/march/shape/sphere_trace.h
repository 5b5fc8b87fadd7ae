// SPDX-License-Identifier: MIT
// `sphere-trace`: advances by the field's value, the radius of a ball free of surface.
//
//        o-----------o--------o----o--o-o--.        each step is the radius of a ball free of surface; where balls get
//      (           )(       )(   )              ___ small, because the surface is ahead or beside the ray, segments of
//       `---------'  `-----'  `-'         __---     the ray are bounded instead (along() of the field): free if the
//                                  ___---           field's linear model minus its remainder is positive
//
// A segment is free, or free up to a point, or known to be below the surface from a point on: a Newton iteration that
// cannot overshoot. Where the surface is smooth its remainder is of second order, so that rays which graze a face or a
// ball take a few bounds instead of a thousand balls. The last interval, no longer than the tolerance, is refined (by
// secants) until the value is within rounding error.
//
// Guarantee: conservative, including rounding: it misses no crossing. A hit is a crossing, or a point that is
// indistinguishable from one within the tolerance. A ray that exceeds the step limit is exhausted, never a hit. A ray
// that starts inside is followed out of the solid; it is `below` unless it hits a surface from outside later. A ray
// that starts on the surface is outside by definition: it is free while it provably does not lose distance, and hits at
// its start if it provably loses some; there is no epsilon offset. Sources: J. C. Hart, "Sphere tracing", The Visual
// Computer 12, 1996; for the segments E. Galin et al., "Segment tracing using local Lipschitz bounds", Computer
// Graphics Forum 39(2), 2020.
#pragma once

#include "scarp/base/ray.h"
#include "scarp/field/distance_field.h"
#include "scarp/march/hit_rules.h"
#include "scarp/march/march_settings.h"

namespace scarp {

/// Closest hit; Hit::cell stays empty. Uses settings.sphere_trace. Overwrites `stats` unless null: steps counts values,
/// cell_tests counts segment bounds; both count towards the step limit.
Hit march_sphere_trace(const DistanceField& field, const Ray& ray, const MarchSettings& settings = {},
                       MarchStats* stats = nullptr);
/// Closest hit that the filter accepts. Behind a rejected hit the ray continues through the solid until it emerges,
/// like a ray that starts inside. Two hits within the tolerance may reach the filter as one, or one hit may reach it
/// twice.
Hit march_sphere_trace_filtered(const DistanceField& field, const Ray& ray, const HitFilter& accept,
                                const MarchSettings& settings = {}, MarchStats* stats = nullptr);
/// Any hit; does not refine the crossing.
bool occluded_sphere_trace(const DistanceField& field, const Ray& ray, const MarchSettings& settings = {});

}  // namespace scarp
