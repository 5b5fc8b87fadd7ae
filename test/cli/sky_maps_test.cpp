// SPDX-License-Identifier: MIT
// `scarp horizon`, `skyview` and `sunhours`: their output, and their one-line errors.
#include <fmt/format.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "cli/maps_cli.h"

namespace scarp::test {
namespace {

class SkyMaps : public MapsCli {};

// The wall is 50 m high and 100 m on the map east of column 10. On the ground that is 100 m / 0.9996: the model is on
// the meridian of its zone.
constexpr double kWall = 100 / 0.9996;
// ground_scale.h promises lengths to 1e-6. Slopes of 1/2 and angles are floats, each rounded to half of 2^-24; an arc
// tangent is off by 2^-22 at most (horizon_measures.h).
constexpr double kDegrees = 57.29577951308232;
const double kWallAngle = kDegrees * std::atan(50 / kWall);
constexpr double kAngleError = kDegrees * (0.5e-6 + 0x1p-22 + 2 * 0x1p-25) + 0x1p-20;
constexpr double kWallError = kWall * 1e-6 + 0x1p-18;

TEST_F(SkyMaps, HorizonsAreMeasuredFromEveryPixel) {
  const Names flat = on_dem("horizon") + Names{"--cc", "0"};
  const auto result = run(flat + Names{"--azimuths", "4", "--distance", "-o", path("h.tif")});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("4 azimuths, highest 78.69 degrees"), std::string::npos) << result.out;  // 50 m, 10 m away
  const auto map = open(path("h.tif"));
  ASSERT_EQ(map->GetRasterCount(), 8);
  EXPECT_STREQ(map->GetRasterBand(2)->GetDescription(), "horizon 90");
  EXPECT_NEAR(static_cast<double>(pixels_of(*map, 2).at(10, 9)), kWallAngle, kAngleError);
  EXPECT_NEAR(static_cast<double>(pixels_of(*map, 6).at(10, 9)), kWall, kWallError);
  EXPECT_FLOAT_EQ(pixels_of(*map, 4).at(10, 9), 0);     // west: flat
  EXPECT_FLOAT_EQ(pixels_of(*map, 4).at(0, 9), -90);    // the border
  EXPECT_FLOAT_EQ(pixels_of(*map, 2).at(0, 0), -9999);  // the hole
  const auto points = run(flat + Names{"--azimuths", "4", "--clamp", "--at", "500105,5000105,25"});
  ASSERT_EQ(points.status, 0) << points.err;
  EXPECT_EQ(lines(points.out), 5);
  EXPECT_TRUE(points.out.starts_with("point,horizon_azimuth,horizon_elevation,distance\n1,0,0.000000,90.036"))
      << points.out;
  EXPECT_NE(points.out.find("\n1,90,14.0308"), std::string::npos) << points.out;  // atan(25 / 100.04)
}

// By the distances of all azimuths, which are bands of the same map.
TEST_F(SkyMaps, FarthestHorizonIsTheLargestDistance) {
  const Names horizon = on_dem("horizon") + Names{"--cc", "0", "--azimuths", "12", "--distance", "--farthest"};
  const auto result = run(horizon + Names{"-o", path("f.tif")});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto map = open(path("f.tif"));
  ASSERT_EQ(map->GetRasterCount(), 26);
  EXPECT_STREQ(map->GetRasterBand(25)->GetDescription(), "farthest distance");
  EXPECT_STREQ(map->GetRasterBand(25)->GetUnitType(), "m");
  EXPECT_STREQ(map->GetRasterBand(26)->GetDescription(), "farthest azimuth");
  std::vector<Pixels> bands;
  for (int band = 1; band <= 26; ++band) bands.push_back(pixels_of(*map, band));
  for (int row = 0; row < 20; ++row) {
    for (int col = 0; col < 30; ++col) {
      float distance = -9999, azimuth = -9999;
      for (std::size_t i = 0; i < 12; ++i)
        if (const float here = bands[12 + i].at(col, row); here > distance)
          distance = here, azimuth = 30 * static_cast<float>(i);
      EXPECT_EQ(bands[24].at(col, row), distance) << col << ", " << row;
      EXPECT_EQ(bands[25].at(col, row), azimuth) << col << ", " << row;
    }
  }
  // In row 9, 95 m and 9 rows from the border in the north, 100 m from the wall and 100 m from the border in the west:
  // at 60 degrees the wall is 100 m / sin 60 away. The middle of the raster is 150 m east of the zone's meridian,
  // at 45.15 degrees: north is turned by that.
  const double north = 150 / 6.389e6 * std::tan(45.15 / kDegrees);
  EXPECT_NEAR(static_cast<double>(bands[24].at(10, 9)), kWall / std::sin(60 / kDegrees - north), 2 * kWallError);
  EXPECT_EQ(bands[25].at(10, 9), 60);
  EXPECT_EQ(bands[24].at(0, 0), -9999);  // the hole
  // Without the bands of distances, the same.
  ASSERT_EQ(run(on_dem("horizon") + Names{"--cc", "0", "--azimuths", "12", "--farthest", "-o", path("g.tif")}).status,
            0);
  EXPECT_EQ(pixels_of(*open(path("g.tif")), 13).samples, bands[24].samples);
  expect_refused(on_dem("horizon") + Names{"--farthest", "--at", "500105,5000105"}, "--farthest cannot be combined");
}

TEST_F(SkyMaps, PackedAnglesAreWithinHalfAStep) {
  const Names horizon = on_dem("horizon") + Names{"--azimuths", "7", "--observer-height", "3"};
  ASSERT_EQ(run(horizon + Names{"-o", path("f.tif")}).status, 0);
  for (const Names& part : {Names{}, {"--part", "2/3"}}) {
    const auto result = run(horizon + part + Names{"--pack", "-o", path("p.tif")});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto floats = open(path("f.tif")), packed = open(path("p.tif"));
    ASSERT_EQ(packed->GetRasterCount(), 7);
    const int first = part.empty() ? 0 : 6, rows = packed->GetRasterYSize();  // 20 rows in parts of 6 or 7
    for (int band = 1; band <= 7; ++band) {
      GDALRasterBand& stored = *packed->GetRasterBand(band);
      EXPECT_EQ(stored.GetRasterDataType(), GDT_UInt16);
      EXPECT_EQ(stored.GetNoDataValue(), 65535);
      EXPECT_STREQ(stored.GetUnitType(), "degrees");
      EXPECT_STREQ(stored.GetDescription(), floats->GetRasterBand(band)->GetDescription());
      const double step = stored.GetScale();
      EXPECT_EQ(step, 0.003);
      const Pixels expected = pixels_of(*floats, band), samples = pixels_of(*packed, band);
      for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < 30; ++col) {
          const float angle = expected.at(col, row + first), sample = samples.at(col, row);
          if (angle == -9999) {
            EXPECT_EQ(sample, 65535) << col << ", " << row;
          } else {
            const double value = static_cast<double>(sample) * step + stored.GetOffset();
            // And the rounding of a float of up to 90.
            EXPECT_NEAR(value, static_cast<double>(angle), step / 2 + 0x1p-18) << col << ", " << row;
          }
        }
      }
    }
  }
  for (const char* option : {"--distance", "--farthest"})
    expect_refused(horizon + Names{"--pack", option, "-o", path("x.tif")}, "cannot be combined");
  expect_refused(on_dem("horizon") + Names{"--pack", "--at", "500105,5000105"}, "--pack cannot be combined with --at");
  expect_refused(on_dem("horizon") + Names{"--azimuths", "1", "--pack", "-o", path("x.xyz")},
                 "XYZ does not store the scale of packed samples");
}

