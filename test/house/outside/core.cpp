// SPDX-License-Identifier: MIT
// Links only scarp::core: rays straight down on a plane 5 m high and on voxels that stand on it.
#include <cstdint>
#include <vector>

#include "scarp/scarp.h"

int main() {
  const std::vector<std::int16_t> samples(9, 5);
  const auto terrain = scarp::Terrain::view(samples.data(), 3, 3);
  const std::vector<std::uint8_t> indices(8, 1);
  const auto voxels = scarp::Voxels::copy(indices.data(), {2, 2, 2}, {.side = 0.5});
  const scarp::Scene scene = scarp::combine({{terrain}, {voxels, {.origin = {1, 1, 5}}}});
  const std::vector<scarp::Ray> rays{{.origin = {0.5, 0.5, 15}}, {.origin = {1.25, 1.25, 15}}};
  std::vector<scarp::Hit> hits(rays.size());
  scarp::cast(scene, rays, hits);
  return hits[0].t == 10.0 && hits[1].t == 9.0 && scarp::cast(terrain, rays[1]).t == 10.0 ? 0 : 1;
}
