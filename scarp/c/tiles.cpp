// SPDX-License-Identifier: MIT
#include "scarp/c/scene_handle.h"
#include "scarp/c/settings.h"
#include "scarp/c/structures.h"
#include "scarp/c/threads.h"

/// Samples with a `release` are kept alive by their tile.
struct scarp_tiles {
  explicit scarp_tiles(const scarp::TileLayout& layout) : terrain(layout) {}
  scarp::TiledTerrain terrain;
};

using namespace scarp::c;

scarp_status scarp_tiles_create(const scarp_tile_layout* layout, scarp_tiles** tiles) {
  return guarded([&] {
    required(tiles, "tiles");
    const scarp_tile_layout given = read(layout, "tile_layout");
    *tiles = new scarp_tiles({.cols = given.cols,
                              .rows = given.rows,
                              .cell_cols = given.cell_cols,
                              .cell_rows = given.cell_rows,
                              .ground = ground_from(given)});
  });
}

scarp_status scarp_tiles_edit(scarp_tiles* tiles, const scarp_tile_change* changes, size_t count) {
  return guarded_on_threads([&] {
    required(changes, count, "changes");
    required(tiles, "tiles").terrain.edit([&](scarp::TiledTerrain::Editor& editor) {
      for (size_t i = 0; i < count; ++i) {
        const scarp::TilePlace place{changes[i].col, changes[i].row};
        if (changes[i].heights) {
          editor.put(place, only_terrain(changes[i].heights).field());
        } else {
          editor.remove(place);
        }
      }
    });
  });
}

scarp_status scarp_tiles_read(const scarp_tiles* tiles, scarp_scene** scene) {
  return guarded([&] {
    required(scene, "scene");
    *scene = opened(required(tiles, "tiles").terrain.read()).release();
  });
}

void scarp_tiles_release(scarp_tiles* tiles) { delete tiles; }
