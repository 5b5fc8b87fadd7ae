// SPDX-License-Identifier: MIT
#include "scarp/source/raster/npy.h"

#include <cmath>
#include <cstdint>

#include "source/files.h"
#include "source/npy_bytes.h"

namespace scarp {
namespace {

using namespace test;

class Npy : public Files {
 protected:
  std::string write_npy(const std::string& name, const std::string& descr, const std::string& shape,
                        const std::string& samples, bool fortran = false) {
    return write(name, npy_bytes(npy_dictionary(descr, shape, fortran), samples));
  }
};

const std::vector<double> kValues{1, 2, 3, 4, 5, 100};
// The same as IEEE halves.
const std::string kHalves = sample_bytes<std::uint16_t>({0x3c00, 0x4000, 0x4200, 0x4400, 0x4500, 0x5640});

TEST_F(Npy, ReadsAllTypesAndByteOrders) {
  struct Case {
    const char* descr;
    std::string samples;
  };
  for (const Case& c : {Case{"|i1", sample_bytes<std::int8_t>(kValues)},
                        {"|u1", sample_bytes<std::uint8_t>(kValues)},
                        {"<i2", sample_bytes<std::int16_t>(kValues)},
                        {">i2", sample_bytes<std::int16_t>(kValues, true)},
                        {"<u2", sample_bytes<std::uint16_t>(kValues)},
                        {">u2", sample_bytes<std::uint16_t>(kValues, true)},
                        {"<i4", sample_bytes<std::int32_t>(kValues)},
                        {">u4", sample_bytes<std::uint32_t>(kValues, true)},
                        {"<i8", sample_bytes<std::int64_t>(kValues)},
                        {">i8", sample_bytes<std::int64_t>(kValues, true)},
                        {"<u8", sample_bytes<std::uint64_t>(kValues)},
                        {"<f2", kHalves},
                        {"<f4", sample_bytes<float>(kValues)},
                        {">f4", sample_bytes<float>(kValues, true)},
                        {"<f8", sample_bytes<double>(kValues)},
                        {">f8", sample_bytes<double>(kValues, true)}}) {
    const Raster raster = read_raster(write_npy("a.npy", c.descr, "(2, 3)", c.samples), {});
    EXPECT_EQ(3, raster.cols) << c.descr;
    EXPECT_EQ(2, raster.rows) << c.descr;
    EXPECT_EQ(kValues, doubles(raster)) << c.descr;
    EXPECT_FALSE(raster.georeference.present);
  }
  EXPECT_TRUE(
      holds<std::int16_t>(read_raster(write_npy("a.npy", "<i2", "(2, 3)", sample_bytes<std::int16_t>(kValues)), {})));
  EXPECT_TRUE(holds<float>(read_raster(write_npy("a.npy", ">f4", "(2, 3)", sample_bytes<float>(kValues, true)), {})));
}

TEST_F(Npy, ConvertsUnsupportedTypesToFloat32WithANote) {
  const Raster wide =
      read_raster(write_npy("a.npy", "<i8", "(2, 3)", sample_bytes<std::int64_t>({16777217, -2, 3, 4, 5, 6})), {});
  EXPECT_TRUE(holds<float>(wide));
  EXPECT_EQ("Int64", wide.file_type);
  EXPECT_EQ(-2, doubles(wide)[1]);
  EXPECT_TRUE(has_note(wide, "Int64 samples converted to float32, rounded by at most 1"));
  const Raster half = read_raster(write_npy("a.npy", "<f2", "(2, 3)", kHalves), {});
  EXPECT_TRUE(holds<float>(half));
  EXPECT_EQ("Float16", half.file_type);
  EXPECT_TRUE(has_note(half, "Float16 samples converted to float32 without rounding"));
}

TEST_F(Npy, ReadsEveryKindOfHalfFloat) {
  // -2; the largest number; 1/3, rounded; the smallest normal number; the largest and the smallest subnormal number;
  // NaN.
  const std::vector<double> bits{0xc000, 0x7bff, 0x3555, 0x0400, 0x03ff, 0x0001, 0x7e00, 0x8000};
  const std::vector<double> values{-2, 65504, 1365.0 / 4096, 0x1p-14, 1023 * 0x1p-24, 0x1p-24, 0, 0};
  for (const bool big_endian : {false, true}) {
    for (const bool fortran : {false, true}) {
      const std::string file = write_npy("a.npy", big_endian ? ">f2" : "<f2", fortran ? "(8, 1)" : "(1, 8)",
                                         sample_bytes<std::uint16_t>(bits, big_endian), fortran);
      const std::vector<double> read = doubles(read_raster(file, {}));
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (bits[i] == 0x7e00) {
          EXPECT_TRUE(std::isnan(read[i]));
        } else {
          EXPECT_EQ(values[i], read[i]) << i;
        }
      }
    }
  }
  expect_says(read_error(write_npy("a.npy", "<f2", "(1, 2)", sample_bytes<std::uint16_t>({0, 0xfc00}))),
              "column 1, row 0 is minus infinity");
}

TEST_F(Npy, SignedBytesKeepTheirSign) {
  EXPECT_EQ((std::vector<double>{-1, -128}),
            doubles(read_raster(write_npy("a.npy", "|i1", "(1, 2)", sample_bytes<std::int8_t>({-1, -128})), {})));
  EXPECT_EQ((std::vector<double>{-1, -128}),
            doubles(read_raster(write_npy("a.npy", "|i1", "(1, 2)", sample_bytes<std::int8_t>({-1, -128}), true), {})));
}

TEST_F(Npy, ReadsFortranOrder) {
  // The array [[1, 2, 3], [4, 5, 100]], column by column.
  const std::vector<double> columns{1, 4, 2, 5, 3, 100};
  EXPECT_EQ(kValues,
            doubles(read_raster(write_npy("a.npy", "<i2", "(2, 3)", sample_bytes<std::int16_t>(columns), true), {})));
  const std::string file = write_npy("a.npy", ">f8", "(2, 3)", sample_bytes<double>(columns, true), true);
  EXPECT_EQ(kValues, doubles(read_raster(file, {})));
  RasterOptions options;
  options.window = {1, 1, 2, 1};
  EXPECT_EQ((std::vector<double>{5, 100}), doubles(read_raster(file, options)));
  const std::string halves = sample_bytes<std::uint16_t>({0x3c00, 0x4400, 0x4000, 0x4500, 0x4200, 0x5640});
  EXPECT_EQ((std::vector<double>{5, 100}),
            doubles(read_raster(write_npy("a.npy", "<f2", "(2, 3)", halves, true), options)));
  EXPECT_EQ(kValues, doubles(read_raster(
                         write_npy("a.npy", ">i8", "(2, 3)", sample_bytes<std::int64_t>(columns, true), true), {})));
}

TEST_F(Npy, DropsExtentsOfOneFromThree) {
  const std::string samples = sample_bytes<std::int16_t>(kValues);
  EXPECT_EQ(kValues, doubles(read_raster(write_npy("a.npy", "<i2", "(1, 2, 3)", samples), {})));
  const Raster raster = read_raster(write_npy("a.npy", "<i2", "(2, 3, 1)", samples), {});
  EXPECT_EQ(3, raster.cols);
  EXPECT_TRUE(has_note(raster, "2 x 3 x 1"));
}

TEST_F(Npy, RejectsOtherShapes) {
  const std::string samples = sample_bytes<std::int16_t>(kValues);
  for (const char* shape : {"()", "(6,)", "(1, 1, 6, 1)", "(2, 3, 1, 1)"}) {
    expect_says(read_error(write_npy("a.npy", "<i2", shape, samples)), "two dimensions required",
                fmt::format("{}", shape));
  }
  expect_says(read_error(write_npy("a.npy", "<i2", "(0, 6)", samples)), "no samples (save");
}

TEST_F(Npy, RejectsOtherTypesByName) {
  for (const char* descr : {"|b1", "<c8", "|O", "<f16", "|S5", "<U7", "|V4", "<M8[ns]"}) {
    const std::string text = read_error(write_npy("a.npy", descr, "(2, 3)", std::string(1000, '\0')));
    expect_says(text, descr);
    expect_says(text, "f4");
  }
  expect_says(
      read_error(write("a.npy", npy_bytes("{'descr': [('z', '<f4')], 'fortran_order': False, 'shape': (2, 3), }", ""))),
      "structures");
}

TEST_F(Npy, RejectsTruncatedFilesBeforeAllocation) {
  const std::string samples = sample_bytes<std::int16_t>(kValues);
  expect_says(read_error(write_npy("a.npy", "<i2", "(2, 4)", samples)), "truncated");
  expect_says(read_error(write_npy("a.npy", "<i2", "(1000000000, 1000000000)", samples)), "truncated");
  expect_says(read_error(write_npy("a.npy", "<i2", "(9000000000000000000, 9000000000000000000)", samples)),
              "extents are limited to");
  expect_says(read_error(write("b.npy", "\x93NUMPY")), "truncated");
  expect_says(read_error(write("b.npy", npy_bytes(npy_dictionary("<i2", "(2, 3)"), "").substr(0, 40))), "truncated");
  expect_says(read_error(write("b.npy", "hello, world, this is text")), "not a .npy");
}

TEST_F(Npy, FindsTheOnlyRasterInAnArchive) {
  const std::string height = npy_bytes(npy_dictionary("<i2", "(2, 3)"), sample_bytes<std::int16_t>(kValues));
  const std::string number = npy_bytes(npy_dictionary("<f8", "()"), sample_bytes<double>({30}));
  const std::string file = write_zip("a.npz", {{"height.npy", height}, {"dx.npy", number}});
  EXPECT_EQ(kValues, doubles(read_raster(file, {})));
  RasterOptions options;
  options.key = "height";
  EXPECT_EQ(kValues, doubles(read_raster(file, options)));
  options.key = "dx";
  expect_says(read_error(file, options), "two dimensions required");
  options.key = "nothing";
  const std::string text = read_error(file, options);
  expect_says(text, "height (2 x 3)");
  expect_says(text, "dx (a single number)");
}

TEST_F(Npy, RequiresAKeyForSeveralRasters) {
  const std::string a = npy_bytes(npy_dictionary("<i2", "(2, 3)"), sample_bytes<std::int16_t>(kValues));
  const std::string file = write_zip("a.npz", {{"a.npy", a}, {"b.npy", a}});
  const std::string text = read_error(file);
  expect_says(text, "--key");
  expect_says(text, "a (2 x 3), b (2 x 3)");
}

TEST_F(Npy, IgnoresNonHeightArraysInAnArchive) {
  const std::string height = npy_bytes(npy_dictionary("<i2", "(2, 3)"), sample_bytes<std::int16_t>(kValues));
  const std::string mask = npy_bytes(npy_dictionary("|b1", "(2, 3)"), std::string(6, '\1'));
  const std::string table =
      npy_bytes("{'descr': [('z', '<f4')], 'fortran_order': False, 'shape': (2, 3), }", std::string(24, '\0'));
  EXPECT_EQ(kValues, doubles(read_raster(write_zip("a.npz", {{"dem.npy", height}, {"m.npy", mask}}), {})));
  EXPECT_EQ(kValues, doubles(read_raster(write_zip("b.npz", {{"t.npy", table}, {"dem.npy", height}}), {})));
  // A single array is rejected for its kind; with several arrays, the error asks for a name.
  expect_says(read_error(write_zip("c.npz", {{"m.npy", mask}})), "'|b1' (true and false)");
  expect_says(read_error(write_zip("d.npz", {{"t.npy", table}})), "structures");
  expect_says(read_error(write_zip("e.npz", {{"m.npy", mask}, {"t.npy", table}})),
              "0 two-dimensional arrays of heights (choose one with --key: m (2 x 3 of '|b1'), t (not read)");
  RasterOptions options;
  options.key = "m";
  expect_says(error_of([&] { read_raster(path("a.npz"), options); }), "true and false");
}

TEST_F(Npy, ReadsAFortranArrayInAnArchive) {
  const std::string a =
      npy_bytes(npy_dictionary("<i2", "(2, 3)", true), sample_bytes<std::int16_t>({1, 4, 2, 5, 3, 100}));
  EXPECT_EQ(kValues, doubles(read_raster(write_zip("a.npz", {{"a.npy", a}}), {})));
}

TEST_F(Npy, RejectsADamagedArchive) {
  expect_says(read_error(write("a.npz", "hello, world")), "not a .npz");
  std::vector<double> noise(40000);
  for (std::size_t i = 0; i < noise.size(); ++i) noise[i] = static_cast<double>(i * i * 7919 % 65521);
  const std::string a = npy_bytes(npy_dictionary("<u2", "(200, 200)"), sample_bytes<std::uint16_t>(noise));
  const std::string file = write_zip("b.npz", {{"a.npy", a}});
  EXPECT_NO_THROW(read_raster(file, {}));
  std::string bytes = bytes_of(file);
  write("cut.npz", bytes.substr(0, bytes.size() / 2));
  expect_says(read_error(path("cut.npz")), "truncated");
  bytes.replace(bytes.size() / 2, 2000, 2000, '\xff');
  write("bad.npz", bytes);
  expect_says(read_error(path("bad.npz")), path("bad.npz") + ": ");
}

TEST_F(Npy, BoundsAndCrsSetTheGeoreference) {
  RasterOptions options;
  options.bounds = {10, 45, 10.3, 45.2};
  options.crs = "EPSG:4326";
  const Raster raster = read_raster(write_npy("a.npy", "<i2", "(2, 3)", sample_bytes<std::int16_t>(kValues)), options);
  EXPECT_TRUE(raster.georeference.present);
  EXPECT_NEAR(10.05, raster.georeference.map_from_node[0], 1e-12);
  EXPECT_NEAR(45.15, raster.georeference.map_from_node[3], 1e-12);
  EXPECT_NEAR(0.1 * 111320 * 0.7061, raster.georeference.cell_x_m, 20);
}

TEST_F(Npy, AcceptsSpacesAndAmpersandsInNames) {
  EXPECT_EQ(kValues, doubles(read_raster(
                         write_npy("a & <b> 'c'.NPY", "<i2", "(2, 3)", sample_bytes<std::int16_t>(kValues)), {})));
}

}  // namespace
}  // namespace scarp
