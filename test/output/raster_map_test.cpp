// SPDX-License-Identifier: MIT
// Maps in every raster format that this GDAL can write.
#include "scarp/output/raster_map.h"

#include <cpl_conv.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>
#if defined(__has_include)
#if __has_include(<sanitizer/lsan_interface.h>)
#include <sanitizer/lsan_interface.h>
#endif
#endif
#include <ogr_spatialref.h>

#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "full_disk.h"
#include "scarp/base/error.h"
#include "scratch.h"

namespace scarp {
namespace {

constexpr int kCols = 24, kRows = 16;

std::string utm() {
  OGRSpatialReference crs;
  crs.importFromEPSG(32633);
  char* text = nullptr;
  crs.exportToWkt(&text);
  const std::string wkt = text;
  CPLFree(text);
  return wkt;
}

// Maps as the subcommands write them: codes, counts, heights, and two bands of heights.
class Maps {
 public:
  Maps() {
    for (int i = 0; i < kCols * kRows; ++i) {
      codes_.push_back(i % 7 == 0 ? 255 : static_cast<std::uint8_t>(i % 2));
      counts_.push_back(static_cast<std::uint16_t>(i % 11 == 0 ? 65535 : 257 * (i % 3)));
      heights_.push_back(i % 5 == 0 ? -9999.0f : 1000.0f + 0.1f * static_cast<float>(i));
    }
  }
  RasterMap codes() const {
    MapBand band{"visible", "", std::span(codes_), 255, {}};
    band.classes = {{0, "hidden", {205, 205, 205, 255}}, {1, "visible", {44, 150, 60, 255}}, {255, "none", {}}};
    return map({band});
  }
  RasterMap counts() const { return map({{"observers", "", std::span(counts_), 65535, {}}}); }
  RasterMap heights(std::size_t bands) const {
    const MapBand band{"height", "m", std::span(heights_), -9999, {}};
    return map(std::vector<MapBand>(bands, band));
  }
  std::vector<std::pair<std::string, RasterMap>> all() const {
    return {{"codes", codes()}, {"counts", counts()}, {"heights", heights(1)}, {"two of heights", heights(2)}};
  }

 private:
  static RasterMap map(std::vector<MapBand> bands) {
    RasterMap map;
    map.cols = kCols;
    map.rows = kRows;
    map.bands = std::move(bands);
    map.place = MapPlace{{500000, 10, 0, 5000000, 0, -10}, utm()};
    map.metadata = {{"METHOD", "test"}};
    return map;
  }
  std::vector<std::uint8_t> codes_;
  std::vector<std::uint16_t> counts_;
  std::vector<float> heights_;
};

std::vector<double> samples_of(const MapBand& band) {
  std::vector<double> all;
  std::visit([&](const auto& samples) { all.assign(samples.begin(), samples.end()); }, band.samples);
  return all;
}

constexpr const char* kTypes[] = {"Byte", "UInt16", "Float32"};

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
using IgnoredLeaks = __lsan::ScopedDisabler;
#define SCARP_IGNORES_LEAKS
#endif
#endif
#ifndef SCARP_IGNORES_LEAKS
struct IgnoredLeaks {
  IgnoredLeaks() {}
};
#endif

class RasterMaps : public testing::Test {
 protected:
  RasterMaps() { GDALAllRegister(); }
  // GeoPackages of tests need not survive a power failure.
  const CPLConfigOptionSetter unsynced_{"OGR_SQLITE_SYNCHRONOUS", "OFF", false};

