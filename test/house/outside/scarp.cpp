// SPDX-License-Identifier: MIT
// Links scarp::scarp: a small terrain becomes a picture in a file.
#include <cstdint>
#include <vector>

#include "scarp/render/camera/camera.h"
#include "scarp/render/frame/picture.h"
#include "scarp/scarp.h"

int main() {
  const std::vector<std::int16_t> samples{0, 1, 2, 1, 5, 1, 2, 1, 0};
  scarp::render(scarp::Terrain::view(samples.data(), 3, 3), "outside.png", {.width = 32, .height = 32}, {});
}
