// SPDX-License-Identifier: MIT
#include "scarp/source/raster/file_check.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <string_view>

#include "scarp/base/error.h"
#include "scarp/base/input_file.h"
#include "scarp/source/incomplete_file.h"
#include "scarp/source/raster/netcdf_size.h"
#include "scarp/source/raster/raw_band.h"
#include "scarp/source/raster/vsi_file.h"
#include "scarp/source/raster/zip_archive.h"

namespace scarp {
namespace {

void require_bytes(double needed, std::uint64_t has) {
  if (static_cast<double>(has) < needed) {
    throw Error(
        fmt::format("truncated: {} bytes instead of {:.0f} as its header states ({})", has, needed, kFetchAgain));
  }
}

// ENVI stores samples uncompressed after an offset, all bands in one file.
std::optional<double> envi_bytes(GDALDataset& dataset) {
  const auto entry = [&](const char* name) {
    const char* text = dataset.GetMetadataItem(name, "ENVI");
    return text ? std::atof(text) : 0.0;
  };
  if (entry("file_compression") != 0) return {};
  const double samples =
      static_cast<double>(dataset.GetRasterXSize()) * dataset.GetRasterYSize() * dataset.GetRasterCount();
  return entry("header_offset") + samples * GDALGetDataTypeSizeBytes(dataset.GetRasterBand(1)->GetRasterDataType());
}

}  // namespace

void check_file(const std::string& path) {
  refuse_special_file(path);
  VSIStatBufL status;
  if (VSIStatExL(path.c_str(), &status, VSI_STAT_EXISTS_FLAG | VSI_STAT_NATURE_FLAG | VSI_STAT_SIZE_FLAG) != 0) return;
  if (!VSI_ISREG(status.st_mode)) return;
  if (status.st_size == 0) throw Error("empty file (0 bytes)");
  refuse_lfs_pointer(bytes_from(path, 0, kLfsPointer.size()));
}

void check_end(const std::string& path) {
  const auto size = static_cast<std::uint64_t>(file_bytes(path));
  if (is_zip(path)) {
    if (!has_zip_end(path))
      throw Error(fmt::format("truncated: the end record of the archive is missing ({})", kFetchAgain));
    return;
  }
  const std::string start = bytes_from(path, 0, kNetcdfHeaderBytes);
  if (const std::optional<double> classic = netcdf_classic_bytes(start)) require_bytes(*classic, size);
  if (const std::optional<double> hdf5 = hdf5_bytes(start)) require_bytes(*hdf5, size);
}

std::string bytes_from(const std::string& path, std::uint64_t begin, std::size_t count) {
  errno = 0;
  const VsiFile file(VSIFOpenL(path.c_str(), "rb"));
  if (!file) throw Error(fmt::format("cannot be opened: {}", errno ? std::strerror(errno) : "GDAL gives no reason"));
  std::string bytes(count, '\0');
  VSIFSeekL(file.get(), begin, SEEK_SET);
  bytes.resize(VSIFReadL(bytes.data(), 1, count, file.get()));
  return bytes;
}

void check_length(GDALDataset& dataset) {
  const char* const driver = dataset.GetDriver() ? dataset.GetDriver()->GetDescription() : "";
  const bool netcdf = EQUAL(driver, "netCDF"), envi = EQUAL(driver, "ENVI");
  if ((!netcdf && !envi) || dataset.GetRasterCount() == 0) return;
  const CPLStringList files(dataset.GetFileList());
  VSIStatBufL status;
  if (files.empty() || VSIStatL(files[0], &status) != 0) return;
  const std::optional<double> least =
      netcdf ? netcdf_classic_bytes(bytes_from(files[0], 0, kNetcdfHeaderBytes)) : envi_bytes(dataset);
  if (least) require_bytes(*least, status.st_size);
}

}  // namespace scarp