TEST_F(SkyMaps, HorizonOfPointsKeepsTheirColumns) {
  const std::string table =
      scratch_.write("sites.csv", "name,x,y,z\n\"mast, north\",500105,5000105,25\nhut,500155,5000055,0\n");
  const Names flat = on_dem("horizon") + Names{"--cc", "0", "--azimuths", "4"};
  const auto result = run(flat + Names{"--points", table, "-o", path("h.csv")});
  ASSERT_EQ(result.status, 0) << result.err;
  const std::string points = text_of(path("h.csv"));
  EXPECT_TRUE(points.starts_with("name,point,horizon_azimuth,horizon_elevation,distance\n\"mast, north\",1,0,"))
      << points;
  // The same numbers as those of typed points.
  const auto typed = run(flat + Names{"--at", "500105,5000105,25", "--at", "500155,5000055", "-o", "-"});
  ASSERT_EQ(typed.status, 0) << typed.err;
  std::string without = points;
  for (const std::string name : {"\"mast, north\",", "hut,", "name,"})
    for (auto at = without.find(name); at != std::string::npos; at = without.find(name)) without.erase(at, name.size());
  EXPECT_EQ(without, typed.out);
}

TEST_F(SkyMaps, PointsHaveNoOptionsOfMaps) {
  for (const Names& option : {Names{"--of", "Foo"},
                              {"--co", "X=Y"},
                              {"--part", "3/2"},
                              {"--preview", path("p.png")},
                              {"--dry-run"},
                              {"--quiet"},
                              {"--distance"}}) {
    expect_refused(on_dem("horizon") + Names{"--at", "500105,5000105", "-o", path("x.csv")} + option,
                   option[0] + " cannot be combined with --at");
    expect_refused(on_dem("horizon") + Names{"--points", path("none.csv"), "-o", path("x.csv")} + option,
                   option[0] + " cannot be combined with --points");
  }
  expect_refused(on_dem("horizon") + Names{"-o", path("x.tif"), "--coords", "map"},
                 "--coords has no effect without --at or --points");
  for (const Names& map : maps())
    if (map[0] == "shadow" || map[0] == "skyview")
      expect_refused(map + Names{"-o", path("x.tif"), "--coords", "map"}, "unknown option '--coords'");
}

