// SPDX-License-Identifier: MIT
// Several files as one raster.
#include <cmath>
#include <limits>
#include <utility>

#include "source/files.h"

namespace scarp {
namespace {

using namespace test;

constexpr double kHole = std::numeric_limits<double>::quiet_NaN();

class TileSet : public Files {
 protected:
  // A tile of 2 x 2 samples whose north-west corner is `col` columns and `row` rows from that of the map.
  std::string tile(const std::string& name, double col, double row, std::vector<double> samples = {1, 2, 3, 4},
                   GDALDataType type = GDT_Int16, const std::function<void(GDALDataset&)>& edit = {}, int bands = 1,
                   const std::vector<const char*>& options = {}) const {
    return write_tiff(
        name, type, 2, 2, std::move(samples),
        [&](GDALDataset& d) {
          double map[] = {500000 + 10 * col, 10, 0, 4000000 - 10 * row, 0, -10};
          d.SetGeoTransform(map);
          OGRSpatialReference crs;
          crs.importFromEPSG(32610);
          d.SetSpatialRef(&crs);
          if (edit) edit(d);
        },
        bands, options);
  }
  static std::function<void(GDALDataset&)> nodata(double value) {
    return [value](GDALDataset& d) { d.GetRasterBand(1)->SetNoDataValue(value); };
  }

  // The samples with NaN for every hole.
  static std::vector<double> holes_as_nan(const Raster& raster) {
    std::vector<double> samples = doubles(raster);
    for (double& sample : samples) {
      if (raster.nodata && sample == *raster.nodata) sample = kHole;
    }
    return samples;
  }
  static void expect_samples(const Raster& raster, const std::vector<double>& expected) {
    const std::vector<double> samples = holes_as_nan(raster);
    ASSERT_EQ(expected.size(), samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (std::isnan(expected[i])) {
        EXPECT_TRUE(std::isnan(samples[i])) << i << ": " << samples[i];
      } else {
        EXPECT_EQ(expected[i], samples[i]) << i;
      }
    }
  }

