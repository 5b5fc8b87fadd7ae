// SPDX-License-Identifier: MIT
#include "scarp/source/raster/node_places.h"

#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <atomic>
#include <thread>
#include <vector>

#include "scarp/base/error.h"

namespace scarp {
namespace {

// UTM zone 33, 30 m cells, at 15 degrees east on the zone's meridian.
Georeference utm() {
  OGRSpatialReference crs;
  crs.importFromEPSG(32633);
  Georeference geo;
  geo.present = true;
  geo.map_from_node = {500000, 30, 0, 5000000, 0, -30};
  char* wkt = nullptr;
  crs.exportToWkt(&wkt);
  geo.crs_wkt = wkt;
  CPLFree(wkt);
  geo.cell_x_m = geo.cell_y_m = 29.99;
  return geo;
}

TEST(NodePlaces, MatchTheCoordinates) {
  const NodePlaces places(utm(), 40, 20);
  const CoordinateFrame frame(utm(), 40, 20, Coordinates::lonlat);
  std::vector<dvec3> row(5);
  places.row(3, -1, row);
  EXPECT_NEAR(row[1].x, 15, 1e-12);
  for (int i = 0; i < 5; ++i) {
    std::vector<dvec3> one{dvec3((i - 1) * 29.99, (19 - 3) * 29.99, 0)};
    ASSERT_FALSE(frame.from_local(one));
    EXPECT_EQ(row[static_cast<std::size_t>(i)], one[0]);
  }
}

TEST(NodePlaces, AreThreadSafe) {
  const NodePlaces places(utm(), 200, 64);
  std::vector<dvec3> expected(200);
  places.row(0, 0, expected);
  std::atomic<int> wrong = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([&] {
      std::vector<dvec3> row(200);
      for (int k = 0; k < 50; ++k) {
        places.row(0, 0, row);
        wrong += row != expected;
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
}

TEST(NodePlaces, RejectRastersWithoutCoordinates) {
  Georeference none = utm();
  none.crs_wkt.clear();
  EXPECT_THROW(NodePlaces(none, 4, 4), Error);
  Georeference far = utm();
  far.map_from_node[0] = 1e12;
  const NodePlaces places(far, 4, 4);
  std::vector<dvec3> row(4);
  EXPECT_THROW(places.row(0, 0, row), Error);
}

}  // namespace
}  // namespace scarp