// The southern half of the model does not exist.
TEST_F(SkyMaps, PartsReadOnlyTheRowsThatTheyNeed) {
  const std::string half = R"(<SourceBand>1</SourceBand><SrcRect xOff="0" yOff="0" xSize="30" ySize="10"/>)";
  const std::string model = scratch_.write(
      "model.vrt",
      fmt::format(
          R"(<VRTDataset rasterXSize="30" rasterYSize="20"><SRS>EPSG:32633</SRS>)"
          R"(<GeoTransform>500000,10,0,5000200,0,-10</GeoTransform><VRTRasterBand dataType="Float32" band="1">)"
          R"(<SimpleSource><SourceFilename>{}</SourceFilename>{}<DstRect xOff="0" yOff="0" xSize="30" ySize="10"/>)"
          R"(</SimpleSource><SimpleSource><SourceFilename>{}</SourceFilename>{})"
          R"(<DstRect xOff="0" yOff="11" xSize="30" ySize="9"/></SimpleSource></VRTRasterBand></VRTDataset>)",
          dem_, half, path("missing.asc"), half));
  for (Names map : maps()) {
    if (map[0] == "viewshed" || map[0] == "shadow") continue;
    map[1] = model;
    const Names north = map + Names{"-o", path("north.tif"), "--part", "1/4"};
    // Rows 0 to 4, and floor(51 / 10) + 2 more.
    EXPECT_EQ(run(north + Names{"--max-distance", "51"}).status, 1) << map[0];
    const auto result = run(north + Names{"--max-distance", "39"});
    EXPECT_EQ(result.status, 0) << result.err;
  }
}

TEST_F(SkyMaps, MetadataStatesTheSettings) {
  const auto metadata = [&](const Names& words, const char* key) {
    EXPECT_EQ(run(words + Names{"-o", path("m.tif")}).status, 0);
    const auto map = open(path("m.tif"));
    const char* value = map->GetMetadataItem(key);
    return std::string(value ? value : "");
  };
  const Names horizon = on_dem("horizon") + Names{"--azimuths", "1", "--max-distance", "90"};
  EXPECT_EQ(metadata(horizon, "CLAMP"), "none");
  EXPECT_EQ(metadata(horizon + Names{"--clamp"}, "CLAMP"), "0 instead of angles below the horizontal");
  EXPECT_EQ(metadata(horizon, "MAX_DISTANCE"), "90 m");
#ifdef SCARP_ERFA
  const Names sun = on_dem("sunhours") + Names{"--step", "240", "--date", "2026-06-21"};
  EXPECT_EQ(metadata(sun, "DATES"), "2026-06-21");
  EXPECT_EQ(metadata(sun + Names{"--to", "2026-06-22"}, "DATES"), "2026-06-21 to 2026-06-22");
  EXPECT_EQ(metadata(sun, "REFRACTION"), "none");
  EXPECT_EQ(metadata(sun + Names{"--refraction"}, "REFRACTION"), "standard atmosphere");
  EXPECT_NE(run(sun + Names{"-o", path("m.tif")}).out.find("curvature coefficient"), std::string::npos);
#endif
}

