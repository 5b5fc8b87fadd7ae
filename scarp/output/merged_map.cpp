// SPDX-License-Identifier: MIT
// merge_raster_maps(): a virtual raster over the parts, copied to the output.
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal_proxy.h>
#include <gdal_vrt.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/output/gdal_writing.h"
#include "scarp/output/map_writing.h"
#include "scarp/output/raster_map.h"

namespace scarp {
namespace {

constexpr const char* kPartItem = "PART";
constexpr const char* kRunItem = "RUN";

// Properties that all parts of a map share, as text, with a name for messages: "metadata", "CRS".
using Traits = std::vector<std::pair<std::string, std::string>>;

struct Part {
  std::string path;
  int part = 0, parts = 0, first = 0, last = 0;  // rows [first, last]
  Traits traits;
  std::array<double, 6> transform{};  // of the raster's first row; zeros: none
};

GDALDatasetUniquePtr open_raster(const std::string& path) {
  errno = 0;
  VSILFILE* const file = VSIFOpenL(path.c_str(), "rb");
  // Some formats have names that are not files.
  if (!file && errno != 0 && errno != ENOENT && errno != ENOTDIR)
    throw Error(fmt::format("{}: cannot be read: {}", path, std::strerror(errno)));
  if (file) VSIFCloseL(file);
  GDALDatasetUniquePtr dataset(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER));
  if (!dataset) throw Error(fmt::format("{}: {}", path, file ? "is not a raster" : "missing, or not a raster"));
  return dataset;
}

// Without what differs between parts.
std::vector<std::string> metadata_of(GDALDataset& dataset) {
  std::vector<std::string> pairs;
  for (char** pair = dataset.GetMetadata(); pair && *pair; ++pair) {
    const std::string_view text = *pair;
    if (!text.starts_with("PART=") && !text.starts_with("RUN=") && !text.starts_with("AREA_OR_POINT="))
      pairs.emplace_back(text);
  }
  return pairs;
}

Traits traits_of(GDALDataset& dataset) {
  Traits traits;
  // SOURCE is the path as it was typed; RUN has the name of the file.
  for (const std::string& pair : metadata_of(dataset))
    if (!pair.starts_with("SOURCE=")) traits.emplace_back("metadata", pair);
  traits.emplace_back("columns", fmt::format("{}", dataset.GetRasterXSize()));
  traits.emplace_back("bands", fmt::format("{}", dataset.GetRasterCount()));
  traits.emplace_back("CRS", dataset.GetProjectionRef());
  for (int i = 1; i <= dataset.GetRasterCount(); ++i) {
    GDALRasterBand& band = *dataset.GetRasterBand(i);
    const auto add = [&](const char* what, const std::string& text) {
      traits.emplace_back(fmt::format("{} of band {}", what, i), text);
    };
    add("sample type", GDALGetDataTypeName(band.GetRasterDataType()));
    add("name", band.GetDescription());
    add("unit", band.GetUnitType());
    int has = 0;
    const double nodata = band.GetNoDataValue(&has);
    add("nodata", has != 0 ? fmt::format("{}", nodata) : "none");
    add("scale", fmt::format("{}", band.GetScale()));
    add("offset", fmt::format("{}", band.GetOffset()));
    const char* const legend = band.GetMetadataItem("LEGEND");
    add("legend", legend ? legend : "none");
  }
  // The last, because another difference says more.
  const char* const run = dataset.GetMetadataItem(kRunItem);
  traits.emplace_back(kRunItem, run ? run : "none");
  return traits;
}

Part part_in(const std::string& path) {
  const GDALDatasetUniquePtr dataset = open_raster(path);
  Part part{path, 0, 0, 0, 0, {}, {}};
  const char* const text = dataset->GetMetadataItem(kPartItem);
  if (!text)
    throw Error(fmt::format("{}: is not a part of a map (it has no metadata PART, which --part writes)", path));
  if (std::sscanf(text, "%d/%d: rows %d to %d", &part.part, &part.parts, &part.first, &part.last) != 4 ||
      part.part < 1 || part.part > part.parts || part.first < 0 ||
      part.last - part.first + 1 != dataset->GetRasterYSize())
    throw Error(fmt::format("{}: has a wrong PART '{}' (cropped or resampled after it was written?)", path, text));
  part.traits = traits_of(*dataset);
  if (auto& t = part.transform; dataset->GetGeoTransform(t.data()) == CE_None) {
    t[0] -= part.first * t[2];
    t[3] -= part.first * t[5];
  } else {
    t = {};
  }
  return part;
}

// The first property in which two parts differ; empty: none.
std::string difference(const Part& a, const Part& b) {
  static const std::pair<std::string, std::string> kNone;
  for (std::size_t i = 0; i < std::max(a.traits.size(), b.traits.size()); ++i) {
    const auto &x = i < a.traits.size() ? a.traits[i] : kNone, &y = i < b.traits.size() ? b.traits[i] : kNone;
    if (x == y) continue;
    if (x.first == kRunItem && y.first == kRunItem)
      return "it has other options, or its input had another size or time (compute it again)";
    return fmt::format("{} '{}' instead of '{}'", y.first.empty() ? x.first : y.first, y.second, x.second);
  }
  // Text formats keep ten digits of coordinates: millimetres below 10^7 m, a thousandth of cells of a metre.
  constexpr double kSamePlace = 1e-3;  // cells
  const std::array<double, 6> cell{a.transform[1], a.transform[1], a.transform[5],
                                   a.transform[5], a.transform[5], a.transform[5]};
  for (std::size_t i = 0; i < cell.size(); ++i)
    if (!(std::abs(a.transform[i] - b.transform[i]) <= kSamePlace * std::abs(cell[i]))) return "it is at another place";
  return {};
}

// Sorts the parts from north to south.
void require_all(std::vector<Part>& parts) {
  std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.part < b.part; });
  const Part& model = parts.front();
  for (const Part& one : parts) {
    if (one.parts != model.parts)
      throw Error(fmt::format("{}: is one of {} parts, {} one of {}", one.path, one.parts, model.path, model.parts));
    if (const std::string what = difference(model, one); !what.empty())
      throw Error(fmt::format("{}: is not of the same map as {}: {}", one.path, model.path, what));
  }
  std::string missing;
  int count = 0, wanted = 1;
  const auto miss = [&](int end) {
    for (; wanted < end; ++wanted) {
      constexpr int kListed = 8;
      if (++count <= kListed) missing += fmt::format("{}{}", count == 1 ? "" : ", ", wanted);
      if (count == kListed + 1) missing += ", ...";
    }
  };
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i > 0 && parts[i].part == parts[i - 1].part)
      throw Error(fmt::format("part {} is given twice: {} and {}", parts[i].part, parts[i - 1].path, parts[i].path));
    miss(parts[i].part);
    ++wanted;
  }
  miss(model.parts + 1);
  if (count > 0)
    throw Error(fmt::format("{} of {} parts {} missing: {}", count, model.parts, count == 1 ? "is" : "are", missing));
  for (std::size_t i = 1; i < parts.size(); ++i)
    if (parts[i].first != parts[i - 1].last + 1)
      throw Error(fmt::format("{}: begins at row {}, {} ends at row {}", parts[i].path, parts[i].first,
                              parts[i - 1].path, parts[i - 1].last));
}

