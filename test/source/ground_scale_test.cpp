// SPDX-License-Identifier: MIT
// Ground lengths against geodesics (Karney's, in PROJ's geodesic.h) and PROJ's own point scales.
#include "scarp/source/raster/ground_scale.h"

#include <geodesic.h>
#include <gtest/gtest.h>
#include <proj.h>

#include <cmath>
#include <numbers>

#include "scarp/base/error.h"

namespace scarp {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

// Length and azimuth (degrees) of the geodesic between two points, in degrees, on an ellipsoid.
struct Geodesic {
  double length, azimuth;
};
Geodesic geodesic(double a, double f, double lon1, double lat1, double lon2, double lat2) {
  geod_geodesic g;
  geod_init(&g, a, f);
  double s = 0, azimuth = 0;
  geod_inverse(&g, lat1, lon1, lat2, lon2, &s, &azimuth, nullptr);
  return {s, azimuth};
}

constexpr double kWgs84A = 6378137, kWgs84F = 1 / 298.257223563;

// Longitude and latitude of a map point, in degrees.
PJ_COORD geographic_of(const char* crs, const char* base, double x, double y) {
  PJ_CONTEXT* context = proj_context_create();
  PJ* raw = proj_create_crs_to_crs(context, crs, base, nullptr);
  PJ* transform = proj_normalize_for_visualization(context, raw);
  const PJ_COORD at = proj_trans(transform, PJ_FWD, proj_coord(x, y, 0, 0));
  proj_destroy(transform);
  proj_destroy(raw);
  proj_context_destroy(context);
  return at;
}

// The ground length of a step in the map, by a geodesic of about 100 m.
void expect_like_geodesics(const char* crs, const char* base, double a, double f, double x, double y, double unit,
                           double to_degrees = 1) {
  const double half = 50 / unit;
  const auto step = [&](double dx, double dy) {
    const PJ_COORD from = geographic_of(crs, base, x - dx, y - dy), to = geographic_of(crs, base, x + dx, y + dy);
    return geodesic(a, f, from.xy.x * to_degrees, from.xy.y * to_degrees, to.xy.x * to_degrees, to.xy.y * to_degrees);
  };
  const GroundScale scale = ground_scale_at(crs, x, y);
  const Geodesic east = step(half, 0), north = step(0, half);
  EXPECT_NEAR(east.length / (2 * half), scale.metres_per_x, 2e-6 * scale.metres_per_x) << crs;
  EXPECT_NEAR(north.length / (2 * half), scale.metres_per_y, 2e-6 * scale.metres_per_y) << crs;
  EXPECT_NEAR(north.azimuth, scale.grid_north_azimuth / kDegree, 1e-3) << crs;
}

TEST(GroundScale, DegreesMatchGeodesics) {
  for (const double lat : {0.0, 0.5, 36.65, -45.0, 70.0, 89.0}) {
    const GroundScale scale = ground_scale_at("EPSG:4326", 12, lat);
    const double half = 5e-4;
    EXPECT_NEAR(geodesic(kWgs84A, kWgs84F, 12 - half, lat, 12 + half, lat).length / (2 * half), scale.metres_per_x,
                1e-6 * scale.metres_per_x)
        << lat;
    EXPECT_NEAR(geodesic(kWgs84A, kWgs84F, 12, lat - half, 12, lat + half).length / (2 * half), scale.metres_per_y,
                1e-6 * scale.metres_per_y)
        << lat;
    EXPECT_EQ(0, scale.grid_north_azimuth);
  }
}

TEST(GroundScale, DegreesUseTheEllipsoidOfTheCrs) {
  // NAD27: Clarke 1866; and the Moon, a sphere of 1737.4 km.
  EXPECT_NEAR(geodesic(6378206.4, 1 / 294.978698213898, 0, 40, 1e-3, 40).length * 1e3,
              ground_scale_at("EPSG:4267", 0, 40).metres_per_x, 0.1);
  const GroundScale moon = ground_scale_at("+proj=longlat +R=1737400 +type=crs", 0, 60);
  EXPECT_NEAR(1737400 * kDegree / 2, moon.metres_per_x, 1e-6);
  EXPECT_NEAR(1737400 * kDegree, moon.metres_per_y, 1e-6);
}

TEST(GroundScale, GradsUseTheirUnit) {
  // NTF (Paris): longitudes in grads from Paris, 400 of them around the Earth.
  const double per_degree = ground_scale_at("EPSG:4275", 3, 45).metres_per_x;
  EXPECT_NEAR(per_degree * 0.9, ground_scale_at("EPSG:4807", 3, 50).metres_per_x, 1e-6 * per_degree);
}

TEST(GroundScale, ProjectionsMatchGeodesics) {
  expect_like_geodesics("EPSG:32610", "EPSG:4326", kWgs84A, kWgs84F, 562710, 5114985, 1);
  expect_like_geodesics("EPSG:32733", "EPSG:4326", kWgs84A, kWgs84F, 180000, 6200000, 1);
  expect_like_geodesics("EPSG:3857", "EPSG:4326", kWgs84A, kWgs84F, -13628000, 4551000, 1);
  // Oblique and conic projections; equal-area projections are not conformal.
  expect_like_geodesics("EPSG:2056", "EPSG:4150", 6377397.155, 1 / 299.1528128, 2600000, 1200000, 1);
  expect_like_geodesics("EPSG:3035", "EPSG:4258", 6378137, 1 / 298.257222101, 3000000, 4000000, 1);
}

TEST(GroundScale, MapsInFeetMatchGeodesics) {
  expect_like_geodesics("EPSG:2225", "EPSG:4269", 6378137, 1 / 298.257222101, 6600000, 1900000, 1200.0 / 3937);
}

TEST(GroundScale, BaseCrsInGradsMatchesGeodesics) {
  expect_like_geodesics("EPSG:27572", "EPSG:4807", 6378249.2, 1 - 6356515.0 / 6378249.2, 700000, 2300000, 1, 0.9);
}

TEST(GroundScale, WebMercatorIsStretchedByTheCosine) {
  const double x = -122.4 * kDegree * kWgs84A,
               y = std::log(std::tan(std::numbers::pi / 4 + 38 * kDegree / 2)) * kWgs84A;
  const GroundScale scale = ground_scale_at("EPSG:3857", x, y);
  EXPECT_NEAR(1.27, 1 / scale.metres_per_x, 0.005);
  EXPECT_NEAR(1.27, 1 / scale.metres_per_y, 0.005);
  EXPECT_NEAR(0, scale.grid_north_azimuth, 1e-9);
}

TEST(GroundScale, MatchesPointScaleAndConvergenceOfProj) {
  const PJ_COORD at = geographic_of("EPSG:32610", "EPSG:4326", 600000, 5114985);
  PJ* crs = proj_create(nullptr, "EPSG:32610");
  const PJ_FACTORS factors = proj_factors(crs, proj_coord(at.xy.x * kDegree, at.xy.y * kDegree, 0, 0));
  proj_destroy(crs);
  const GroundScale scale = ground_scale_at("EPSG:32610", 600000, 5114985);
  EXPECT_NEAR(factors.parallel_scale, 1 / scale.metres_per_x, 1e-7);
  EXPECT_NEAR(factors.meridional_scale, 1 / scale.metres_per_y, 1e-7);
  EXPECT_NEAR(factors.meridian_convergence, scale.grid_north_azimuth, 1e-6);
}

TEST(GroundScale, WorksAtThePoleAndTheAntimeridian) {
  // Polar stereographic with scale 0.994 at the pole itself.
  EXPECT_NEAR(1 / 0.994, ground_scale_at("EPSG:32661", 2000000, 2000000).metres_per_x, 1e-6);
  EXPECT_NEAR(1, ground_scale_at("EPSG:3832", 20037508.342789 - 3339584.7, 0).metres_per_x, 0.01);
}

TEST(GroundScale, IgnoresVerticalAndBoundParts) {
  EXPECT_NEAR(ground_scale_at("EPSG:32610", 562710, 5114985).metres_per_x,
              ground_scale_at("EPSG:32610+5773", 562710, 5114985).metres_per_x, 1e-12);
  EXPECT_NEAR(ground_scale_at("EPSG:4326", 0, 40).metres_per_x,
              ground_scale_at("+proj=longlat +ellps=WGS84 +towgs84=1,2,3 +type=crs", 0, 40).metres_per_x, 1e-6);
}

TEST(GroundScale, LocalSystemsUseTheirUnit) {
  const char* feet =
      "ENGCRS[\"site\",EDATUM[\"site\"],CS[Cartesian,2],AXIS[\"x\",east],AXIS[\"y\",north],LENGTHUNIT[\"foot\",0.3048]"
      "]";
  EXPECT_DOUBLE_EQ(0.3048, ground_scale_at(feet, 1, 2).metres_per_x);
}

TEST(GroundScale, RejectsInvalidPlaces) {
  EXPECT_THROW(ground_scale_at("EPSG:4326", 0, 90), Error);
  EXPECT_THROW(ground_scale_at("EPSG:4326", 500000, 5100000), Error);
  EXPECT_THROW(ground_scale_at("EPSG:32610", 1e12, 1e12), Error);
  EXPECT_THROW(ground_scale_at("nonsense", 0, 0), Error);
  EXPECT_THROW(ground_scale_at("EPSG:4978", 0, 0), Error);  // geocentric
}

}  // namespace
}  // namespace scarp
