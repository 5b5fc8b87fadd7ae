// SPDX-License-Identifier: MIT
// Small files for the tests of readers, in a folder that is removed with the test.
#pragma once

#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/source/gdal_errors.h"
#include "scarp/source/raster/read_raster.h"
#include "scratch.h"

namespace scarp::test {

class Files : public ::testing::Test, protected Scratch {
 protected:
  Files() { GDALAllRegister(); }

  std::string bytes_of(const std::string& file) const {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  /// A .zip with compressed members: names and bytes.
  std::string write_zip(const std::string& name,
                        const std::vector<std::pair<std::string, std::string>>& members) const {
    const std::string archive = "/vsizip/{" + path(name) + "}";
    // The archive must stay open between its members, otherwise it would contain only the first one.
    VSILFILE* whole = VSIFOpenL(archive.c_str(), "wb");
    for (const auto& [member, bytes] : members) {
      VSILFILE* file = VSIFOpenL((archive + "/" + member).c_str(), "wb");
      if (!file) break;
      EXPECT_EQ(bytes.size(), VSIFWriteL(bytes.data(), 1, bytes.size(), file));
      VSIFCloseL(file);
    }
    VSIFCloseL(whole);
    return path(name);
  }

  /// A GeoTIFF whose bands all hold `samples`; `edit` is called with the dataset before it is closed.
  std::string write_tiff(const std::string& name, GDALDataType type, int cols, int rows, std::vector<double> samples,
                         const std::function<void(GDALDataset&)>& edit = {}, int bands = 1,
                         std::vector<const char*> options = {}) const {
    options.push_back(nullptr);
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    GDALDatasetUniquePtr dataset(
        driver->Create(path(name).c_str(), cols, rows, bands, type, const_cast<char**>(options.data())));
    for (int b = 1; b <= bands; ++b) {
      EXPECT_EQ(CE_None, dataset->GetRasterBand(b)->RasterIO(GF_Write, 0, 0, cols, rows, samples.data(), cols, rows,
                                                             GDT_Float64, 0, 0, nullptr));
    }
    if (edit) edit(*dataset);
    return path(name);
  }
};

/// The samples of any type as doubles.
inline std::vector<double> doubles(const Raster& raster) {
  return std::visit([](const auto& s) { return std::vector<double>(s.begin(), s.end()); }, raster.samples);
}

template <class T>
bool holds(const Raster& raster) {
  return std::holds_alternative<std::vector<T>>(raster.samples);
}

inline bool has_note(const Raster& raster, const std::string& part) {
  for (const std::string& note : raster.notes) {
    if (note.find(part) != std::string::npos) return true;
  }
  return false;
}

/// The text of the Error that `f` throws: one line that names `path`; fails the test if it throws none.
inline std::string error_of(const std::function<void()>& f) {
  try {
    f();
  } catch (const Interrupted&) {
    ADD_FAILURE() << "interrupted";
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_EQ(std::string::npos, text.find('\n')) << text;
    return text;
  }
  ADD_FAILURE() << "no error";
  return {};
}

inline std::string read_error(const std::string& path, const RasterOptions& options = {}) {
  const std::string text = error_of([&] { read_raster(path, options); });
  EXPECT_NE(std::string::npos, text.find(path + ": ")) << text;
  return text;
}

inline void expect_says(const std::string& text, const std::string& part, const std::string& where = {}) {
  EXPECT_NE(std::string::npos, text.find(part)) << "expected '" << part << "' in: " << text << " " << where;
}

}  // namespace scarp::test
