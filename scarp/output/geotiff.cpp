// SPDX-License-Identifier: MIT
#include "scarp/output/geotiff.h"

#include <cpl_string.h>
#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/output/gdal_writing.h"

namespace scarp {
namespace {

constexpr int kTiledFrom = 512;  // pixels: smaller images are read as a whole anyway
// Rows per write call: a multiple of GDAL's tile height of 256 pixels, so that no tile is written twice.
constexpr int kRows = 256;
constexpr int kBands = 4;

void write_rows(GDALDataset& dataset, const RgbView& picture, std::span<const std::uint8_t> alpha) {
  const auto width = static_cast<std::size_t>(picture.width);
  std::vector<std::uint8_t> rgba(kBands * width * kRows);
  for (int first = 0; first < picture.height; first += kRows) {
    const int rows = std::min(kRows, picture.height - first);
    const std::size_t before = width * static_cast<std::size_t>(first), count = width * static_cast<std::size_t>(rows);
    for (std::size_t i = 0; i < count; ++i) {
      std::copy_n(picture.data + 3 * (before + i), 3, rgba.data() + kBands * i);
      rgba[kBands * i + 3] = alpha.empty() ? 255 : alpha[before + i];
    }
    const CPLErr result =
        dataset.RasterIO(GF_Write, 0, first, picture.width, rows, rgba.data(), picture.width, rows, GDT_Byte, kBands,
                         nullptr, kBands, std::int64_t{kBands} * picture.width, 1, nullptr);
    if (result != CE_None) return;  // GDAL has already reported the reason
  }
}

}  // namespace

void write_geotiff(ReplaceFile& file, const std::string& path, const RgbView& picture,
                   std::span<const std::uint8_t> alpha, const std::optional<MapPlace>& place) {
  require_size(picture, std::numeric_limits<int>::max(), path, "TIFF");
  const GdalWriting writing;
  const double bytes = static_cast<double>(kBands) * picture.width * picture.height;
  CPLStringList options;
  for (const char* option : {"COMPRESS=DEFLATE", "PREDICTOR=2", "PHOTOMETRIC=RGB", "ALPHA=YES", "BIGTIFF=IF_SAFER"})
    options.AddString(option);
  if (std::max(picture.width, picture.height) > kTiledFrom) options.AddString("TILED=YES");
  GDALDatasetUniquePtr dataset(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      file.temporary_path().c_str(), picture.width, picture.height, kBands, GDT_Byte, options.List()));
  writing.require_good(path, bytes);
  if (place) {
    auto transform = place->map_from_pixel;
    dataset->SetGeoTransform(transform.data());
    OGRSpatialReference crs;
    if (!place->crs_wkt.empty() && crs.importFromWkt(place->crs_wkt.c_str()) != OGRERR_NONE)
      throw Error(fmt::format("{}: unusable coordinate reference system", path));
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    if (!crs.IsEmpty()) dataset->SetSpatialRef(&crs);
  }
  write_rows(*dataset, picture, alpha);
  dataset.reset();
  writing.require_good(path, bytes);
  file.commit();
}

}  // namespace scarp