// A source of the mosaic, which is opened when its rows are read, and closed when others are.
GDALDataset* lazily_opened(const Part& part, GDALDataset& like) {
  auto* const dataset = new GDALProxyPoolDataset(part.path.c_str(), like.GetRasterXSize(), part.last - part.first + 1,
                                                 GA_ReadOnly, FALSE);
  for (int b = 1; b <= like.GetRasterCount(); ++b) {
    GDALRasterBand& band = *like.GetRasterBand(b);
    int cols = 0, rows = 0;
    band.GetBlockSize(&cols, &rows);
    dataset->AddSrcBandDescription(band.GetRasterDataType(), cols, rows);
  }
  return dataset;
}

// `model`: the first part, which is open.
GDALDatasetUniquePtr mosaic_of(const std::vector<Part>& parts, GDALDataset& model) {
  const int cols = model.GetRasterXSize(), first = parts.front().first, rows = parts.back().last - first + 1;
  auto* const driver = GetGDALDriverManager()->GetDriverByName("VRT");
  GDALDatasetUniquePtr mosaic(driver->Create("", cols, rows, 0, GDT_Byte, nullptr));
  std::vector<GDALDataset*> sources;
  for (const Part& part : parts) sources.push_back(lazily_opened(part, model));
  for (int b = 1; b <= model.GetRasterCount(); ++b) {
    GDALRasterBand& like = *model.GetRasterBand(b);
    mosaic->AddBand(like.GetRasterDataType(), nullptr);
    GDALRasterBand& band = *mosaic->GetRasterBand(b);
    band.SetDescription(like.GetDescription());
    if (*like.GetUnitType() != 0) band.SetUnitType(like.GetUnitType());
    int has = 0;
    if (const double nodata = like.GetNoDataValue(&has); has != 0) band.SetNoDataValue(nodata);
    if (const double scale = like.GetScale(&has); has != 0 && scale != 1) band.SetScale(scale);
    if (const double offset = like.GetOffset(&has); has != 0 && offset != 0) band.SetOffset(offset);
    if (GDALColorTable* const colours = like.GetColorTable()) band.SetColorTable(colours);
    for (char** pair = like.GetMetadata(); pair && *pair; ++pair) {
      char* name = nullptr;
      const char* const value = CPLParseNameValue(*pair, &name);
      if (name && value && !STARTS_WITH(name, "STATISTICS_")) band.SetMetadataItem(name, value);
      CPLFree(name);
    }
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const Part& part = parts[i];
      VRTAddSimpleSource(static_cast<VRTSourcedRasterBandH>(GDALRasterBand::ToHandle(&band)),
                         GDALRasterBand::ToHandle(sources[i]->GetRasterBand(b)), 0, 0, cols, part.last - part.first + 1,
                         0, part.first - first, cols, part.last - part.first + 1, nullptr, VRT_NODATA_UNSET);
    }
  }
  std::array<double, 6> transform{};
  if (model.GetGeoTransform(transform.data()) == CE_None) mosaic->SetGeoTransform(transform.data());
  if (const OGRSpatialReference* const crs = model.GetSpatialRef()) mosaic->SetSpatialRef(crs);
  for (const std::string& pair : metadata_of(model)) {
    const auto equals = pair.find('=');
    mosaic->SetMetadataItem(pair.substr(0, equals).c_str(), pair.c_str() + equals + 1);
  }
  for (GDALDataset* const source : sources) source->ReleaseRef();  // the mosaic holds references
  return mosaic;
}

}  // namespace

