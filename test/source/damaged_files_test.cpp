// SPDX-License-Identifier: MIT
// Files that are not rasters of heights: one line each, and nothing on stderr.
#include <cmath>

#include "source/files.h"

namespace scarp {
namespace {

using namespace test;

// Fails if anything is printed during a test: GDAL and PROJ tend to print.
class DamagedFiles : public Files {
 protected:
  void SetUp() override { ::testing::internal::CaptureStderr(); }
  void TearDown() override { EXPECT_EQ("", ::testing::internal::GetCapturedStderr()); }

  std::string copy_as(const std::string& tiff, const char* driver_name, const std::string& name,
                      std::vector<const char*> options = {}) {
    options.push_back(nullptr);
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(driver_name);
    if (!driver) return {};
    std::filesystem::remove(path(name));  // GDAL would inspect the replaced file, and print messages
    const GDALDatasetUniquePtr source(GDALDataset::Open(tiff.c_str()));
    const GDALDatasetUniquePtr copy(driver->CreateCopy(path(name).c_str(), source.get(), FALSE,
                                                       const_cast<char**>(options.data()), nullptr, nullptr));
    EXPECT_TRUE(copy);
    return path(name);
  }

  std::string slope(GDALDataType type = GDT_Int16, std::vector<const char*> options = {}) {
    std::vector<double> values(200 * 150);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i * 7919 % 1000) + 1;
    return write_tiff("slope.tif", type, 200, 150, values, {}, 1, std::move(options));
  }

