// SPDX-License-Identifier: MIT
// A voxel world: a tower on grass over stone, a tunnel that is dug afterwards, and rays before and after.
#include <cstdio>

#include "scarp/scarp.h"

namespace {

enum Entry : unsigned { stone = 1, grass, brick };
const char* const names[] = {"nothing", "stone", "grass", "brick"};

void report(const scarp::Voxels& voxels, const char* ray_name, const scarp::Ray& ray) {
  const scarp::Hit hit = scarp::cast(voxels, ray);
  if (!hit) return void(std::printf("%s: nothing\n", ray_name));
  const scarp::ivec3 v = hit.voxel;
  std::printf("%s: %s in voxel (%d, %d, %d) after %.1f m\n", ray_name, names[voxels.grid().entry(v)], v.x, v.y, v.z,
              hit.t);
}

}  // namespace

int main() {
  // 128 x 128 x 64 voxels of half a metre. Entries are indices of the palette; sRGB colours for pictures.
  scarp::VoxelGrid grid({128, 128, 64});
  grid.fill({{0, 0, 0}, {128, 128, 19}}, stone);
  grid.fill({{0, 0, 19}, {128, 128, 20}}, grass);
  grid.fill({{56, 56, 20}, {72, 72, 60}}, brick);
  scarp::Voxels voxels(std::move(grid), {.side = 0.5, .palette = {{}, {128, 128, 128}, {96, 140, 64}, {168, 74, 50}}});

  // One ray down beside the tower, and one level into its western wall. Directions are unit vectors, so t is in metres.
  const scarp::Ray down{.origin = {10, 10, 40}, .direction = {0, 0, -1}};
  const scarp::Ray level{.origin = {0, 32, 15}, .direction = {1, 0, 0}};
  report(voxels, "down", down);
  report(voxels, "level", level);

  // A tunnel through the tower along x. An edit returns the box of voxels that it changed.
  voxels.edit([](scarp::VoxelGrid& g) { return g.clear({{0, 62, 28}, {128, 66, 32}}); });
  report(voxels, "level, through the tunnel", level);
  return 0;
}
