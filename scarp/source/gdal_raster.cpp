// SPDX-License-Identifier: MIT
#include "scarp/source/gdal_raster.h"

#include <fmt/format.h>
#include <gdal_priv.h>

#include <new>

#include "scarp/base/error.h"
#include "scarp/source/file_check.h"
#include "scarp/source/gdal_dataset.h"
#include "scarp/source/gdal_errors.h"

namespace scarp {
namespace {

[[noreturn]] void refuse_unopened(const std::string& path, const GdalSession& session) {
  VSIStatBufL status;
  const bool exists = VSIStatExL(path.c_str(), &status, VSI_STAT_EXISTS_FLAG | VSI_STAT_NATURE_FLAG) == 0;
  if (exists && VSI_ISDIR(status.st_mode)) throw Error("is a directory; a raster file is needed");
  // Names such as NETCDF:"f.nc":var and inline XML are no paths.
  if (!exists && path.find_first_of(":<") == std::string::npos) throw Error("does not exist; name a raster file");
  if (exists && path.size() > 4 && EQUAL(path.c_str() + path.size() - 4, ".hgt")) {
    throw Error(
        "is no whole .hgt tile: its name must tell its corner (N46W123.hgt), its length must be that of 1201 x 1201 or "
        "3601 x 3601 samples of 2 bytes");
  }
  throw Error(fmt::format("is no raster that GDAL {} can read: {}", GDALVersionInfo("RELEASE_NAME"),
                          session.reason("it gives no reason")));
}

}  // namespace

Raster read_gdal_raster(const std::string& path, const RasterOptions& options, const Progress& progress) {
  GdalSession session;
  // Formats without compression and with a header of their own would be filled up with zeros where the file ends early.
  const GdalOption sizes("RAW_CHECK_FILE_SIZE", "YES");
  const GdalOption jpeg("GDAL_ERROR_ON_LIBJPEG_WARNING", "YES");
  try {
    if (path.empty()) throw Error("the file name is empty; name a raster file");
    if (!options.key.empty()) throw Error("--key names an array in a .npz file, which this is not; leave it out");
    check_file(path);
    const GDALDatasetUniquePtr dataset(
        GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
    if (!dataset) refuse_unopened(path, session);
    check_length(*dataset);
    Raster raster = read_dataset(*dataset, options, session, progress);
    raster.path = path;
    return raster;
  } catch (const Interrupted&) {
    throw;
  } catch (const Error& error) {
    throw Error(fmt::format("raster '{}': {}", path, error.what()));
  } catch (const std::bad_alloc&) {
    throw Error(fmt::format(
        "raster '{}': its samples do not fit into memory; read a part with --window COL,ROW,COLS,ROWS", path));
  }
}

}  // namespace scarp
