// SPDX-License-Identifier: MIT
#include "scarp/source/raster/gdal_raster.h"

#include <fmt/format.h>
#include <gdal_priv.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/source/incomplete_file.h"
#include "scarp/source/raster/file_check.h"
#include "scarp/source/raster/text_samples.h"
#include "scarp/source/raster/zip_archive.h"

namespace scarp {
namespace {

// Returns the file within a GDAL name: /vsizip/FILE/MEMBER, NETCDF:FILE:VARIABLE. Empty if there is none.
std::string file_inside(const std::string& path) {
  constexpr std::string_view kZip = "/vsizip/";
  VSIStatBufL status;
  const auto is_file = [&](const std::string& name) {
    return VSIStatL(name.c_str(), &status) == 0 && VSI_ISREG(status.st_mode);
  };
  if (path.starts_with(kZip)) {
    std::string name = path.substr(kZip.size());
    if (name.starts_with('{')) {
      name = name.substr(1, name.find('}') - 1);
      return is_file(name) ? name : "";
    }
    while (!name.empty() && !is_file(name))
      name.resize(name.find_last_of('/') == std::string::npos ? 0 : name.find_last_of('/'));
    return name;
  }
  std::size_t begin = path.find(':'), end = path.rfind(':');
  if (begin == std::string::npos || begin == end) return {};
  ++begin;
  if (end > begin + 1 && path[begin] == '"' && path[end - 1] == '"') ++begin, --end;
  const std::string name = path.substr(begin, end - begin);
  return is_file(name) ? name : "";
}

// Lists members of a .zip whose own name was given.
std::string examples_in(const std::string& archive) {
  constexpr std::size_t kMembersNamed = 3;
  const std::vector<std::string> members = zip_members(archive);
  // GDAL recognises the end of the archive's name by .zip, or by braces.
  const std::string in_name = extension_of(archive) == ".zip" ? archive : "{" + archive + "}";
  std::string text;
  for (std::size_t i = 0; i < std::min(members.size(), kMembersNamed); ++i)
    text += fmt::format("{}/vsizip/{}/{}", i == 0 ? "" : ", ", in_name, members[i]);
  if (members.size() > kMembersNamed) text += fmt::format(" or {} more", members.size() - kMembersNamed);
  return text.empty() ? "empty archive" : "name a raster in it: " + text;
}

[[noreturn]] void refuse_unopened(const std::string& path, const GdalSession& session) {
  VSIStatBufL status;
  const bool exists = VSIStatExL(path.c_str(), &status, VSI_STAT_EXISTS_FLAG | VSI_STAT_NATURE_FLAG) == 0;
  if (exists && VSI_ISDIR(status.st_mode)) throw Error("is a directory (name a raster file)");
  if (exists && VSI_ISREG(status.st_mode)) {
    check_end(path);
    if (is_zip(path)) throw Error(fmt::format("is a .zip archive ({})", examples_in(path)));
  } else if (const std::string file = exists ? "" : file_inside(path); !file.empty()) {
    try {
      check_file(file);
      check_end(file);
    } catch (const Error& error) {
      throw Error(fmt::format("'{}': {}", file, error.what()));
    }
    if (is_zip(file)) throw Error(fmt::format("does not exist in '{}' ({})", file, examples_in(file)));
  }
  // Names such as NETCDF:"f.nc":var and inline XML are not paths.
  if (!exists && path.find_first_of(":<") == std::string::npos) throw Error("does not exist (name a raster file)");
  if (exists && extension_of(path) == ".hgt") {
    throw Error(
        "not a complete .hgt tile (it must be named by its corner, like N46W123.hgt, and contain 1201 x 1201 or "
        "3601 x 3601 samples of 2 bytes)");
  }
  throw Error(fmt::format("not a raster format that GDAL {} can read: {}{}", GDALVersionInfo("RELEASE_NAME"),
                          session.reason("no reason given"),
                          exists ? fmt::format(" (if it should be one, {})", kFetchAgain) : ""));
}

}  // namespace

bool is_ascii_grid(GDALDataset& dataset) {
  return dataset.GetDriver() && EQUAL(dataset.GetDriver()->GetDescription(), "AAIGrid") &&
         dataset.GetRasterCount() == 1;
}

GDALDatasetUniquePtr open_gdal_raster(const std::string& path, const GdalSession& session) {
  if (path.empty()) throw Error("file name is empty (name a raster file)");
  check_file(path);
  const auto open = [&] {
    return GDALDatasetUniquePtr(
        GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
  };
  GDALDatasetUniquePtr dataset = open();
  if (!dataset) refuse_unopened(path, session);
  check_length(*dataset);
  if (is_ascii_grid(*dataset)) {
    const double count = static_cast<double>(dataset->GetRasterXSize()) * dataset->GetRasterYSize();
    const bool integers = has_integers_alone(path, count);
    if (!integers && !GDALDataTypeIsFloating(dataset->GetRasterBand(1)->GetRasterDataType())) {
      const GdalOption type("AAIGRID_DATATYPE", "Float64");
      dataset = open();
      if (!dataset) refuse_unopened(path, session);
    }
  }
  return dataset;
}

}  // namespace scarp
