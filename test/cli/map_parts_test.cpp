// SPDX-License-Identifier: MIT
// `los`, `profile`, `viewshed` and `horizon` at points read only the part of a raster that they need. Lines of sight,
// viewsheds and horizons are those of the whole raster, which a second question in the same run forces them to read;
// profiles follow the samples.
#include <fmt/format.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "cli/csv_rows.h"
#include "cli/program.h"
#include "cli/refused.h"
#include "scarp/base/vec.h"

namespace scarp::test {
namespace {

constexpr int kModelCols = 700, kModelRows = 600;

class MapParts : public testing::Test {
 protected:
  MapParts() {
    GDALAllRegister();
    std::uniform_int_distribution<int> rough(0, 40), hole(0, 60);
    for (int row = 0; row < kModelRows; ++row)
      for (int col = 0; col < kModelCols; ++col) {
        const double hills = 300 * std::sin(col / 23.0) * std::cos(row / 31.0);
        samples_.push_back(static_cast<std::int16_t>(hole(random_) == 0 ? -9999 : 400 + hills + rough(random_)));
      }
    utm_ = write("utm.tif", 32633, {500000, 10, 0, 5000000, 0, -10});
    degrees_ = write("degrees.tif", 4326, {12, 1.0 / 7200, 0, 46, 0, -1.0 / 7200});
  }

  std::string write(const std::string& name, int crs_code, std::vector<double> map) const {
    const char* const options[] = {"TILED=YES", "BLOCKXSIZE=64", "BLOCKYSIZE=32", nullptr};
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    GDALDatasetUniquePtr file(
        driver->Create(scratch_.path(name).c_str(), kModelCols, kModelRows, 1, GDT_Int16, const_cast<char**>(options)));
    OGRSpatialReference crs;
    crs.importFromEPSG(crs_code);
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    file->SetSpatialRef(&crs);
    file->SetGeoTransform(map.data());
    GDALRasterBand& band = *file->GetRasterBand(1);
    band.SetNoDataValue(-9999);
    EXPECT_EQ(band.RasterIO(GF_Write, 0, 0, kModelCols, kModelRows, const_cast<std::int16_t*>(samples_.data()),
                            kModelCols, kModelRows, GDT_Int16, 0, 0, nullptr),
              CE_None);
    return scratch_.path(name);
  }

  /// Coordinates of a position in columns and rows of one of the two rasters.
  dvec2 place(const std::string& dem, double col, double row) const {
    const double x = col + 0.5, y = row + 0.5;
    return dem == utm_ ? dvec2(500000 + 10 * x, 5000000 - 10 * y) : dvec2(12 + x / 7200, 46 - y / 7200);
  }
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  /// A random position: inside, on a node, on the border or in a corner.
  dvec2 position(int case_number) {
    const double share = case_number % 2 == 0 ? 0 : whole(0, 1023) / 1024.0;
    dvec2 at{whole(0, kModelCols - 2) + share, whole(0, kModelRows - 2) + share};
    if (case_number % 5 == 1) at.x = 0;
    if (case_number % 5 == 2) at.y = kModelRows - 1;
    if (case_number % 5 == 3) at = {kModelCols - 1, kModelRows - 1};
    return at;
  }

  /// A height slightly above the samples around a position.
  int above(const dvec2& at) const {
    int highest = 100;
    for (const int south : {0, 1})
      for (const int east : {0, 1}) {
        const int col = std::min(static_cast<int>(at.x) + east, kModelCols - 1),
                  row = std::min(static_cast<int>(at.y) + south, kModelRows - 1);
        highest = std::max<int>(highest, samples_[static_cast<std::size_t>(row) * kModelCols + col]);
      }
    return highest + 5;
  }

  static Result answer(const Names& words, const Names& more) {
    Result result = run(words + more);
    EXPECT_EQ(result.status, 0) << result.err;
    return result;
  }

  struct Map {
    int cols = 0, rows = 0;
    double west = 0, north = 0;
    std::vector<float> pixels;
    float at(int col, int row) const { return pixels[static_cast<std::size_t>(row) * cols + col]; }
  };
  static Map map_in(const std::string& file) {
    const GDALDatasetUniquePtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER));
    Map map{dataset->GetRasterXSize(), dataset->GetRasterYSize(), 0, 0, {}};
    map.pixels.resize(static_cast<std::size_t>(map.cols) * map.rows);
    double transform[6] = {};
    dataset->GetGeoTransform(transform);
    map.west = transform[0], map.north = transform[3];
    EXPECT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, map.cols, map.rows, map.pixels.data(), map.cols,
                                                  map.rows, GDT_Float32, 0, 0, nullptr),
              CE_None);
    return map;
  }

  Scratch scratch_;
  std::mt19937 random_{7};
  std::vector<std::int16_t> samples_;
  std::string utm_, degrees_;
};