// The top of the wall sees the whole sky, its foot a little more than the half away from it.
TEST_F(SkyMaps, SkyviewNamesItsMeasures) {
  const auto result = run(on_dem("skyview") + Names{"--cc", "0", "--measure", "sky-fraction", "--measure",
                                                    "positive-openness", "-o", path("s.tif")});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto map = open(path("s.tif"));
  ASSERT_EQ(map->GetRasterCount(), 2);
  EXPECT_STREQ(map->GetRasterBand(1)->GetDescription(), "sky-fraction");
  EXPECT_STREQ(map->GetRasterBand(2)->GetUnitType(), "degrees");
  EXPECT_STREQ(map->GetMetadataItem("FORMULA sky-fraction"), "mean of 1 - sin h, h the horizon, at least 0");
  const auto fraction = pixels_of(*map, 1), openness = pixels_of(*map, 2);
  EXPECT_FLOAT_EQ(fraction.at(20, 9), 1);
  EXPECT_GT(fraction.at(19, 9), 0.5f);
  EXPECT_LT(fraction.at(19, 9), 0.6f);
  EXPECT_GT(openness.at(20, 9), 90);
  EXPECT_EQ(fraction.at(0, 0), -9999);
}

TEST_F(SkyMaps, SweepsStateTheirError) {
  for (const Names& map : maps()) {
    if (map[0] == "viewshed" || map[0] == "shadow") continue;
    const Names sweep = map + Names{"--engine", "sweep", "-o", path("s.tif")};
    const auto result = run(sweep);
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.out.find(" angles compared with exact ones: 99 % within "), std::string::npos) << result.out;
    const auto swept = open(path("s.tif"));
    EXPECT_STREQ(swept->GetMetadataItem("ENGINE"), "sweep");
    EXPECT_TRUE(std::string(swept->GetMetadataItem("METHOD")).starts_with("horizons swept along lines")) << map[0];
    expect_refused(map + Names{"--engine", "sweep", "--max-distance", "50", "-o", path("x.tif")},
                   "--max-distance has no effect without --engine exact");
    const auto exact = run(map + Names{"-o", path("e.tif")});
    EXPECT_EQ(exact.out.find("compared"), std::string::npos) << exact.out;
    EXPECT_STREQ(open(path("e.tif"))->GetMetadataItem("ENGINE"), "exact");
  }
  // Over nodes of the grid, the sweep finds the same crossing.
  ASSERT_EQ(
      run(on_dem("horizon") + Names{"--cc", "0", "--azimuths", "4", "--engine", "sweep", "-o", path("h.tif")}).status,
      0);
  EXPECT_NEAR(static_cast<double>(pixels_of(*open(path("h.tif")), 2).at(10, 9)), kWallAngle, kAngleError);
  expect_refused(on_dem("horizon") + Names{"--at", "500105,5000105", "--engine", "sweep"},
                 "--engine cannot be combined with --at");
}