  // Returns the message of the refusal; empty if the file was written.
  std::string write(const test::Scratch& folder, const RasterMap& map, const std::string& name) const {
    // KMLSUPEROVERLAY and other drivers of GDAL 3.6 keep coordinate transformations when they copy.
    const IgnoredLeaks ignored;
    try {
      require_raster_driver(map.driver, map.creation_options, kTypes[map.bands[0].samples.index()]);
      write_raster_map(folder.path(name), map);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  }

  static void expect_equal(const std::string& path, const RasterMap& map, const std::string& what) {
    const GDALDatasetUniquePtr dataset(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER));
    ASSERT_TRUE(dataset) << what;
    ASSERT_EQ(dataset->GetRasterXSize(), kCols) << what;
    ASSERT_EQ(dataset->GetRasterYSize(), kRows) << what;
    ASSERT_GE(dataset->GetRasterCount(), static_cast<int>(map.bands.size())) << what;
    for (std::size_t b = 0; b < map.bands.size(); ++b) {
      std::vector<double> read(kCols * kRows);
      ASSERT_EQ(dataset->GetRasterBand(static_cast<int>(b) + 1)
                    ->RasterIO(GF_Read, 0, 0, kCols, kRows, read.data(), kCols, kRows, GDT_Float64, 0, 0, nullptr),
                CE_None)
          << what;
      // Some formats have a fixed value for samples without data.
      int has = 0;
      const double nodata = dataset->GetRasterBand(static_cast<int>(b) + 1)->GetNoDataValue(&has);
      for (double& sample : read)
        if (has != 0 && (sample == nodata || std::isnan(sample))) sample = *map.bands[b].nodata;
      const std::vector<double> expected = samples_of(map.bands[b]);
      for (std::size_t i = 0; i < read.size(); ++i)
        ASSERT_EQ(static_cast<float>(read[i]), static_cast<float>(expected[i])) << what << ", sample " << i;
    }
    std::array<double, 6> place{};
    ASSERT_EQ(dataset->GetGeoTransform(place.data()), CE_None) << what;
    // Some formats store coordinates as text.
    constexpr double kMetres = 0.1;
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(place[i], map.place->map_from_pixel[i], kMetres) << what;
  }