void expect_same(const Row& a, const Row& b, bool exact, const std::string& what) {
  if (exact) {
    EXPECT_EQ(a, b) << what;
    return;
  }
  // Local coordinates differ, and with them the rounding of the last of ten digits, which is at most 1e-9 of a number.
  constexpr double kLastDigit = 0x1p-29;  // less than two of it
  ASSERT_EQ(a.size(), b.size()) << what;
  for (const auto& [column, text] : a) {
    EXPECT_EQ(text.empty(), b.at(column).empty()) << what << ": " << column;
    EXPECT_NEAR(number(a, column), number(b, column), kLastDigit * std::abs(number(b, column)))
        << what << ": " << column;
  }
}

TEST_F(MapParts, LinesOfSightAreThoseOfTheWholeRaster) {
  const std::string head = "x,y,z,tx,ty,tz\n";
  for (const std::string& dem : {utm_, degrees_})
    for (const char* surface : {"crossings", "bilinear"}) {
      const Names words{"los", dem,         "--heights", "sea",  "--plane-error",
                        "9",   "--surface", surface,     "--cc", std::string(surface) == "bilinear" ? "0" : "0.8"};
      std::string near, all = head;
      std::vector<std::string> alone;
      for (int i = 0; i < 8; ++i) {
        const dvec2 from = position(i);
        const dvec2 to{std::clamp(from.x + whole(-40, 40), 0.0, kModelCols - 1.0),
                       std::clamp(from.y + whole(-40, 40), 0.0, kModelRows - 1.0)};
        // Heights are above sea, because some ends are on holes.
        const dvec2 eye = place(dem, from.x, from.y), target = place(dem, to.x, to.y);
        const std::string row = fmt::format("{:.17g},{:.17g},{},{:.17g},{:.17g},{}\n", eye.x, eye.y, above(from),
                                            target.x, target.y, above(to));
        alone.push_back(head + row);
        near += row;
      }
      // A line from corner to corner needs the whole raster.
      const dvec2 first = place(dem, 0, 0), last = place(dem, kModelCols - 1, kModelRows - 1);
      all += near + fmt::format("{:.17g},{:.17g},2000,{:.17g},{:.17g},2000\n", first.x, first.y, last.x, last.y);
      const auto lines_of = [&](const std::string& table) {
        return rows_of(answer(words, {"--lines", scratch_.write("lines.csv", table)}).out);
      };
      const std::vector<Row> whole_raster = lines_of(all), in_turn = lines_of(head + near);
      ASSERT_EQ(whole_raster.size(), alone.size() + 1);
      ASSERT_EQ(in_turn.size(), alone.size());
      int blocked = 0;
      for (std::size_t i = 0; i < alone.size(); ++i) {
        Row one = lines_of(alone[i]).at(0);
        one["line"] = in_turn[i].at("line");
        const std::string what = fmt::format("{} {}: line {}", dem, surface, i);
        const bool exact = surface == std::string("crossings");
        expect_same(one, whole_raster[i], exact, what);
        expect_same(in_turn[i], whole_raster[i], exact, what);
        blocked += one.at("visible") == "0";
      }
      EXPECT_GT(blocked, 0);
      EXPECT_LT(blocked, 8);
    }
}