// 1,200 km near 60 degrees north in Mercator's projection: no metric plane fits to half a cell.
TEST_F(SkyMaps, SweepsWideRasters) {
  std::string text = "ncols 60\nnrows 60\nxllcorner 0\nyllcorner 7800000\ncellsize 20000\n";
  for (int i = 0; i < 60 * 60; ++i) text += fmt::format("{} ", 100 * (i % 7));
  const std::string wide = scratch_.write("wide.asc", text);
  const Names words{"skyview", wide, "--crs", "EPSG:3857", "--engine", "sweep", "-o", path("wide.tif")};
  expect_refused(words, "--plane-error");
  const auto result = run(words + Names{"--plane-error", "99"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("angles compared with exact ones"), std::string::npos) << result.out;
}

#ifdef SCARP_ERFA
TEST_F(SkyMaps, EnergyIsTheSumOfItsParts) {
  const Names sun = on_dem("sunhours") + Names{"--date", "2026-06-21", "--step", "6", "--cc", "0", "--energy"};
  const auto energy_of = [&](const Names& options) {
    const auto result = run(sun + options + Names{"-o", path("e.tif")});
    EXPECT_EQ(result.status, 0) << result.err;
    const auto map = open(path("e.tif"));
    EXPECT_EQ(map->GetRasterCount(), 5);
    EXPECT_STREQ(map->GetRasterBand(2)->GetDescription(), "energy 2026-06-21");
    EXPECT_STREQ(map->GetRasterBand(2)->GetUnitType(), "kWh/m2");
    std::vector<Pixels> bands;
    for (int band = 1; band <= 5; ++band) bands.push_back(pixels_of(*map, band));
    return bands;
  };
  const auto bands = energy_of({});
  for (int row = 0; row < 20; ++row) {
    for (int col = 0; col < 30; ++col) {
      const float parts = bands[2].at(col, row) + bands[3].at(col, row) + bands[4].at(col, row);
      EXPECT_FLOAT_EQ(bands[1].at(col, row), col + row == 0 ? -9999 : parts);
    }
  }
  // The level top of the wall sees the whole sky. r.sun of GRASS 8.2 has 7.547 and 1.279 kWh/m^2 there; its sun and the
  // one of ERFA are a tenth of a degree apart, and both sum in steps.
  EXPECT_NEAR(bands[2].at(20, 9), 7.547f, 0.01f * 7.547f);
  EXPECT_NEAR(bands[3].at(20, 9), 1.279f, 0.01f * 1.279f);
  EXPECT_EQ(bands[4].at(20, 9), 0);
  // The foot of the wall sees half of the sky, and the plain before it.
  EXPECT_LT(bands[3].at(19, 9), 0.9f * 1.279f);
  EXPECT_GT(bands[4].at(19, 9), 0.1f);
  const auto hazy = energy_of({"--linke", "6", "--albedo", "0"});
  EXPECT_LT(hazy[2].at(20, 9), 0.8f * bands[2].at(20, 9));
  EXPECT_GT(hazy[3].at(20, 9), 1.2f * bands[3].at(20, 9));
  EXPECT_EQ(hazy[4].at(19, 9), 0);
  // Half of the beam: half of that outside at the zenith, less below; and the sky is brighter.
  const auto half = energy_of({"--transmittance", "0.5"});
  EXPECT_LT(half[2].at(20, 9), 0.6f * bands[2].at(20, 9));
  EXPECT_GT(half[3].at(20, 9), bands[3].at(20, 9));
  EXPECT_STREQ(open(path("e.tif"))->GetMetadataItem("TRANSMITTANCE"), "0.5");
  EXPECT_EQ(open(path("e.tif"))->GetMetadataItem("LINKE_TURBIDITY"), nullptr);
  expect_refused(on_dem("sunhours") + Names{"--date", "2026-06-21", "--energy", "--linke", "2", "--transmittance",
                                            "0.5", "-o", path("x.tif")},
                 "cannot be combined");
  expect_refused(on_dem("sunhours") + Names{"--date", "2026-06-21", "--albedo", "0.5", "-o", path("x.tif")},
                 "--albedo has no effect without --energy");
}

// On a plain at 45.15 degrees north, the sun's centre is up for 2 acos(-tan(latitude) tan(declination)) / 15 degrees.
// Steps of a minute are off by one at both ends.
TEST_F(SkyMaps, SunHoursOfAPlainAreTheDay) {
  std::string text = "ncols 3\nnrows 3\nxllcorner 500000\nyllcorner 5000000\ncellsize 10\n";
  for (int i = 0; i < 9; ++i) text += "0 ";
  const std::string plain = scratch_.write("plain.asc", text);
  const auto result = run({"sunhours", plain, "--crs", "EPSG:32633", "--date", "2026-06-21", "--step", "1",
                           "--first-last", "-o", path("sun.tif")});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.err.find("UTC+01:00"), std::string::npos) << result.err;
  const auto map = open(path("sun.tif"));
  ASSERT_EQ(map->GetRasterCount(), 3);
  constexpr double kRadian = 0.017453292519943295;
  const double day = 2 * std::acos(-std::tan(45.1529 * kRadian) * std::tan(23.437 * kRadian)) / kRadian / 15;
  EXPECT_NEAR(static_cast<double>(pixels_of(*map, 1).at(1, 1)), day, 2.0 / 60);
  const double first = static_cast<double>(pixels_of(*map, 2).at(1, 1));
  const double last = static_cast<double>(pixels_of(*map, 3).at(1, 1));
  EXPECT_NEAR(last - first, day, 3.0 / 60);
  // Solar noon at 15 degrees east: the equation of time is 1.9 minutes, and each end is off by half a step at most.
  EXPECT_NEAR((first + last) / 2, 12, 3.0 / 60);
}

