// SPDX-License-Identifier: MIT
// When a sphere or capsule that moves along a segment first touches a triangle.
//
//       ( )===( )              the capsule is the points within `radius` of its segment a..b
//     ---->                    it touches the triangle when its centre line is within `radius` of it; so a point, a,
//         /\                   touches the triangle extended by the segment b..a and dilated by the radius: faces moved
//        /__\                  out by the radius, cylinders around the edges, spheres around the corners
//
// Guarantee: exact to rounding. A touch is a contact; a graze within rounding may be either. Source: C. Ericson,
// Real-Time Collision Detection (2005), 5.5.7, with the extension by a segment. Cost: 12 to 40 quadratic equations.
#pragma once

#include <optional>

#include "scarp/base/vec.h"

namespace scarp {

struct ClosestPair;  // closest_of.h

/// All points within `radius` of the segment a..b; a sphere if b is a.
struct Capsule {
  dvec3 a{0.0}, b{0.0};
  double radius = 0;  ///< metres, >= 0, finite
};

/// The first contact of a moving capsule.
struct Contact {
  double t = 0;       ///< fraction of the motion, 0..1; 0: it touches or overlaps at the start
  dvec3 point{0.0};   ///< where it touches
  dvec3 normal{0.0};  ///< unit, from the point towards the centre line; if that intersects the surface, the surface's
                      ///< normal towards the side that the motion comes from
  double depth = 0;   ///< metres; if t is 0: the way along the normal after which it only touches there
};

/// Throws Error unless a capsule and a motion are finite and the radius is not negative.
void validate(const Capsule& capsule, const dvec3& motion);

/// Returns the first t from 0 to `last` at which the capsule, moved by t * motion, touches the triangle.
std::optional<double> sweep_time(const Capsule& capsule, const dvec3& motion, const Triangle& triangle, double last);

/// Returns the contact of a capsule that overlaps or touches a surface at its start. `closest`: the closest points of
/// the centre line and the surface; `n`: a normal of the surface there, of any length.
Contact overlap_at(const Capsule& capsule, const dvec3& motion, const ClosestPair& closest, const dvec3& n);

/// Returns the contact with a triangle that is touched at t.
Contact contact_at(const Capsule& capsule, const dvec3& motion, const Triangle& triangle, double t);

/// Returns the fraction of the motion from which the capsule may touch a box; infinity if it does not until `last`. It
/// is never later than the first contact.
double sweep_bound(const Capsule& capsule, const dvec3& motion, const dvec3& low, const dvec3& high, double last);

}  // namespace scarp
