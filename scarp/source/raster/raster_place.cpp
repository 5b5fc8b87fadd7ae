// SPDX-License-Identifier: MIT
#include "scarp/source/raster/raster_place.h"

#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "scarp/base/error.h"
#include "scarp/source/raster/ground_scale.h"
#include "scarp/source/raster/warp_words.h"

namespace scarp {
namespace {

std::string bounds_text(const MapBounds& b) { return fmt::format("{},{},{},{}", b.west, b.south, b.east, b.north); }

// Returns the geotransform from the caller's bounds, or else from the file; nullopt if there is neither.
std::optional<GeoTransform> geotransform_of(GDALDataset& dataset, const RasterOptions& options) {
  const int cols = dataset.GetRasterXSize(), rows = dataset.GetRasterYSize();
  GeoTransform map{};
  if (options.bounds) {
    const MapBounds& b = *options.bounds;
    if (!(std::isfinite(b.west) && std::isfinite(b.south) && b.west < b.east && b.south < b.north &&
          std::isfinite(b.east) && std::isfinite(b.north))) {
      throw Error(fmt::format("bounds {} are empty (use --bounds W,S,E,N with W < E and S < N)", bounds_text(b)));
    }
    return GeoTransform{b.west, (b.east - b.west) / cols, 0, b.north, 0, (b.south - b.north) / rows};
  }
  if (dataset.GetGeoTransform(map.data()) != CE_None) return {};
  return map;
}

// Returns the CRS from the caller, or else from the file; nullopt if there is neither.
std::optional<OGRSpatialReference> crs_of(const OGRSpatialReference* own, const RasterOptions& options) {
  OGRSpatialReference crs;
  if (options.crs == kNoCrs) return {};
  if (!options.crs.empty()) {
    const char* const no_network[] = {"ALLOW_NETWORK_ACCESS=NO", nullptr};
    if (crs.SetFromUserInput(options.crs.c_str(), no_network) != OGRERR_NONE) {
      throw Error(fmt::format("unknown coordinate reference system '{}' (specify one such as EPSG:32610, or WKT)",
                              options.crs));
    }
  } else if (own) {
    crs = *own;
  } else {
    return {};
  }
  if (crs.IsEmpty()) return {};
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return crs;
}

std::string wkt_of(const OGRSpatialReference& crs) {
  char* text = nullptr;
  const char* const options[] = {"FORMAT=WKT2_2019", "MULTILINE=NO", nullptr};
  const bool good = crs.exportToWkt(&text, options) == OGRERR_NONE && text;
  std::string wkt = good ? text : "";
  CPLFree(text);
  return wkt;
}

std::string name_of(const OGRSpatialReference& crs) {
  std::string name = crs.GetName() ? crs.GetName() : "";
  if (name.empty() || name == "unnamed" || name == "unknown") {
    int north = 0;
    const int zone = crs.GetUTMZone(&north);
    const char* base = crs.GetAttrValue("GEOGCS");
    const char* projection = crs.GetAttrValue("PROJECTION");
    if (zone != 0) {
      name = fmt::format("{} / UTM zone {}{}", base ? base : "unknown datum", zone, north ? 'N' : 'S');
    } else if (projection) {
      name = fmt::format("{} / unnamed {}", base ? base : "unknown datum", projection);
    } else {
      name = "unnamed coordinate reference system";
    }
  }
  const char *authority = crs.GetAuthorityName(nullptr), *code = crs.GetAuthorityCode(nullptr);
  return authority && code ? fmt::format("{} ({}:{})", name, authority, code) : name;
}

// Geographic rasters that span many degrees are not planar: adds a note that states the error.
void note_latitude_span(const OGRSpatialReference& crs, double north, double south, RasterPlace& place) {
  const double unit = crs.GetAngularUnits(), pole = std::numbers::pi / 2;
  const double far = std::min(std::max(std::abs(north), std::abs(south)) * unit, pole);
  const double centre = std::cos((north + south) / 2 * unit), least = std::cos(far);
  const double most = north * south < 0 ? 1 : std::cos(std::min(std::abs(north), std::abs(south)) * unit);
  // If a cell near a pole is less than a tenth as wide as at the centre, no plane can represent both.
  constexpr double kNearAPole = 0.1;
  if (least < kNearAPole * centre) {
    place.notes.push_back(
        "the latitudes reach a pole, where cells have no width, but all get the width at the centre: a plane suits "
        "regions only (choose one with --window, or gdalwarp to a projected CRS)");
    return;
  }
  // An error of a hundredth of a cell per cell is visible in an image.
  if (std::max(centre - least, most - centre) > 0.01 * centre) {
    place.notes.push_back(
        fmt::format("true cell widths are {:.1f} to {:.1f} % of the width at the centre, which is used for all cells "
                    "(gdalwarp to a projected CRS avoids this)",
                    100 * least / centre, 100 * most / centre));
  }
}

// Whether all bounds of the file fit degrees. Cells of a degree are too coarse for an elevation model, except for one
// of the whole globe. A corner at exactly (0, 0) is the usual origin of local metres and, in degrees, a point in the
// open ocean; but elevation models in metres do not have cells below a centimetre.
enum class Degrees { no, perhaps, yes };
constexpr double kFinestLocalCell_m = 0.01;
Degrees like_degrees(const GeoTransform& map, double cols, double rows) {
  constexpr double kTurn = 360;
  const double step_x = std::abs(map[1]), step_y = std::abs(map[5]);
  const double west = std::min(map[0], map[0] + cols * map[1]), east = west + cols * step_x,
               south = std::min(map[3], map[3] + rows * map[5]), north = south + rows * step_y;
  // Samples on the borders of the globe have edges half a cell beyond them.
  const bool fits =
      west >= -180 - step_x / 2 && east <= kTurn + step_x / 2 && south >= -90 - step_y / 2 && north <= 90 + step_y / 2;
  const bool globe = std::abs(east - west - kTurn) <= step_x;
  if (!fits || !(globe || (step_x < 1 && step_y < 1))) return Degrees::no;
  const double close = kLargestDriftInCells;
  const bool at_origin = step_x >= kFinestLocalCell_m && std::abs(west) < close * step_x &&
                         (std::abs(south) < close * step_y || std::abs(north) < close * step_y);
  return at_origin ? Degrees::perhaps : Degrees::yes;
}

std::string nodata_words_of(GDALDataset& dataset, const RasterOptions& options) {
  if (dataset.GetRasterCount() == 0) return {};
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  int declared = 0;
  band.GetNoDataValue(&declared);
  return warp_nodata_words(GDALGetDataTypeName(band.GetRasterDataType()), declared != 0, options.nodata);
}

OGRSpatialReference wgs84() {
  OGRSpatialReference crs;
  crs.importFromEPSG(4326);
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return crs;
}

}  // namespace

void check_geotransform(const GeoTransform& map, int cols, int rows, const std::string& nodata_words) {
  for (const double x : map) {
    if (!std::isfinite(x)) throw Error("geotransform is not finite (specify the outer edges with --bounds W,S,E,N)");
  }
  // Drift of the far corner across the grid, in cells.
  const double across_cols = std::abs(map[2]) * rows / std::abs(map[1]),
               across_rows = std::abs(map[4]) * cols / std::abs(map[5]);
  if (map[2] != 0 || map[4] != 0) {
    if (!(across_cols <= kLargestDriftInCells && across_rows <= kLargestDriftInCells)) {
      throw Error(fmt::format(
          "geotransform is rotated or sheared (make the raster north-up first: gdalwarp{} IN OUT.tif)", nodata_words));
    }
  }
  if (map[1] == 0 || map[5] == 0)
    throw Error("geotransform has cells of size 0 (specify the outer edges with --bounds W,S,E,N)");
}

double turn_of(const OGRSpatialReference* own, const GeoTransform& map, double cols, double rows,
               const RasterOptions& options) {
  const std::optional<OGRSpatialReference> crs = crs_of(own, options);
  if (crs) return crs->IsGeographic() ? 2 * std::numbers::pi / crs->GetAngularUnits() : 0;
  return options.crs != kNoCrs && like_degrees(map, cols, rows) != Degrees::no ? 360 : 0;
}

std::pair<double, std::string> vertical_unit_of(const OGRSpatialReference& crs) {
  if (!crs.IsCompound() && !crs.IsVertical()) return {};
  const char* name = nullptr;
  const double unit = crs.GetTargetLinearUnits("VERT_CS", &name);
  if (!crs.GetAttrNode("VERT_CS") && !crs.IsVertical()) return {};
  return {unit, name ? name : ""};
}

RasterPlace find_place(GDALDataset& dataset, const RasterWindow& window, const RasterOptions& options) {
  RasterPlace place;
  Georeference& geo = place.georeference;
  std::optional<OGRSpatialReference> crs = crs_of(dataset.GetSpatialRef(), options);
  if (crs) std::tie(place.vertical_unit, place.vertical_unit_name) = vertical_unit_of(*crs);
  const std::optional<GeoTransform> map = geotransform_of(dataset, options);
  if (!map) {
    if (!options.crs.empty() && options.crs != kNoCrs)
      throw Error("no geotransform that --crs could apply to (specify the outer edges, too: --bounds W,S,E,N)");
    if (dataset.GetGCPCount() > 0)
      throw Error(
          fmt::format("ground control points without a geotransform (warp the raster first: gdalwarp{} IN OUT.tif)",
                      nodata_words_of(dataset, options)));
    geo.cell_size_found = "no georeference: cells of 1 m, assuming that north is up";
    place.notes.push_back("no georeference, assuming cells of 1 m (override with --bounds W,S,E,N and --crs)");
    return place;
  }
  check_geotransform(*map, dataset.GetRasterXSize(), dataset.GetRasterYSize(), nodata_words_of(dataset, options));

  // Samples are at pixel centres; rows run south, columns east.
  place.flip_rows = (*map)[5] > 0;
  place.flip_cols = (*map)[1] < 0;
  if (place.flip_rows) place.notes.push_back("rows run from south to north in the file, flipped");
  if (place.flip_cols) place.notes.push_back("columns run from east to west in the file, flipped");
  const double step_x = std::abs((*map)[1]), step_y = std::abs((*map)[5]);
  const double first_x = (*map)[0] + (window.col + (place.flip_cols ? window.cols - 0.5 : 0.5)) * (*map)[1];
  const double first_y = (*map)[3] + (window.row + (place.flip_rows ? window.rows - 0.5 : 0.5)) * (*map)[5];
  const double last_y = first_y - (window.rows - 1) * step_y;
  geo.present = true;
  geo.map_from_node = {first_x, step_x, 0, first_y, 0, -step_y};

  if (!crs && options.crs != kNoCrs) {
    const Degrees degrees = like_degrees(*map, dataset.GetRasterXSize(), dataset.GetRasterYSize());
    if (degrees == Degrees::yes) crs = wgs84();
    place.notes.push_back(
        degrees == Degrees::yes
            ? "no coordinate reference system, assuming degrees (EPSG:4326), because all bounds fit "
              "(override with --crs; --crs none: map units are metres)"
        : degrees == Degrees::perhaps
            ? "no coordinate reference system, assuming map units of metres, because a corner is at 0,0, but the "
              "bounds fit degrees (override with --crs EPSG:4326)"
            : "no coordinate reference system, assuming map units of metres (override with --crs)");
  }
  if (!crs) {
    geo.cell_x_m = step_x;
    geo.cell_y_m = step_y;
    geo.cell_size_found = "no coordinate reference system: map units taken as metres, north as up";
    return place;
  }
  // One and a half times around the Earth: from 0 to 360 and beyond either border. Larger values indicate another CRS.
  constexpr double kFarthestLongitude = 540;
  if (crs->IsGeographic()) {
    const double west = first_x - 0.5 * step_x, east = first_x + (window.cols - 0.5) * step_x,
                 to_degrees = crs->GetAngularUnits() * 180 / std::numbers::pi;
    if (!(std::max(std::abs(west), std::abs(east)) * to_degrees <= kFarthestLongitude)) {
      throw Error(
          fmt::format("longitudes span {:.10g} to {:.10g}, but the CRS {} limits them to {} degrees "
                      "(correct --crs or --bounds)",
                      west, east, name_of(*crs), kFarthestLongitude));
    }
  }
  geo.crs_name = name_of(*crs);
  crs->StripVertical();
  if (crs->IsProjected() || crs->IsLocal()) place.map_unit = crs->GetLinearUnits();
  geo.crs_wkt = wkt_of(*crs);
  const GroundScale ground =
      ground_scale_at(geo.crs_wkt, first_x + (window.cols - 1) / 2.0 * step_x, (first_y + last_y) / 2);
  geo.cell_x_m = step_x * ground.metres_per_x;
  geo.cell_y_m = step_y * ground.metres_per_y;
  geo.grid_north_azimuth = ground.grid_north_azimuth;
  geo.cell_size_found = ground.found;
  place.notes.insert(place.notes.end(), ground.notes.begin(), ground.notes.end());
  if (crs->IsGeographic()) note_latitude_span(*crs, first_y, last_y, place);
  if (crs->IsDerivedGeographic())
    place.notes.push_back("longitudes and latitudes refer to a rotated pole, and so do azimuths");
  if (crs->IsLocal()) place.notes.push_back("local coordinate system, assuming that north is up");
  return place;
}

}  // namespace scarp