TEST_F(MapParts, HorizonsAreThoseOfTheWholeRaster) {
  constexpr std::size_t kPoints = 8, kInTurn = 3, kAzimuths = 7;
  for (const std::string& dem : {utm_, degrees_}) {
    const auto horizons_of = [&](const std::string& table) {
      return run({"horizon", dem, "--azimuths", fmt::format("{}", kAzimuths), "--max-distance", "400", "--plane-error",
                  "9", "--points", scratch_.write("points.csv", "x,y,z\n" + table)});
    };
    std::vector<std::string> points;
    std::vector<Row> alone;
    for (int i = 0; points.size() < kPoints; ++i) {
      // Corners first, so that the first points are far apart.
      const dvec2 at = i == 0 ? dvec2(0, 0) : i == 1 ? dvec2(kModelCols - 1, kModelRows - 1) : position(i);
      const dvec2 typed = place(dem, at.x, at.y);
      const std::string row = fmt::format("{:.17g},{:.17g},{}\n", typed.x, typed.y, i);
      const Result result = horizons_of(row);
      if (result.status != 0) continue;  // over a hole
      points.push_back(row);
      for (Row& one : rows_of(result.out)) {
        one["point"] = fmt::format("{}", points.size());
        alone.push_back(one);
      }
    }
    const auto first = [&](std::size_t count) {
      std::string table;
      for (std::size_t i = 0; i < count; ++i) table += points[i];
      const Result result = horizons_of(table);
      EXPECT_EQ(result.status, 0) << result.err;
      return rows_of(result.out);
    };
    // Eight points are read as one part, three one after the other.
    EXPECT_EQ(first(kPoints), alone) << dem;
    EXPECT_EQ(first(kInTurn), std::vector<Row>(alone.begin(), alone.begin() + kInTurn * kAzimuths)) << dem;
    EXPECT_GT(std::count_if(alone.begin(), alone.end(), [](const Row& row) { return !row.at("distance").empty(); }),
              20);
  }
}

TEST_F(MapParts, ProfilesFollowTheSamples) {
  for (const std::string& dem : {utm_, degrees_})
    for (int i = 0; i < 4; ++i) {
      const dvec2 a = position(i), b{std::clamp(a.x + whole(-30, 30), 0.0, kModelCols - 1.0),
                                     std::clamp(a.y + whole(-30, 30), 0.0, kModelRows - 1.0)};
      const dvec2 from = place(dem, a.x, a.y), to = place(dem, b.x, b.y);
      const std::vector<Row> points = rows_of(answer({"profile", dem, "--heights", "sea", "--plane-error", "9"},
                                                     {fmt::format("--from={:.17g},{:.17g},900", from.x, from.y),
                                                      fmt::format("--to={:.17g},{:.17g},900", to.x, to.y)})
                                                  .out);
      ASSERT_GT(points.size(), 2u);
      for (const Row& point : points) {
        // The ground is linear between the two samples beside a crossing. Ten digits of 46 degrees are 3.6e-5 of a
        // cell, those of 5,000,000 m are 5e-5. Both coordinates and each of up to four weights are wrong by that.
        constexpr double kDigits = 5e-5, kLeastWeight = 2 * kDigits, kTallest = 400 + 300 + 40;
        const double col = dem == utm_ ? (number(point, "x") - 500000) / 10 - 0.5
                                       : (number(point, "x") - 12) * 7200 - 0.5,
                     row = dem == utm_ ? (5000000 - number(point, "y")) / 10 - 0.5
                                       : (46 - number(point, "y")) * 7200 - 0.5;
        const int c = std::clamp(static_cast<int>(std::floor(col + kDigits)), 0, kModelCols - 1),
                  r = std::clamp(static_cast<int>(std::floor(row + kDigits)), 0, kModelRows - 1);
        if (point.at("ground").empty()) continue;  // an end on a hole
        const double u = std::max(0.0, col - c), v = std::max(0.0, row - r);
        double sum = 0;
        for (const int south : {0, 1})
          for (const int east : {0, 1}) {
            const double weight = (east ? u : 1 - u) * (south ? v : 1 - v);
            // A sample beside the line may be a hole.
            if (weight > kLeastWeight)
              sum += weight * samples_[static_cast<std::size_t>(std::min(r + south, kModelRows - 1)) * kModelCols +
                                       std::min(c + east, kModelCols - 1)];
          }
        EXPECT_NEAR(number(point, "ground"), sum, 5 * kDigits * kTallest) << dem << ": " << col << ' ' << row;
      }
    }
}

