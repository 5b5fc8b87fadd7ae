// SPDX-License-Identifier: MIT
#include "scarp/source/file_check.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <string_view>

#include "scarp/base/error.h"
#include "scarp/source/netcdf_size.h"

namespace scarp {
namespace {

constexpr std::string_view kLfsPointer = "version https://git-lfs";

struct FileCloser {
  void operator()(VSILFILE* file) const { VSIFCloseL(file); }
};

// Up to `count` bytes from the beginning.
std::string start_of(const std::string& path, std::size_t count) {
  errno = 0;
  const std::unique_ptr<VSILFILE, FileCloser> file(VSIFOpenL(path.c_str(), "rb"));
  if (!file) throw Error(fmt::format("cannot be opened: {}", errno ? std::strerror(errno) : "GDAL gives no reason"));
  std::string start(count, '\0');
  start.resize(VSIFReadL(start.data(), 1, count, file.get()));
  return start;
}

// ENVI's samples lie plainly behind an offset, all bands in one file.
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
  VSIStatBufL status;
  if (VSIStatExL(path.c_str(), &status, VSI_STAT_EXISTS_FLAG | VSI_STAT_NATURE_FLAG | VSI_STAT_SIZE_FLAG) != 0) return;
  if (!VSI_ISREG(status.st_mode)) return;
  if (status.st_size == 0) throw Error("is empty (0 bytes); a raster file is needed");
  if (start_of(path, kLfsPointer.size()) == kLfsPointer) {
    throw Error("is a Git LFS pointer, not the file itself; fetch it with: git lfs pull");
  }
}

void check_length(GDALDataset& dataset) {
  const char* const driver = dataset.GetDriver() ? dataset.GetDriver()->GetDescription() : "";
  const bool netcdf = EQUAL(driver, "netCDF"), envi = EQUAL(driver, "ENVI");
  if ((!netcdf && !envi) || dataset.GetRasterCount() == 0) return;
  const CPLStringList files(dataset.GetFileList());
  VSIStatBufL status;
  if (files.empty() || VSIStatL(files[0], &status) != 0) return;
  const std::optional<double> least =
      netcdf ? netcdf_classic_bytes(start_of(files[0], kNetcdfHeaderBytes)) : envi_bytes(dataset);
  if (least && static_cast<double>(status.st_size) < *least) {
    throw Error(fmt::format("is cut off: its header needs {:.0f} bytes, it has {}", *least, status.st_size));
  }
}

}  // namespace scarp
