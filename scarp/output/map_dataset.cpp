// SPDX-License-Identifier: MIT
#include "scarp/output/map_dataset.h"

#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_vrt.h>
#include <ogr_spatialref.h>

#include <string>

#include "scarp/base/error.h"

namespace scarp {
namespace {

GDALDataType type_of(const MapBand& band) {
  constexpr GDALDataType kTypes[] = {GDT_Byte, GDT_UInt16, GDT_Float32};
  return kTypes[band.samples.index()];
}

// Wraps the samples, without a copy, as an in-memory dataset.
GDALDatasetUniquePtr samples_of(const RasterMap& map, int cols, int rows) {
  auto* driver = GetGDALDriverManager()->GetDriverByName("MEM");
  GDALDatasetUniquePtr dataset(driver->Create("", cols, rows, 0, GDT_Byte, nullptr));
  for (const MapBand& band : map.bands) {
    const auto add = [&](const auto& samples) {
      char address[64] = {};
      address[CPLPrintPointer(address, const_cast<void*>(static_cast<const void*>(samples.data())),
                              sizeof address - 1)] = 0;
      CPLStringList options;
      options.SetNameValue("DATAPOINTER", address);
      dataset->AddBand(type_of(band), options.List());
    };
    std::visit(add, band.samples);
  }
  return dataset;
}

// Surrounds the samples of a part by nodata, which takes no memory.
GDALDatasetUniquePtr surrounded(const RasterMap& map) {
  const MapPart& part = *map.part;
  auto* driver = GetGDALDriverManager()->GetDriverByName("VRT");
  GDALDatasetUniquePtr dataset(driver->Create("", map.cols, map.rows, 0, GDT_Byte, nullptr));
  for (const MapBand& band : map.bands) dataset->AddBand(type_of(band), nullptr);
  if (part.rows == 0) return dataset;
  GDALDatasetUniquePtr samples = samples_of(map, part.cols, part.rows);
  for (int b = 1; b <= dataset->GetRasterCount(); ++b)
    VRTAddSimpleSource(static_cast<VRTSourcedRasterBandH>(GDALRasterBand::ToHandle(dataset->GetRasterBand(b))),
                       GDALRasterBand::ToHandle(samples->GetRasterBand(b)), 0, 0, part.cols, part.rows, part.col,
                       part.row, part.cols, part.rows, nullptr, VRT_NODATA_UNSET);
  samples.release()->ReleaseRef();  // the sources hold references
  return dataset;
}

}  // namespace

GDALDatasetUniquePtr dataset_of(const RasterMap& map, const std::string& path, bool coloured) {
  GDALDatasetUniquePtr dataset = map.part ? surrounded(map) : samples_of(map, map.cols, map.rows);
  for (int b = 1; b <= dataset->GetRasterCount(); ++b) {
    const MapBand& band = map.bands[static_cast<std::size_t>(b - 1)];
    GDALRasterBand& to = *dataset->GetRasterBand(b);
    to.SetDescription(band.name.c_str());
    if (!band.unit.empty()) to.SetUnitType(band.unit.c_str());
    if (band.nodata) to.SetNoDataValue(*band.nodata);
    if (band.scale != 1) to.SetScale(band.scale);
    if (band.offset != 0) to.SetOffset(band.offset);
    if (band.classes.empty()) continue;
    std::string legend;
    GDALColorTable colours;
    for (const MapClass& one : band.classes) {
      const GDALColorEntry entry{one.colour[0], one.colour[1], one.colour[2], one.colour[3]};
      if (one.code < 256) colours.SetColorEntry(one.code, &entry);
      legend += fmt::format("{}{} {}", legend.empty() ? "" : ", ", one.code, one.name);
    }
    if (coloured && type_of(band) == GDT_Byte && map.bands.size() == 1) to.SetColorTable(&colours);
    to.SetMetadataItem("LEGEND", legend.c_str());
  }
  if (map.place) {
    auto transform = map.place->map_from_pixel;
    dataset->SetGeoTransform(transform.data());
    OGRSpatialReference crs;
    if (!map.place->crs_wkt.empty() && crs.importFromWkt(map.place->crs_wkt.c_str()) != OGRERR_NONE)
      throw Error(fmt::format("{}: unusable coordinate reference system", path));
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    if (!crs.IsEmpty()) dataset->SetSpatialRef(&crs);
  }
  for (const auto& [name, value] : map.metadata) dataset->SetMetadataItem(name.c_str(), value.c_str());
  return dataset;
}

}  // namespace scarp
