// SPDX-License-Identifier: MIT
#include "scarp/source/raster/procedural_dem_file.h"

#include "full_disk.h"
#include "source/files.h"

namespace scarp {
namespace {

using namespace test;

class ProceduralDemFile : public Files {
 protected:
  std::size_t files() const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder_)) ++count;
    return count;
  }
};

ProceduralDem terrain(int cols, int rows) {
  ProceduralDem settings;
  settings.cols = cols;
  settings.rows = rows;
  settings.seed = 5;
  return settings;
}

TEST_F(ProceduralDemFile, MatchesMemoryBitForBit) {
  const ProceduralDem settings = terrain(700, 530);
  write_procedural_dem(path("a.tif"), settings);
  const Raster raster = read_raster(path("a.tif"), {});
  EXPECT_EQ(generate_dem(settings), std::get<std::vector<float>>(raster.samples));
  EXPECT_EQ(1u, files());  // no side files
}

TEST_F(ProceduralDemFile, HasTheChosenCellSizeAndIsNorthUp) {
  write_procedural_dem(path("a.tif"), terrain(300, 200));
  const Raster raster = read_raster(path("a.tif"), {});
  EXPECT_NEAR(30, raster.georeference.cell_x_m, 1e-6);
  EXPECT_NEAR(30, raster.georeference.cell_y_m, 1e-6);
  EXPECT_NEAR(0, raster.georeference.grid_north_azimuth, 1e-6);
  EXPECT_EQ("m", raster.vertical_unit);
  EXPECT_TRUE(raster.notes.empty()) << raster.notes.front();
}

TEST_F(ProceduralDemFile, ReplacesAnOldFileAndReportsProgress) {
  write("a.tif", "old");
  double last = 0;
  write_procedural_dem(path("a.tif"), terrain(10, 600), [&](double share) {
    EXPECT_GE(share, last);
    last = share;
    return true;
  });
  EXPECT_EQ(1, last);
  EXPECT_EQ(600, read_raster(path("a.tif"), {}).rows);
}

TEST_F(ProceduralDemFile, LeavesNoFileWhenInterrupted) {
  int calls = 0;
  EXPECT_THROW(write_procedural_dem(path("a.tif"), terrain(300, 2000), [&](double) { return ++calls < 40; }),
               Interrupted);
  EXPECT_EQ(0u, files());
}

TEST_F(ProceduralDemFile, FullDiskLeavesNoFile) {
  for (const std::uint64_t length : {100, 100000, 500000}) {
    ::testing::internal::CaptureStderr();
    const std::string text = error_of([&] {
      const test::FullDisk disk(length);
      write_procedural_dem(path("a.tif"), terrain(700, 530));
    });
    const std::string printed = ::testing::internal::GetCapturedStderr();
    expect_says(text, path("a.tif") + ": ");
    expect_says(text, "is the disk full");
    EXPECT_EQ("", printed) << length;
    EXPECT_EQ(0u, files()) << length;
  }
}

TEST_F(ProceduralDemFile, RejectsUnwritablePaths) {
  expect_says(error_of([&] { write_procedural_dem(path("none/a.tif"), terrain(10, 10)); }), "does not exist");
  expect_says(error_of([&] { write_procedural_dem(folder_.string(), terrain(10, 10)); }), "is a directory");
}

}  // namespace
}  // namespace scarp
