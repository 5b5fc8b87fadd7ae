// SPDX-License-Identifier: MIT
// max-mip-easy as compilers without `precise` may compile it: operations fused and reordered.
#pragma once

#include "march/height/easy_judge.h"
#include "scarp/accel/max_pyramid.h"

namespace scarp::test {

EasyAnswer cast_reordered(const HeightField& field, const MaxPyramid& pyramid, glm::vec3 origin, glm::vec3 direction,
                          float t_max);

}  // namespace scarp::test
