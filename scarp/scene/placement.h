// SPDX-License-Identifier: MIT
// Placements of objects: rotation, uniform scale, translation.
//
//   p_world = scale * turn * p_field + origin
//
// t is the same in both spaces: directions are rotated and scaled, and never normalised.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "scarp/base/ray.h"

namespace scarp {

/// A rotation, a uniform scale and a translation, in this order. For a rotation by an angle about an axis:
/// `glm::dmat3(glm::rotate(glm::dmat4(1), radians, axis))`, from <glm/gtc/matrix_transform.hpp>.
struct Placement {
  dmat3 turn{1.0};    ///< a rotation
  double scale = 1;   ///< > 0
  dvec3 origin{0.0};  ///< metres

  dvec3 world_from_field(const dvec3& p) const { return scale * (turn * p) + origin; }
  dvec3 world_from_normal(const dvec3& n) const { return turn * n; }
  dvec3 field_from_world(const dvec3& p) const { return ((p - origin) * turn) / scale; }
  /// Exact for the identity.
  Ray field_from_world(const Ray& ray) const {
    Ray local = ray;
    local.origin = ((ray.origin - origin) * turn) / scale;  // v * M is transpose(M) * v
    local.direction = (ray.direction * turn) / scale;
    return local;
  }

  bool identity() const { return turn == dmat3(1.0) && scale == 1 && origin == dvec3(0.0); }
  /// Whether z stays up, that is, the rotation is about z only. Rounding reduces the cosine by about 2^-50; a tilt of
  /// 2^-20 is detected.
  bool upright() const { return turn[2].z >= 1 - 0x1p-41; }
};

/// Applies `inner`, then `outer`.
inline Placement placed(const Placement& outer, const Placement& inner) {
  return {outer.turn * inner.turn, outer.scale * inner.scale, outer.world_from_field(inner.origin)};
}

}  // namespace scarp