TEST_F(MapParts, ViewshedsAreThoseOfTheWholeRaster) {
  int visible = 0;
  for (const std::string& dem : {utm_, degrees_})
    for (int i = 0; i < 5; ++i) {
      const dvec2 at = position(i), spot = place(dem, std::floor(at.x), std::floor(at.y));
      const std::string near = scratch_.path("near.tif"), all = scratch_.path("all.tif"),
                        crop = scratch_.path("crop.tif");
      const Names words{"viewshed",
                        dem,
                        "--heights",
                        "sea",
                        "--plane-error",
                        "9",
                        "--max-distance",
                        "275",
                        fmt::format("--observer={:.17g},{:.17g},{}", spot.x, spot.y, 750)};
      answer(words, {"-o", near});
      answer(words, {"-o", crop, "--crop"});
      // To tell holes from pixels out of range, all samples are read.
      answer(words, {"-o", all, "--out-of-range-value", "254"});
      const Map part = map_in(near), whole_raster = map_in(all), cropped = map_in(crop);
      ASSERT_EQ(part.cols, kModelCols);
      ASSERT_EQ(part.rows, kModelRows);
      EXPECT_LT(cropped.cols, 75);
      EXPECT_LT(cropped.rows, 75);
      const dvec2 corner = place(dem, -0.5, -0.5);
      const double cell = dem == utm_ ? 10 : 1.0 / 7200;
      const int west = static_cast<int>(std::lround((cropped.west - corner.x) / cell)),
                north = static_cast<int>(std::lround((corner.y - cropped.north) / cell));
      int wrong = 0, wrong_in_crop = 0;
      for (int row = 0; row < kModelRows; ++row)
        for (int col = 0; col < kModelCols; ++col) {
          const float expected = whole_raster.at(col, row) == 254 ? 255 : whole_raster.at(col, row);
          wrong += part.at(col, row) != expected;
          const int c = col - west, r = row - north;
          const bool inside = c >= 0 && r >= 0 && c < cropped.cols && r < cropped.rows;
          wrong_in_crop += (inside ? cropped.at(c, r) : 255) != expected;
          visible += expected == 1;
        }
      EXPECT_EQ(wrong, 0) << dem << ": observer " << i;
      EXPECT_EQ(wrong_in_crop, 0) << dem << ": observer " << i;
    }
  EXPECT_GT(visible, 1000);
}

TEST_F(MapParts, MapsOfSeveralObserversCoverTheirUnion) {
  const auto spot = [&](int col, int row) {
    const dvec2 at = place(utm_, col, row);
    return fmt::format("--observer={},{},900", at.x, at.y);
  };
  // Without a limit, all is read.
  const Names two{"viewshed", utm_, "--heights", "sea", spot(0, 0), spot(20, 10)};
  for (const char* mode : {"count", "ground", "angle"}) {
    const std::string near = scratch_.path("near.tif"), all = scratch_.path("all.tif");
    answer(two, {"--mode", mode, "--max-distance", "300", "-o", near});
    answer(two, {"--mode", mode, "-o", all});
    const Map part = map_in(near), whole_raster = map_in(all);
    const float nodata = std::string(mode) == "count" ? 65535 : -9999;
    int wrong = 0;
    for (int row = 0; row < kModelRows; ++row)
      for (int col = 0; col < kModelCols; ++col) {
        // Cells are 0.04 % longer on the ground than on the map.
        const auto reaches = [&](int c, int r) { return std::hypot(col - c, row - r) * 10 / 0.9996 <= 300; };
        const bool first = reaches(0, 0), second = reaches(20, 10);
        if (!first && !second) wrong += part.at(col, row) != nodata;
        if (first && second) wrong += part.at(col, row) != whole_raster.at(col, row);
      }
    EXPECT_EQ(wrong, 0) << mode;
    // Parts are bands of the whole map's rows, whether or not an observer reaches them.
    for (const int i : {1, 2, 6}) {
      const std::string band = scratch_.path("band.tif");
      answer(two, {"--mode", mode, "--max-distance", "300", "-o", band, "--part", fmt::format("{}/6", i)});
      const Map rows = map_in(band);
      ASSERT_EQ(rows.rows, 100);
      const auto begin = part.pixels.begin() + static_cast<std::ptrdiff_t>(i - 1) * 100 * kModelCols;
      EXPECT_TRUE(std::equal(rows.pixels.begin(), rows.pixels.end(), begin)) << mode << ": part " << i;
    }
  }
}

TEST_F(MapParts, ErrorsNamePlacesOfTheWholeRaster) {
  const auto hole = static_cast<int>(std::find(samples_.begin() + 200000, samples_.end(), -9999) - samples_.begin());
  const dvec2 at = place(utm_, hole % kModelCols, hole / kModelCols),
              beside = place(utm_, hole % kModelCols + 9, hole / kModelCols);
  const std::string text = fmt::format("{},{}", at.x, at.y), other = fmt::format("{},{},9999", beside.x, beside.y);
  for (const Names& words :
       {Names{"los", utm_, "--from=" + text, "--to=" + other},
        {"los", utm_, "--from=" + other, "--to=" + text},
        {"profile", utm_, "--from=" + text, "--to=" + other},
        {"viewshed", utm_, "--observer=" + text, "--max-distance", "90", "-o", scratch_.path("a.tif")}}) {
    expect_refused(scratch_, words, text + " is on nodata");
  }
}

}  // namespace
}  // namespace scarp::test
