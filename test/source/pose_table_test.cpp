// SPDX-License-Identifier: MIT
#include "scarp/source/table/pose_table.h"

#include <gtest/gtest.h>

#include <string>

#include "base/refusal.h"

namespace scarp {
namespace {

TEST(PoseTable, ReadsColumnsInAnyOrder) {
  const PoseTable table = parse_pose_csv(
      "\xef\xbb\xbfspeed;heading;time;y;x;z;roll\r\n"
      "9.5;90;0.5;200;100;12;1\r\n"
      "\r\n"
      "9.6;-85.5;+0.75;201;101;13;-2.5\r\n");
  EXPECT_FALSE(table.lonlat);
  EXPECT_FALSE(table.above_ground);
  ASSERT_EQ(table.rows.size(), 2u);
  const PoseRow& row = table.rows[1];
  EXPECT_EQ(row.time, 0.75);
  EXPECT_EQ(row.at, dvec3(101, 201, 13));
  EXPECT_EQ(row.heading, -85.5);
  EXPECT_EQ(row.pitch, 0);
  EXPECT_EQ(row.roll, -2.5);
  EXPECT_EQ(row.line, 4);
}

TEST(PoseTable, ReadsDegreesAndHeightsAboveGround) {
  const PoseTable table = parse_pose_csv("time,lon,lat,above,heading,pitch\n0,10.5,0.25,1.5,0,3\n");
  EXPECT_TRUE(table.lonlat);
  EXPECT_TRUE(table.above_ground);
  EXPECT_EQ(table.rows.at(0).at, dvec3(10.5, 0.25, 1.5));
  EXPECT_EQ(table.rows.at(0).pitch, 3);
}

TEST(PoseTable, ErrorsNameTheLineAndTheExpectedValue) {
  const std::string header = "time,x,y,z,heading\n";
  const struct {
    std::string text, fragment;
  } cases[] = {
      {"", "is empty"},
      {header, "has no rows"},
      {"time,x,y,z\n0,1,2,3\n", "columns are missing (required: time, x,y or lon,lat, z or above, heading"},
      {"x,y,z,heading\n1,2,3,0\n", "columns are missing"},
      {"time,x,lat,z,heading\n0,1,2,3,0\n", "columns are missing"},
      {"time,x,y,heading\n0,1,2,0\n", "columns are missing"},
      {"time,x,y,z,heading,x\n0,1,2,3,0,1\n", "two columns 'x'"},
      {"time,x,y,lon,lat,z,heading\n0,1,2,3,4,5,0\n", "columns x,y and lon,lat both"},
      {"time,x,y,z,above,heading\n0,1,2,3,4,5\n", "columns z and above both"},
      {header + "0,1,2,3\n", "line 2: 4 fields; the header has 5"},
      {header + "0,1,2,3,0\n1,1,nan,3,0\n", "line 3: y 'nan' is not a finite number"},
      {header + "0,1,2,3,\n", "line 2: heading '' is not a finite number"},
      {header + "0,1,2 m,3,0\n", "line 2: y '2 m' is not a finite number"},
      {header + "1e999,1,2,3,0\n", "line 2: time '1e999' is not a finite number"},
      {header + "0,1,2,3,0\n0,1,2,3,0\n", "line 3: time 0 is not later than 0 in the row before it"},
      {header + "5,1,2,3,0\n4,1,2,3,0\n", "line 3: time 4 is not later than 5"},
      {header + "\"5,1,2,3,0\n", "line 2"},
  };
  for (const auto& c : cases) {
    const std::string what = test::refusal([&] { parse_pose_csv(c.text); });
    EXPECT_NE(what.find(c.fragment), std::string::npos) << c.text << ": " << what;
  }
  EXPECT_EQ(test::refusal([] { read_poses("/no/drive.csv"); }).find("/no/drive.csv: "), 0u);
}

}  // namespace
}  // namespace scarp
