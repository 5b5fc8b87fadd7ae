// SPDX-License-Identifier: MIT
// A batch of rays on a Vulkan device, with the same call as on the CPU: gpu_batch [DEVICE]; the default is the best
// device.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "scarp/scarp.h"
#include "scarp/scene/scene_vk.h"

int main(int argc, char** argv) try {
  const int side = 513;
  std::vector<float> heights;
  for (int i = 0; i < side * side; ++i)
    heights.push_back(static_cast<float>(40.0 * (std::sin(0.05 * (i % side)) + std::cos(0.04 * (i / side)))));
  const auto terrain = scarp::Terrain::view(heights.data(), side, side, {.cell_x = 10.0, .cell_y = 10.0});

  // Copies the samples into device memory and builds the pyramid there.
  const scarp::Device device({.choice = argc > 1 ? argv[1] : "auto"});
  const scarp::Scene on_device = scarp::scene_on(device, terrain);

  std::vector<scarp::Ray> rays;
  for (int i = 0; i < 100'000; ++i)
    rays.push_back({.origin = {5.1 * (i % 1000), 51.0 * (i / 1000), 300}, .direction = {0.3, 0.2, -1}});
  std::vector<scarp::Hit> hits(rays.size()), exact(rays.size());
  scarp::cast(on_device, rays, hits);

  // Devices compute in single precision: hits agree with the CPU's to about a thousandth of a cell.
  scarp::cast(terrain, rays, exact);
  double farthest = 0;
  int hit = 0, different = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    hit += hits[i] ? 1 : 0;
    if (static_cast<bool>(hits[i]) != static_cast<bool>(exact[i])) ++different;
    if (hits[i] && exact[i]) farthest = std::max(farthest, std::abs(hits[i].t - exact[i].t));
  }
  std::printf("%s: %d of %zu rays hit; %d differ from the CPU; t within %.0e m\n", device.description().name.c_str(),
              hit, rays.size(), different, farthest);
  return 0;
} catch (const scarp::Error& error) {
  std::fprintf(stderr, "gpu_batch: error: %s\n", error.what());
  return 1;
}
