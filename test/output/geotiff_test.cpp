// SPDX-License-Identifier: MIT
#include "scarp/output/geotiff.h"

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <filesystem>
#include <random>
#include <vector>

#include "full_disk.h"
#include "scarp/base/error.h"
#include "scarp/output/jpeg.h"
#include "scratch.h"

namespace scarp {
namespace {

namespace fs = std::filesystem;

class RasterOutput : public testing::Test, protected test::Scratch {
 protected:
  RasterOutput() { GDALAllRegister(); }
};

std::vector<std::uint8_t> noise(int width, int height, int bytes) {
  std::mt19937 random(1);
  std::vector<std::uint8_t> all(static_cast<std::size_t>(bytes) * static_cast<std::size_t>(width) *
                                static_cast<std::size_t>(height));
  for (std::uint8_t& byte : all) byte = static_cast<std::uint8_t>(random());
  return all;
}

std::string wkt_of(int epsg) {
  OGRSpatialReference crs;
  crs.importFromEPSG(epsg);
  char* text = nullptr;
  crs.exportToWkt(&text);
  const std::string wkt = text;
  CPLFree(text);
  return wkt;
}

TEST_F(RasterOutput, RoundTrips) {
  for (const auto& [width, height] : {std::pair(3, 2), {700, 300}}) {
    const auto rgb = noise(width, height, 3), alpha = noise(width, height, 1);
    const MapPlace place{{500000, 2.5, 0, 4000000, 0, -2.5}, wkt_of(32616)};
    ReplaceFile file(path("map.tif"));
    write_geotiff(file, path("map.tif"), {rgb.data(), width, height}, alpha, place);
    const GDALDatasetUniquePtr read(GDALDataset::Open(path("map.tif").c_str()));
    ASSERT_TRUE(read);
    ASSERT_EQ(read->GetRasterXSize(), width);
    ASSERT_EQ(read->GetRasterYSize(), height);
    std::array<double, 6> transform{};
    ASSERT_EQ(read->GetGeoTransform(transform.data()), CE_None);
    EXPECT_EQ(transform, place.map_from_pixel);
    EXPECT_STREQ(read->GetSpatialRef()->GetAuthorityCode(nullptr), "32616");
    ASSERT_EQ(read->GetRasterCount(), 4);
    EXPECT_EQ(read->GetRasterBand(4)->GetColorInterpretation(), GCI_AlphaBand);
    for (int band = 0; band < 4; ++band) {
      std::vector<std::uint8_t> bytes(alpha.size());
      ASSERT_EQ(read->GetRasterBand(band + 1)->RasterIO(GF_Read, 0, 0, width, height, bytes.data(), width, height,
                                                        GDT_Byte, 0, 0, nullptr),
                CE_None);
      for (std::size_t i = 0; i < bytes.size(); ++i)
        ASSERT_EQ(bytes[i], band < 3 ? rgb[3 * i + static_cast<std::size_t>(band)] : alpha[i]) << band << " " << i;
    }
  }
  EXPECT_EQ(files().size(), 1u) << "other files were left behind";
}

TEST_F(RasterOutput, WritesNoGeoreferenceWithoutOne) {
  const auto rgb = noise(4, 4, 3);
  ReplaceFile file(path("map.tif"));
  write_geotiff(file, path("map.tif"), {rgb.data(), 4, 4}, {}, {});
  const GDALDatasetUniquePtr read(GDALDataset::Open(path("map.tif").c_str()));
  std::array<double, 6> transform{};
  EXPECT_NE(read->GetGeoTransform(transform.data()), CE_None);
  EXPECT_EQ(read->GetSpatialRef(), nullptr);
}

TEST_F(RasterOutput, JpegIsCloseToThePicture) {
  std::vector<std::uint8_t> rgb(3 * 64 * 48);
  for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<std::uint8_t>(i / 3 % 64 * 3 + i % 3 * 20);
  ReplaceFile file(path("a.jpg"));
  write_jpeg(file, path("a.jpg"), {rgb.data(), 64, 48});
  const GDALDatasetUniquePtr read(GDALDataset::Open(path("a.jpg").c_str()));
  ASSERT_TRUE(read);
  std::vector<std::uint8_t> bytes(rgb.size());
  ASSERT_EQ(read->RasterIO(GF_Read, 0, 0, 64, 48, bytes.data(), 64, 48, GDT_Byte, 3, nullptr, 3, 3 * 64, 1, nullptr),
            CE_None);
  for (std::size_t i = 0; i < rgb.size(); ++i) ASSERT_NEAR(bytes[i], rgb[i], 12) << i;
  EXPECT_EQ(files().size(), 1u);
}

TEST_F(RasterOutput, FullDiskLeavesNoFile) {
  const auto rgb = noise(600, 600, 3);
  for (const bool tiff : {true, false}) {
    const std::string name = path(tiff ? "a.tif" : "a.jpg");
    for (const std::uint64_t limit : {100, 20000, 100000}) {
      try {
        const test::FullDisk disk(limit);
        ReplaceFile file(name);
        const RgbView view{rgb.data(), 600, 600};
        tiff ? write_geotiff(file, name, view, {}, {}) : write_jpeg(file, name, view);
        ADD_FAILURE() << "a limit of " << limit << " bytes was not noticed";
      } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find(name + ": cannot be written"), 0u) << error.what();
      }
      EXPECT_EQ(files().size(), 0u);
    }
  }
}

}  // namespace
}  // namespace scarp
