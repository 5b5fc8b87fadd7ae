// SPDX-License-Identifier: MIT
// Terrain::open() of scarp.h.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/refusal.h"
#include "scarp/scarp.h"
#include "scarp/scene/file/from_raster.h"
#include "scarp/source/raster/raster_options.h"

namespace scarp {
namespace {

using test::refusal;

std::string path_of(const std::string& name) { return testing::TempDir() + name; }

// 3 x 2 samples, cells of 25 m.
std::string small_grid() {
  const std::string path = path_of("open_test.asc");
  std::ofstream(path) << "ncols 3\nnrows 2\nxllcorner 1000\nyllcorner 2000\ncellsize 25\nNODATA_value -9\n"
                         "1 2 3\n4 5 -9\n";
  return path;
}

TEST(TerrainOpen, ReadsAnElevationModel) {
  const Terrain terrain = Terrain::open(small_grid());
  EXPECT_EQ(terrain.field().cols(), 3);
  EXPECT_EQ(terrain.field().rows(), 2);
  EXPECT_EQ(terrain.field().settings().cell_x, 25);
  EXPECT_EQ(terrain.height(0, 25), 1);
  EXPECT_FALSE(terrain.height(40, 12));
  const Hit hit = cast(terrain, {.origin = {12.5, 12.5, 100}, .direction = {0, 0, -1}});
  EXPECT_EQ(hit.t, 97);
  EXPECT_TRUE(terrain.georeference().present);
  EXPECT_EQ(terrain.georeference().map_from_node[0], 1012.5);
}

TEST(TerrainOpen, AppliesOptions) {
  RasterOptions raster;
  raster.nodata = 4;
  const Terrain terrain = Terrain::open(small_grid(), raster, {.exaggeration = 2});
  EXPECT_EQ(terrain.height(50, 25), 6);
  EXPECT_FALSE(terrain.height(10, 12));
}

TEST(TerrainOpen, ErrorIsOneLineAndNamesTheFile) {
  const std::string text = path_of("open_test.txt");
  std::ofstream(text) << "no raster\n";
  const std::string folder = path_of("open_test_folder");
  std::filesystem::create_directory(folder);
  for (const std::string& path : {path_of("missing.tif"), text, folder, std::string()}) {
    const std::string message = refusal([&] { Terrain::open(path); });
    EXPECT_NE(message, "") << path;
    EXPECT_NE(message.find(path), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace scarp
