// SPDX-License-Identifier: MIT
// A terrain larger than memory: tiles around a moving eye, with full resolution near it, while another thread casts
// rays.
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

#include "scarp/scarp.h"
#include "scarp/scene/tiled_terrain.h"

namespace {

constexpr int kTiles = 20, kCells = 64;
constexpr double kCell = 10;

float height(double x, double y) {
  return static_cast<float>(120 * std::sin(0.0011 * x) * std::cos(0.0007 * y) + 15 * std::sin(0.013 * (x + y)));
}

// A real program would read these from a file.
scarp::HeightField load(scarp::TilePlace place, int level) {
  const int step = 1 << level, side = kCells / step + 1;
  std::vector<float> samples;
  for (int row = 0; row < side; ++row) {
    for (int col = 0; col < side; ++col)
      samples.push_back(height((place.col * kCells + col * step) * kCell, (place.row * kCells + row * step) * kCell));
  }
  return scarp::HeightField::own(std::move(samples), side, side, {.cell_x = kCell * step, .cell_y = kCell * step});
}

// The tile below the eye and its neighbours have full detail, the next two rings are coarser; -1: not loaded.
int wanted_level(scarp::TilePlace place, int eye_col, int eye_row) {
  const int away = std::max(std::abs(place.col - eye_col), std::abs(place.row - eye_row));
  return away <= 1 ? 0 : away <= 3 ? away - 1 : -1;
}

}  // namespace

int main() {
  scarp::TiledTerrain terrain({.cols = kTiles,
                               .rows = kTiles,
                               .cell_cols = kCells,
                               .cell_rows = kCells,
                               .ground = {.cell_x = kCell, .cell_y = kCell}});
  std::atomic<int> eye{-1};
  std::atomic<bool> done{false};
  std::atomic<int> lost{0}, frames{0};
  // Steep rays around the eye hit the ground in every frame: there are no gaps between levels, and no tile is half
  // loaded.
  std::thread frame([&] {
    while (!done) {
      const scarp::TerrainTiles tiles = terrain.read();
      const int col = eye;
      if (col < 0 || !tiles.tile({col, kTiles / 2})) continue;
      std::vector<scarp::Ray> rays;
      for (int i = 0; i < 1000; ++i) {
        const double x = (col + 0.5) * kCells * kCell, y = (kTiles / 2 - 0.5) * kCells * kCell;
        rays.push_back({.origin = {x, y, 400}, .direction = {std::sin(i), std::cos(i), -1 - i % 7}});
      }
      std::vector<scarp::Hit> hits(rays.size());
      scarp::cast(tiles, rays, hits);
      for (const scarp::Hit& hit : hits) lost += !hit;
      ++frames;
    }
  });
  int loaded = 0;
  for (int col = 3; col < kTiles - 3; ++col) {
    const scarp::TerrainTiles now = terrain.read();
    terrain.edit([&](auto& editor) {
      for (int i = 0; i < kTiles * kTiles; ++i) {
        const scarp::TilePlace place{i % kTiles, i / kTiles};
        const int level = wanted_level(place, col, kTiles / 2);
        const scarp::HeightField* there = now.tile(place);
        const int level_there = there ? static_cast<int>(std::lround(std::log2(there->settings().cell_x / kCell))) : -1;
        if (level == level_there) continue;
        if (there) editor.remove(place);
        if (level < 0) continue;
        editor.put(place, load(place, level));
        ++loaded;
      }
    });
    eye = col;
  }
  while (frames == 0) std::this_thread::yield();
  done = true;
  frame.join();
  std::printf("%d tiles loaded in %d edits; rays lost: %d\n", loaded, static_cast<int>(terrain.read().epoch()),
              lost.load());
  return 0;
}
