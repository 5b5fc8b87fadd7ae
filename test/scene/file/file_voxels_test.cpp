// SPDX-License-Identifier: MIT
// Hits on voxels by their coordinates in the file, from every reader: grids are cropped, and axes are permuted.
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "scarp/scene/file/from_parts.h"
#include "scarp/scene/file/from_vdb.h"
#include "scarp/scene/file/from_volume.h"
#include "scarp/scene/file/from_vox.h"
#include "scarp/scene/scene.h"
#include "scarp/scene/voxel_entry.h"
#include "scarp/source/voxel/qubicle.h"
#include "scarp/source/voxel/voxlap.h"

namespace scarp {
namespace {

std::string numbers(std::initializer_list<std::uint32_t> list) {
  std::string bytes;
  for (const std::uint32_t number : list) {
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(number >> (8 * i) & 255);
  }
  return bytes;
}

// The coordinates of the highest voxel in the middle of a scene.
ivec3 hit_voxel(const PlacedVoxels& voxels) {
  const Scene scene(scene_voxels(voxels));
  const dvec3 middle = 0.5 * (scene.box().low + scene.box().high);
  const Hit hit = scene.closest_hit({{middle.x, middle.y, scene.box().high.z + 1}, {0, 0, -1}});
  EXPECT_TRUE(hit);
  return file_voxel(scene, hit).value_or(ivec3(-99));
}

TEST(FileVoxels, KeepTheModelsCoordinates) {
  VoxFile file;
  file.version = 200;
  file.models = {{{10, 12, 9}, {{5, 6, 7, 3}}}};
  EXPECT_EQ(hit_voxel(placed_voxels_from(file)), ivec3(5, 6, 7));
  // Rotated by a quarter turn about x, and moved.
  file.nodes = {{0, {}, VoxTransform{1, -1, -1, {{{"_r", "40"}, {"_t", "7 8 9"}}}}}, {1, {}, VoxShape{}}};
  EXPECT_EQ(hit_voxel(placed_voxels_from(file)), ivec3(5, 6, 7));
}

TEST(FileVoxels, MatchEachFrame) {
  VoxFile file;
  file.version = 200;
  file.models = {{{10, 12, 9}, {{5, 6, 7, 3}}}, {{10, 12, 9}, {{1, 2, 3, 3}}}};
  VoxShape shape;
  shape.models = {{0, {{"_f", "0"}}}, {1, {{"_f", "1"}}}};
  file.nodes = {{0, {}, VoxTransform{1}}, {1, {}, shape}};
  EXPECT_EQ(hit_voxel(placed_voxels_from(file, {{.frame = 0}, {}})), ivec3(5, 6, 7));
  EXPECT_EQ(hit_voxel(placed_voxels_from(file, {{.frame = 1}, {}})), ivec3(1, 2, 3));
}

TEST(FileVoxels, MatchQubicleMatrices) {
  for (const std::uint32_t right_handed : {0u, 1u}) {
    std::string bytes =
        numbers({0x101, 0, right_handed, 0, 0, 1}) + std::string(1, '\0') + numbers({4, 3, 5, 10, 20, 30});
    // Voxel (2, 1, 3): x fastest, then y, then z.
    for (int i = 0; i < 60; ++i) bytes += numbers({i == 2 + 4 * (1 + 3 * 3) ? 0xff030201u : 0u});
    EXPECT_EQ(hit_voxel(placed_voxels_from(parse_qubicle(bytes), {})), ivec3(2, 1, 3)) << right_handed;
  }
}

TEST(FileVoxels, MatchVoxlapFiles) {
  // Voxel (1, 2, 3) of 2 x 4 x 6, z fastest.
  std::string indices(48, '\xff');
  indices[3 + 6 * (2 + 4 * 1)] = 1;
  const std::string file = numbers({2, 4, 6}) + indices + std::string(768, '\0');
  EXPECT_EQ(hit_voxel(placed_voxels_from(parse_voxlap_vox(file), {})), ivec3(1, 2, 3));
}

TEST(FileVoxels, MatchVolumes) {
  Binvox binvox;
  binvox.size = {4, 5, 6};
  binvox.clear();
  binvox.set({1, 3, 5});
  std::string numbers(120, '\0');
  numbers[1 + 4 * (3 + 5 * 5)] = 1;
  const DenseVolume volume(parse_volume_format("4x5x6:u8"), numbers);
  for (const UpAxis up : {UpAxis::y, UpAxis::z}) {
    EXPECT_EQ(hit_voxel(placed_voxels_from(binvox, kPlainVoxels, {{}, up, {}})), ivec3(1, 3, 5));
    EXPECT_EQ(hit_voxel(placed_voxels_from(volume, std::array<VoxelColour, 1>{kPlainVoxels}, {}, {{}, up, {}})),
              ivec3(1, 3, 5));
  }
}

TEST(FileVoxels, MatchOpenVdbIndices) {
  VdbVoxels file;
  VdbLeaf leaf;
  leaf.low = {-8, 16, 24};
  leaf.solid[0] = std::uint64_t{1} << (1 + 4 * 2 + 16 * 3);
  file.leaves = {leaf};
  for (const UpAxis up : {UpAxis::y, UpAxis::z})
    EXPECT_EQ(hit_voxel(placed_voxels_from(file, VoxelFileOptions{}, up)), ivec3(-7, 18, 27));
}

}  // namespace
}  // namespace scarp
