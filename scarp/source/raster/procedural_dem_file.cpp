// SPDX-License-Identifier: MIT
#include "scarp/source/raster/procedural_dem_file.h"

#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/base/progress_part.h"
#include "scarp/base/replace_file.h"
#include "scarp/source/gdal_errors.h"

namespace scarp {
namespace {

constexpr int kBlock = 256;       // side of the file's tiles
constexpr int kRowsPerPiece = 8;  // of a strip, for one thread

[[noreturn]] void refuse(const std::string& path, const GdalSession& session) {
  throw Error(
      fmt::format("{}: cannot be written: {} (is the disk full?)", path, session.reason("GDAL gives no reason")));
}

GDALDatasetUniquePtr create(const std::string& path, const std::string& file, const ComputedDem& s,
                            GdalSession& session) {
  GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  if (!driver) throw Error("GDAL has no GeoTIFF driver (install a build that has)");
  CPLStringList options;
  options.SetNameValue("TILED", "YES");
  options.SetNameValue("BLOCKXSIZE", fmt::format("{}", kBlock).c_str());
  options.SetNameValue("BLOCKYSIZE", fmt::format("{}", kBlock).c_str());
  options.SetNameValue("COMPRESS", "DEFLATE");
  options.SetNameValue("PREDICTOR", "3");
  // Higher levels do not compress noise better.
  options.SetNameValue("ZLEVEL", "1");
  options.SetNameValue("NUM_THREADS", "ALL_CPUS");
  options.SetNameValue("BIGTIFF", "IF_SAFER");
  GDALDatasetUniquePtr dataset(driver->Create(file.c_str(), s.cols, s.rows, 1, GDT_Float32, options.List()));
  if (!dataset) refuse(path, session);

  OGRSpatialReference crs;
  crs.SetWellKnownGeogCS("WGS84");
  crs.SetTM(0, 0, 1, 0, 0);
  crs.SetProjCS("Transverse Mercator around 0 N 0 E");
  crs.SetLinearUnits(SRS_UL_METER, 1);
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  std::array<double, 6> map{-s.cols * s.cell_m / 2, s.cell_m, 0, s.rows * s.cell_m / 2, 0, -s.cell_m};
  dataset->SetSpatialRef(&crs);
  dataset->SetGeoTransform(map.data());
  dataset->SetMetadataItem("TIFFTAG_IMAGEDESCRIPTION", s.description.c_str());
  dataset->GetRasterBand(1)->SetUnitType("m");
  if (session.failed()) refuse(path, session);
  return dataset;
}

}  // namespace

void write_procedural_dem(const std::string& path, const ProceduralDem& settings, const Progress& progress) {
  validate(settings);
  const std::string features =
      settings.feature_size > 0 ? fmt::format(", features of {} cells", settings.feature_size) : "";
  write_computed_dem(path,
                     {settings.cols, settings.rows, settings.cell_m,
                      fmt::format("procedural terrain: {}, seed {}{}", name_of(settings.kind), settings.seed, features),
                      [&](int row, int rows, float* out) {
                        fill_rectangle(settings, 0, row, settings.cols, rows, out, settings.cols);
                      }},
                     progress);
}

void write_computed_dem(const std::string& path, const ComputedDem& settings, const Progress& progress) {
  const auto side = [](int n) { return n >= 1 && n <= kLargestProceduralSide; };
  if (!side(settings.cols) || !side(settings.rows))
    throw Error(fmt::format("terrain: {} x {} samples (sides must be 1 to {})", settings.cols, settings.rows,
                            kLargestProceduralSide));
  if (!(settings.cell_m > 0 && settings.cell_m <= kLargestProceduralCell))
    throw Error(fmt::format("terrain: sample spacing of {} m (must be above 0 and at most {} m)", settings.cell_m,
                            kLargestProceduralCell));
  GdalSession session;
  // Declared before the dataset, so that on every exit the file is closed before it is deleted.
  ReplaceFile output(path);
  GDALDatasetUniquePtr dataset = create(path, output.temporary_path(), settings, session);
  GDALRasterBand& band = *dataset->GetRasterBand(1);
  const int strips = (settings.rows + kBlock - 1) / kBlock;
  std::vector<float> strip(static_cast<std::size_t>(settings.cols) *
                           static_cast<std::size_t>(std::min(kBlock, settings.rows)));
  for (int s = 0; s < strips; ++s) {
    const int first = s * kBlock, rows = std::min(kBlock, settings.rows - first);
    parallel_for(
        rows, kRowsPerPiece,
        [&](std::int64_t begin, std::int64_t end) {
          settings.fill(first + static_cast<int>(begin), static_cast<int>(end - begin),
                        strip.data() + begin * settings.cols);
        },
        progress_part(progress, s, strips));
    const CPLErr result = band.RasterIO(GF_Write, 0, first, settings.cols, rows, strip.data(), settings.cols, rows,
                                        GDT_Float32, 0, 0, nullptr);
    if (result != CE_None) refuse(path, session);
    // Flushes GDAL's cache immediately: it must not grow, and a full disk must be reported early.
    dataset->FlushCache();
    if (session.failed()) refuse(path, session);
  }
  dataset.reset();
  if (session.failed()) refuse(path, session);
  output.commit();
}

}  // namespace scarp
