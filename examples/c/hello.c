// SPDX-License-Identifier: MIT
// The first ray from C: a hill of 101 x 101 samples, seen from the west.
#include <math.h>
#include <stdio.h>

#include "scarp/scarp_c.h"

int main(void) {
  static float samples[101 * 101];
  for (int i = 0; i < 101 * 101; ++i) samples[i] = (float)(40 - hypot(i % 101 - 50, i / 101 - 50));
  scarp_heights heights = {.struct_size = sizeof heights, .samples = samples, .cols = 101, .rows = 101, .cell_x = 10, .cell_y = 10};
  scarp_scene* scene = NULL;
  if (scarp_heights_view(&heights, &scene) != SCARP_OK) return puts(scarp_last_error()), 1;
  scarp_ray ray = {{0, 500, 20}, {1, 0, 0}, 0, INFINITY};
  scarp_hit hit;
  if (scarp_cast(scene, &ray, NULL, &hit) != SCARP_OK) return puts(scarp_last_error()), 1;
  if (hit.status == SCARP_HIT) printf("hit after %.2f m in cell (%d, %d)\n", hit.t, hit.col, hit.row);
  scarp_scene_release(scene);
  return 0;
}