  void cut(const std::string& file, double share) {
    std::filesystem::resize_file(
        file, static_cast<std::uintmax_t>(static_cast<double>(std::filesystem::file_size(file)) * share));
  }
};

TEST_F(DamagedFiles, NamesAMissingFile) { expect_says(read_error(path("none.tif")), "does not exist"); }
TEST_F(DamagedFiles, RejectsAnEmptyName) { expect_says(read_error(""), "empty"); }
TEST_F(DamagedFiles, NamesADirectory) {
  expect_says(read_error(folder_.string()), "folder without a raster");
  std::filesystem::create_directory(path("d.npy"));
  expect_says(read_error(path("d.npy")), "is a directory");
}
TEST_F(DamagedFiles, NamesAnEmptyFile) {
  for (const char* name : {"e.tif", "e.npy", "e.npz", "N00E010.hgt"})
    expect_says(read_error(write(name, "")), "0 bytes", fmt::format("{}", name));
}
TEST_F(DamagedFiles, RecognisesGitLfsPointers) {
  const std::string pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n";
  for (const char* name : {"p.tif", "p.npy", "p.npz"})
    expect_says(read_error(write(name, pointer)), "git lfs pull", fmt::format("{}", name));
}
TEST_F(DamagedFiles, RejectsOtherFiles) {
  expect_says(read_error(write("t.tif", "hello")), "not a raster format");
  expect_says(read_error(write("t.tif", std::string(5000, '\0'))), "not a raster format");
  expect_says(read_error(write("N00E010.hgt", std::string(5000, '\1'))), ".hgt");
}

// The correct advice, and nothing that only GDAL's developers understand.
void expect_advice(const std::string& text) {
  expect_says(text, "fetch or copy it again");
  for (const char* riddle : {"4294967295", "0x", "No such file", "Success"})
    EXPECT_EQ(std::string::npos, text.find(riddle)) << text;
}

TEST_F(DamagedFiles, RejectsFilesTruncatedAnywhere) {
  for (const double share : {0.1, 0.5, 0.97}) {
    std::string file = slope();
    cut(file, share);
    expect_advice(read_error(file));
    file = slope(GDT_Float32, {"TILED=YES", "BLOCKXSIZE=64", "BLOCKYSIZE=64", "COMPRESS=DEFLATE"});
    cut(file, share);
    expect_advice(read_error(file));
    for (const auto& [driver, name] : std::vector<std::pair<const char*, const char*>>{{"AAIGrid", "a.asc"},
                                                                                       {"PNG", "a.png"},
                                                                                       {"EHdr", "a.bil"},
                                                                                       {"ENVI", "a.img"},
                                                                                       {"HFA", "h.img"},
                                                                                       {"netCDF", "a.nc"}}) {
      const std::string source = slope(std::string(driver) == "PNG" ? GDT_UInt16 : GDT_Int16);
      file = copy_as(source, driver, name);
      if (file.empty()) continue;
      EXPECT_NO_THROW(read_raster(file, {})) << name;
      cut(file, share);
      expect_advice(read_error(file));
    }
  }
}

TEST_F(DamagedFiles, ReportsTruncatedNetcdf4) {
  const std::string file = copy_as(slope(), "netCDF", "a.nc", {"FORMAT=NC4"});
  if (file.empty()) GTEST_SKIP() << "this GDAL has no netCDF";
  const auto bytes = std::filesystem::file_size(file);
  cut(file, 0.5);
  const std::string needed = fmt::format("truncated: {} bytes instead of {} as its header states", bytes / 2, bytes);
  for (const std::string& name : {file, "NETCDF:\"" + file + "\":Band1", "NETCDF:" + file + ":Band1"}) {
    const std::string text = read_error(name);
    expect_says(text, needed);
    expect_advice(text);
  }
}

TEST_F(DamagedFiles, ReportsTruncatedArchives) {
  const std::string tiff = bytes_of(slope());
  const std::string whole = write_zip("a.zip", {{"dem/slope.tif", tiff}, {"b", "1"}, {"c", "2"}, {"d", "3"}});
  EXPECT_NO_THROW(read_raster("/vsizip/" + whole + "/dem/slope.tif", {}));
  // A valid archive, but the path is incomplete or wrong: the message lists the content.
  expect_says(read_error(whole), "is a .zip archive (name a raster in it: /vsizip/" + whole + "/dem/slope.tif, ");
  expect_says(read_error(whole), "/c or 1 more");
  expect_says(read_error("/vsizip/" + whole + "/slope.tif"), "does not exist in '" + whole + "' (name a raster in it");
  std::filesystem::copy(whole, path("a.archive"));
  const std::string braces = "/vsizip/{" + path("a.archive") + "}/dem/slope.tif";
  expect_says(read_error(path("a.archive")), "name a raster in it: " + braces);
  EXPECT_NO_THROW(read_raster(braces, {}));
  for (const std::string& file : {path("a.archive"), whole}) {
    cut(file, 0.5);
    for (const std::string& name :
         {file, "/vsizip/" + file + "/dem/slope.tif", "/vsizip/{" + file + "}/dem/slope.tif"}) {
      const std::string text = read_error(name);
      expect_says(text, "truncated");
      expect_advice(text);
    }
  }
}

TEST_F(DamagedFiles, NamesTheSourceOfAVirtualRaster) {
  const auto vrt_of = [&](const std::string& source, int relative) {
    return write("v.vrt", fmt::format("<VRTDataset rasterXSize=\"2\" rasterYSize=\"2\"><VRTRasterBand "
                                      "dataType=\"Int16\" band=\"1\"><SimpleSource><SourceFilename "
                                      "relativeToVRT=\"{}\">{}</SourceFilename><SourceBand>1</SourceBand>"
                                      "</SimpleSource></VRTRasterBand></VRTDataset>",
                                      relative, source));
  };
  write_tiff("two.tif", GDT_Int16, 2, 2, {1, 2, 3, 4});
  EXPECT_NO_THROW(read_raster(vrt_of("two.tif", 1), {}));
  for (const int relative : {0, 1}) {
    const auto named = [&](const std::string& name) { return relative ? name : path(name); };
    expect_says(read_error(vrt_of(named("none.tif"), relative)), "source '" + path("none.tif") + "' does not exist");
    write("p.tif", "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n");
    const std::string text = read_error(vrt_of(named("p.tif"), relative));
    expect_says(text, "source '" + path("p.tif") + "': Git LFS pointer");
    expect_says(text, "git lfs pull");
  }
}

TEST_F(DamagedFiles, ReadsEveryKindOfNetcdf) {
  for (const char* format : {"FORMAT=NC", "FORMAT=NC2", "FORMAT=NC4", "FORMAT=NC4C"}) {
    const std::string file = copy_as(slope(), "netCDF", "a.nc", {format});
    if (file.empty()) GTEST_SKIP() << "this GDAL has no netCDF";
    const Raster raster = read_raster(file, {});
    EXPECT_EQ(doubles(read_raster(path("slope.tif"), {})), doubles(raster)) << format;
  }
}

TEST_F(DamagedFiles, ListsTheVariablesOfANetcdf) {
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("netCDF");
  if (!driver) GTEST_SKIP() << "this GDAL has no netCDF";
  {
    const GDALDatasetUniquePtr two(
        GDALDataset::Open(write_tiff("two.tif", GDT_Int16, 2, 2, {1, 2, 3, 4}, {}, 2).c_str()));
    const GDALDatasetUniquePtr copy(
        driver->CreateCopy(path("two.nc").c_str(), two.get(), FALSE, nullptr, nullptr, nullptr));
  }
  const std::string text = read_error(path("two.nc"));
  expect_says(text, "Band1");
  expect_says(text, "NETCDF:");
  EXPECT_EQ(4, read_raster("NETCDF:\"" + path("two.nc") + "\":Band2", {}).rows * 2);
}

TEST_F(DamagedFiles, RejectsAPhotographWithARemedy) {
  const std::string file = write_tiff("rgb.tif", GDT_Byte, 2, 2, {1, 2, 3, 4}, {}, 3, {"PHOTOMETRIC=RGB"});
  const std::string text = read_error(file);
  expect_says(text, "photograph");
  expect_says(text, "--band");
  RasterOptions options;
  options.band = 2;
  EXPECT_EQ((std::vector<double>{1, 2, 3, 4}), doubles(read_raster(file, options)));
  options.band = 4;
  expect_says(read_error(file, options), "no band 4: the file has");
}

TEST_F(DamagedFiles, RequiresAChoiceOfBand) {
  expect_says(read_error(write_tiff("two.tif", GDT_Int16, 2, 2, {1, 2, 3, 4}, {}, 2)),
              "with 2 bands (choose the band of heights with --band 1..2)");
}

TEST_F(DamagedFiles, RejectsAPalette) {
  const std::string file = write_tiff("p.tif", GDT_Byte, 2, 2, {1, 2, 3, 4}, [](GDALDataset& d) {
    GDALColorTable colours;
    const GDALColorEntry red{255, 0, 0, 255};
    colours.SetColorEntry(1, &red);
    d.GetRasterBand(1)->SetColorTable(&colours);
  });
  expect_says(read_error(file), "palette");
  RasterOptions options;
  options.band = 1;
  EXPECT_NO_THROW(read_raster(file, options));
}

TEST_F(DamagedFiles, RejectsAKeyOutsideArchives) {
  RasterOptions options;
  options.key = "height";
  expect_says(read_error(slope(), options), ".npz");
}

TEST_F(DamagedFiles, RejectsRastersLargerThanMemoryUpFront) {
  // A sparse file: 100 GB would be needed for 200,000 x 130,000 floats, the file has some MB.
  const std::string file = path("huge.vrt");
  write("huge.vrt",
        "<VRTDataset rasterXSize=\"2000000\" rasterYSize=\"2000000\"><VRTRasterBand dataType=\"Float32\" "
        "band=\"1\"/></VRTDataset>");
  const std::string text = read_error(file);
  expect_says(text, "2000000 x 2000000");
  expect_says(text, "--window");
  RasterOptions options;
  options.window = {1999990, 1999990, 10, 10};
  EXPECT_EQ(10, read_raster(file, options).cols);
}

}  // namespace
}  // namespace scarp
