// SPDX-License-Identifier: MIT
// Models and maps for tests of --memory, --part, --resume and `scarp merge`.
#pragma once

#include <fmt/format.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "cli/program.h"

namespace scarp::test {

namespace fs = std::filesystem;

/// A limit on a resource of this process and those it starts, for the lifetime of the object.
class ResourceLimit {
 public:
  /// `resource`: RLIMIT_...
  ResourceLimit(__rlimit_resource resource, ::rlim_t most) : resource_(resource) {
    ::getrlimit(resource, &before_);
    const ::rlimit limit{most, before_.rlim_max};
    ::setrlimit(resource, &limit);
  }
  ~ResourceLimit() { ::setrlimit(resource_, &before_); }
  ResourceLimit(const ResourceLimit&) = delete;
  ResourceLimit& operator=(const ResourceLimit&) = delete;

 private:
  __rlimit_resource resource_;
  ::rlimit before_{};
};

class MapLimits : public testing::Test {
 protected:
  MapLimits() { GDALAllRegister(); }

  /// Hills with holes in zone 33, cells of 10 x 12.5 m.
  std::string model(const std::string& name, int cols, int rows, GDALDataType type) {
    std::uniform_int_distribution<int> rough(0, 30), hole(0, 60);
    std::vector<float> samples;
    for (int row = 0; row < rows; ++row)
      for (int col = 0; col < cols; ++col)
        samples.push_back(hole(random_) == 0
                              ? 0
                              : static_cast<float>(400 + rough(random_) +
                                                   std::lround(150 * std::sin(col / 13.0) * std::cos(row / 29.0))));
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    const std::string path = scratch_.path(name);
    GDALDatasetUniquePtr file(driver->Create(path.c_str(), cols, rows, 1, type, nullptr));
    OGRSpatialReference crs;
    crs.importFromEPSG(32633);
    file->SetSpatialRef(&crs);
    std::vector<double> map{500000, 10, 0, 5000000, 0, -12.5};
    file->SetGeoTransform(map.data());
    GDALRasterBand& band = *file->GetRasterBand(1);
    band.SetNoDataValue(0);
    EXPECT_EQ(band.RasterIO(GF_Write, 0, 0, cols, rows, samples.data(), cols, rows, GDT_Float32, 0, 0, nullptr),
              CE_None);
    return path;
  }

  std::string path(const std::string& name) const { return scratch_.path(name); }
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }

  /// Runs a command that must succeed, and returns its file.
  std::string written(const Names& words, const std::string& name) const {
    const Result result = run(words + Names{"-o", path(name)});
    EXPECT_EQ(result.status, 0) << result.err;
    return text_of(path(name));
  }
  void expect_refused(const Names& words, const std::string& what) const {
    const auto before = scratch_.files();
    const Result result = run(words);
    EXPECT_NE(result.status, 0);
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_NE(result.err.find(what), std::string::npos) << result.err;
    EXPECT_EQ(scratch_.files(), before);
  }

  Scratch scratch_;
  std::mt19937 random_{31};
};

// All that a raster says; GDAL may compress tiles of nodata in two ways.
struct Content {
  std::vector<std::string> texts;
  std::vector<double> numbers;
  bool operator==(const Content&) const = default;
};
inline Content content_of(const std::string& path) {
  const GDALDatasetUniquePtr file(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER));
  Content content;
  const auto add_metadata = [&](GDALMajorObject& object) {
    for (char** pair = object.GetMetadata(); pair && *pair; ++pair) content.texts.emplace_back(*pair);
  };
  const int cols = file->GetRasterXSize(), rows = file->GetRasterYSize();
  add_metadata(*file);
  content.texts.emplace_back(file->GetProjectionRef());
  content.numbers.resize(6);
  file->GetGeoTransform(content.numbers.data());
  for (int b = 1; b <= file->GetRasterCount(); ++b) {
    GDALRasterBand& band = *file->GetRasterBand(b);
    add_metadata(band);
    content.texts.insert(content.texts.end(),
                         {band.GetDescription(), band.GetUnitType(), GDALGetDataTypeName(band.GetRasterDataType())});
    std::vector<double> samples(static_cast<std::size_t>(cols) * rows);
    EXPECT_EQ(band.RasterIO(GF_Read, 0, 0, cols, rows, samples.data(), cols, rows, GDT_Float64, 0, 0, nullptr),
              CE_None);
    samples.insert(samples.end(), {band.GetNoDataValue(), band.GetScale(), band.GetOffset()});
    if (const GDALColorTable* const colours = band.GetColorTable())
      for (int i = 0; i < colours->GetColorEntryCount(); ++i) samples.push_back(colours->GetColorEntry(i)->c1);
    content.numbers.insert(content.numbers.end(), samples.begin(), samples.end());
  }
  return content;
}

// Horizons, sky views and hours of sun, by both engines.
inline std::vector<Names> sky_maps() {
  std::vector<Names> kinds;
  for (const char* engine : {"exact", "sweep"}) {
    kinds.push_back({"horizon", "--azimuths", "3", "--distance", "--farthest", "--engine", engine});
    kinds.push_back({"skyview", "--azimuths", "6", "--measure", "sky-view-factor", "--engine", engine});
#ifdef SCARP_ERFA
    kinds.push_back({"sunhours", "--date", "2026-06-21", "--step", "240", "--first-last", "--engine", engine});
#endif
  }
  return kinds;
}

// The words of a map of a model, which may also be an option's value.
inline Names on_model(Names words, const std::string& dem) {
  std::replace(words.begin(), words.end(), std::string("MODEL"), dem);
  words.insert(words.begin() + 1, dem);
  return words;
}

// Every kind of map, of an observer or a sun near the model's middle.
inline std::vector<Names> kinds_of_maps() {
  const Names seen{"viewshed", "--observer", "500200,4996000,9"};
  std::vector<Names> kinds{seen,
                           seen + Names{"--mode", "count", "--observer", "500100,4993000,4"},
                           seen + Names{"--mode", "angle", "--max-distance", "2000"},
                           seen + Names{"--mode", "ground", "--max-distance", "900", "--crop"},
                           seen + Names{"--max-distance", "1500", "--out-of-range-value", "9"},
                           seen + Names{"--mode", "height", "--target-height", "30", "--max-distance", "1500"},
                           seen + Names{"--mode", "fresnel", "--frequency", "100", "--max-distance", "900"},
                           seen + Names{"--ground", "MODEL", "--observer", "500100,4993000,4"},
                           seen + Names{"--per-observer", "bands", "--observer", "500100,4993000,4"},
                           {"shadow", "--sun", "135,20", "--sun", "10,6"},
                           {"shadow", "--sun", "271,30", "--fraction", "--surface", "bilinear"},
                           {"horizon", "--azimuths", "3", "--max-distance", "700", "--pack"}};
  for (Names& sky : sky_maps()) kinds.push_back(std::move(sky));
#ifdef SCARP_ERFA
  kinds.push_back({"shadow", "--time", "2026-06-21T09:00+02:00"});
  kinds.push_back({"shadow", "--time", "2026-12-21T10:00+02:00", "--sun-per-cell"});
  kinds.push_back({"sunhours", "--date", "2026-06-21", "--step", "240", "--masks", "--sun-per-cell"});
#endif
  return kinds;
}

}  // namespace scarp::test
