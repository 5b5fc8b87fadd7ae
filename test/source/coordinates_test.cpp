// SPDX-License-Identifier: MIT
#include "scarp/source/raster/coordinates.h"

#include <cmath>
#include <numbers>
#include <random>

#include "source/files.h"

namespace scarp {
namespace {

using test::error_of;
using test::expect_says;

constexpr int kCols = 301, kRows = 201;

// Georeferences of rasters: outer edges and CRS.
struct Place {
  const char* crs;
  double west, south, cell_x, cell_y;
};
const Place kPlaces[] = {
    {"EPSG:4326", -84.5, 36.25, 1.0 / 1200, 1.0 / 1200},  // arc seconds
    {"EPSG:32616", 721000, 4030000, 30, 30},              // UTM
    {"EPSG:2274", 2450000, 640000, 15, 20},               // feet
    {"EPSG:3857", -9400000, 4350000, 40, 40},             // Web Mercator
    {"EPSG:3413", -420000, -2100000, 90, 90},             // polar, grid north far from true north
    {"EPSG:4326", 179.9, -17.5, 1.0 / 1200, 1.0 / 1200},  // across the antimeridian
    {"EPSG:4326", 275.5, 36.25, 1.0 / 1200, 1.0 / 1200},  // longitudes from 0 to 360
    {"EPSG:32760", 829000, 8070000, 1.0, 1.0},            // cells of a metre, far from the origin of their map
};

class CoordinatesOfFiles : public test::Files {
 protected:
  // A file with this georeference, read like any other.
  Georeference at(const Place& place) {
    const std::string file = write_tiff(
        "place.tif", GDT_Int16, kCols, kRows, std::vector<double>(static_cast<std::size_t>(kCols * kRows), 7),
        [&](GDALDataset& dataset) {
          double map[6] = {place.west, place.cell_x, 0, place.south + kRows * place.cell_y, 0, -place.cell_y};
          dataset.SetGeoTransform(map);
          OGRSpatialReference crs;
          crs.SetFromUserInput(place.crs);
          dataset.SetSpatialRef(&crs);
        });
    return read_raster(file, {}).georeference;
  }

  static std::vector<dvec3> somewhere(const Georeference& geo) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> share(-0.2, 1.2), height(-100, 9000);
    std::vector<dvec3> points;
    // More than one batch.
    for (int i = 0; i < 3000; ++i) {
      points.emplace_back(share(random) * (kCols - 1) * geo.cell_x_m, share(random) * (kRows - 1) * geo.cell_y_m,
                          height(random));
    }
    return points;
  }
};

TEST_F(CoordinatesOfFiles, RoundTrip) {
  for (const Place& place : kPlaces) {
    const Georeference geo = at(place);
    for (const Coordinates coordinates : {Coordinates::local, Coordinates::map, Coordinates::lonlat}) {
      const CoordinateFrame frame(geo, kCols, kRows, coordinates);
      const std::vector<dvec3> local = somewhere(geo);
      std::vector<dvec3> points = local;
      ASSERT_FALSE(frame.from_local(points)) << place.crs;
      ASSERT_FALSE(frame.to_local(points)) << place.crs;
      // PROJ guarantees inverses to some 1e-10 of a radian only where it iterates: 1e-6 of a cell of 30 m and more.
      const double bound = coordinates == Coordinates::lonlat ? 1e-6 : 1e-9;
      for (std::size_t i = 0; i < points.size(); ++i) {
        ASSERT_NEAR(points[i].x / geo.cell_x_m, local[i].x / geo.cell_x_m, bound) << place.crs << " " << i;
        ASSERT_NEAR(points[i].y / geo.cell_y_m, local[i].y / geo.cell_y_m, bound) << place.crs << " " << i;
        ASSERT_EQ(points[i].z, local[i].z);
      }
    }
  }
}

TEST_F(CoordinatesOfFiles, MapNodesAreFieldNodes) {
  for (const Place& place : kPlaces) {
    const Georeference geo = at(place);
    std::vector<dvec3> nodes;
    for (const auto& [col, row] : {std::pair(0, 0), {kCols - 1, 0}, {0, kRows - 1}, {123, 45}}) {
      nodes.emplace_back(place.west + (col + 0.5) * place.cell_x, place.south + (kRows - row - 0.5) * place.cell_y, 5);
    }
    const CoordinateFrame frame(geo, kCols, kRows, Coordinates::map);
    ASSERT_FALSE(frame.to_local(nodes));
    const dvec2 expected[] = {{0, kRows - 1}, {kCols - 1, kRows - 1}, {0, 0}, {123, kRows - 1 - 45}};
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      EXPECT_NEAR(nodes[i].x / geo.cell_x_m, expected[i].x, 1e-9) << place.crs;
      EXPECT_NEAR(nodes[i].y / geo.cell_y_m, expected[i].y, 1e-9) << place.crs;
    }
  }
}