  // One line that names the file, and contains `part`.
  static void expect_refused(const std::vector<std::string>& files, const std::string& file, const std::string& part,
                             const RasterOptions& options = {}) {
    const std::string text = error_of([&] { read_tiles(files, options); });
    expect_says(text, file + ": ");
    expect_says(text, part);
  }
};

TEST_F(TileSet, JoinsAdjacentTilesKeepingTheirType) {
  const Raster raster = read_tiles({tile("b.tif", 2, 0, {5, 6, 7, 8}), tile("a.tif", 0, 0)}, {});
  EXPECT_EQ(4, raster.cols);
  EXPECT_EQ(2, raster.rows);
  EXPECT_TRUE(holds<std::int16_t>(raster));
  EXPECT_FALSE(raster.nodata);
  EXPECT_EQ("Int16", raster.file_type);
  expect_samples(raster, {1, 2, 5, 6, 3, 4, 7, 8});
  EXPECT_EQ(path("b.tif") + ", " + path("a.tif"), raster.path);
  EXPECT_TRUE(has_note(raster, "combined 2 tiles into a raster of 4 x 2"));
  EXPECT_FALSE(has_note(raster, "gaps"));
  EXPECT_EQ(500005, raster.georeference.map_from_node[0]);
  EXPECT_EQ(3999995, raster.georeference.map_from_node[3]);
  EXPECT_EQ("WGS 84 / UTM zone 10N (EPSG:32610)", raster.georeference.crs_name);
}

TEST_F(TileSet, JoinsTilesAcrossTheAntimeridian) {
  const auto at = [&](const std::string& name, double west, const char* crs, std::vector<double> samples) {
    return tile(name, 0, 0, std::move(samples), GDT_Int16, [=](GDALDataset& d) {
      double map[] = {west, 0.5, 0, 50, 0, -0.5};
      d.SetGeoTransform(map);
      OGRSpatialReference srs;
      if (crs) {
        EXPECT_EQ(OGRERR_NONE, srs.SetFromUserInput(crs));
      }
      d.SetSpatialRef(crs ? &srs : nullptr);
    });
  };
  for (const char* crs : {"EPSG:4326", static_cast<const char*>(nullptr)}) {
    const Raster raster = read_tiles({at("w.tif", -180, crs, {5, 6, 7, 8}), at("e.tif", 179, crs, {1, 2, 3, 4})}, {});
    expect_samples(raster, {1, 2, 5, 6, 3, 4, 7, 8});
    EXPECT_EQ(179.25, raster.georeference.map_from_node[0]);
    EXPECT_TRUE(has_note(raster, "moved 1 of 2 tiles by a full circle of longitude"));
    EXPECT_FALSE(has_note(raster, "gaps"));
  }
  // Maps in metres do not wrap around, for any bounds.
  RasterOptions metres;
  metres.crs = "none";
  EXPECT_EQ(720, read_tiles({path("w.tif"), path("e.tif")}, metres).cols);
  EXPECT_EQ(
      4, read_tiles({at("a.tif", -1, "EPSG:4326", {1, 2, 3, 4}), at("b.tif", 0, "EPSG:4326", {1, 2, 3, 4})}, {}).cols);
}

TEST_F(TileSet, FolderStandsForItsRastersInNameOrder) {
  std::filesystem::create_directory(path("tiles"));
  tile("tiles/b.tif", 2, 0, {5, 6, 7, 8});
  tile("tiles/a.tif", 0, 0);
  write("tiles/README.txt", "hello");
  write("tiles/.hidden.tif", "hello");
  std::filesystem::create_directory(path("tiles/sub"));
  const Raster raster = read_raster(path("tiles"), {});
  expect_samples(raster, {1, 2, 5, 6, 3, 4, 7, 8});
  EXPECT_EQ(path("tiles"), raster.path);
  EXPECT_TRUE(has_note(raster, "skipped files that are not rasters: " + path("tiles/README.txt")));
  expect_samples(read_tiles({path("tiles"), tile("c.tif", 0, 2, {9, 9, 9, 9})}, {}),
                 {1, 2, 5, 6, 3, 4, 7, 8, 9, 9, kHole, kHole, 9, 9, kHole, kHole});
}

TEST_F(TileSet, SkipsPicturesInAFolder) {
  std::filesystem::create_directory(path("tiles"));
  tile("tiles/b.tif", 2, 0, {5, 6, 7, 8});
  tile("tiles/a.tif", 0, 0);
  const auto picture = [&](const std::string& name, int bands, const std::function<void(GDALDataset&)>& edit = {}) {
    return write_tiff(name, GDT_Byte, 2, 2, {1, 2, 3, 4}, edit, bands, {bands == 1 ? nullptr : "PHOTOMETRIC=RGB"});
  };
  const std::string colours = picture("tiles/0.tif", 3);
  expect_samples(read_raster(path("tiles"), {}), {1, 2, 5, 6, 3, 4, 7, 8});
  EXPECT_TRUE(has_note(read_raster(path("tiles"), {}), "skipped pictures without a georeference: " + colours));
  picture("tiles/1.tif", 1, [](GDALDataset& d) {
    GDALColorTable table;
    const GDALColorEntry red{255, 0, 0, 255};
    table.SetColorEntry(1, &red);
    d.GetRasterBand(1)->SetColorTable(&table);
  });
  picture("tiles/c.tif", 4);
  EXPECT_TRUE(
      has_note(read_raster(path("tiles"), {}), "skipped pictures without a georeference: " + colours + " and 2 more"));

  // If the caller says that colours are heights, or names an image, it is read.
  RasterOptions options;
  options.band = 1;
  expect_says(error_of([&] { read_raster(path("tiles"), options); }), "0.tif: no georeference");
  options = {};
  options.encoding = HeightEncoding::terrarium;
  expect_says(error_of([&] { read_raster(path("tiles"), options); }), "0.tif: no georeference");
  expect_refused({colours, path("tiles/a.tif")}, colours, "colour photograph");

  // A georeferenced image is not a finished figure, but an error to be reported.
  tile("tiles/d.tif", 4, 0, {1, 2, 3, 4}, GDT_Byte, {}, 3, {"PHOTOMETRIC=RGB"});
  expect_says(error_of([&] { read_raster(path("tiles"), {}); }), "d.tif: colour photograph");

  std::filesystem::create_directory(path("album"));
  picture("album/a.tif", 3);
  const std::string text = read_error(path("album"));
  expect_says(text, "folder of pictures without a georeference, such as '" + path("album/a.tif") + "'");
  expect_says(text, "--encoding");
}

TEST_F(TileSet, SkipsSidecarFilesInAFolder) {
  std::filesystem::create_directory(path("tiles"));
  const std::string file = tile("tiles/a.tif", 0, 0);
  {
    GDALDatasetUniquePtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
    int levels[] = {2};
    EXPECT_EQ(CE_None, dataset->BuildOverviews("NEAREST", 1, levels, 0, nullptr, nullptr, nullptr));
  }
  ASSERT_TRUE(std::filesystem::exists(file + ".ovr"));
  const Raster raster = read_raster(path("tiles"), {});
  expect_samples(raster, {1, 2, 3, 4});
  EXPECT_EQ(file, raster.path);
}

TEST_F(TileSet, RejectsAFolderWithoutRasters) {
  std::filesystem::create_directory(path("none"));
  expect_says(read_error(path("none")), "folder without a raster");
  write("none/README.txt", "hello");
  expect_says(read_error(path("none")), "folder without a raster");
  expect_refused({path("none"), tile("a.tif", 0, 0)}, path("none"), "folder without a raster");
  expect_says(error_of([] { read_tiles({}, {}); }), "no raster given");
}

TEST_F(TileSet, GapsTakeTheNodataValueOfTheTiles) {
  const Raster raster = read_tiles({tile("a.tif", 0, 0, {1, 2, 3, -9}, GDT_Int16, nodata(-9)),
                                    tile("b.tif", 2, 2, {5, 6, 7, 8}, GDT_Int16, nodata(-9))},
                                   {});
  EXPECT_TRUE(holds<std::int16_t>(raster));
  EXPECT_EQ(-9, raster.nodata);
  expect_samples(raster, {1, 2, kHole, kHole, 3, kHole, kHole, kHole, kHole, kHole, 5, 6, kHole, kHole, 7, 8});
  EXPECT_TRUE(has_note(raster, "gaps between tiles: 8 samples (50 %) are holes"));
}

TEST_F(TileSet, GapsAreNanWithoutNodata) {
  const struct {
    GDALDataType type;
    std::vector<double> samples;
  } cases[] = {{GDT_Byte, {0, 255, 1, 2}},
               {GDT_Int16, {-32768, 32767, 0, 1}},
               {GDT_UInt16, {0, 65535, 1, 2}},
               {GDT_Int32, {-16777216, 16777216, 0, 1}},
               {GDT_Float32, {-0x1p99, 0x1p99, 0, 1}},
               {GDT_Float64, {-0x1p99, 0x1p99, 0, 1}}};
  for (const auto& c : cases) {
    const Raster raster =
        read_tiles({tile("a.tif", 0, 0, c.samples, c.type), tile("b.tif", 4, 0, c.samples, c.type)}, {});
    EXPECT_TRUE(holds<float>(raster));
    EXPECT_EQ(GDALGetDataTypeName(c.type), raster.file_type);
    const std::vector<double>& f = c.samples;
    expect_samples(raster, {f[0], f[1], kHole, kHole, f[0], f[1], f[2], f[3], kHole, kHole, f[2], f[3]});
    EXPECT_TRUE(has_note(raster, "gaps between tiles: 4 samples (33.3 %)"));
  }
}

TEST_F(TileSet, LaterTilesWinExceptAtHoles) {
  const std::string a = tile("a.tif", 0, 0, {1, 2, 3, 4}, GDT_Int16, nodata(-9)),
                    b = tile("b.tif", 1, 0, {-9, 6, 7, 8}, GDT_Int16, nodata(-9));
  expect_samples(read_tiles({a, b}, {}), {1, 2, 6, 3, 7, 8});
  expect_samples(read_tiles({b, a}, {}), {1, 2, 6, 3, 4, 8});
}

TEST_F(TileSet, CallersNodataResolvesConflicts) {
  const std::string a = tile("a.tif", 0, 0, {1, 2, 3, 4}, GDT_Int16, nodata(-9)), b = tile("b.tif", 2, 2, {5, 6, 7, 8});
  expect_refused({a, b}, b, "nodata value is none, but that of '" + a + "' is -9");
  RasterOptions options;
  options.nodata = 4;
  const Raster raster = read_tiles({a, b}, options);
  EXPECT_EQ(4, raster.nodata);
  expect_samples(raster, {1, 2, kHole, kHole, 3, kHole, kHole, kHole, kHole, kHole, 5, 6, kHole, kHole, 7, 8});
  // A value that the sample type cannot hold does not mark gaps.
  options.nodata = 40000;
  EXPECT_TRUE(std::isnan(doubles(read_tiles({a, b}, options))[2]));
}

TEST_F(TileSet, MaskDoesNotHideTilesBelow) {
  const GdalOption inside("GDAL_TIFF_INTERNAL_MASK", "YES");
  const std::string a = tile("a.tif", 0, 0),
                    b = tile("b.tif", 1, 0, {5, 6, 7, 8}, GDT_Int16, [](GDALDataset&d) {
                      d.CreateMaskBand(GMF_PER_DATASET);
                      std::uint8_t mask[] = {0, 255, 255, 0};
                      EXPECT_EQ(CE_None, d.GetRasterBand(1)->GetMaskBand()->RasterIO(GF_Write, 0, 0, 2, 2, mask, 2, 2,
                                                                                     GDT_Byte, 0, 0, nullptr));
                    });
  expect_samples(read_tiles({a, b}, {}), {1, 2, 6, 3, 7, kHole});
}

TEST_F(TileSet, DecodesEncodedHeightsAfterJoining) {
  const auto colours = [&](const std::string& name, double col, double value, bool alpha) {
    return tile(name, col, 0, {value, value, value, value}, GDT_Byte,
                [&](GDALDataset& d) {
                  // The pixel in the south-east is transparent.
                  std::uint8_t opacity[] = {255, 255, 255, 0};
                  if (!alpha) return;
                  EXPECT_EQ(CE_None,
                            d.GetRasterBand(4)->RasterIO(GF_Write, 0, 0, 2, 2, opacity, 2, 2, GDT_Byte, 0, 0, nullptr));
                },
                alpha ? 4 : 3, {"PHOTOMETRIC=RGB", alpha ? "ALPHA=YES" : "INTERLEAVE=PIXEL"});
  };
  RasterOptions options;
  options.encoding = HeightEncoding::terrarium;
  const auto n = [](int value) { return value * 65536.0 + value * 256 + value; };
  const Raster raster = read_tiles({colours("a.tif", 0, 1, false), colours("b.tif", 3, 0, false)}, options);
  EXPECT_EQ("terrarium", raster.file_type);
  expect_samples(raster, {n(1), n(1), kHole, 0, 0, n(1), n(1), kHole, 0, 0});
  const std::string c = colours("c.tif", 0, 1, true), d = colours("d.tif", 1, 2, true);
  expect_samples(read_tiles({c, d}, options), {n(1), n(2), n(2), n(1), n(2), kHole});
  expect_samples(read_tiles({d, c}, options), {n(1), n(1), n(2), n(1), n(2), kHole});
  expect_refused({c, path("a.tif")}, path("a.tif"), "number of bands is 3", options);
  expect_refused({c, tile("g.tif", 0, 0)}, path("g.tif"), "terrarium needs byte bands", options);
}

TEST_F(TileSet, HeightRangeUsesTheTypeOfTheTiles) {
  RasterOptions options;
  options.height_range = {0, 65535};
  const std::vector<double> values{0, 65535, 1, 2};
  const Raster raster =
      read_tiles({tile("a.tif", 0, 0, values, GDT_UInt16), tile("b.tif", 4, 0, values, GDT_UInt16)}, options);
  EXPECT_TRUE(holds<float>(raster));
  EXPECT_EQ(1, raster.scale);
}

TEST_F(TileSet, KeepsScaleUnitAndBand) {
  const auto feet = [](GDALDataset& d) {
    d.GetRasterBand(1)->SetScale(2);
    d.GetRasterBand(1)->SetOffset(5);
    d.GetRasterBand(1)->SetUnitType("ft");
  };
  const Raster raster = read_tiles(
      {tile("a.tif", 0, 0, {1, 2, 3, 4}, GDT_Int16, feet), tile("b.tif", 2, 0, {1, 2, 3, 4}, GDT_Int16, feet)}, {});
  EXPECT_DOUBLE_EQ(2 * 0.3048, raster.scale);
  EXPECT_DOUBLE_EQ(5 * 0.3048, raster.offset);
  expect_refused({path("a.tif"), tile("c.tif", 2, 0)}, path("c.tif"), "scale is");
  RasterOptions options;
  options.band = 2;
  const auto second = [](GDALDataset& d) { d.GetRasterBand(2)->Fill(77); };
  expect_samples(read_tiles({tile("d.tif", 0, 0, {1, 2, 3, 4}, GDT_Int16, second, 2),
                             tile("e.tif", 2, 0, {1, 2, 3, 4}, GDT_Int16, second, 2)},
                            options),
                 std::vector<double>(8, 77));
  expect_refused({path("d.tif"), path("e.tif")}, path("d.tif"), "--band 1..2");
}

TEST_F(TileSet, WindowsApplyToTheJoinedRaster) {
  RasterOptions options;
  options.window = {1, 1, 2, 1};
  expect_samples(read_tiles({tile("a.tif", 0, 0), tile("b.tif", 2, 0, {5, 6, 7, 8})}, options), {4, 7});
}

TEST_F(TileSet, RejectsMismatchedTilesByName) {
  const std::string a = tile("a.tif", 0, 0);
  const auto crs = [](GDALDataset& d) {
    OGRSpatialReference other;
    other.importFromEPSG(32611);
    d.SetSpatialRef(&other);
  };
  expect_refused({a, tile("b.tif", 2, 0, {1, 2, 3, 4}, GDT_Int16, crs)}, path("b.tif"),
                 "CRS is WGS 84 / UTM zone 11N, but that of '" + a + "' is WGS 84 / UTM zone 10N");
  expect_refused({a, tile("c.tif", 2, 0, {1, 2, 3, 4}, GDT_Float32)}, path("c.tif"), "sample type is Float32");
  const auto place = [](double x, double dx, double shear, double y, double dy) {
    return [=](GDALDataset& d) {
      double map[] = {x, dx, shear, y, 0, dy};
      d.SetGeoTransform(map);
    };
  };
  const auto placed = [&](const std::string& name, const std::function<void(GDALDataset&)>& edit) {
    return tile(name, 0, 0, {1, 2, 3, 4}, GDT_Int16, edit);
  };
  expect_refused({a, placed("d.tif", place(500020, 20, 0, 4000000, -20))}, path("d.tif"), "cell size is 20 x 20");
  expect_refused({a, placed("e.tif", place(500023, 10, 0, 4000000, -10))}, path("e.tif"), "offset by 0.3 of a cell");
  expect_refused({a, placed("f.tif", place(500020, 10, 0, 4000000, 10))}, path("f.tif"), "north-up");
  expect_refused({a, placed("g.tif", place(500020, 10, 3, 4000000, -10))}, path("g.tif"), "rotated");
  expect_refused({a, placed("h.tif", place(1e15, 10, 0, 4000000, -10))}, path("h.tif"), "too far");
  expect_refused({a, write_tiff("i.tif", GDT_Int16, 2, 2, {1, 2, 3, 4})}, path("i.tif"), "no georeference");
  expect_refused({a, path("none.tif")}, path("none.tif"), "does not exist");
  expect_refused({a, write("j.tif", "")}, path("j.tif"), "0 bytes");
  expect_refused({a, write("k.npy", "")}, path("k.npy"), "no georeference");
  expect_refused({a, write("l.exr", "")}, path("l.exr"), "no georeference");
  RasterOptions raw;
  raw.raw = parse_raw_format("2x2:u8");
  expect_refused({a, a}, a, "no georeference", raw);
}

TEST_F(TileSet, AcceptsRoundedGeoreferences) {
  const auto close = [](GDALDataset& d) {
    double map[] = {500020.005, 10.0001, 0, 4000000, 0, -10};
    d.SetGeoTransform(map);
  };
  expect_samples(read_tiles({tile("a.tif", 0, 0), tile("b.tif", 0, 0, {5, 6, 7, 8}, GDT_Int16, close)}, {}),
                 {1, 2, 5, 6, 3, 4, 7, 8});
}

TEST_F(TileSet, RejectsADamagedTile) {
  std::vector<double> noise(200 * 200);
  for (std::size_t i = 0; i < noise.size(); ++i) noise[i] = static_cast<double>(i * i * 7919 % 65521);
  const auto big = [&](const std::string& name, double x) {
    return write_tiff(name, GDT_UInt16, 200, 200, noise, [&](GDALDataset& d) {
      double map[] = {x, 1, 0, 0, 0, -1};
      d.SetGeoTransform(map);
    });
  };
  const std::string a = big("a.tif", 0), b = big("b.tif", 200);
  EXPECT_NO_THROW(read_tiles({a, b}, {}));
  std::filesystem::resize_file(b, std::filesystem::file_size(b) / 2);
  error_of([&] { read_tiles({a, b}, {}); });
}

TEST_F(TileSet, ReadsManyTiles) {
  std::vector<std::string> files;
  for (int i = 0; i < 400; ++i) {
    const double v = i;
    files.push_back(tile(fmt::format("{}.tif", i), i % 20 * 2, static_cast<double>(i / 20) * 2, {v, v, v, v}));
  }
  const Raster raster = read_tiles(files, {});
  EXPECT_EQ(40, raster.cols);
  const std::vector<double> samples = doubles(raster);
  for (int row = 0; row < 40; ++row) {
    for (int col = 0; col < 40; ++col)
      ASSERT_EQ(row / 2 * 20 + col / 2, samples[static_cast<std::size_t>(row * 40 + col)]);
  }
  EXPECT_TRUE(raster.path.ends_with("and 397 more")) << raster.path;
}

}  // namespace
}  // namespace scarp
