// SPDX-License-Identifier: MIT
// OpenVDB and NanoVDB files: solid voxels, their positions, and errors. Files are made with OpenVDB itself.
#include <gtest/gtest.h>
#define NANOVDB_USE_OPENVDB
// NanoVDB's headers need it and do not include it.
#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetSphere.h>
#include <openvdb/tools/LevelSetUtil.h>
#include <iostream>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "full_disk.h"
#include "scarp/base/error.h"
#include "scarp/scene/file/from_vdb.h"
#include "scarp/scene/file/to_vdb.h"

namespace scarp::test {
namespace {

class VdbFiles : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { openvdb::initialize(); }
  VdbFiles() : folder_(std::filesystem::path(::testing::TempDir()) / "scarp-vdb") {
    std::filesystem::create_directories(folder_);
  }
  ~VdbFiles() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, const openvdb::GridPtrVec& grids) const {
    openvdb::io::File file(path(name));
    file.write(grids);
    file.close();
    return path(name);
  }
  static std::string refusal(const std::string& file) {
    try {
      placed_voxels_from(read_vdb(file));
    } catch (const Error& error) {
      return error.what();
    }
    return "none";
  }

 private:
  std::filesystem::path folder_;
};

openvdb::FloatGrid::Ptr ball() {
  const auto grid = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(20.0f, {3, 5, -7}, 0.5f);
  grid->setName("ball");
  return grid;
}

// All voxels whose middles are not within rounding of the sphere.
void expect_ball(const PlacedVoxels& placed) {
  ASSERT_EQ(placed.models.size(), 1u);
  const VoxelGrid& grid = placed.models[0]->grid();
  const VoxelPlace& place = placed.places[0];
  std::int64_t wrong = 0, solid = 0;
  for_each_voxel(grid.box(), [&](const ivec3& v) {
    const double distance = length(place.world_from_grid * (dvec3(v) + 0.5) + place.origin - dvec3(3, 5, -7)) - 20;
    solid += grid.solid(v) ? 1 : 0;
    wrong += std::abs(distance) > 1e-3 && grid.solid(v) != (distance < 0) ? 1 : 0;
  });
  EXPECT_EQ(wrong, 0);
  EXPECT_NEAR(static_cast<double>(solid), 4.0 / 3 * 3.14159 * 40 * 40 * 40, 1500);
}

TEST_F(VdbFiles, FillsLevelSets) { expect_ball(placed_voxels_from(read_vdb(write("ball.vdb", {ball()})))); }

TEST_F(VdbFiles, NanovdbHasTheSameVoxels) {
  nanovdb::io::writeGrid(path("ball.nvdb"), nanovdb::openToNanoVDB(*ball()));
  expect_ball(placed_voxels_from(read_vdb(path("ball.nvdb"))));
}

TEST_F(VdbFiles, RotatesTheUpAxis) {
  const auto grid = openvdb::BoolGrid::create(false);
  grid->tree().setValueOn(openvdb::Coord(1, 2, 3), true);
  const std::string file = write("one.vdb", {grid});
  const WorldBox z = world_box(placed_voxels_from(read_vdb(file)));
  EXPECT_EQ(z.low, dvec3(0.5, 1.5, 2.5));
  const WorldBox y = world_box(placed_voxels_from(read_vdb(file), {}, UpAxis::y));
  EXPECT_EQ(y.low, dvec3(0.5, -3.5, 1.5));
}

TEST_F(VdbFiles, Vec3GridsColourVoxels) {
  const auto shape = openvdb::MaskGrid::create(false);
  const auto colours = openvdb::Vec3SGrid::create(openvdb::Vec3s(0, 0, 0));
  for (int i = 0; i < 20; ++i) {
    shape->tree().setValueOn(openvdb::Coord(i, 2 * i, -i));
    if (i % 2 == 0) colours->tree().setValueOn(openvdb::Coord(i, 2 * i, -i), openvdb::Vec3s(1, 0, 0.2140411f));
  }
  const PlacedVoxels placed = placed_voxels_from(read_vdb(write("colours.vdb", {colours, shape})));
  const VoxelModel& model = *placed.models[0];
  EXPECT_EQ(model.grid().solid_count(), 20);
  const dvec3 origin = placed.places[0].origin + 0.5;
  for (int i = 0; i < 20; ++i) {
    const ivec3 v(dvec3(i, 2 * i, -i) - origin);
    ASSERT_TRUE(model.grid().solid(v));
    const VoxelColour expected = i % 2 == 0 ? VoxelColour{255, 0, 127} : VoxelColour{0, 0, 0};
    EXPECT_EQ(model.colour(model.grid().entry(v)), expected) << i;
  }
  EXPECT_EQ(placed_voxels_from(read_vdb(write("alone.vdb", {colours}))).models[0]->grid().solid_count(), 10);
}

