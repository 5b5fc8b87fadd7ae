// SPDX-License-Identifier: MIT
// Samples, holes, heights: the content of valid files.
#include <cmath>
#include <limits>

#include "source/files.h"
#include "source/npy_bytes.h"

namespace scarp {
namespace {

using namespace test;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class GdalRaster : public Files {};

std::function<void(GDALDataset&)> nodata(double value) {
  return [value](GDALDataset& d) { d.GetRasterBand(1)->SetNoDataValue(value); };
}

TEST_F(GdalRaster, KeepsInt16UInt16AndFloat32) {
  const std::vector<double> values{1, 2, 300, 4, 5, 6};
  EXPECT_TRUE(holds<std::int16_t>(read_raster(write_tiff("a.tif", GDT_Int16, 3, 2, values), {})));
  EXPECT_TRUE(holds<std::uint16_t>(read_raster(write_tiff("b.tif", GDT_UInt16, 3, 2, values), {})));
  const Raster raster = read_raster(write_tiff("c.tif", GDT_Float32, 3, 2, values), {});
  EXPECT_TRUE(holds<float>(raster));
  EXPECT_EQ(values, doubles(raster));
  EXPECT_EQ(3, raster.cols);
  EXPECT_EQ(2, raster.rows);
  EXPECT_EQ("Float32", raster.file_type);
  EXPECT_EQ(path("c.tif"), raster.path);
}

TEST_F(GdalRaster, WidensBytesWithANote) {
  const Raster bytes = read_raster(write_tiff("a.tif", GDT_Byte, 2, 2, {0, 1, 200, 255}), {});
  EXPECT_TRUE(holds<std::uint16_t>(bytes));
  EXPECT_TRUE(has_note(bytes, "kept as uint16"));
  EXPECT_EQ((std::vector<double>{0, 1, 200, 255}), doubles(bytes));
}

TEST_F(GdalRaster, ReadsSignedBytesWithTheirSign) {
  // -128 and 5 as bytes, with GDAL metadata that marks them as signed.
  const std::string file = write_tiff(
      "a.tif", GDT_Byte, 2, 2, {128, 5, 255, 0},
      [](GDALDataset& d) { d.GetRasterBand(1)->SetMetadataItem("PIXELTYPE", "SIGNEDBYTE", "IMAGE_STRUCTURE"); }, 1,
      {"PIXELTYPE=SIGNEDBYTE"});
  const Raster raster = read_raster(file, {});
  EXPECT_TRUE(holds<std::int16_t>(raster));
  EXPECT_EQ((std::vector<double>{-128, 5, -1, 0}), doubles(raster));
}

TEST_F(GdalRaster, NarrowsWideTypesAndReportsTheRounding) {
  const Raster whole = read_raster(write_tiff("a.tif", GDT_Int32, 2, 1, {16777216, -5}), {});
  EXPECT_TRUE(holds<float>(whole));
  EXPECT_TRUE(has_note(whole, "without rounding"));
  const Raster rounded = read_raster(write_tiff("b.tif", GDT_UInt32, 2, 1, {16777217, 5}), {});
  EXPECT_TRUE(has_note(rounded, "rounded by at most 1"));
  EXPECT_TRUE(has_note(read_raster(write_tiff("c.tif", GDT_Float64, 2, 1, {0.1, 5}), {}),
                       "Float64 samples converted to float32, rounded by at most 1.49e-09"));
}

TEST_F(GdalRaster, RejectsComplexSamples) {
  expect_says(read_error(write_tiff("a.tif", GDT_CFloat32, 2, 1, {1, 2})), "complex");
}

TEST_F(GdalRaster, KeepsTheNodataValue) {
  const Raster raster = read_raster(write_tiff("a.tif", GDT_Int16, 2, 1, {-32768, 7}, nodata(-32768)), {});
  EXPECT_EQ(-32768, raster.nodata);
}

TEST_F(GdalRaster, CallersNodataTakesPrecedence) {
  RasterOptions options;
  options.nodata = 7;
  const Raster raster = read_raster(write_tiff("a.tif", GDT_Int16, 2, 1, {-32768, 7}, nodata(-32768)), options);
  EXPECT_EQ(7, raster.nodata);
  options.nodata = kNan;
  EXPECT_FALSE(read_raster(path("a.tif"), options).nodata.has_value());
}

TEST_F(GdalRaster, IgnoresNodataOutsideTheType) {
  const Raster raster = read_raster(write_tiff("a.tif", GDT_UInt16, 2, 1, {1, 7}, nodata(-9999)), {});
  EXPECT_FALSE(raster.nodata.has_value());
  EXPECT_TRUE(has_note(raster, "cannot occur"));
}

TEST_F(GdalRaster, MatchesRoundedNodataNearTheLargestFloat) {
  const double exact = -std::numeric_limits<float>::max();
  const Raster raster = read_raster(write_tiff("a.tif", GDT_Float32, 2, 1, {exact, 7}, nodata(-3.402823e+38)), {});
  ASSERT_TRUE(raster.nodata.has_value());
  EXPECT_EQ(static_cast<float>(*raster.nodata), std::get<std::vector<float>>(raster.samples)[0]);
  EXPECT_EQ(7, doubles(raster)[1]);
}

TEST_F(GdalRaster, MatchesSixDigitNodataFarFromHeights) {
  const double mark = -std::numeric_limits<float>::max();
  const Raster raster = read_raster(write_tiff("a.tif", GDT_Float32, 2, 1, {mark, 7}, nodata(-3.40282e+38)), {});
  ASSERT_TRUE(raster.nodata.has_value());
  EXPECT_EQ(static_cast<float>(*raster.nodata), std::get<std::vector<float>>(raster.samples)[0]);
  const Raster heights = read_raster(write_tiff("b.tif", GDT_Float32, 2, 1, {1000.004, 7}, nodata(1000)), {});
  EXPECT_NE(static_cast<float>(*heights.nodata), std::get<std::vector<float>>(heights.samples)[0]);
}

TEST_F(GdalRaster, NodataThatUnderflowsFloatIsNotZero) {
  RasterOptions options;
  options.nodata = 1e-50;
  const Raster raster = read_raster(write_tiff("a.tif", GDT_Float32, 2, 1, {0, 7}), options);
  EXPECT_FALSE(raster.nodata.has_value()) << *raster.nodata;
  EXPECT_EQ(doubles(raster)[0], 0);
}

TEST_F(GdalRaster, DoubleNodataBeyondFloatBecomesNan) {
  const Raster raster = read_raster(
      write_tiff("a.tif", GDT_Float64, 2, 1, {-1.7976931348623157e308, 7}, nodata(-1.7976931348623157e308)), {});
  EXPECT_TRUE(std::isnan(doubles(raster)[0]));
  EXPECT_FALSE(raster.nodata.has_value());
}

TEST_F(GdalRaster, NanIsAHoleWithANote) {
  const Raster raster = read_raster(write_tiff("a.tif", GDT_Float32, 2, 1, {kNan, 7}), {});
  EXPECT_TRUE(std::isnan(doubles(raster)[0]));
  EXPECT_TRUE(has_note(raster, "1 samples are NaN"));
}

TEST_F(GdalRaster, RejectsInfiniteSamplesWithTheirPosition) {
  const std::string text = read_error(write_tiff("a.tif", GDT_Float32, 2, 2, {1, 2, 3, kInf}));
  expect_says(text, "column 1, row 1");
  expect_says(text, "--nodata=inf");
  expect_says(read_error(write_tiff("b.tif", GDT_Float64, 2, 2, {1, -kInf, 3, 4})), "column 1, row 0");
  RasterOptions options;
  options.nodata = kNan;
  expect_says(read_error(write_tiff("c.tif", GDT_Float64, 2, 2, {1, 1e300, 3, 4}), options), "beyond float32");
}

TEST_F(GdalRaster, InfiniteSamplesAreHolesWhenDeclaredNodata) {
  RasterOptions options;
  options.nodata = kInf;
  const std::string file = write_tiff("a.tif", GDT_Float32, 2, 2, {1, 2, 3, kInf});
  const Raster raster = read_raster(file, options);
  EXPECT_EQ(3, doubles(raster)[2]);
  EXPECT_TRUE(std::isnan(doubles(raster)[3]));
  options.nodata = -kInf;
  expect_says(error_of([&] { read_raster(file, options); }), "infinite");
}

TEST_F(GdalRaster, RejectsARasterOfOnlyNodata) {
  expect_says(read_error(write_tiff("a.tif", GDT_Int16, 2, 1, {-1, -1}, nodata(-1))), "all 2 x 1 samples are nodata");
  expect_says(read_error(write_tiff("b.tif", GDT_Float32, 2, 1, {kNan, kNan})), "nodata");
}

// Heights of 100 to 140 m and `mark`. With the option that the note recommends, the mark is a hole.
class SuspectedNodata : public GdalRaster {
 protected:
  std::string marked(GDALDataType type, double mark, double scale = 1) const {
    return write_tiff("a.tif", type, 3, 2, {100, 110, 120, mark, 130, 140},
                      [&](GDALDataset& d) { d.GetRasterBand(1)->SetScale(scale); });
  }
  static void expect_advice_that_works(const std::string& file, const std::string& what) {
    const std::string before = ", which often marks holes (if so, add --nodata=";
    for (const std::string& note : read_raster(file, {}).notes) {
      const std::size_t at = note.find(before);
      if (at == std::string::npos) continue;
      RasterOptions options;
      options.nodata = std::stod(note.substr(at + before.size()));
      const Raster raster = read_raster(file, options);
      const double sample = doubles(raster)[3];
      EXPECT_TRUE(std::isnan(sample) || sample == raster.nodata) << what << ": " << note;
      EXPECT_FALSE(has_note(raster, "often marks holes")) << what;
      return;
    }
    ADD_FAILURE() << what << ": no note";
  }
};

TEST_F(SuspectedNodata, NamesTheValueFarFromZero) {
  const Raster raster = read_raster(write_tiff("a.tif", GDT_UInt16, 2, 1, {100, 65535}), {});
  EXPECT_TRUE(has_note(raster, "--nodata=65535"));
  EXPECT_FALSE(has_note(raster, "--nodata=100 "));
}

TEST_F(SuspectedNodata, SuggestedOptionMakesHoles) {
  const struct {
    GDALDataType type;
    std::vector<double> marks;
  } cases[] = {
      {GDT_Byte, {255}},
      {GDT_Int16, {-32768, -32767, -9999, 32767}},
      {GDT_UInt16, {65535}},
      {GDT_Int32, {-2147483648.0, -99999, 2147483647}},
      {GDT_UInt32, {4294967295}},
      {GDT_Float32, {-9999, -99999, -999999, 99999, 1e20, -1e20, -9999.9e2}},
      {GDT_Float64, {-99999.1, 1e20}},
  };
  for (const auto& c : cases) {
    for (const double mark : c.marks)
      expect_advice_that_works(marked(c.type, mark), fmt::format("{} {}", GDALGetDataTypeName(c.type), mark));
  }
  EXPECT_TRUE(has_note(read_raster(marked(GDT_Float32, 99999), {}), "99999, more than 20 km from all others"));
}

TEST_F(SuspectedNodata, ValuesBeyondAllHeightsAreHoles) {
  constexpr double kFloatMax = std::numeric_limits<float>::max();
  for (const GDALDataType type : {GDT_Float32, GDT_Float64}) {
    for (const double mark : {-kFloatMax, kFloatMax, -3.402823e38, 9.969209968386869e36, -1e31}) {
      const std::string file = marked(type, mark);
      const Raster raster = read_raster(file, {});
      EXPECT_TRUE(std::isnan(doubles(raster)[3])) << mark;
      EXPECT_TRUE(mark != -1e31 || has_note(raster, "1 samples of -1e+31 are taken as holes"));
      EXPECT_TRUE(has_note(raster, "--nodata=nan keeps them"));
      EXPECT_FALSE(has_note(raster, "often marks holes"));
      RasterOptions options;
      options.nodata = kNan;
      EXPECT_EQ(static_cast<float>(mark), doubles(read_raster(file, options))[3]);
    }
  }
  // Several marks, although the file declares another one.
  const Raster raster =
      read_raster(write_tiff("b.tif", GDT_Float32, 3, 2, {1e38, 1, 2, -1e38, -9999, 3}, nodata(-9999)), {});
  EXPECT_TRUE(has_note(raster, "2 samples from -1e+38 to 1e+38 are taken as holes"))
      << ::testing::PrintToString(raster.notes);
  EXPECT_EQ(-9999, raster.nodata);
  expect_says(read_error(write_tiff("c.tif", GDT_Float32, 2, 1, {1e38, 1e38})), "all 2 x 1 samples are nodata");
}

class PictureScale : public GdalRaster {
 protected:
  // An image of 5 x 3 samples that are 0 except for one.
  std::string picture(const std::string& name, GDALDataType type, double most) const {
    GDALDatasetUniquePtr memory(GetGDALDriverManager()->GetDriverByName("MEM")->Create("", 5, 3, 1, type, nullptr));
    EXPECT_EQ(CE_None,
              memory->GetRasterBand(1)->RasterIO(GF_Write, 2, 1, 1, 1, &most, 1, 1, GDT_Float64, 0, 0, nullptr));
    GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName(name.ends_with("png") ? "PNG" : "PNM");
    GDALDatasetUniquePtr(driver->CreateCopy(path(name).c_str(), memory.get(), FALSE, nullptr, nullptr, nullptr));
    return path(name);
  }
};

TEST_F(PictureScale, ScalesPicturesThatAreTooSteep) {
  for (const std::string name : {"a.png", "a.pgm"}) {
    const std::string file = picture(name, GDT_UInt16, 40000);
    const Raster raster = read_raster(file, {});
    EXPECT_DOUBLE_EQ(4.0 / 8 / 65535, raster.scale) << name;
    EXPECT_TRUE(has_note(raster, "samples of 0 to 65535 are taken as heights of 0 to 0.5 m")) << name;
    EXPECT_TRUE(has_note(raster, "--height-range LOW,HIGH"));
    EXPECT_FALSE(has_note(raster, "often marks holes")) << "0.3 m are not 20 km";
    // A window has the scale of the file.
    RasterOptions options;
    options.window = {1, 1, 3, 2};
    EXPECT_EQ(raster.scale, read_raster(file, options).scale);
    // Explicitly stated heights are not corrected.
    options = {};
    options.scale = 1;
    EXPECT_EQ(1, read_raster(file, options).scale);
    EXPECT_FALSE(has_note(read_raster(file, options), "--height-range"));
    options = {};
    options.height_range = {0, 100};
    EXPECT_DOUBLE_EQ(100.0 / 65535, read_raster(file, options).scale);
    options = {};
    options.bounds = {0, 0, 50000, 30000};
    EXPECT_EQ(1, read_raster(file, options).scale);
  }
  EXPECT_DOUBLE_EQ(4.0 / 8 / 255, read_raster(picture("b.png", GDT_Byte, 200), {}).scale);
  const Raster low = read_raster(picture("c.png", GDT_UInt16, 4), {});
  EXPECT_EQ(1, low.scale);
  EXPECT_FALSE(has_note(low, "height"));
}

TEST_F(PictureScale, OtherFilesGetOnlyANote) {
  const Raster plain = read_raster(write_tiff("a.tif", GDT_UInt16, 3, 2, {0, 10000, 20000, 30000, 40000, 50000}), {});
  EXPECT_EQ(1, plain.scale);
  EXPECT_TRUE(has_note(plain, "heights span 50000 m over 2 m of ground (if that is too steep, use --height-range"));
  const Raster is_signed = read_raster(write_tiff("b.tif", GDT_Int16, 3, 2, {0, 1, 2, 3, 4, 5}), {});
  EXPECT_TRUE(has_note(is_signed, "use --scale, --bounds or --exaggeration"));
  const Raster raw = read_raster(
      write("c.npy", npy_bytes(npy_dictionary("<u2", "(2, 2)"), sample_bytes<std::uint16_t>({0, 1, 2, 65535}))), {});
  EXPECT_EQ(1, raw.scale);
  EXPECT_TRUE(has_note(raw, "--height-range LOW,HIGH, --scale"));
}

// As gdalwarp writes around a raster without a nodata value.
TEST_F(SuspectedNodata, NotesACollarOfZerosAroundHighGround) {
  const auto notes = [&](const std::vector<double>& samples, GDALDataType type = GDT_Int16) {
    return has_note(read_raster(write_tiff("collar.tif", type, 3, 3, samples), {}), "--nodata=0");
  };
  for (const GDALDataType type : {GDT_Int16, GDT_Byte, GDT_Float32})
    EXPECT_TRUE(notes({0, 0, 0, 101, 180, 240, 0, 0, 0}, type)) << type;
  EXPECT_TRUE(notes({150, 2500, 3000, 400, 500, 0, 600, 0, 0}));
  EXPECT_FALSE(notes({0, 0, 0, 99, 180, 240, 0, 0, 0})) << "a coast";
  EXPECT_FALSE(notes({150, 200, 250, 300, 0, 350, 400, 450, 500})) << "a pit";
  EXPECT_FALSE(notes({0, 0, 0, 0, 250, 0, 0, 0, 0})) << "a tower";
  EXPECT_FALSE(notes({-5, 0, 0, 101, 180, 240, 0, 0, 0})) << "below the sea";
  RasterOptions options;
  options.nodata = 0;
  EXPECT_FALSE(has_note(read_raster(path("collar.tif"), options), "--nodata=0"));
}

TEST_F(SuspectedNodata, PlausibleHeightsGetNoNote) {
  const auto quiet = [](const std::string& file) {
    const Raster raster = read_raster(file, {});
    EXPECT_FALSE(has_note(raster, "often marks holes")) << ::testing::PrintToString(doubles(raster));
  };
  // Peaks, trenches and towers; the extremes only with a unit that makes them extreme.
  for (const double height : {0.0, -11000.0, 8849.0, 19000.0}) quiet(marked(GDT_Float32, height));
  quiet(marked(GDT_UInt32, 4000000, 0.001));
  expect_advice_that_works(marked(GDT_UInt32, 4000000, 0.01), "decimal centimetres");
  expect_advice_that_works(marked(GDT_UInt32, 4000000, -0.01), "heights that fall with the samples");
  // Samples that fill their type, evenly or nearly so.
  quiet(write_tiff("b.tif", GDT_Byte, 3, 1, {0, 128, 255}));
  quiet(write_tiff("b.tif", GDT_UInt16, 4, 1, {0, 20000, 40000, 65535}));
  quiet(write_tiff("b.tif", GDT_Float64, 3, 1, {0, 4e9, 8e9}));
  // A single value is not an outlier.
  quiet(write_tiff("b.tif", GDT_UInt16, 2, 1, {65535, 65535}));
  // Pixels hidden by a mask or the file's own nodata value do not count as samples.
  quiet(write_tiff("b.tif", GDT_Int16, 3, 1, {1, -9999, 2}, nodata(-9999)));
  const GdalOption inside("GDAL_TIFF_INTERNAL_MASK", "YES");
  quiet(write_tiff("c.tif", GDT_Int16, 3, 1, {1, -9999, 2}, [](GDALDataset& d) {
    d.CreateMaskBand(GMF_PER_DATASET);
    std::uint8_t mask[] = {255, 0, 255};
    EXPECT_EQ(CE_None,
              d.GetRasterBand(1)->GetMaskBand()->RasterIO(GF_Write, 0, 0, 3, 1, mask, 3, 1, GDT_Byte, 0, 0, nullptr));
  }));
}

TEST_F(GdalRaster, MaskMakesHolesInFloat32) {
  const GdalOption inside("GDAL_TIFF_INTERNAL_MASK", "YES");
  const std::string file = write_tiff("a.tif", GDT_Int16, 2, 2, {1, 2, 3, 4}, [](GDALDataset& d) {
    d.CreateMaskBand(GMF_PER_DATASET);
    std::uint8_t mask[] = {255, 0, 255, 255};
    EXPECT_EQ(CE_None,
              d.GetRasterBand(1)->GetMaskBand()->RasterIO(GF_Write, 0, 0, 2, 2, mask, 2, 2, GDT_Byte, 0, 0, nullptr));
  });
  const Raster raster = read_raster(file, {});
  ASSERT_TRUE(holds<float>(raster));
  EXPECT_TRUE(std::isnan(doubles(raster)[1]));
  EXPECT_EQ(4, doubles(raster)[3]);
  EXPECT_TRUE(has_note(raster, "mask"));
}

TEST_F(GdalRaster, AlphaBandMakesHolesAndIsNotAHeightBand) {
  const std::string file = write_tiff(
      "a.tif", GDT_UInt16, 2, 1, {10, 20},
      [](GDALDataset& d) {
        d.GetRasterBand(2)->SetColorInterpretation(GCI_AlphaBand);
        std::uint16_t alpha[] = {65535, 0};
        EXPECT_EQ(CE_None, d.GetRasterBand(2)->RasterIO(GF_Write, 0, 0, 2, 1, alpha, 2, 1, GDT_UInt16, 0, 0, nullptr));
      },
      2, {"ALPHA=YES"});
  const Raster raster = read_raster(file, {});
  EXPECT_EQ(10, doubles(raster)[0]);
  EXPECT_TRUE(std::isnan(doubles(raster)[1]));
}

TEST_F(GdalRaster, FullyValidMaskChangesNothing) {
  const GdalOption inside("GDAL_TIFF_INTERNAL_MASK", "YES");
  const std::string file = write_tiff("a.tif", GDT_Int16, 2, 1, {1, 2}, [](GDALDataset& d) {
    d.CreateMaskBand(GMF_PER_DATASET);
    EXPECT_EQ(CE_None, d.GetRasterBand(1)->GetMaskBand()->Fill(255));
  });
  EXPECT_TRUE(holds<std::int16_t>(read_raster(file, {})));
}

TEST_F(GdalRaster, KeepsScaleAndOffset) {
  const Raster raster = read_raster(write_tiff("a.tif", GDT_Int16, 2, 1, {1, 2},
                                               [](GDALDataset& d) {
                                                 d.GetRasterBand(1)->SetScale(0.5);
                                                 d.GetRasterBand(1)->SetOffset(-100);
                                               }),
                                    {});
  EXPECT_EQ(0.5, raster.scale);
  EXPECT_EQ(-100, raster.offset);
  RasterOptions options;
  options.scale = 3;
  EXPECT_EQ(3, read_raster(path("a.tif"), options).scale);
}

TEST_F(GdalRaster, AppliesANegativeScale) {
  const Raster raster = read_raster(write_tiff("a.tif", GDT_Int16, 3, 1, {1, 2, -9},
                                               [](GDALDataset& d) {
                                                 d.GetRasterBand(1)->SetScale(-2);
                                                 d.GetRasterBand(1)->SetOffset(10);
                                                 d.GetRasterBand(1)->SetNoDataValue(-9);
                                               }),
                                    {});
  EXPECT_EQ(1, raster.scale);
  EXPECT_EQ(0, raster.offset);
  EXPECT_EQ(8, doubles(raster)[0]);
  EXPECT_EQ(6, doubles(raster)[1]);
  EXPECT_TRUE(std::isnan(doubles(raster)[2]));
}

TEST_F(GdalRaster, RejectsAScaleOfZero) {
  RasterOptions options;
  options.scale = 0;
  expect_says(read_error(write_tiff("a.tif", GDT_Int16, 2, 1, {1, 2}), options), "--scale");
}

TEST_F(GdalRaster, ConvertsFeetToMetres) {
  const auto unit = [](const char* name) { return [name](GDALDataset& d) { d.GetRasterBand(1)->SetUnitType(name); }; };
  const Raster feet = read_raster(write_tiff("a.tif", GDT_Int16, 2, 1, {1, 2}, unit("ft")), {});
  EXPECT_DOUBLE_EQ(0.3048, feet.scale);
  EXPECT_TRUE(has_note(feet, "to metres"));
  EXPECT_DOUBLE_EQ(1200.0 / 3937,
                   read_raster(write_tiff("b.tif", GDT_Int16, 2, 1, {1, 2}, unit("US survey foot")), {}).scale);
  const Raster odd = read_raster(write_tiff("c.tif", GDT_Int16, 2, 1, {1, 2}, unit("furlong")), {});
  EXPECT_EQ(1, odd.scale);
  EXPECT_TRUE(has_note(odd, "furlong"));
  EXPECT_TRUE(has_note(read_raster(write_tiff("d.tif", GDT_Int16, 2, 1, {1, 2}, unit("1/3 ft")), {}),
                       "unknown vertical unit '1/3 ft', assuming metres"));
  RasterOptions options;
  options.unit = "ft";
  EXPECT_DOUBLE_EQ(0.3048, read_raster(path("c.tif"), options).scale);
  options.unit = "furlong";
  expect_says(read_error(path("c.tif"), options), "unknown vertical unit 'furlong'");
}

TEST_F(GdalRaster, ReadsAWindowOfTheFile) {
  RasterOptions options;
  options.window = {1, 1, 2, 1};
  const std::string file = write_tiff("a.tif", GDT_Int16, 3, 2, {1, 2, 3, 4, 5, 6});
  const Raster raster = read_raster(file, options);
  EXPECT_EQ((std::vector<double>{5, 6}), doubles(raster));
  EXPECT_EQ(2, raster.cols);
  for (const RasterWindow bad :
       {RasterWindow{-1, 0, 2, 1}, {2, 0, 2, 1}, {0, 0, 0, 1}, {0, 0, 3, 3}, {1, 0, 2147483647, 1}}) {
    options.window = bad;
    expect_says(read_error(file, options), "is not inside the 3 x 2 samples");
  }
}

TEST_F(GdalRaster, AcceptsASingleSample) {
  const Raster raster = read_raster(write_tiff("a.tif", GDT_Int16, 1, 1, {5}), {});
  EXPECT_EQ((std::vector<double>{5}), doubles(raster));
}

TEST_F(GdalRaster, ReadsBlocksOfAnySize) {
  const int cols = 3000, rows = 1700;
  std::vector<double> values(static_cast<std::size_t>(cols) * rows);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i % 32749);
  RasterOptions options;
  options.window = {7, 101, 2900, 1501};
  for (const char* block : {"BLOCKYSIZE=1", "BLOCKYSIZE=37", "TILED=YES"}) {
    const Raster raster = read_raster(write_tiff("a.tif", GDT_Float64, cols, rows, values, {}, 1, {block}), options);
    const auto& samples = std::get<std::vector<float>>(raster.samples);
    for (int row : {0, 1, 250, 348, 349, 500, 1500}) {
      for (int col : {0, 2899}) {
        EXPECT_EQ(values[static_cast<std::size_t>(row + 101) * cols + static_cast<std::size_t>(col) + 7],
                  samples[static_cast<std::size_t>(row) * 2900 + static_cast<std::size_t>(col)])
            << block << row;
      }
    }
  }
}

TEST_F(GdalRaster, ProgressReachesOneAndCanStopReading) {
  const std::string file = write_tiff("a.tif", GDT_Int16, 3, 2, {1, 2, 3, 4, 5, 6});
  double last = 0;
  read_raster(file, {}, [&](double share) { return last = share, true; });
  EXPECT_EQ(1, last);
  EXPECT_THROW(read_raster(file, {}, [](double) { return false; }), Interrupted);
}

}  // namespace
}  // namespace scarp
