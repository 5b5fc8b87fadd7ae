// SPDX-License-Identifier: MIT
// A picture of an elevation model: dem_to_picture dem.tif picture.png. Links scarp::scarp.
#include <cstdio>

#include "scarp/scarp.h"

int main(int argc, char** argv) try {
  if (argc != 3) {
    std::fputs("usage: dem_to_picture DEM PICTURE.png\n", stderr);
    return 2;
  }
  const auto terrain = scarp::Terrain::open(argv[1]);
  scarp::render(terrain, argv[2]);
  std::printf("%s: %d x %d samples\n", argv[2], terrain.field().cols(), terrain.field().rows());
  return 0;
} catch (const scarp::Error& error) {
  std::fprintf(stderr, "dem_to_picture: error: %s\n", error.what());
  return 1;
}