  Maps maps_;
};

// A raster that reads back equal, or one line and no file.
TEST_F(RasterMaps, EveryDriverWritesEqualSamplesOrNothing) {
  std::set<std::string> written;
  for (int i = 0; i < GetGDALDriverManager()->GetDriverCount(); ++i) {
    GDALDriver& driver = *GetGDALDriverManager()->GetDriver(i);
    const auto can = [&](const char* what) { return CPLFetchBool(driver.GetMetadata(), what, false); };
    if (!can(GDAL_DCAP_RASTER) || !(can(GDAL_DCAP_CREATE) || can(GDAL_DCAP_CREATECOPY))) continue;
    const std::string name = driver.GetDescription();
    const char* extensions = driver.GetMetadataItem(GDAL_DMD_EXTENSIONS);
    const std::string extension = name == "PAux" ? "raw"
                                  : extensions   ? std::string(extensions).substr(0, std::string(extensions).find(' '))
                                                 : "";
    for (auto& [kind, map] : maps_.all()) {
      const std::string what = name + ", " + kind;
      const test::Scratch folder;
      map.driver = name;
      const std::string file = extension.empty() ? "out" : "out." + extension;
      const std::string refusal = write(folder, map, file);
      if (refusal.empty()) {
        written.insert(what);
        expect_equal(folder.path(file), map, what);
      } else {
        EXPECT_EQ(refusal.find('\n'), std::string::npos) << what << ": " << refusal;
        EXPECT_TRUE(folder.empty()) << what << ": " << fmt::format("{}", fmt::join(folder.files(), " "));
        EXPECT_EQ(refusal.find("disk"), std::string::npos) << what << ": " << refusal;
        EXPECT_EQ(refusal.find(".parts"), std::string::npos) << what << ": " << refusal;
      }
    }
  }
  for (const char* driver : {"GTiff", "COG", "HFA", "ENVI", "AAIGrid", "GPKG", "PNG", "netCDF", "SAGA", "GSAG"}) {
    if (!GetGDALDriverManager()->GetDriverByName(driver)) continue;
    for (const char* kind : {"codes", "counts", "heights"}) {
      const bool floats = std::string(kind) == "heights" && std::string(driver) == "PNG";
      EXPECT_EQ(written.contains(fmt::format("{}, {}", driver, kind)), !floats) << driver << ", " << kind;
    }
  }
}

TEST_F(RasterMaps, WritesSideFiles) {
  const test::Scratch folder;
  RasterMap map = maps_.codes();
  map.driver = "PNG";
  map.creation_options = {"WORLDFILE=YES"};
  ASSERT_EQ(write(folder, map, "a.png"), "");
  EXPECT_EQ(folder.files(), (std::vector<std::string>{"a.png", "a.png.aux.xml", "a.wld"}));
  expect_equal(folder.path("a.png"), map, "PNG");
}

// Statistics and overviews of the replaced raster would be read for the new one.
TEST_F(RasterMaps, RemovesSideFilesOfTheReplacedRaster) {
  const test::Scratch folder;
  for (const char* name : {"a.tif", "a.tif.aux.xml", "a.tif.ovr", "a.tfw", "b.tif.aux.xml"}) folder.write(name, "old");
  ASSERT_EQ(write(folder, maps_.codes(), "a.tif"), "");
  EXPECT_EQ(folder.files(), (std::vector<std::string>{"a.tfw", "a.tif", "b.tif.aux.xml"}));
}

TEST_F(RasterMaps, SideFilesDoNotReplaceThoseOfOtherFiles) {
  const test::Scratch folder;
  for (const char* name : {"a.bil", "a.hdr"}) folder.write(name, "input");
  RasterMap map = maps_.codes();
  map.driver = "ENVI";
  EXPECT_NE(write(folder, map, "a.img").find("a.hdr: exists and may belong to another file"), std::string::npos);
  EXPECT_EQ(folder.files(), (std::vector<std::string>{"a.bil", "a.hdr"}));
  for (int times = 0; times < 2; ++times) EXPECT_EQ(write(folder, map, "b.img"), "");
}

TEST_F(RasterMaps, RefusesFormatsThatNeverHoldAMap) {
  for (const auto& [driver, remedy] : {std::pair("VRT", "run gdalbuildvrt"), {"JPEG", "*.tif or *.png"}}) {
    try {
      require_raster_driver(driver);
      ADD_FAILURE() << driver;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(remedy), std::string::npos) << error.what();
    }
  }
}

TEST_F(RasterMaps, LossyOptionsAreForMeasuresOnly) {
  const test::Scratch folder;
  RasterMap map = maps_.counts();
  map.creation_options = {"DISCARD_LSB=3"};
  EXPECT_NE(write(folder, map, "a.tif").find("GTiff changes samples"), std::string::npos);
  EXPECT_TRUE(folder.empty());
  map = maps_.codes();
  map.creation_options = {"COMPRESS=JPEG"};
  EXPECT_NE(write(folder, map, "a.tif"), "");
  EXPECT_TRUE(folder.empty());
  map = maps_.heights(1);
  map.creation_options = {"COMPRESS=DEFLATE", "DISCARD_LSB=12"};
  EXPECT_EQ(write(folder, map, "b.tif"), "");
}

// These are not read again after they were written.
TEST_F(RasterMaps, OptionsOfLayoutAndLosslessCompressionKeepSamples) {
  int written = 0;
  for (const char* driver : {"GTiff", "COG"}) {
    for (const std::vector<std::string>& options : std::vector<std::vector<std::string>>{
             {"COMPRESS=NONE"},
             {"compress=deflate", "PREDICTOR=2", "ZLEVEL=1"},
             {"COMPRESS=DEFLATE", "PREDICTOR=YES", "LEVEL=9"},
             {"COMPRESS=LZW", "PREDICTOR=2"},
             {"COMPRESS=ZSTD", "ZSTD_LEVEL=1"},
             {"COMPRESS=LZMA"},
             {"COMPRESS=PACKBITS"},
             {"TILED=NO", "BLOCKYSIZE=16", "BIGTIFF=YES", "NUM_THREADS=1", "SPARSE_OK=TRUE"},
             {"BLOCKSIZE=128", "SPARSE_OK=TRUE"},
             {"TILED=YES", "BLOCKXSIZE=16", "BLOCKYSIZE=32"}}) {
      for (auto& [kind, map] : maps_.all()) {
        const std::string what = fmt::format("{}, {}, {}", driver, fmt::join(options, " "), kind);
        const test::Scratch folder;
        map.driver = driver;
        map.creation_options = options;
        // COG has other names for some, and GDAL may be built without a compression.
        if (!write(folder, map, "out.tif").empty()) continue;
        ++written;
        expect_equal(folder.path("out.tif"), map, what);
      }
    }
  }
  EXPECT_GE(written, 30);
}

TEST_F(RasterMaps, MentionsTheDiskOnlyIfItMayBeFull) {
  const test::Scratch folder;
  RasterMap map = maps_.heights(2);
  {
    const test::FullDisk disk(100);
    EXPECT_NE(write(folder, map, "a.tif").find("(is the disk full?)"), std::string::npos);
  }
  map.driver = "AAIGrid";
  EXPECT_TRUE(write(folder, map, "a.asc").ends_with("Must be 1 band."));
  EXPECT_TRUE(folder.empty());
}

}  // namespace
}  // namespace scarp
