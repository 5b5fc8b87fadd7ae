// SPDX-License-Identifier: MIT
// An odd raster file, and a GIS analyst's expectations of a program that reads it; with functions to write such files.
#pragma once

#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/program.h"

namespace scarp::test {

enum class Expected {
  drawn,             ///< a picture with ground in it
  drawn_or_warned,   ///< a picture, and a warning if there is next to no ground in it
  right_or_refused,  ///< as drawn_or_warned, with the stated numbers; or refused
  described,         ///< `info` works, but there is nothing to draw: rejected by `render`
  refused,           ///< one line that names the file
};

/// Lowest and highest, in metres.
struct Heights {
  double low = std::numeric_limits<double>::quiet_NaN(), high = low;  ///< NaN: any
};

struct SpitefulRaster {
  std::string kind;  ///< its oddity
  std::vector<std::string> inputs;
  Expected expected = Expected::drawn;
  std::string words = {};  ///< one of them must be in the notes or in the error, in any case: "nodata|hole"
  Heights heights = {};
  double width_m = std::numeric_limits<double>::quiet_NaN();  ///< from the first to the last column; NaN: any
  std::string size = "24x16";                                 ///< in samples; empty: any
  bool peaks_in_north_east = false;
  std::vector<std::string> options = {};
  bool may_hang = false;  ///< or use much memory: run with limits on both
};

using SpitefulRasters = std::vector<SpitefulRaster>;

/// The usual terrain of 24 x 16 samples rises from 60 m in the west and south to 120 m in the north-east, in whole
/// metres: any type of sample can hold it.
inline constexpr int kCols = 24, kRows = 16;
inline constexpr Heights kHills{60, 120};
inline constexpr double kHillsWidth_m = 230;

inline double hill(int col, int row) {
  return std::round(60 + 60.0 * col / (kCols - 1) * (kRows - 1 - row) / (kRows - 1));
}

inline std::vector<double> hills() {
  std::vector<double> samples;
  for (int row = 0; row < kRows; ++row) {
    for (int col = 0; col < kCols; ++col) samples.push_back(hill(col, row));
  }
  return samples;
}

/// The hills with other values in the square of `side` samples whose north-western one is (10, 5).
inline std::vector<double> hills_with(double value, int side = 1) {
  std::vector<double> samples = hills();
  for (int row = 5; row < 5 + side; ++row) {
    for (int col = 10; col < 10 + side; ++col) samples[static_cast<std::size_t>(row * kCols + col)] = value;
  }
  return samples;
}

/// Writes files into a temporary folder that it removes.
class SpitefulFiles {
 public:
  using Edit = std::function<void(GDALDataset&)>;

  SpitefulFiles() {
    GDALAllRegister();
    CPLPushErrorHandler(CPLQuietErrorHandler);
  }
  ~SpitefulFiles() { CPLPopErrorHandler(); }
  SpitefulFiles(const SpitefulFiles&) = delete;
  SpitefulFiles& operator=(const SpitefulFiles&) = delete;

  std::string path(const std::string& name) const { return folder_.path(name); }
  std::string bytes(const std::string& name, const std::string& content) const { return folder_.write(name, content); }

  /// An ESRI ASCII grid of the hills with the given last three header lines.
  std::string asc(const std::string& name, const std::string& place, const std::vector<double>& samples = hills(),
                  const char* format = "{} ", const std::string& end = "\n") const {
    std::string text = fmt::format("ncols {}{}nrows {}{}", kCols, end, kRows, end) + place + end;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      text += fmt::format(fmt::runtime(format), samples[i]);
      if ((i + 1) % kCols == 0) text += end;
    }
    return bytes(name, text);
  }

  /// A GeoTIFF of cells of 10 m in UTM zone 32, all of whose bands hold the same samples. `edit` may change anything.
  std::string tiff(const std::string& name, GDALDataType type, const std::vector<double>& samples,
                   const Edit& edit = {}, std::vector<const char*> options = {}, int bands = 1, int cols = kCols,
                   int rows = kRows) const {
    options.push_back(nullptr);
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    const GDALDatasetUniquePtr dataset(
        driver->Create(path(name).c_str(), cols, rows, bands, type, const_cast<char**>(options.data())));
    place(*dataset, {500000, 10, 0, 5000160, 0, -10});
    set_crs(*dataset, "EPSG:32632");
    if (edit) edit(*dataset);
    for (int b = 1; b <= bands && !samples.empty(); ++b) write(*dataset, b, samples);
    return path(name);
  }

  /// The same for hills in 16-bit integers, with a different CRS and cell size.
  std::string tiff_at(const std::string& name, const std::string& crs, std::array<double, 6> map,
                      const std::vector<double>& samples = hills()) const {
    return tiff(name, GDT_Int16, samples, [&](GDALDataset& dataset) {
      place(dataset, map);
      if (!crs.empty()) set_crs(dataset, crs);
    });
  }

  /// A copy in another format; empty where this GDAL cannot write it.
  std::string copy(const std::string& source, const char* driver_name, const std::string& name,
                   std::vector<const char*> options = {}) const {
    options.push_back(nullptr);
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(driver_name);
    if (!driver) return {};
    const GDALDatasetUniquePtr from(GDALDataset::Open(source.c_str()));
    const GDALDatasetUniquePtr to(driver->CreateCopy(path(name).c_str(), from.get(), FALSE,
                                                     const_cast<char**>(options.data()), nullptr, nullptr));
    return to ? path(name) : "";
  }

  static void place(GDALDataset& dataset, std::array<double, 6> map) { dataset.SetGeoTransform(map.data()); }

  static void set_crs(GDALDataset& dataset, const std::string& text) {
    OGRSpatialReference crs;
    crs.SetFromUserInput(text.c_str());
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    dataset.SetSpatialRef(&crs);
  }

  static void write(GDALDataset& dataset, int band, std::vector<double> samples) {
    const int cols = dataset.GetRasterXSize(), rows = dataset.GetRasterYSize();
    if (dataset.GetRasterBand(band)->RasterIO(GF_Write, 0, 0, cols, rows, samples.data(), cols, rows, GDT_Float64, 0, 0,
                                              nullptr) != CE_None)
      throw std::runtime_error("cannot write samples");
  }

 private:
  Scratch folder_;
};

}  // namespace scarp::test
