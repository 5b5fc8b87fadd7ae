// SPDX-License-Identifier: MIT
// Clearance of the first Fresnel zone and k-factors, against crossings found one by one in long double.
#include <fmt/format.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "cli/csv_rows.h"
#include "cli/program.h"

namespace scarp::test {
namespace {

using Real = long double;

constexpr int kFresnelSide = 24;
constexpr Real kCell = 50, kDiameter = 2 * 6378137.0L, kLight = 299792458;  // metres, metres per second

// A model without CRS, whose south-west sample is at (0, 0).
class Fresnel : public testing::Test {
 protected:
  Fresnel() {
    std::mt19937 random(7);
    std::string text = fmt::format("ncols {0}\nnrows {0}\nxllcenter 0\nyllcenter 0\ncellsize 50\n", kFresnelSide);
    for (int i = 0; i < kFresnelSide * kFresnelSide; ++i) {
      heights_.push_back(static_cast<int>(random() % 30));
      text += fmt::format("{}{}", heights_.back(), i % kFresnelSide == kFresnelSide - 1 ? '\n' : ' ');
    }
    dem_ = scratch_.write("dem.asc", text);
  }

  struct Point {
    int col, row;
    Real height;  // above ground
  };
  Real ground(int col, int row) const { return heights_[static_cast<std::size_t>(row * kFresnelSide + col)]; }

  // The least share of the zone over all crossings of a line between nodes.
  Real least_share(const Point& from, const Point& to, Real coefficient, Real megahertz) const {
    const int dc = to.col - from.col, dr = to.row - from.row;
    const Real length = kCell * std::hypot(Real(dc), Real(dr)), wave = kLight / (megahertz * 1e6L);
    const auto lowered = [&](int col, int row) {
      const Real x = kCell * (col - from.col), y = kCell * (row - from.row);
      return ground(col, row) - coefficient * (x * x + y * y) / kDiameter;
    };
    const Real eye = ground(from.col, from.row) + from.height, end = lowered(to.col, to.row) + to.height;
    Real least = std::numeric_limits<Real>::infinity();
    const auto visit = [&](Real along, Real low, Real high, Real share) {
      const Real surface = low + share * (high - low), ray = eye + along * (end - eye);
      least = std::min(least, (ray - surface) / std::sqrt(wave * along * (1 - along) * length));
    };
    for (int k = 1; k < std::abs(dc); ++k) {
      const Real along = Real(k) / std::abs(dc), row = from.row + along * dr;
      const int col = from.col + (dc > 0 ? k : -k), north = static_cast<int>(std::floor(row));
      visit(along, lowered(col, north), lowered(col, std::min(north + 1, kFresnelSide - 1)), row - north);
    }
    for (int k = 1; k < std::abs(dr); ++k) {
      const Real along = Real(k) / std::abs(dr), col = from.col + along * dc;
      const int row = from.row + (dr > 0 ? k : -k), west = static_cast<int>(std::floor(col));
      visit(along, lowered(west, row), lowered(std::min(west + 1, kFresnelSide - 1), row), col - west);
    }
    return least;
  }

  static std::string typed(const Point& at) {
    return fmt::format("{},{},{}", 50 * at.col, 50 * (kFresnelSide - 1 - at.row), static_cast<double>(at.height));
  }

