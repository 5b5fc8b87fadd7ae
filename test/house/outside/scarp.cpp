// SPDX-License-Identifier: MIT
// Links scarp::scarp: a small terrain becomes a picture in a file, and a map.
#include <cstdint>
#include <vector>

#include "scarp/analysis/viewshed.h"
#include "scarp/render/camera/camera.h"
#include "scarp/render/frame/picture.h"
#include "scarp/scarp.h"

int main() {
  const std::vector<std::int16_t> samples{0, 1, 2, 1, 5, 1, 2, 1, 0};
  const auto terrain = scarp::Terrain::view(samples.data(), 3, 3);
  scarp::render(terrain, "outside.png", {.width = 32, .height = 32}, {});
  return scarp::viewshed(terrain.field(), {1, 1}).size() == samples.size() ? 0 : 1;
}
