// SPDX-License-Identifier: MIT
// Height fields that meet in a scene leave no gap, for any cell size and position.
#include <gtest/gtest.h>

#include <vector>

#include "march/height/spiteful.h"
#include "scarp/scarp.h"

namespace scarp::test {
namespace {

TEST(Seams, PassNoRay) {
  constexpr int kSide = 65, kRays = 40'000;
  const std::vector<float> flat(kSide * kSide, 0.0f);
  for (const auto& [cell, corner] : {std::pair(1.0, 0.0), {0.3, 0.0}, {0.1, 123456.7}, {1.0 / 3, -7e5}}) {
    const Terrain tile = Terrain::view(flat.data(), kSide, kSide, {.cell_x = cell, .cell_y = cell});
    const double width = (kSide - 1) * cell;
    const Scene scene =
        combine({{tile, {.origin = {corner, corner, 0}}}, {tile, {.origin = {corner + width, corner, 0}}}});
    Random random(6);
    std::vector<Ray> rays(kRays);
    for (Ray& ray : rays) {
      const dvec3 aim(corner + width, corner + uniform(random, 0, width), 0);
      ray.origin = {corner + uniform(random, 0, 2 * width), corner + uniform(random, 0, width), uniform(random, 1, 50)};
      ray.direction = aim - ray.origin;
    }
    std::vector<Hit> hits(rays.size());
    cast(scene, rays, hits);
    std::vector<std::uint8_t> blocked(rays.size());
    occluded(scene, rays, blocked);
    int lost = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) lost += !hits[i] || !blocked[i];
    EXPECT_EQ(lost, 0) << "cell " << cell << " at " << corner;
    // Straight down, next to the seam and on it.
    for (const double x : {std::nextafter(corner + width, -1e9), corner + width, std::nextafter(corner + width, 1e9)})
      EXPECT_TRUE(cast(scene, Ray{{x, corner + 0.5 * width, 9}})) << x;
  }
}

}  // namespace
}  // namespace scarp::test