TEST_F(CoordinatesOfFiles, LonlatMatchesProj) {
  // By Krueger's series to the fourth order of n (1912), accurate to a few micrometres, for UTM zone 16N.
  const Georeference geo = at(kPlaces[1]);
  const CoordinateFrame map(geo, kCols, kRows, Coordinates::map), lonlat(geo, kCols, kRows, Coordinates::lonlat);
  std::vector<dvec3> point = {{725000, 4033000, 12}};
  ASSERT_FALSE(map.to_local(point));
  ASSERT_FALSE(lonlat.from_local(point));
  EXPECT_NEAR(point[0].x, -84.4905367802, 1e-9);
  EXPECT_NEAR(point[0].y, 36.4158495853, 1e-9);
}

TEST_F(CoordinatesOfFiles, LongitudesWrapToTheRaster) {
  for (const Place& place : {kPlaces[5], kPlaces[6]}) {
    const Georeference geo = at(place);
    const CoordinateFrame frame(geo, kCols, kRows, Coordinates::lonlat);
    const double lon = place.west + 150.5 * place.cell_x, lat = place.south + 100.5 * place.cell_y;
    std::vector<dvec3> points = {{lon - 360, lat, 0}, {lon, lat, 0}};
    ASSERT_FALSE(frame.to_local(points));
    for (const dvec3& p : points) EXPECT_NEAR(p.x / geo.cell_x_m, 150, 1e-8) << place.west;
    ASSERT_FALSE(frame.from_local(points));
    EXPECT_LE(std::abs(points[0].x), 180);
    // The map's own longitudes are as accurate.
    const CoordinateFrame map(geo, kCols, kRows, Coordinates::map);
    points = {{lon - 360, lat, 0}, {lon, lat, 0}};
    ASSERT_FALSE(map.to_local(points));
    for (const dvec3& p : points) EXPECT_NEAR(p.x / geo.cell_x_m, 150, 1e-8) << place.west;
  }
}

TEST_F(CoordinatesOfFiles, MapDirectionsAreDifferencesOfPoints) {
  for (const Place& place : kPlaces) {
    const Georeference geo = at(place);
    const CoordinateFrame frame(geo, kCols, kRows, Coordinates::map);
    const dvec3 direction(3 * place.cell_x, -2 * place.cell_y, -0.5);
    std::vector<dvec3> ends = {{place.west, place.south, 100}, dvec3(place.west, place.south, 100) + direction};
    ASSERT_FALSE(frame.to_local(ends));
    const dvec3 local = frame.direction_to_local(direction), difference = ends[1] - ends[0];
    EXPECT_NEAR(local.x, difference.x, 1e-8 * geo.cell_x_m);
    EXPECT_NEAR(local.y, difference.y, 1e-8 * geo.cell_y_m);
    EXPECT_EQ(local.z, -0.5);
  }
}

