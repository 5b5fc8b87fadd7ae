// SPDX-License-Identifier: MIT
// Depths for other renderers: the z-buffer value of a point that a ray hit.
//
//              near                      far            z   metres along the camera's view axis (linear view depth)
//   eye *-------|----------*---------------|-->  z      r   metres along the ray: r = z / cos of the angle to the axis
//                '.        |
//                   '. r   |         device depth = f / (f - n) * (1 - n / z), 0 at z = n, 1 at z = f
//                      '.  |
//                         '*         A perspective projection takes (x, y, z) to clip coordinates with w = z and
//                                    z_clip = (f z - f n) / (f - n) (Vulkan, [0, 1]); OpenGL's clip depth,
//   z_ndc = (f + n) / (f - n) - 2 f n / ((f - n) z) in [-1, 1], becomes (z_ndc + 1) / 2 in the window: the same number.
//
// The founding text on the semi-voxel caster uses r in this formula, "the distance along the ray -- the same as the
// vertex - eye distance". That is true only on the view axis: in the corner of a 4:3 picture with a field of view of 60
// degrees, r is 1.39 times z, and terrain written this way is behind meshes that it should hide. With `reversed`, the
// depth is 1 minus this value, so floats keep their precision at the far end (n / z for an infinite far plane).
#pragma once

#include <limits>

#include "scarp/base/vec.h"

namespace scarp {

struct DepthRange {
  double near_m = 1;                                       ///< above 0
  double far_m = std::numeric_limits<double>::infinity();  ///< above near_m; may be infinite
  bool reversed = false;                                   ///< 1 at the near plane, 0 at the far one
};

/// Throws Error if a plane is out of range.
void validate(const DepthRange& range);

/// Returns the distance along the view axis, in metres, of the point that is t lengths of `direction` from the eye.
/// `forward` is the axis, a unit vector.
inline double view_depth(const dvec3& direction, double t, const dvec3& forward) { return t * dot(direction, forward); }

/// Returns the depth buffer value of OpenGL (window depth, default glDepthRange) and Vulkan for a view depth in metres:
/// 0..1 between the planes, outside this range beyond them. An infinite z means no surface.
double device_depth(double z, const DepthRange& range);
/// The inverse of device_depth(). Infinite on an infinite far plane.
double view_depth_from_device(double depth, const DepthRange& range);

}  // namespace scarp
