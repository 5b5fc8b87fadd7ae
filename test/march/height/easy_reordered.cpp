// SPDX-License-Identifier: MIT
// Compiled with -funsafe-math-optimizations -ffp-contract=fast (test/march/CMakeLists.txt).
#include "march/height/easy_reordered.h"

// A separate class: the linker would keep only one of two equal ones.
#define Ground ReorderedGround
#include "scarp/march/height/max_mip_easy_ground.h"

namespace scarp::test {

EasyAnswer cast_reordered(const HeightField& field, const MaxPyramid& pyramid, glm::vec3 origin, glm::vec3 direction,
                          float t_max) {
  easy::ReorderedGround ground(field, pyramid);
  const auto hit = ground.max_mip_easy(origin, direction, t_max, false);
  return {hit.hit, hit.below, double{hit.t}, {hit.cell.x, hit.cell.y}, double{hit.place.x}, double{hit.place.y}};
}

}  // namespace scarp::test
