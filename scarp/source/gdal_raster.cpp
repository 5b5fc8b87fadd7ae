// SPDX-License-Identifier: MIT
#include "scarp/source/gdal_raster.h"

#include <fmt/format.h>
#include <gdal_priv.h>

#include "scarp/base/error.h"
#include "scarp/source/file_check.h"
#include "scarp/source/file_extension.h"
#include "scarp/source/gdal_dataset.h"
#include "scarp/source/gdal_errors.h"
#include "scarp/source/raster_name.h"

namespace scarp {
namespace {

[[noreturn]] void refuse_unopened(const std::string& path, const GdalSession& session) {
  VSIStatBufL status;
  const bool exists = VSIStatExL(path.c_str(), &status, VSI_STAT_EXISTS_FLAG | VSI_STAT_NATURE_FLAG) == 0;
  if (exists && VSI_ISDIR(status.st_mode)) throw Error("is a directory; a raster file is needed");
  // Names such as NETCDF:"f.nc":var and inline XML are no paths.
  if (!exists && path.find_first_of(":<") == std::string::npos) throw Error("does not exist; name a raster file");
  if (exists && has_extension(path, ".hgt")) {
    throw Error(
        "is no whole .hgt tile: its name must tell its corner (N46W123.hgt), its length must be that of 1201 x 1201 or "
        "3601 x 3601 samples of 2 bytes");
  }
  throw Error(fmt::format("is no raster that GDAL {} can read: {}", GDALVersionInfo("RELEASE_NAME"),
                          session.reason("it gives no reason")));
}

}  // namespace

GDALDatasetUniquePtr open_gdal_raster(const std::string& path, const GdalSession& session) {
  check_file(path);
  GDALDatasetUniquePtr dataset(
      GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
  if (!dataset) refuse_unopened(path, session);
  check_length(*dataset);
  return dataset;
}

Raster read_gdal_raster(const std::string& path, const RasterOptions& options, const Progress& progress) {
  GdalSession session;
  const StrictReading strict;
  return read_named(path, [&] {
    if (path.empty()) throw Error("the file name is empty; name a raster file");
    const GDALDatasetUniquePtr dataset = open_gdal_raster(path, session);
    return read_dataset(*dataset, options, session, progress);
  });
}

}  // namespace scarp