TEST_F(CoordinatesOfFiles, LonlatDirectionsAreTrueMetres) {
  for (const Place& place : kPlaces) {
    const Georeference geo = at(place);
    const CoordinateFrame frame(geo, kCols, kRows, Coordinates::lonlat);
    // A short step north from the centre, in degrees, has the same length in metres.
    std::vector<dvec3> centre = {{(kCols - 1) / 2.0 * geo.cell_x_m, (kRows - 1) / 2.0 * geo.cell_y_m, 0}};
    const dvec3 begin = centre[0];
    ASSERT_FALSE(frame.from_local(centre));
    std::vector<dvec3> end = {centre[0] + dvec3(0, 1e-5, 0)};
    ASSERT_FALSE(frame.to_local(end));
    const dvec3 north = normalize(end[0] - begin), by_direction = frame.direction_to_local({0, 1, 0});
    EXPECT_NEAR(north.x, by_direction.x, 1e-4) << place.crs << " " << place.west;
    EXPECT_NEAR(north.y, by_direction.y, 1e-4) << place.crs << " " << place.west;
    const dvec3 back = frame.normal_from_local(by_direction);
    EXPECT_NEAR(back.x, 0, 1e-15);
    EXPECT_NEAR(back.y, 1, 1e-15);
  }
}

TEST_F(CoordinatesOfFiles, DetectsInvalidPlaces) {
  const CoordinateFrame frame(at(kPlaces[1]), kCols, kRows, Coordinates::lonlat);
  for (const dvec3 bad : {dvec3(725000, 4033000, 0), dvec3(-84, 91, 0), dvec3(400, 36, 0)}) {
    std::vector<dvec3> points(2000, dvec3(-84, 36.4, 0));
    points[1500] = bad;
    EXPECT_EQ(frame.to_local(points), 1500u);
  }
}

TEST_F(CoordinatesOfFiles, ErrorNamesTheRayWithInvalidCoordinates) {
  const CoordinateFrame frame(at(kPlaces[1]), kCols, kRows, Coordinates::lonlat);
  RayTable table = parse_ray_csv("x,y,z,tx,ty,tz\n-84,36,0,-84.1,36,0\n-84,36,0,36,-840,0\n");
  table.path = "a.csv";
  const std::string text = error_of([&] { rays_in_local(table, frame); });
  expect_says(text, "a.csv: line 3 (ray 1): (36, -840)");
}

TEST_F(CoordinatesOfFiles, TargetsAreAtTEqualToOne) {
  const CoordinateFrame frame(at(kPlaces[1]), kCols, kRows, Coordinates::lonlat);
  const RayTable table = parse_ray_csv("x,y,z,tx,ty,tz\n-84.51,36.42,900,-84.5,36.41,700\n");
  const std::vector<Ray> rays = rays_in_local(table, frame);
  std::vector<dvec3> ends = {rays.at(0).at(0), rays[0].at(1)};
  ASSERT_FALSE(frame.from_local(ends));
  EXPECT_NEAR(ends[0].x, -84.51, 1e-10);
  EXPECT_NEAR(ends[0].y, 36.42, 1e-10);
  EXPECT_NEAR(ends[1].x, -84.5, 1e-10);
  EXPECT_NEAR(ends[1].y, 36.41, 1e-10);
  EXPECT_NEAR(ends[1].z, 700, 1e-9);
  EXPECT_EQ(rays[0].t_max, 1);
}

TEST(CoordinateNames, AreRecognised) {
  for (const char* name : {"local", "map", "lonlat"}) EXPECT_EQ(name_of(find_coordinates(name)), name);
  expect_says(error_of([] { find_coordinates("EPSG:4326"); }), "local, map or lonlat");
}

TEST(CoordinateFrame, ReportsMissingGeoreferenceOrCrs) {
  Georeference geo;
  EXPECT_NO_THROW(CoordinateFrame(geo, 3, 3, Coordinates::local));
  expect_says(error_of([&] { CoordinateFrame(geo, 3, 3, Coordinates::map); }), "no georeference");
  expect_says(error_of([&] { CoordinateFrame(geo, 3, 3, Coordinates::lonlat); }), "no georeference");
  geo.present = true;
  EXPECT_NO_THROW(CoordinateFrame(geo, 3, 3, Coordinates::map));
  expect_says(error_of([&] { CoordinateFrame(geo, 3, 3, Coordinates::lonlat); }), "no coordinate reference system");
  geo.crs_wkt = R"(LOCAL_CS["a quarry",UNIT["metre",1]])";
  expect_says(error_of([&] { CoordinateFrame(geo, 3, 3, Coordinates::lonlat); }), "PROJ cannot convert");
}

}  // namespace
}  // namespace scarp
