// SPDX-License-Identifier: MIT
// `sphere-trace`: from where the ray is nothing of the surface is nearer than the field's value; so it goes on by that.
//
//        o-----------o--------o----o--o-o--.        each step is the radius of a ball that is free of the surface;
//      (           )(       )(   )              ___ where they get short, because the surface is ahead or beside
//       `---------'  `-----'  `-'         __---     the ray, segments of the ray are bounded now and then (along() of
//                                  ___---           the field): free if the field's line less its remainder is positive
//
// A segment is free, or free up to a point, or known to be under the surface from a point on: a Newton iteration that
// cannot overshoot. Where the surface is smooth its remainder is of second order, so that rays which graze a face or a
// ball take a few bounds instead of a thousand balls. The last interval, no longer than the tolerance, is halved (by
// secants) until the value is rounding.
//
// Guarantee: conservative, with rounding counted: no crossing is passed. A hit is a crossing, or a place where the ray
// cannot be told from one within the tolerance. Used-up steps are exhausted, never a hit. A ray that begins inside is
// followed out of the solid; unless it hits a surface from outside later it is below. A ray that begins on the surface
// is outside by definition: it is free as long as it provably does not lose distance, and hits where it begins if it
// provably loses some; nothing is pushed off by an epsilon. Sources: J. C. Hart, "Sphere tracing", The Visual Computer
// 12, 1996; for the segments E. Galin et al., "Segment tracing using local Lipschitz bounds", Computer Graphics Forum
// 39(2), 2020.
#pragma once

#include "scarp/base/ray.h"
#include "scarp/field/distance_field.h"
#include "scarp/march/march_settings.h"

namespace scarp {

/// Closest hit; Hit::cell stays empty. Uses settings.sphere_trace. `stats`, when given, is overwritten: steps are
/// values looked at, cell_tests bounds of segments; both count as steps for the limit.
Hit march_sphere_trace(const DistanceField& field, const Ray& ray, const MarchSettings& settings = {},
                       MarchStats* stats = nullptr);
/// Whether that is a hit, without closing in on it.
bool occluded_sphere_trace(const DistanceField& field, const Ray& ray, const MarchSettings& settings = {});

}  // namespace scarp
