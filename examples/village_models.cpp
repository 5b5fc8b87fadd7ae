// SPDX-License-Identifier: MIT
// Makes the voxel models of examples/scenes: village_models FOLDER writes house.vox, church.vox, pine.vox,
// broadleaf.vox and block.vox there. A voxel is half a metre in the village.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>

#include "scarp/source/voxel/vox_file.h"

namespace {

// Palette indices.
enum Colour : std::uint8_t {
  stone = 1,
  plaster,
  timber,
  roof,
  ridge,
  glass,
  door,
  bark,
  needles,
  tips,
  leaves,
  light_leaves,
  slate
};

scarp::VoxPalette palette() {
  scarp::VoxPalette colours{};
  const auto set = [&](Colour index, std::uint8_t r, std::uint8_t g, std::uint8_t b) {
    colours[static_cast<std::size_t>(index) - 1] = {r, g, b, 255};
  };
  set(stone, 142, 136, 126);
  set(plaster, 232, 222, 202);
  set(timber, 92, 66, 44);
  set(roof, 168, 74, 50);
  set(ridge, 132, 54, 40);
  set(glass, 82, 110, 134);
  set(door, 74, 92, 66);
  set(bark, 88, 66, 48);
  set(needles, 48, 82, 52);
  set(tips, 74, 112, 66);
  set(leaves, 92, 126, 52);
  set(light_leaves, 136, 156, 70);
  set(slate, 86, 92, 102);
  return colours;
}

class Builder {
 public:
  Builder(int width, int depth, int height) { model_.size = {width, depth, height}; }

  void set(int x, int y, int z, Colour colour) {
    model_.voxels.push_back(
        {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), static_cast<std::uint8_t>(z), colour});
  }
  // The walls of a box, without floor and ceiling; x1, y1, z1 are exclusive.
  void walls(int x0, int y0, int z0, int x1, int y1, int z1, Colour colour) {
    for (int z = z0; z < z1; ++z) {
      for (int y = y0; y < y1; ++y) {
        for (int x = x0; x < x1; ++x) {
          if (x == x0 || x == x1 - 1 || y == y0 || y == y1 - 1) set(x, y, z, colour);
        }
      }
    }
  }
  // A roof along y over [x0, x1) from z0 up, with gables below it; the ridge is `steep` times as high as the roof is
  // wide.
  void gable_roof(int x0, int x1, int y0, int y1, int z0, int steep, Colour tiles, Colour top, Colour gable) {
    for (int inset = 0; x0 + inset < x1 - inset; ++inset) {
      const int left = x0 + inset, right = x1 - 1 - inset;
      for (int up = 0; up < steep; ++up) {
        const int z = z0 + inset * steep + up;
        const Colour colour = left >= right - 1 ? top : tiles;
        for (int y = y0; y < y1; ++y) set(left, y, z, colour), set(right, y, z, colour);
        for (int x = left + 1; x < right; ++x) set(x, y0 + 1, z, gable), set(x, y1 - 2, z, gable);
      }
    }
  }
  void write(const std::filesystem::path& path) const {
    scarp::VoxFile file;
    file.palette = palette();
    file.models.push_back(model_);
    scarp::write_vox(path.string(), file);
  }

 private:
  scarp::VoxModel model_;
};

Builder house() {
  Builder b(16, 20, 19);
  b.walls(1, 2, 0, 15, 18, 2, stone);
  b.walls(1, 2, 2, 15, 18, 10, plaster);
  for (int z = 2; z < 10; ++z) {  // corner posts
    for (const int x : {1, 14}) b.set(x, 2, z, timber), b.set(x, 17, z, timber);
  }
  for (int y = 2; y < 18; ++y) b.set(1, y, 9, timber), b.set(14, y, 9, timber);
  for (const int y : {5, 12}) {  // windows of the long sides
    for (int z = 4; z < 7; ++z) {
      for (int i = 0; i < 3; ++i) b.set(1, y + i, z, glass), b.set(14, y + i, z, glass);
    }
  }
  for (int z = 0; z < 5; ++z) b.set(7, 2, z, door), b.set(8, 2, z, door);
  for (int z = 4; z < 7; ++z) {
    for (const int x : {3, 4, 11, 12}) b.set(x, 2, z, glass), b.set(x, 17, z, glass);
  }
  b.gable_roof(0, 16, 1, 19, 9, 1, roof, ridge, plaster);
  for (int z = 12; z < 19; ++z) {  // chimney
    for (int i = 0; i < 4; ++i) b.set(11 + i % 2, 13 + i / 2, z, stone);
  }
  return b;
}