TEST_F(VdbFiles, RoundTrips) {
  std::mt19937 random(3);
  VoxelGrid grid({256, 270, 150}, 1);
  // Whole pages of the grid.
  grid.fill({{0, 0, 0}, {256, 140, 140}}, 0);
  for (int i = 0; i < 3000; ++i) grid.set(ivec3(random() % 256, random() % 270, random() % 150), 0);
  write_vdb(path("written.vdb"), vdb_of(grid, {-5, 7, 100}, 0.25));
  const VdbVoxels file = read_vdb(path("written.vdb"));
  const PlacedVoxels placed = placed_voxels_from(file);
  const VoxelGrid& read = placed.models[0]->grid();
  EXPECT_EQ(placed.places[0].origin, 0.25 * dvec3(-5, 7, 100));
  EXPECT_EQ(placed.places[0].world_from_grid, glm::dmat3(0.25));
  ASSERT_EQ(read.solid_count(), grid.solid_count());
  for_each_voxel(read.box(), [&](const ivec3& v) { ASSERT_EQ(read.solid(v), grid.solid(v)); });
  EXPECT_TRUE(std::any_of(file.tiles.begin(), file.tiles.end(), [](const VdbTile& tile) { return tile.side == 128; }));
}

TEST_F(VdbFiles, FullDiskKeepsTheOldFile) {
  VoxelGrid grid({64, 64, 64}, 1);
  std::mt19937 random(4);
  for (int i = 0; i < 5000; ++i) grid.set(ivec3(random() % 64, random() % 64, random() % 64), 0);
  write_vdb(path("a.vdb"), vdb_of(grid, {0, 0, 0}, 1));
  const auto size = std::filesystem::file_size(path("a.vdb"));
  // The last byte is written when the file is closed.
  for (const std::uintmax_t bytes : {std::uintmax_t{100}, size / 2, size - 1}) {
    std::string message;
    try {
      const FullDisk disk(bytes);
      write_vdb(path("a.vdb"), vdb_of(grid, {0, 0, 0}, 1));
    } catch (const Error& error) {
      message = error.what();
    }
    EXPECT_EQ(message, path("a.vdb") + ": cannot be written; is the disk full?") << bytes;
    EXPECT_EQ(read_vdb(path("a.vdb")).leaves.size(), 512u);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(path("")), {}), 1)
        << "temporary files were left behind";
  }
}

TEST_F(VdbFiles, RejectsGridsWithoutVoxels) {
  const auto fog = ball()->deepCopy();
  openvdb::tools::sdfToFogVolume(*fog);
  fog->setName("density");
  EXPECT_EQ(refusal(write("fog.vdb", {fog})),
            path("fog.vdb") +
                ": grid 'density' is a fog volume of type float (level sets, bool, mask and Vec3 grids have voxels)");
  EXPECT_EQ(refusal(write("none.vdb", {})), path("none.vdb") + ": contains no grid");
  EXPECT_EQ(refusal(write("empty.vdb", {openvdb::BoolGrid::create(false)})), "no voxel is solid");
  EXPECT_EQ(refusal(path("missing.vdb")), path("missing.vdb") + ": cannot be read");
}

TEST_F(VdbFiles, RejectsOversizedOrSkewedGrids) {
  const auto wide = openvdb::BoolGrid::create(false);
  wide->tree().setValueOn(openvdb::Coord(0, 0, 0), true);
  wide->tree().setValueOn(openvdb::Coord(0, 20000, 0), true);
  EXPECT_EQ(refusal(write("wide.vdb", {wide})),
            path("wide.vdb") + ": its grid has 20008 voxels along y (limited to 16384)");
  const auto huge = openvdb::BoolGrid::create(false);
  huge->fill(openvdb::CoordBBox(openvdb::Coord(0), openvdb::Coord(32767)), true, true);
  EXPECT_NE(refusal(write("huge.vdb", {huge})).find("(limited to 16384)"), std::string::npos);
  const auto stretched = ball();
  stretched->setTransform(openvdb::math::Transform::createLinearTransform(
      openvdb::math::Mat4d(1.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0)));
  EXPECT_EQ(refusal(write("stretched.vdb", {stretched})),
            path("stretched.vdb") + ": grid 'ball': its voxels are not cubes (resample it)");
}

TEST_F(VdbFiles, RejectsTruncatedFiles) {
#ifndef NDEBUG
  // OpenVDB allocates as much memory as the rest of such a file declares. The address sanitizer stops the program
  // there.
  GTEST_SKIP() << "OpenVDB under the address sanitizer";
#endif
  nanovdb::io::writeGrid(path("ball.nvdb"), nanovdb::openToNanoVDB(*ball()));
  for (const std::string& file : {write("ball.vdb", {ball()}), path("ball.nvdb")}) {
    const auto size = std::filesystem::file_size(file);
    for (const double share : {0.999, 0.7, 0.3, 0.01, 0.0001, 0.0}) {
      std::filesystem::resize_file(file, static_cast<std::uintmax_t>(share * static_cast<double>(size)));
      EXPECT_NE(refusal(file), "none") << share;
    }
  }
}

}  // namespace
}  // namespace scarp::test
