// SPDX-License-Identifier: MIT
// Geotransform and CRS of a file, seen through the reader.
#include <ogr_spatialref.h>

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "scarp/source/raster/map_extent.h"
#include "source/files.h"

namespace scarp {
namespace {

using namespace test;

std::function<void(GDALDataset&)> placed(std::array<double, 6> map, const char* crs = nullptr) {
  return [map, crs](GDALDataset& d) mutable {
    d.SetGeoTransform(map.data());
    if (!crs) return;
    OGRSpatialReference srs;
    EXPECT_EQ(OGRERR_NONE, srs.SetFromUserInput(crs));
    srs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    d.SetSpatialRef(&srs);
  };
}

class RasterPlaceTest : public Files {
 protected:
  Raster read(const std::function<void(GDALDataset&)>& edit, const RasterOptions& options = {}) {
    return read_raster(write_tiff("a.tif", GDT_Int16, 3, 2, {1, 2, 3, 4, 5, 6}, edit), options);
  }
  std::string error(const std::function<void(GDALDataset&)>& edit, const RasterOptions& options = {}) {
    return read_error(write_tiff("a.tif", GDT_Int16, 3, 2, {1, 2, 3, 4, 5, 6}, edit), options);
  }
};

TEST_F(RasterPlaceTest, SamplesAreAtPixelCentres) {
  const Georeference geo = read(placed({500000, 30, 0, 5000000, 0, -20}, "EPSG:32610")).georeference;
  EXPECT_TRUE(geo.present);
  EXPECT_EQ((std::array<double, 6>{500015, 30, 0, 4999990, 0, -20}), geo.map_from_node);
  EXPECT_EQ("WGS 84 / UTM zone 10N (EPSG:32610)", geo.crs_name);
  EXPECT_NEAR(30 / 0.9996, geo.cell_x_m, 1e-4);
  EXPECT_NEAR(20 / 0.9996, geo.cell_y_m, 1e-4);
  EXPECT_NE(std::string::npos, geo.cell_size_found.find("0.9996"));
  EXPECT_NE(std::string::npos, geo.crs_wkt.find("UTM zone 10N"));
}

TEST_F(RasterPlaceTest, PixelIsPointIsNotShiftedTwice) {
  const auto edit = [](GDALDataset& d) {
    d.SetMetadataItem("AREA_OR_POINT", "Point");
    placed({500000, 30, 0, 5000000, 0, -30}, "EPSG:32610")(d);
  };
  EXPECT_EQ(500015, read(edit).georeference.map_from_node[0]);
}

TEST_F(RasterPlaceTest, NotesAssumedHeightUnitsOnMapsInFeet) {
  const auto map = [](const char* crs) { return placed({6000000, 30, 0, 2000000, 0, -30}, crs); };
  const std::string note = "map units are feet, but heights are assumed to be metres (override with --unit ";
  EXPECT_TRUE(has_note(read(map("EPSG:2227")), note + "us-ft"));
  EXPECT_TRUE(has_note(read(placed({700000, 30, 0, 1000000, 0, -30}, "EPSG:2222")), note + "ft"));
  // No note if the unit of heights is known: from the caller, the band, the vertical CRS, or a map in metres.
  RasterOptions options;
  options.unit = "us-ft";
  const auto in_metres = [&](GDALDataset& d) {
    map("EPSG:2227")(d);
    d.GetRasterBand(1)->SetUnitType("m");
  };
  for (const Raster& raster :
       {read(map("EPSG:2227"), options), read(in_metres), read(map("EPSG:2227+5703")), read(map("EPSG:2227+6360")),
        read(placed({500000, 30, 0, 5000000, 0, -20}, "EPSG:32610")),
        read(placed({10, 0.1, 0, 45, 0, -0.1}, "EPSG:4326"))})
    EXPECT_FALSE(has_note(raster, "feet")) << raster.georeference.crs_name;
}

TEST_F(RasterPlaceTest, WindowMovesTheOrigin) {
  RasterOptions options;
  options.window = {1, 1, 2, 1};
  const Georeference geo = read(placed({500000, 30, 0, 5000000, 0, -20}, "EPSG:32610"), options).georeference;
  EXPECT_EQ((std::array<double, 6>{500045, 30, 0, 4999970, 0, -20}), geo.map_from_node);
}

TEST_F(RasterPlaceTest, SouthUpIsFlipped) {
  const Raster raster = read(placed({500000, 30, 0, 4999960, 0, 20}, "EPSG:32610"));
  EXPECT_EQ((std::vector<double>{4, 5, 6, 1, 2, 3}), doubles(raster));
  EXPECT_EQ((std::array<double, 6>{500015, 30, 0, 4999990, 0, -20}), raster.georeference.map_from_node);
  EXPECT_TRUE(has_note(raster, "south to north"));
}

TEST_F(RasterPlaceTest, WindowOfASouthUpFileUsesTheRowsOfTheFile) {
  RasterOptions options;
  options.window = {0, 1, 3, 1};
  const Raster raster = read(placed({500000, 30, 0, 4999960, 0, 20}, "EPSG:32610"), options);
  EXPECT_EQ((std::vector<double>{4, 5, 6}), doubles(raster));
  EXPECT_EQ(4999990, raster.georeference.map_from_node[3]);
}

TEST_F(RasterPlaceTest, WestwardColumnsAreFlipped) {
  const Raster raster = read(placed({500090, -30, 0, 5000000, 0, -20}, "EPSG:32610"));
  EXPECT_EQ((std::vector<double>{3, 2, 1, 6, 5, 4}), doubles(raster));
  EXPECT_EQ((std::array<double, 6>{500015, 30, 0, 4999990, 0, -20}), raster.georeference.map_from_node);
}

TEST_F(RasterPlaceTest, RejectsRotatedRastersWithARemedy) {
  expect_says(error(placed({500000, 30, 5, 5000000, 5, -30}, "EPSG:32610")), "gdalwarp -dstnodata -9999 IN");
  expect_says(error(placed({500000, 0, 30, 5000000, 30, 0}, "EPSG:32610")), "gdalwarp");
  // Pixels around the warped raster are marked.
  const auto rotated = placed({500000, 30, 5, 5000000, 5, -30}, "EPSG:32610");
  const auto marked = [&](GDALDataset& d) {
    rotated(d);
    d.GetRasterBand(1)->SetNoDataValue(-1);
  };
  expect_says(error(marked), "gdalwarp IN");
  RasterOptions options;
  options.nodata = 5;
  expect_says(error(rotated, options), "gdalwarp -srcnodata 5 -dstnodata 5 IN");
  expect_says(read_error(write_tiff("b.tif", GDT_Byte, 3, 2, {1, 2, 3, 4, 5, 6}, rotated)),
              "gdalwarp -ot Float32 -dstnodata -9999 IN");
  // A rotation that moves no sample by a thousandth of a cell is noise.
  EXPECT_NO_THROW(read(placed({500000, 30, 1e-9, 5000000, 1e-9, -30}, "EPSG:32610")));
}

TEST_F(RasterPlaceTest, DegreesAreMappedToALocalPlane) {
  const Georeference geo = read(placed({10, 0.001, 0, 45.001, 0, -0.001}, "EPSG:4326")).georeference;
  EXPECT_NEAR(78.847, geo.cell_x_m, 0.001);  // 0.001 degree at 45 N on WGS 84 (tables of the ellipsoid)
  EXPECT_NEAR(111.132, geo.cell_y_m, 0.001);
  EXPECT_EQ("WGS 84 (EPSG:4326)", geo.crs_name);
}

TEST_F(RasterPlaceTest, RejectsLongitudesBeyondTheEarth) {
  EXPECT_NO_THROW(read(placed({360, 1, 0, 40, 0, -1}, "EPSG:4326")));
  for (const double west : {500000.0, 541.0, -541.0}) {
    expect_says(error(placed({west, 0.01, 0, 40, 0, -0.01}, "EPSG:4326")), "longitudes span");
  }
}

TEST_F(RasterPlaceTest, NotesThatAHemisphereIsNotPlanar) {
  EXPECT_TRUE(has_note(read(placed({0, 1, 0, 80, 0, -20}, "EPSG:4326")),
                       "true cell widths are 68.4 to 128.6 % of the width at the centre"));
  // Percentages of zero are meaningless: samples at a pole, and at both.
  for (const double step : {90.0, 180.0}) {
    const Raster globe = read(placed({-180, 120, 0, 90 + step / 2, 0, -step}, "EPSG:4326"));
    EXPECT_TRUE(has_note(globe, "the latitudes reach a pole"));
    EXPECT_TRUE(has_note(globe, "--window, or gdalwarp"));
    EXPECT_FALSE(has_note(globe, "%"));
  }
}

TEST_F(RasterPlaceTest, ConvertsMapsInFeetToMetres) {
  const Raster raster = read(placed({6600000, 100, 0, 1900000, 0, -100}, "EPSG:2225"));
  EXPECT_NEAR(30.48, raster.georeference.cell_x_m, 0.01);
  EXPECT_EQ(1, raster.scale);  // horizontal feet say nothing about heights
}

TEST_F(RasterPlaceTest, VerticalCrsInFeetAppliesToHeights) {
  // NAVD88 height (ftUS) is EPSG:6360.
  const Raster raster = read(placed({500000, 30, 0, 5000000, 0, -30}, "EPSG:26910+6360"));
  EXPECT_DOUBLE_EQ(1200.0 / 3937, raster.scale);
  EXPECT_EQ(std::string::npos, raster.georeference.crs_wkt.find("NAVD88"));
  RasterOptions options;
  options.unit = "m";
  EXPECT_EQ(1, read_raster(path("a.tif"), options).scale);
}

TEST_F(RasterPlaceTest, CellsAreOneMetreWithoutGeoreference) {
  const Raster raster = read({});
  EXPECT_FALSE(raster.georeference.present);
  EXPECT_EQ(1, raster.georeference.cell_x_m);
  EXPECT_EQ((std::array<double, 6>{0, 1, 0, 0, 0, -1}), raster.georeference.map_from_node);
  EXPECT_TRUE(has_note(raster, "no georeference"));
}

TEST_F(RasterPlaceTest, MapUnitsAreMetresWithoutCrs) {
  const Raster raster = read(placed({1000, 30, 0, 2000, 0, -30}));
  EXPECT_TRUE(raster.georeference.present);
  EXPECT_EQ(30, raster.georeference.cell_x_m);
  EXPECT_TRUE(has_note(raster, "assuming map units of metres"));
  // Metres from a corner of the site, with typical cell sizes of elevation models.
  const Raster site = read(placed({0, 0.5, 0, 1, 0, -0.5}));
  EXPECT_EQ(0.5, site.georeference.cell_x_m);
  EXPECT_TRUE(has_note(site, "a corner is at 0,0, but the bounds fit degrees (override with --crs EPSG:4326)"));
}

TEST_F(RasterPlaceTest, AssumesDegreesForPlausibleBounds) {
  const auto tile = placed({10, 0.001, 0, 45.001, 0, -0.001});
  const Raster raster = read(tile);
  EXPECT_NEAR(78.847, raster.georeference.cell_x_m, 0.001);
  EXPECT_EQ("WGS 84 (EPSG:4326)", raster.georeference.crs_name);
  EXPECT_TRUE(
      has_note(raster, "assuming degrees (EPSG:4326), because all bounds fit (override with --crs; --crs none"));
  // The whole file decides, not the window.
  RasterOptions options;
  options.window = {1, 0, 2, 2};
  EXPECT_EQ("WGS 84 (EPSG:4326)", read(tile, options).georeference.crs_name);
  // Cells too small for metres at 0,0; and whole globes of coarse cells, of either origin.
  for (const auto& map :
       {std::array<double, 6>{0, 0.001, 0, 1, 0, -0.5}, {-180, 120, 0, 90, 0, -90}, {0, 120, 0, 90, 0, -90}})
    EXPECT_EQ("WGS 84 (EPSG:4326)", read(placed(map)).georeference.crs_name) << map[0];
  for (const auto& map : {std::array<double, 6>{10, 2, 0, 45, 0, -2},
                          {300, 30, 0, 45, 0, -0.5},
                          {10, 0.5, 0, 91, 0, -0.5},
                          {-181, 0.5, 0, 45, 0, -0.5}})
    EXPECT_EQ("", read(placed(map)).georeference.crs_name) << map[0];
}

TEST_F(RasterPlaceTest, CrsNoneOverridesGuessAndFile) {
  RasterOptions options;
  options.crs = "none";
  for (const char* crs : {static_cast<const char*>(nullptr), "EPSG:4326"}) {
    const Raster raster = read(placed({10, 0.001, 0, 45.001, 0, -0.001}, crs), options);
    EXPECT_EQ(0.001, raster.georeference.cell_x_m);
    EXPECT_EQ("", raster.georeference.crs_name);
    EXPECT_FALSE(has_note(raster, "coordinate reference system"));
  }
  EXPECT_EQ(1, read({}, options).georeference.cell_x_m);
}

TEST_F(RasterPlaceTest, ReportsExtentOfSamplesAndEdges) {
  const auto extent = [&](const Raster& raster) { return map_extent(raster.georeference, raster.cols, raster.rows); };
  const auto numbers = [](const std::optional<MapBounds>& b) {
    return b ? std::vector<double>{b->west, b->south, b->east, b->north} : std::vector<double>{};
  };
  const MapExtent degrees = extent(read(placed({10, 1, 0, 45, 0, -0.5}, "EPSG:4326")));
  EXPECT_EQ((std::vector<double>{10.5, 44.25, 12.5, 44.75}), numbers(degrees.samples));
  EXPECT_EQ((std::vector<double>{10, 44, 13, 45}), numbers(degrees.edges));
  EXPECT_EQ(numbers(degrees.samples), numbers(degrees.samples_lonlat));
  EXPECT_EQ(numbers(degrees.edges), numbers(degrees.edges_lonlat));
  // 500 km east is the central meridian, 15 degrees.
  const MapExtent metres = extent(read(placed({400000, 100000, 0, 5100000, 0, -100000}, "EPSG:32633")));
  EXPECT_EQ((std::vector<double>{400000, 4900000, 700000, 5100000}), numbers(metres.edges));
  ASSERT_TRUE(metres.samples_lonlat);
  EXPECT_LT(metres.samples_lonlat->west, 15);
  EXPECT_GT(metres.samples_lonlat->east, 16.9);
  EXPECT_LT(metres.edges_lonlat->west, metres.samples_lonlat->west);
  EXPECT_NEAR(46.05, metres.edges_lonlat->north, 0.01);
  EXPECT_FALSE(extent(read(placed({1000, 30, 0, 2000, 0, -30}))).edges_lonlat);
}

TEST_F(RasterPlaceTest, CallersCrsAndBoundsTakePrecedence) {
  RasterOptions options;
  options.crs = "EPSG:4326";
  EXPECT_NEAR(78.847, read(placed({10, 0.001, 0, 45.001, 0, -0.001}), options).georeference.cell_x_m, 0.001);
  options.bounds = {10, 44.999, 10.003, 45.001};
  EXPECT_NEAR(78.847, read(placed({1, 2, 0, 3, 0, -4}), options).georeference.cell_x_m, 0.001);
}

TEST_F(RasterPlaceTest, RejectsInvalidCrsAndBounds) {
  RasterOptions options;
  options.crs = "EPSG:999999";
  expect_says(error({}, options), "unknown coordinate reference system 'EPSG:999999'");
  options.crs = "EPSG:4326";
  expect_says(error({}, options), "--bounds");
  expect_says(error(placed({500000, 30, 0, 5000000, 0, -30}), options), "longitudes");
  expect_says(error(placed({50, 30, 0, 5000000, 0, -30}), options), "latitude");
  options.bounds = {10, 45, 9, 46};
  expect_says(error({}, options), "W < E");
  options.bounds = {10, 46, 11, 45};
  expect_says(error({}, options), "S < N");
  options.bounds = {10, std::nan(""), 11, 45};
  expect_says(error({}, options), "--bounds W,S,E,N");
}

TEST_F(RasterPlaceTest, AcceptsLocalSystems) {
  const Raster raster = read(
      placed({0, 10, 0, 0, 0, -10}, "LOCAL_CS[\"site\",UNIT[\"foot\",0.3048],AXIS[\"x\",EAST],AXIS[\"y\",NORTH]]"));
  EXPECT_NEAR(3.048, raster.georeference.cell_x_m, 1e-12);
  EXPECT_TRUE(has_note(raster, "local coordinate system"));
}

TEST_F(RasterPlaceTest, GroundControlPointsNeedAWarp) {
  const auto edit = [](GDALDataset& d) {
    GDAL_GCP points[3];
    GDALInitGCPs(3, points);
    const double at[3][4] = {{0, 0, 10, 45}, {3, 0, 11, 45}, {0, 2, 10, 44.5}};
    for (int i = 0; i < 3; ++i) {
      points[i].dfGCPPixel = at[i][0];
      points[i].dfGCPLine = at[i][1];
      points[i].dfGCPX = at[i][2];
      points[i].dfGCPY = at[i][3];
    }
    OGRSpatialReference srs;
    srs.SetWellKnownGeogCS("WGS84");
    EXPECT_EQ(CE_None, d.SetGCPs(3, points, &srs));
    GDALDeinitGCPs(3, points);
  };
  expect_says(error(edit), "gdalwarp -dstnodata -9999 IN");
}

}  // namespace
}  // namespace scarp
