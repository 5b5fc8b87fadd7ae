// SPDX-License-Identifier: MIT
// A scene that changes: a ball rolls over a plain where a hill is raised, while another thread casts rays.
#include <atomic>
#include <cstdio>
#include <thread>
#include <vector>

#include "scarp/scarp.h"
#include "scarp/scene/live_scene.h"

int main() {
  // A plain of 1 km x 1 km at height 0, and a ball with a radius of 20 m.
  const int side = 101;
  auto terrain = scarp::Terrain::own(std::vector<float>(side * side, 0.0f), side, side, {.cell_x = 10, .cell_y = 10});
  const auto ball = scarp::scene_shape(scarp::DistanceField(scarp::make_shape(scarp::shape::Sphere{20})));

  scarp::LiveScene live;
  std::uint32_t ground = 0, rolling = 0;
  live.edit([&](auto& editor) {
    ground = editor.add(terrain);
    rolling = editor.add(ball, {.origin = {100, 500, 20}});
  });

  // Each reading sees one state, regardless of concurrent edits: the ball is always in sight, exactly once.
  std::atomic<bool> done{false};
  std::atomic<int> wrong{0};
  std::thread watcher([&] {
    std::vector<scarp::Ray> rays;
    for (int i = 0; i <= 10; ++i) rays.push_back({.origin = {100.0 * i, 500, 500}, .direction = {0, 0, -1}});
    std::vector<scarp::Hit> hits(rays.size());
    while (!done) {
      const auto reading = live.read();
      scarp::cast(reading.scene(), rays, hits);
      int seen = 0;
      for (const scarp::Hit& hit : hits) seen += hit && hit.object == rolling;
      wrong += seen != 1;
    }
  });
  for (int step = 2; step <= 9; ++step)
    live.edit([&](auto& editor) { editor.move(rolling, {.origin = {100.0 * step, 500, 20}}); });

  // The hill and the ball on top of it appear together.
  const std::vector<float> hill(25, 60.0f);
  live.edit([&](auto& editor) {
    terrain.set_samples({.col = 48, .row = 48, .cols = 5, .rows = 5}, hill.data());
    editor.move(rolling, {.origin = {500, 500, 80}});
  });
  done = true;
  watcher.join();

  const auto reading = live.read();
  const scarp::Hit across = scarp::cast(reading.scene(), {.origin = {0, 500, 30}, .direction = {1, 0, 0}});
  const scarp::Hit above = scarp::cast(reading.scene(), {.origin = {500, 500, 500}, .direction = {0, 0, -1}});
  std::printf("epoch %d: the ray across hits the %s, the ray from above the %s; wrong readings: %d\n",
              static_cast<int>(reading.epoch()), across.object == ground ? "hill" : "ball",
              above.object == rolling ? "ball" : "hill", wrong.load());
  return 0;
}
