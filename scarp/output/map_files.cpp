// SPDX-License-Identifier: MIT
#include "scarp/output/map_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <vector>

#include "scarp/base/error.h"

namespace scarp {

namespace fs = std::filesystem;

namespace {

// Whether a file contains the samples of a band. Formats may have their own value for samples without data.
class SameSample {
 public:
  SameSample(GDALRasterBand& expected, GDALRasterBand& stored)
      : floats_(expected.GetRasterDataType() == GDT_Float32), nodata_(expected.GetNoDataValue()) {
    int has = 0;
    const double value = stored.GetNoDataValue(&has);
    if (has != 0) stored_ = value;
  }
  bool operator()(double expected, double stored) const {
    if (stored_) {
      const bool is_nodata = stored == *stored_ || std::isnan(stored);
      if (expected == nodata_ || is_nodata) return expected == nodata_ && is_nodata;
    }
    // Text has as many digits as floats need.
    return floats_ ? static_cast<float>(expected) == static_cast<float>(stored) : expected == stored;
  }

 private:
  bool floats_;
  double nodata_;
  std::optional<double> stored_;
};

// Whether pixels have the same place on the ground, to a hundredth of a pixel.
bool same_place(GDALDataset& expected, GDALDataset& stored) {
  std::array<double, 6> a{}, b{};
  if (expected.GetGeoTransform(a.data()) != CE_None) return true;
  if (stored.GetGeoTransform(b.data()) != CE_None) return false;
  const double most = 0.01 * std::hypot(a[1], a[4]);
  for (const double col : {0, expected.GetRasterXSize()})
    for (const double row : {0, expected.GetRasterYSize()})
      for (const std::size_t i : {0, 3})
        if (!(std::abs(a[i] - b[i] + col * (a[i + 1] - b[i + 1]) + row * (a[i + 2] - b[i + 2])) <= most)) return false;
  return true;
}

}  // namespace

MapFiles::MapFiles(const std::string& path)
    : target_(path), file_(path), folder_(path), main_((fs::path(folder()) / fs::path(path).filename()).string()) {}

void MapFiles::commit() {
  const fs::path target(target_), beside = target.parent_path();
  std::error_code failed;
  const auto move = [&](const fs::path& from, const fs::path& to) {
    fs::rename(from, to, failed);
    if (failed) throw Error(fmt::format("{}: cannot be written: {}", to.string(), failed.message()));
  };
  std::vector<fs::path> sides;
  for (const auto& entry : fs::directory_iterator(folder()))
    if (entry.path() != main_) sides.push_back(entry.path());
  // NAME.hdr, unlike NAME.EXT.aux.xml, may belong to an input with another extension.
  for (const fs::path& side : sides) {
    const std::string name = side.filename().string();
    if (!name.starts_with(target.filename().string()) && fs::exists(beside / name) && !fs::exists(target))
      throw Error(fmt::format("{}: exists and may belong to another file (remove it, or name another output than {})",
                              (beside / name).string(), target_));
  }
  for (const char* side : {".aux.xml", ".ovr", ".msk"}) fs::remove(fs::path(target_ + side), failed);
  for (const fs::path& side : sides) move(side, beside / side.filename());
  if (fs::is_directory(main_)) {
    if (fs::exists(target))
      throw Error(fmt::format("{}: is a file (its format writes a folder: name another)", target_));
    return move(main_, target);
  }
  move(main_, file_.temporary_path());
  file_.commit();
}

void require_same_map(const std::string& written, GDALDataset& expected, const std::string& path,
                      const std::string& driver) {
  const auto refuse = [&](const std::string& what) {
    throw Error(fmt::format("{}: {} {} (name the output *.tif)", path, driver, what));
  };
  const GDALDatasetUniquePtr dataset(GDALDataset::Open(written.c_str(), GDAL_OF_RASTER));
  if (!dataset || dataset->GetRasterCount() == 0) refuse("files of this map cannot be read back");
  const int cols = expected.GetRasterXSize(), rows = expected.GetRasterYSize(), bands = expected.GetRasterCount();
  if (dataset->GetRasterXSize() != cols || dataset->GetRasterYSize() != rows)
    refuse(fmt::format("stores {} x {} pixels instead of {} x {}", dataset->GetRasterXSize(), dataset->GetRasterYSize(),
                       cols, rows));
  if (dataset->GetRasterCount() < bands) refuse(fmt::format("stores {} of {} bands", dataset->GetRasterCount(), bands));
  if (!same_place(expected, *dataset)) refuse("does not store the georeference");
  constexpr int kSamples = 1 << 20;  // per read
  const int step = std::clamp(kSamples / cols, 1, rows);
  std::vector<double> a(static_cast<std::size_t>(cols) * step), b(a.size());
  for (int band = 1; band <= bands; ++band) {
    if (expected.GetRasterBand(band)->GetScale() != dataset->GetRasterBand(band)->GetScale() ||
        expected.GetRasterBand(band)->GetOffset() != dataset->GetRasterBand(band)->GetOffset())
      refuse("does not store the scale of packed samples");
    const SameSample same(*expected.GetRasterBand(band), *dataset->GetRasterBand(band));
    for (int row = 0; row < rows; row += step) {
      const int count = std::min(step, rows - row);
      const auto read = [&](GDALDataset& from, std::vector<double>& to) {
        if (from.GetRasterBand(band)->RasterIO(GF_Read, 0, row, cols, count, to.data(), cols, count, GDT_Float64, 0, 0,
                                               nullptr) != CE_None)
          refuse("files of this map cannot be read back");
      };
      read(expected, a);
      read(*dataset, b);
      const auto end = a.begin() + static_cast<std::ptrdiff_t>(cols) * count;
      const auto [at, other] = std::mismatch(a.begin(), end, b.begin(), same);
      if (at == end) continue;
      const auto i = static_cast<int>(at - a.begin());
      refuse(fmt::format("changes samples: {:.12g} to {:.12g} at column {}, row {}", *at, *other, i % cols,
                         row + i / cols));
    }
  }
}

}  // namespace scarp
