// SPDX-License-Identifier: MIT
#include "scarp/output/map_vectors.h"

#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_alg.h>
#include <ogrsf_frmts.h>

#include <array>
#include <filesystem>
#include <functional>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/output/gdal_writing.h"
#include "scarp/output/map_dataset.h"
#include "scarp/output/map_files.h"

namespace scarp {
namespace {

constexpr std::pair<const char*, const char*> kVectorDrivers[] = {{".gpkg", "GPKG"},
                                                                  {".geojson", "GeoJSON"},
                                                                  {".json", "GeoJSON"},
                                                                  {".shp", "ESRI Shapefile"},
                                                                  {".fgb", "FlatGeobuf"}};

// Passes features of a band on to another layer, with the names of the band and of their classes.
class NamingLayer : public OGRLayer {
 public:
  NamingLayer(OGRLayer& layer, const MapBand& band) : layer_(layer), band_(band) {}
  OGRFeatureDefn* GetLayerDefn() override { return layer_.GetLayerDefn(); }
  OGRErr ICreateFeature(OGRFeature* feature) override {
    const int name = feature->GetFieldIndex("class"), band = feature->GetFieldIndex("band");
    for (const MapClass& one : band_.classes)
      if (name >= 0 && feature->GetFieldAsInteger("value") == one.code) feature->SetField(name, one.name.c_str());
    if (band >= 0) feature->SetField(band, band_.name.c_str());
    return layer_.CreateFeature(feature);
  }
  int TestCapability(const char* name) override { return layer_.TestCapability(name); }
  void ResetReading() override {}
  OGRFeature* GetNextFeature() override { return nullptr; }

 private:
  OGRLayer& layer_;
  const MapBand& band_;
};

// GDAL calls report() while it works.
struct Watched {
  const Progress& progress;
  bool stopped = false;

  static int CPL_STDCALL report(double done, const char*, void* data) {
    auto& self = *static_cast<Watched*>(data);
    self.stopped = self.progress && !self.progress(done);
    return self.stopped ? FALSE : TRUE;
  }
};

using Fill = std::function<CPLErr(GDALDataset& map, OGRLayer& layer, Watched& watched)>;

void write_layer(const std::string& path, const RasterMap& map, OGRwkbGeometryType type,
                 const std::vector<OGRFieldDefn*>& fields, const Fill& fill, const Progress& progress) {
  const std::string driver_name = vector_driver_of(path);
  MapFiles files(path);
  GdalWriting writing;
  writing.hide(files.folder());
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(driver_name.c_str());
  if (!driver) throw Error(fmt::format("{}: GDAL has no driver '{}'", path, driver_name));
  const GDALDatasetUniquePtr source = dataset_of(map, path, false);
  GDALDatasetUniquePtr out(driver->Create(files.path().c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  std::array<double, 6> plain{-0.5, 1, 0, map.rows - 0.5, 0, -1};
  if (!map.place) source->SetGeoTransform(plain.data());
  const double bytes = static_cast<double>(map.cols) * map.rows;
  writing.require_good(path, bytes);
  CPLStringList options;
  if (driver_name == "GeoJSON" && source->GetSpatialRef()) options.AddString("RFC7946=YES");
  // Older versions of GDAL take no constant CRS, and change none.
  auto* const crs = const_cast<OGRSpatialReference*>(source->GetSpatialRef());
  OGRLayer* layer = out->CreateLayer(std::filesystem::path(path).stem().c_str(), crs, type, options.List());
  writing.require_good(path, bytes);
  for (OGRFieldDefn* field : fields) layer->CreateField(field);
  Watched watched{progress};
  out->StartTransaction();
  const CPLErr result = fill(*source, *layer, watched);
  if (watched.stopped) throw Interrupted();
  if (result == CE_None) out->CommitTransaction();
  out.reset();
  writing.require_good(path, bytes);
  if (result != CE_None) throw Error(fmt::format("{}: {} cannot hold this map", path, driver_name));
  files.commit();
}

}  // namespace

std::string vector_driver_of(const std::string& path) {
  const std::string extension = extension_of(path);
  for (const auto& [known, driver] : kVectorDrivers)
    if (extension == known) return driver;
  return {};
}

void write_map_polygons(const std::string& path, const RasterMap& map, const Progress& progress) {
  OGRFieldDefn value("value", OFTInteger), name("class", OFTString), band_name("band", OFTString);
  std::vector<OGRFieldDefn*> fields{&value};
  if (!map.bands[0].classes.empty()) fields.push_back(&name);
  if (map.bands.size() > 1) fields.push_back(&band_name);
  const auto fill = [&](GDALDataset& source, OGRLayer& layer, Watched& watched) {
    for (std::size_t i = 0; i < map.bands.size(); ++i) {
      NamingLayer named(layer, map.bands[i]);
      GDALRasterBand& band = *source.GetRasterBand(static_cast<int>(i) + 1);
      const CPLErr result =
          GDALPolygonize(GDALRasterBand::ToHandle(&band), GDALRasterBand::ToHandle(band.GetMaskBand()),
                         OGRLayer::ToHandle(&named), 0, nullptr, Watched::report, &watched);
      if (result != CE_None) return result;
    }
    return CE_None;
  };
  write_layer(path, map, wkbPolygon, fields, fill, progress);
}

void write_contours(const std::string& path, const RasterMap& map, const ContourLevels& levels,
                    const Progress& progress) {
  OGRFieldDefn elevation("elev", OFTReal);
  write_layer(
      path, map, wkbLineString, {&elevation},
      [&](GDALDataset& source, OGRLayer& layer, Watched& watched) {
        CPLStringList options;
        if (levels.levels.empty()) {
          options.SetNameValue("LEVEL_INTERVAL", fmt::format("{:.17g}", levels.interval.value_or(1)).c_str());
          options.SetNameValue("LEVEL_BASE", fmt::format("{:.17g}", levels.base).c_str());
        } else {
          options.SetNameValue("FIXED_LEVELS", fmt::format("{:.17g}", fmt::join(levels.levels, ",")).c_str());
        }
        options.SetNameValue("ELEV_FIELD", "0");
        if (map.bands[0].nodata) options.SetNameValue("NODATA", fmt::format("{:.17g}", *map.bands[0].nodata).c_str());
        return GDALContourGenerateEx(GDALRasterBand::ToHandle(source.GetRasterBand(1)), OGRLayer::ToHandle(&layer),
                                     options.List(), Watched::report, &watched);
      },
      progress);
}

}  // namespace scarp
