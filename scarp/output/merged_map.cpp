// SPDX-License-Identifier: MIT
// merge_raster_maps(): a virtual raster over the parts, copied to the output.
#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_vrt.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <string_view>

#include "scarp/base/error.h"
#include "scarp/output/gdal_writing.h"
#include "scarp/output/map_writing.h"
#include "scarp/output/raster_map.h"

namespace scarp {
namespace {

constexpr const char* kPartItem = "PART";

struct Part {
  std::string path;
  GDALDatasetUniquePtr dataset;
  int part = 0, parts = 0, first = 0, last = 0;  // rows [first, last]
};

Part open_part(const std::string& path) {
  Part part{path, GDALDatasetUniquePtr(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER)), 0, 0, 0, 0};
  if (!part.dataset) throw Error(fmt::format("{}: missing, or not a raster", path));
  const char* const text = part.dataset->GetMetadataItem(kPartItem);
  if (!text)
    throw Error(fmt::format("{}: is not a part of a map (it has no metadata PART, which --part writes)", path));
  if (std::sscanf(text, "%d/%d: rows %d to %d", &part.part, &part.parts, &part.first, &part.last) != 4 ||
      part.part < 1 || part.part > part.parts || part.first < 0 ||
      part.last - part.first + 1 != part.dataset->GetRasterYSize())
    throw Error(fmt::format("{}: has a wrong PART '{}' (cropped or resampled after it was written?)", path, text));
  return part;
}

std::vector<std::string> metadata_of(GDALDataset& dataset) {
  std::vector<std::string> pairs;
  for (char** pair = dataset.GetMetadata(); pair && *pair; ++pair) {
    const std::string_view text = *pair;
    if (!text.starts_with("PART=") && !text.starts_with("AREA_OR_POINT=")) pairs.emplace_back(text);
  }
  return pairs;
}

// The first property in which two parts differ; empty: none.
std::string difference(GDALDataset& a, GDALDataset& b) {
  const auto first = metadata_of(a), second = metadata_of(b);
  for (std::size_t i = 0; i < std::max(first.size(), second.size()); ++i) {
    const std::string& x = i < first.size() ? first[i] : "";
    const std::string& y = i < second.size() ? second[i] : "";
    if (x != y) return fmt::format("'{}' instead of '{}'", y, x);
  }
  if (a.GetRasterXSize() != b.GetRasterXSize())
    return fmt::format("{} columns instead of {}", b.GetRasterXSize(), a.GetRasterXSize());
  if (a.GetRasterCount() != b.GetRasterCount())
    return fmt::format("{} bands instead of {}", b.GetRasterCount(), a.GetRasterCount());
  for (int i = 1; i <= a.GetRasterCount(); ++i) {
    GDALRasterBand &x = *a.GetRasterBand(i), &y = *b.GetRasterBand(i);
    if (x.GetRasterDataType() != y.GetRasterDataType() || std::strcmp(x.GetDescription(), y.GetDescription()) != 0 ||
        x.GetNoDataValue() != y.GetNoDataValue())
      return fmt::format("another band {}", i);
  }
  return {};
}

// Sorts the parts from north to south.
void require_all(std::vector<Part>& parts) {
  std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.part < b.part; });
  const Part& model = parts.front();
  for (const Part& one : parts) {
    if (one.parts != model.parts)
      throw Error(fmt::format("{}: is one of {} parts, {} one of {}", one.path, one.parts, model.path, model.parts));
    if (const std::string what = difference(*model.dataset, *one.dataset); !what.empty())
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

GDALDatasetUniquePtr mosaic_of(std::vector<Part>& parts) {
  GDALDataset& model = *parts.front().dataset;
  const int cols = model.GetRasterXSize(), first = parts.front().first, rows = parts.back().last - first + 1;
  auto* const driver = GetGDALDriverManager()->GetDriverByName("VRT");
  GDALDatasetUniquePtr mosaic(driver->Create("", cols, rows, 0, GDT_Byte, nullptr));
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
    for (const Part& part : parts)
      VRTAddSimpleSource(static_cast<VRTSourcedRasterBandH>(GDALRasterBand::ToHandle(&band)),
                         GDALRasterBand::ToHandle(part.dataset->GetRasterBand(b)), 0, 0, cols,
                         part.last - part.first + 1, 0, part.first - first, cols, part.last - part.first + 1, nullptr,
                         VRT_NODATA_UNSET);
  }
  std::array<double, 6> transform{};
  if (model.GetGeoTransform(transform.data()) == CE_None) mosaic->SetGeoTransform(transform.data());
  if (const OGRSpatialReference* const crs = model.GetSpatialRef()) mosaic->SetSpatialRef(crs);
  for (const std::string& pair : metadata_of(model)) {
    const auto equals = pair.find('=');
    mosaic->SetMetadataItem(pair.substr(0, equals).c_str(), pair.c_str() + equals + 1);
  }
  // The sources hold references.
  for (Part& part : parts) part.dataset.release()->ReleaseRef();
  return mosaic;
}

}  // namespace

void merge_raster_maps(const std::string& path, const std::vector<std::string>& parts, const MergedFormat& format,
                       const Progress& progress) {
  const GdalWriting quiet(AuxiliaryFiles::written);
  std::vector<Part> opened;
  for (const std::string& part : parts) opened.push_back(open_part(part));
  if (opened.empty()) throw Error("no parts to merge");
  require_all(opened);
  const GDALDatasetUniquePtr mosaic = mosaic_of(opened);
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