void merge_raster_maps(const std::string& path, const std::vector<std::string>& parts, const MergedFormat& format,
                       const Progress& progress) {
  const GdalWriting quiet(AuxiliaryFiles::written);
  // Sources that GDAL keeps open; systems limit the files of a process, some to 256.
  const CPLConfigOptionSetter few("GDAL_MAX_DATASET_POOL_SIZE", "8", true);
  std::vector<Part> checked;
  for (const std::string& part : parts) checked.push_back(part_in(part));
  if (checked.empty()) throw Error("no parts to merge");
  require_all(checked);
  const GDALDatasetUniquePtr model = open_raster(checked.front().path);
  const GDALDatasetUniquePtr mosaic = mosaic_of(checked, *model);
  GDALRasterBand& band = *mosaic->GetRasterBand(1);
  const double pixels = static_cast<double>(mosaic->GetRasterXSize()) * mosaic->GetRasterYSize();
  write_dataset(path, *mosaic,
                {.driver = format.driver,
                 .creation_options = format.creation_options,
                 .floats = band.GetRasterDataType() == GDT_Float32,
                 .classes = band.GetMetadataItem("LEGEND") != nullptr,
                 .bytes = pixels * mosaic->GetRasterCount() * GDALGetDataTypeSizeBytes(band.GetRasterDataType())},
                progress);
}

}  // namespace scarp
