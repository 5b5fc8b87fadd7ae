// SPDX-License-Identifier: MIT
// Rays of `scarp cast` that start on the surface of a cell.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cli/csv_rows.h"
#include "cli/program.h"

namespace scarp::test {
namespace {

class CastStarts : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return scratch_.path(name); }
  std::string rays(const std::string& bytes) const { return scratch_.write("rays.csv", bytes); }

  // An ESRI ASCII grid of 5 x 4, its south-west node at map (1000, 2000), cells of 10.
  std::string hills(const std::string& samples =
                        "100 107 128 163 212\n111 115 133 165 211\n122 123 138 167 210\n"
                        "133 131 143 169 209") const {
    return scratch_.write("hills.asc",
                          "ncols 5\nnrows 4\nxllcenter 1000\nyllcenter 2000\ncellsize 10\n" + samples + "\n");
  }
  void expect_rays_refused(const std::string& table, const std::string& fragment) const {
    const auto result = run({"cast", path("hills.asc"), "--coords", "local", "--rays", rays(table)});
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(fragment), std::string::npos) << result.err;
  }

  Scratch scratch_;
};

TEST_F(CastStarts, CountAsAboveTheSurface) {
  hills("0 0 0 0 0\n0 0 0 0 0\n0 0 0 0 0\n0 0 0 0 0");
  // Along the plane: touching is a hit for a free ray, but not for one that starts on it.
  const auto result = run({"cast", path("hills.asc"), "--coords", "local", "--rays",
                           rays("x,y,z,dx,dy,dz,start_col,start_row\n15,15,0,1,0,0,,\n15,15,0,1,0,0,1,1\n")});
  const auto rows = rows_of(result.out);
  ASSERT_EQ(rows.size(), 2u) << result.err;
  EXPECT_EQ(rows[0].at("status"), "hit");
  EXPECT_EQ(rows[1].at("status"), "miss");
  EXPECT_EQ(result.err.find("start_col"), std::string::npos) << result.err;
}

TEST_F(CastStarts, MustLieInTheirCell) {
  hills();
  const std::string header = "x,y,z,dx,dy,dz,t_min,t_max,start_col,start_row\n";
  expect_rays_refused(header + "15,15,0,0,0,1,0,9,1,1\n15,15,0,0,0,1,0,9,3,1\n",
                      "rays.csv: line 3 (ray 1): it starts at column 1.5, row 1.5 of the samples, which is not in the "
                      "cell of start_col 3 and start_row 1, nor next to it");
  expect_rays_refused(header + "31,15,0,0,0,1,0,9,1,1\n", "column 3.1, row 1.5");
  expect_rays_refused(header + "-50,15,0,0,0,1,0,9,0,1\n", "column -5, row 1.5");
  expect_rays_refused(header + "15,15,0,1,0,0,20,99,1,1\n", "column 3.5, row 1.5");
  const auto err = [&](const std::string& table, const Names& more = {}) {
    Names words{"cast", path("hills.asc"), "--coords", "local", "--rays", rays(header + table)};
    words.insert(words.end(), more.begin(), more.end());
    const auto result = run(words);
    EXPECT_EQ(result.status, 0) << result.err;
    return result.err;
  };
  // On the border and slightly off it, because numbers in a table may be rounded.
  err("20,15,0,0,0,1,0,9,1,1\n20,15,0,0,0,1,0,9,2,1\n20.5,15,0,0,0,1,0,9,1,1\n15,15,0,1,0,0,10,99,2,1\n");
  err("65,15,0,0,0,1,0,9,1,1\n", {"--wrap", "periodic"});
  EXPECT_NE(err("15,15,9000,0,0,1,0,9,1,1\n").find("note: rays with start_col and start_row start on the surface"),
            std::string::npos);
}

// Each ray starts at the hit of the previous one, given by its x, y, z and cell. Some are on borders of their cell.
TEST_F(CastStarts, MayBeHitsOfOtherRays) {
  const std::string degrees = scratch_.write("degrees.asc",
                                             "ncols 5\nnrows 4\nxllcenter 10\nyllcenter 50\ncellsize 0.0001\n"
                                             "1 5 2 7 3\n4 1 8 2 1\n2 6 3 9 3\n3 1 2 5 6\n");
  struct Case {
    std::string coordinates, file, crs;
    double x, y, unit;
  };
  for (const Case& c : {Case{"local", hills(), "EPSG:32616", 0, 0, 1},
                        {"map", hills(), "EPSG:32616", 1000, 2000, 1},
                        {"lonlat", degrees, "EPSG:4326", 10, 50, 1e-5}}) {
    const auto cast = [&](const std::string& table) {
      const auto result = run({"cast", c.file, "--crs", c.crs, "--coords", c.coordinates, "--rays", rays(table)});
      EXPECT_EQ(result.status, 0) << c.coordinates << ": " << result.err;
      EXPECT_EQ(result.err.find("start_col"), std::string::npos) << result.err;
      return rows_of(result.out);
    };
    std::string first = "x,y,z,tx,ty,tz\n", next = "x,y,z,dx,dy,dz,start_col,start_row\n";
    for (int i = 1; i < 40; ++i) {
      const double x = c.x + i * c.unit, y = c.y + 10 * (1 + i % 2) * c.unit;
      first += fmt::format("{0},{1},5000,{0},{1},-5000\n{2},{3},5000,{0},{1},0\n", x, y, x - 1000 * c.unit,
                           y + 333 * c.unit);
    }
    int starts = 0;
    for (const Row& hit : cast(first)) {
      if (hit.at("status") != "hit") continue;
      next +=
          fmt::format("{},{},{},0,0,1,{},{}\n", hit.at("x"), hit.at("y"), hit.at("z"), hit.at("col"), hit.at("row"));
      ++starts;
    }
    EXPECT_GT(starts, 40) << c.coordinates;
    for (const Row& row : cast(next)) EXPECT_EQ(row.at("status"), "miss");
  }
}

}  // namespace
}  // namespace scarp::test