// The sum of masks is the hours of the same steps.
TEST_F(SkyMaps, MasksOfStepsAddUpToHours) {
  for (const char* engine : {"exact", "sweep"}) {
    const Names sun = on_dem("sunhours") + Names{"--date", "2026-12-21", "--step", "30", "--engine", engine};
    ASSERT_EQ(run(sun + Names{"-o", path("hours.tif")}).status, 0);
    const auto result = run(sun + Names{"--masks", "-o", path("masks.tif")});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto hours = open(path("hours.tif")), masks = open(path("masks.tif"));
    EXPECT_NE(result.out.find(fmt::format("{} steps with the sun up", masks->GetRasterCount())), std::string::npos);
    EXPECT_EQ(masks->GetRasterBand(1)->GetRasterDataType(), GDT_Byte);
    // The day is 8.6 hours long and noon at 11:58.
    EXPECT_STREQ(masks->GetRasterBand(1)->GetDescription(), "sun 2026-12-21 07:45");
    EXPECT_EQ(masks->GetRasterCount(), 17);
    const Pixels all = pixels_of(*hours);
    std::vector<float> sum(all.samples.size());
    for (int band = 1; band <= masks->GetRasterCount(); ++band) {
      const Pixels mask = pixels_of(*masks, band);
      EXPECT_EQ(mask.at(0, 0), 255);
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += mask.samples[i] / 2;
    }
    for (std::size_t i = 1; i < sum.size(); ++i) ASSERT_EQ(sum[i], all.samples[i]) << i;
    EXPECT_LT(all.at(19, 9), all.at(5, 9));
  }
  expect_refused(on_dem("sunhours") + Names{"--date", "2026-06-21", "--masks", "--energy", "-o", path("x.tif")},
                 "--masks cannot be combined with --energy");
  expect_refused({"sunhours", dem_, "--crs", "EPSG:32633", "--bounds=500000,8900000,500300,8900200", "--date",
                  "2026-12-21", "--masks", "-o", path("x.tif")},
                 "the sun does not rise on 2026-12-21");
}

TEST_F(SkyMaps, RefusesAMillionStepsWithTheirCost) {
  expect_refused(
      on_dem("sunhours") + Names{"--date", "2026-01-01", "--to", "2027-12-31", "--step", "1", "-o", path("x.tif")},
      "1051200 positions of the sun would take about");
}

// Before anything is opened: there is no model.
TEST_F(SkyMaps, SunHoursValidatesDates) {
  const Names sun{"sunhours", path("none.tif"), "-o", path("x.tif"), "--dry-run"};
  expect_refused(sun, "--date DATE is required");
  for (const char* date : {"2026-02-30", "2026- 6-21", "1800-06-21", "2026-6-21", "2026-06-21T12:00", "today", ""})
    expect_refused(sun + Names{"--date", date}, fmt::format("--date '{}': expected a date from 1900 to 2100", date));
  const Names day = sun + Names{"--date", "2026-06-21"};
  expect_refused(day + Names{"--to", "2101-01-01"}, "--to '2101-01-01': expected a date");
  expect_refused(day + Names{"--to", "2026-06-20"}, "is before");
  for (const char* offset : {"5", "+ 4: 5", "+15:00"})
    expect_refused(day + Names{"--utc-offset", offset}, fmt::format("--utc-offset '{}': expected +HH:MM", offset));
  expect_refused(day, "none.tif");
  expect_refused({"sunhours", dem_, "--crs", "none", "--date", "2026-06-21", "-o", path("x.tif")}, "CRS");
}
#endif

TEST_F(SkyMaps, ReportBadInputInOneLineWithoutOutput) {
  const std::string out = path("x.tif");
  expect_refused(on_dem("horizon"), "-o FILE is required");
  expect_refused(on_dem("horizon") + Names{"-o", out, "--azimuths", "0"}, "--azimuths");
  expect_refused(on_dem("horizon") + Names{"--at", "500005,5000195"}, "the point is over a hole");
  expect_refused(on_dem("horizon") + Names{"--at", "500105,5000105,-2"}, "at least 0 metres");
  expect_refused(on_dem("horizon") + Names{"--at", "500105,5000105", "-o", out}, "expected .csv");
  expect_refused(on_dem("skyview") + Names{"-o", out, "--measure", "svf"}, "--measure");
  expect_refused(on_dem("skyview") + Names{"-o", path("x.png")}, "cannot store Float32 samples");
}

}  // namespace
}  // namespace scarp::test
