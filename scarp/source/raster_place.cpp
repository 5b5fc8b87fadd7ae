// SPDX-License-Identifier: MIT
#include "scarp/source/raster_place.h"

#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scarp/base/error.h"
#include "scarp/source/ground_scale.h"

namespace scarp {
namespace {

std::string bounds_text(const MapBounds& b) { return fmt::format("{},{},{},{}", b.west, b.south, b.east, b.north); }

// The geotransform from the caller's bounds or the file; nullopt if neither has one.
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

std::optional<OGRSpatialReference> crs_of(GDALDataset& dataset, const RasterOptions& options) {
  OGRSpatialReference crs;
  if (!options.crs.empty()) {
    const char* const no_network[] = {"ALLOW_NETWORK_ACCESS=NO", nullptr};
    if (crs.SetFromUserInput(options.crs.c_str(), no_network) != OGRERR_NONE) {
      throw Error(fmt::format("unknown coordinate reference system '{}' (specify one such as EPSG:32610, or WKT)",
                              options.crs));
    }
  } else if (const OGRSpatialReference* own = dataset.GetSpatialRef()) {
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

// Geographic rasters of many degrees are not planar: a note says by how much.
void note_latitude_span(const OGRSpatialReference& crs, double north, double south, RasterPlace& place) {
  const double unit = crs.GetAngularUnits(), far = std::max(std::abs(north), std::abs(south)) * unit;
  if (far > std::numbers::pi / 2) return;
  const double centre = std::cos((north + south) / 2 * unit), least = std::cos(far);
  const double most = north * south < 0 ? 1 : std::cos(std::min(std::abs(north), std::abs(south)) * unit);
  // A hundredth of a cell per cell is visible in an image.
  if (std::max(centre - least, most - centre) > 0.01 * centre) {
    place.notes.push_back(fmt::format(
        "cells are {:.1f} % wider at one edge and {:.1f} % narrower at the other than at the centre, whose size is "
        "used (gdalwarp to a projected CRS avoids this)",
        (most / centre - 1) * 100, (1 - least / centre) * 100));
  }
}

}  // namespace

void check_geotransform(const GeoTransform& map, int cols, int rows) {
  for (const double x : map) {
    if (!std::isfinite(x)) throw Error("geotransform is not finite (specify the outer edges with --bounds W,S,E,N)");
  }
  // Drift of the far corner across the grid, in cells.
  const double across_cols = std::abs(map[2]) * rows / std::abs(map[1]),
               across_rows = std::abs(map[4]) * cols / std::abs(map[5]);
  if (map[2] != 0 || map[4] != 0) {
    if (!(across_cols <= kLargestDriftInCells && across_rows <= kLargestDriftInCells)) {
      throw Error("geotransform is rotated or sheared (make the raster north-up first: gdalwarp IN OUT.tif)");
    }
  }
  if (map[1] == 0 || map[5] == 0)
    throw Error("geotransform has cells of size 0 (specify the outer edges with --bounds W,S,E,N)");
}

RasterPlace find_place(GDALDataset& dataset, const RasterWindow& window, const RasterOptions& options) {
  RasterPlace place;
  Georeference& geo = place.georeference;
  std::optional<OGRSpatialReference> crs = crs_of(dataset, options);
  if (crs && (crs->IsCompound() || crs->IsVertical())) {
    const char* name = nullptr;
    const double unit = crs->GetTargetLinearUnits("VERT_CS", &name);
    if (crs->GetAttrNode("VERT_CS") || crs->IsVertical()) {
      place.vertical_unit = unit;
      place.vertical_unit_name = name ? name : "";
    }
  }
  const std::optional<GeoTransform> map = geotransform_of(dataset, options);
  if (!map) {
    if (!options.crs.empty())
      throw Error("no geotransform that --crs could apply to (specify the outer edges, too: --bounds W,S,E,N)");
    if (dataset.GetGCPCount() > 0)
      throw Error("ground control points without a geotransform (warp the raster first: gdalwarp IN OUT.tif)");
    geo.cell_size_found = "no georeference: cells of 1 m, assuming that north is up";
    place.notes.push_back("no georeference, assuming cells of 1 m (override with --bounds W,S,E,N and --crs)");
    return place;
  }
  check_geotransform(*map, dataset.GetRasterXSize(), dataset.GetRasterYSize());

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

  // Once and a half around the Earth: from 0 to 360 and beyond either border. More indicates another CRS.
  constexpr double kFarthestLongitude = 540;
  if (crs && crs->IsGeographic()) {
    const double west = first_x - 0.5 * step_x, east = first_x + (window.cols - 0.5) * step_x,
                 to_degrees = crs->GetAngularUnits() * 180 / std::numbers::pi;
    if (!(std::max(std::abs(west), std::abs(east)) * to_degrees <= kFarthestLongitude)) {
      throw Error(
          fmt::format("longitudes span {:.10g} to {:.10g}, but the CRS {} limits them to {} degrees "
                      "(correct --crs or --bounds)",
                      west, east, name_of(*crs), kFarthestLongitude));
    }
  }
  if (!crs) {
    geo.cell_x_m = step_x;
    geo.cell_y_m = step_y;
    geo.cell_size_found = "no coordinate reference system: map units taken as metres, north as up";
    const bool like_degrees = step_x < 1 && step_y < 1 && std::abs(first_x) <= 180 && std::abs(first_y) <= 90 &&
                              std::abs(last_y) <= 90 && first_x + (window.cols - 1) * step_x <= 360;
    place.notes.push_back(
        like_degrees ? "no coordinate reference system, assuming map units of metres, but they look like degrees "
                       "(override with --crs EPSG:4326)"
                     : "no coordinate reference system, assuming map units of metres (override with --crs)");
    return place;
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
