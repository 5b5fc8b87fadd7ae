// SPDX-License-Identifier: MIT
// The first contact of a moving capsule with a part of a bilinear cell, and the closest point of the part, by Newton's
// method, with a proof that there is no earlier or closer one.
//
//        ( e )           The end e of the capsule touches the patch at p, with the normal n. Above the tangent plane,
//        the /    m          patch rises at most like a parabola of curvature k, and the capsule at earlier times lies
//        above a
//       v                cone around a ball. If the ball is more curved than the parabola, and the cone is above it as
//       far
//   ___( )____ __        as the patch reaches, the patch was not touched before.
//      `-p--''           n
//
// Guarantee: where `proven`, no point of the patch is deeper than `slack` in the capsule before `t`. Otherwise the
// contact is a touch, but perhaps not the first one. Cost: about as much as a triangle.
#pragma once

#include <optional>

#include "scarp/march/sweep.h"

namespace scarp {

/// The points corner + u * along_u + v * along_v + (0, 0, twist) * u * v, in metres, for u and v from 0 to 1; along_u
/// is in the plane y = 0, along_v in the plane x = 0.
struct Patch {
  dvec3 corner, along_u, along_v;
  double twist;

  dvec3 at(double u, double v) const { return corner + u * along_u + v * along_v + dvec3(0, 0, twist * u * v); }
};

struct PatchContact : Contact {
  bool proven = false;
};

struct PatchPoint {
  double u, v;
  dvec3 point;
  double distance;      ///< metres
  bool proven = false;  ///< no point of the patch is closer by more than `slack`
};

/// Returns a contact not after `last`; nullopt if none was found, which proves nothing. `slack`: metres.
std::optional<PatchContact> patch_contact(const Patch& patch, const Capsule& capsule, const dvec3& motion, double last,
                                          double slack);

/// Returns a point of the patch near p: the closest one, if `proven`. `slack`: metres, > 0.
PatchPoint closest_of_patch(const Patch& patch, const dvec3& p, double slack);

}  // namespace scarp