Builder church() {
  Builder b(18, 34, 46);
  b.walls(2, 10, 0, 16, 33, 13, plaster);
  b.walls(2, 10, 0, 16, 33, 2, stone);
  for (const int y : {15, 21, 27}) {
    for (int z = 4; z < 10; ++z)
      b.set(2, y, z, glass), b.set(2, y + 1, z, glass), b.set(15, y, z, glass), b.set(15, y + 1, z, glass);
  }
  b.gable_roof(1, 17, 9, 34, 12, 1, slate, slate, plaster);
  b.walls(4, 1, 0, 14, 11, 28, plaster);
  b.walls(4, 1, 0, 14, 11, 3, stone);
  for (int z = 0; z < 6; ++z) {
    for (int x = 7; x < 11; ++x) b.set(x, 1, z, door);
  }
  for (int z = 21; z < 26; ++z) {  // belfry
    for (int i = 7; i < 11; ++i)
      b.set(i, 1, z, timber), b.set(i, 10, z, timber), b.set(4, i - 1, z, timber), b.set(13, i - 1, z, timber);
  }
  // A spire of rings, two voxels high each, wider than the tower at its foot.
  for (int z = 28; z < 44; ++z) {
    const int inset = (z - 28) * 6 / 16;
    b.walls(3 + inset, 0 + inset, z, 15 - inset, 12 - inset, z + 1, slate);
  }
  for (int z = 43; z < 46; ++z)
    b.set(8, 5, z, ridge), b.set(9, 6, z, ridge), b.set(8, 6, z, ridge), b.set(9, 5, z, ridge);
  return b;
}

// A reproducible pseudo-random integer for a voxel.
int mixed(int x, int y, int z) {
  std::uint32_t n = static_cast<std::uint32_t>(x) * 73856093U ^ static_cast<std::uint32_t>(y) * 19349663U ^
                    static_cast<std::uint32_t>(z) * 83492791U;
  n = (n ^ (n >> 15)) * 0x2c1b3c6dU;
  return static_cast<int>((n ^ (n >> 12)) & 0xffff);
}

Builder pine() {
  Builder b(15, 15, 30);
  for (int z = 0; z < 5; ++z) {
    for (int i = 0; i < 4; ++i) b.set(7 + i % 2 - 1, 7 + i / 2 - 1, z, bark);
  }
  for (int z = 4; z < 30; ++z) {
    // Tiers of branches: wide at the bottom, narrower towards the top.
    const double up = (z - 4) / 26.0, tier = 1.25 - 0.55 * ((z - 4) % 6) / 5.0;
    const double radius = std::max(0.6, 6.4 * (1 - up) * tier);
    for (int y = 0; y < 15; ++y) {
      for (int x = 0; x < 15; ++x) {
        const double dx = x - 6.5, dy = y - 6.5, r2 = dx * dx + dy * dy;
        if (r2 > radius * radius || (r2 > (radius - 1) * (radius - 1) && mixed(x, y, z) % 3 == 0)) continue;
        if (x < 14 && y < 14) b.set(x, y, z, r2 > (radius - 1.2) * (radius - 1.2) && (z - 4) % 6 < 2 ? tips : needles);
      }
    }
  }
  return b;
}

Builder broadleaf() {
  Builder b(18, 18, 22);
  for (int z = 0; z < 9; ++z) {
    for (int i = 0; i < 4; ++i) b.set(8 + i % 2, 8 + i / 2, z, bark);
  }
  for (int z = 6; z < 22; ++z) {
    for (int y = 0; y < 18; ++y) {
      for (int x = 0; x < 18; ++x) {
        const double dx = x - 8.5, dy = y - 8.5, dz = (z - 13.5) * 1.08, r = dx * dx + dy * dy + dz * dz;
        if (r > 68 - 22.0 * (mixed(x / 2, y / 2, z / 2) % 100) / 100) continue;
        b.set(x, y, z, mixed(x, y, z) % 4 == 0 ? light_leaves : leaves);
      }
    }
  }
  return b;
}

// Solid, for cutting other models.
Builder block() {
  Builder b(16, 12, 20);
  for (int z = 0; z < 20; ++z) {
    for (int y = 0; y < 12; ++y) {
      for (int x = 0; x < 16; ++x) b.set(x, y, z, stone);
    }
  }
  return b;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::fputs("usage: village_models FOLDER\n", stderr);
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  house().write(folder / "house.vox");
  church().write(folder / "church.vox");
  pine().write(folder / "pine.vox");
  broadleaf().write(folder / "broadleaf.vox");
  block().write(folder / "block.vox");
  std::printf("house.vox church.vox pine.vox broadleaf.vox block.vox\n");
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "village_models: %s\n", error.what());
  return 1;
}