  Scratch scratch_;
  std::string dem_;
  std::vector<int> heights_;
};

// Tables have ten digits.
constexpr double kFresnelDigits = 1e-9;

TEST_F(Fresnel, ShareIsTheLeastOverAllCrossings) {
  const Point tower{2, 3, 25};
  std::string lines = "x,y,z,tx,ty,tz\n";
  std::vector<Point> targets;
  for (int i = 0; i < 40; ++i)
    targets.push_back({(5 * i + 9) % kFresnelSide, (7 * i + 11) % kFresnelSide, Real(i % 13)});
  for (const Point& target : targets) lines += typed(tower) + ',' + typed(target) + '\n';
  const std::string file = scratch_.write("lines.csv", lines);
  struct Case {
    Names options;
    Real coefficient;
  };
  for (const auto& [options, coefficient] : {Case{{"--k-factor", "4/3"}, 0.75L}, Case{{"--k-factor", "0.5"}, 2},
                                             Case{{"--cc", "0"}, 0}, Case{{}, 6 / 7.0L}}) {
    const Result result = run(Names{"los", dem_, "--lines", file, "--frequency", "2400"} + options);
    ASSERT_EQ(result.status, 0) << result.err;
    const auto rows = rows_of(result.out);
    ASSERT_EQ(rows.size(), targets.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double expected = static_cast<double>(least_share(tower, targets[i], coefficient, 2400));
      ASSERT_NEAR(number(rows[i], "fresnel"), expected, kFresnelDigits * std::max(1.0, std::abs(expected))) << i;
      EXPECT_EQ(rows[i].at("visible"), expected >= 0 ? "1" : "0");
    }
  }
}

TEST_F(Fresnel, ProfilesHaveTheZoneAtEachPoint) {
  const Point from{2, 3, 40}, to{20, 12, 30};
  const Names line{"profile", dem_,          "--from", typed(from),  "--to",
                   typed(to), "--frequency", "900",    "--k-factor", "4/3"};
  const Result result = run(line);
  ASSERT_EQ(result.status, 0) << result.err;
  const auto rows = rows_of(result.out);
  const double length = number(rows.back(), "distance");
  double least = HUGE_VAL;
  for (const Row& row : rows) {
    const double at = number(row, "distance");
    EXPECT_NEAR(number(row, "zone"), std::sqrt(299.792458 / 900 * at * (length - at) / length), 1e-7);
    if (row.at("fresnel").empty()) {
      EXPECT_TRUE(at == 0 || at == length);
    } else {
      least = std::min(least, number(row, "fresnel"));
    }
  }
  const double expected = static_cast<double>(least_share(from, to, 0.75L, 900));
  EXPECT_NEAR(least, expected, kFresnelDigits * std::max(1.0, std::abs(expected)));
#ifdef SCARP_CAIRO
  const Result figure = run(line + Names{"-o", scratch_.path("link.svg")});
  EXPECT_EQ(figure.status, 0) << figure.err;
#endif
}

TEST_F(Fresnel, MapsHaveTheLargestShareOfAllObservers) {
  const std::vector<Point> towers{{2, 3, 25}, {20, 17, 40}};
  Names words{"viewshed", dem_, "--mode",          "fresnel", "--frequency", "5800",
              "--cc",     "0",  "--target-height", "3",       "-o",          scratch_.path("share.tif")};
  for (const Point& tower : towers) words = words + Names{"--observer", typed(tower)};
  const Result result = run(words);
  ASSERT_EQ(result.status, 0) << result.err;
  GDALAllRegister();
  const GDALDatasetUniquePtr raster(GDALDataset::Open(scratch_.path("share.tif").c_str(), GDAL_OF_RASTER));
  ASSERT_TRUE(raster);
  std::vector<float> pixels(kFresnelSide * kFresnelSide);
  ASSERT_EQ(raster->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, kFresnelSide, kFresnelSide, pixels.data(), kFresnelSide,
                                               kFresnelSide, GDT_Float32, 0, 0, nullptr),
            CE_None);
  for (int i = 0; i < kFresnelSide * kFresnelSide; ++i) {
    Real expected = -std::numeric_limits<Real>::infinity();
    for (const Point& tower : towers)
      expected =
          std::max(expected, std::min(1.0L, least_share(tower, {i % kFresnelSide, i / kFresnelSide, 3}, 0, 5800)));
    // Floats.
    EXPECT_NEAR(pixels[static_cast<std::size_t>(i)], static_cast<double>(expected),
                1e-6 * std::max(1.0, std::abs(static_cast<double>(expected))));
  }
}

TEST_F(Fresnel, RejectsValuesOutOfRange) {
  const auto refused = [&](const Names& options, const std::string& what) {
    const Result result = run(Names{"los", dem_, "--from", "0,0", "--to", "500,500"} + options);
    EXPECT_NE(result.status, 0);
    EXPECT_EQ(lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(what), std::string::npos) << result.err;
  };
  refused({"--k-factor", "0"}, "--k-factor '0': expected a number or a fraction of at least 0.1");
  refused({"--k-factor", "4/0"}, "--k-factor '4/0'");
  refused({"--k-factor", "nan"}, "--k-factor 'nan'");
  refused({"--k-factor", "1", "--cc", "1"}, "--cc");
  refused({"--frequency", "0"}, "--frequency '0'");
  refused({"--frequency", "900", "--surface", "bilinear", "--cc", "0"},
          "--frequency has no effect without --surface crossings");
}

}  // namespace
}  // namespace scarp::test
