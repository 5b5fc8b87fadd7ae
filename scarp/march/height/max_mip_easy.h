// SPDX-License-Identifier: MIT
// `max-mip-easy`: max-mip as one short source file to paste into other shaders (max_mip_easy.glsl.h), here compiled as
// C++ in single precision.
//
// Takes bilinear fields without holes and wrap. A ray that starts or enters below the ground stops there: the result is
// `below`, or a wall if the field is solid and the ray enters through the border. A ray from the surface starts above
// it by the rounding bound.
//
// Guarantee: conservative up to the rounding of floats. Never passes a point that is below the ground by more than the
// bound of doc/dev/numerics.md ("The easy text"), and reports no hit that is farther above the ground than that.
// Source: see max_mip.h. Cost: that of max-mip in blocks and cells.
#pragma once

#include "scarp/march/height/height_target.h"
#include "scarp/march/march_settings.h"

namespace scarp {

/// Closest hit; conventions as in ray.h. Requires the field's pyramid. Throws Error for other fields. MarchStats::steps
/// counts blocks and cells, cell_tests the cells among them.
Hit march_max_mip_easy(const HeightTarget& target, const Ray& ray, const MarchSettings& settings = {},
                       MarchStats* stats = nullptr);

}  // namespace scarp
