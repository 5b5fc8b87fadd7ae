// SPDX-License-Identifier: MIT
// What the tests of map subcommands share: an elevation model with a wall, and rasters read as pixels.
#pragma once

#include <fmt/format.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cli/program.h"

namespace scarp::test {

class MapsCli : public testing::Test {
 protected:
  // 30 x 20 samples of 10 m, a wall 50 m high at column 20, a hole in the north-west corner. The south-west sample is
  // at (500005, 5000005) of UTM zone 33.
  MapsCli() {
    std::string text = "ncols 30\nnrows 20\nxllcorner 500000\nyllcorner 5000000\ncellsize 10\nNODATA_value -1\n";
    for (int row = 0; row < 20; ++row) {
      for (int col = 0; col < 30; ++col) text += fmt::format("{} ", col + row == 0 ? -1 : col == 20 ? 50 : 0);
      text += '\n';
    }
    dem_ = scratch_.write("dem.asc", text);
  }
  std::string path(const std::string& name) const { return scratch_.path(name); }
  Names on_dem(const std::string& command) const { return {command, dem_, "--crs", "EPSG:32633"}; }

  /// Each map subcommand, with the words for a map of the model but the output.
  std::vector<Names> maps() const {
    std::vector<Names> all{on_dem("viewshed") + Names{"--observer", "500105,5000105,2"},
                           on_dem("shadow") + Names{"--sun", "90,45"}, on_dem("horizon") + Names{"--azimuths", "3"},
                           on_dem("skyview") + Names{"--azimuths", "9"}};
#ifdef SCARP_ERFA
    all.push_back(on_dem("sunhours") + Names{"--date", "2026-06-21", "--step", "120"});
#endif
    return all;
  }

  void expect_refused(const Names& arguments, const std::string& what) const {
    const auto before = scratch_.files();
    const auto result = run(arguments);
    EXPECT_NE(result.status, 0);
    EXPECT_EQ(lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(what), std::string::npos) << result.err;
    EXPECT_EQ(scratch_.files(), before);
  }

  struct Pixels {
    int cols, rows;
    std::vector<float> samples;
    float at(int col, int row) const { return samples[static_cast<std::size_t>(row * cols + col)]; }
  };
  static Pixels pixels_of(GDALDataset& dataset, int band = 1) {
    Pixels pixels{dataset.GetRasterXSize(), dataset.GetRasterYSize(), {}};
    pixels.samples.resize(static_cast<std::size_t>(pixels.cols) * pixels.rows);
    EXPECT_EQ(dataset.GetRasterBand(band)->RasterIO(GF_Read, 0, 0, pixels.cols, pixels.rows, pixels.samples.data(),
                                                    pixels.cols, pixels.rows, GDT_Float32, 0, 0, nullptr),
              CE_None);
    return pixels;
  }
  static GDALDatasetUniquePtr open(const std::string& name) {
    GDALAllRegister();
    return GDALDatasetUniquePtr(GDALDataset::Open(name.c_str(), GDAL_OF_RASTER));
  }

  Scratch scratch_;
  std::string dem_;
};

}  // namespace scarp::test
