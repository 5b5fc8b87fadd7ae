// SPDX-License-Identifier: MIT
// The command line from outside: its output, its files, its exit status.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "cli/program.h"
#include "cli/refused.h"
#include "output/read_png.h"
#include "scarp/output/png.h"

namespace scarp {
namespace {

using test::Names;
using test::run;

class Cli : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return scratch_.path(name); }
  std::string write(const std::string& name, const std::string& bytes) const { return scratch_.write(name, bytes); }

  // An ESRI ASCII grid.
  std::string grid(const std::string& name, int cols, int rows, const std::string& samples) const {
    return write(
        name, fmt::format("ncols {}\nnrows {}\nxllcorner 0\nyllcorner 0\ncellsize 10\nNODATA_value -9999\n{}\n", cols,
                          rows, samples));
  }
  std::string good() const { return grid("good.asc", 4, 3, "1 2 3 4\n2 3 4 5\n3 9 5 6"); }

  // render must fail on this input: one line on stderr that contains the fragment, nothing on stdout, no file left.
  void expect_refused(const std::string& input, const std::string& fragment) {
    const Names before = scratch_.files();
    const auto result = run({"render", input, "-o", path("out.png")});
    EXPECT_EQ(result.status, 1) << result.err;
    test::expect_refused(result, fragment);
    EXPECT_EQ(scratch_.files(), before);
  }

  // Waits until there is a file other than the one that the test made.
  void wait_for_output() const {
    for (int i = 0; i < 2000 && scratch_.files().size() < 2; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ASSERT_EQ(scratch_.files().size(), 2u) << "the output was never begun";
  }

  test::Scratch scratch_;
};

#ifdef SCARP_CAIRO
TEST_F(Cli, ScaleBarHasTheTrueLength) {
  // 30 m in 320 pixels: 5 m is the longest round length up to a quarter of that. The first half of the bar is black.
  const auto result =
      run({"render", good(), "-o", path("map.png"), "--top", "--size", "320x240", "--scale-bar", "--legend"});
  EXPECT_EQ(result.status, 0) << result.err;
  const test::Rgb picture = test::read_png(path("map.png"));
  int longest = 0;
  for (int y = picture.height / 2; y < picture.height; ++y) {
    int run_length = 0;
    for (int x = 0; x < picture.width / 2; ++x) {
      const auto* p = picture.pixel(x, y);
      run_length = p[0] + p[1] + p[2] == 0 ? run_length + 1 : 0;
      longest = std::max(longest, run_length);
    }
  }
  EXPECT_NEAR(longest, 2.5 * 320 / 30, 2);
}

TEST_F(Cli, RejectsFiguresWhereMeaningless) {
  const auto refused = [&](const Names& more, const std::string& size, const std::string& fragment) {
    Names words{"render", good(), "-o", path("out.png")};
    if (!size.empty()) words.insert(words.end(), {"--size", size});
    words.insert(words.end(), more.begin(), more.end());
    const auto result = run(words);
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(test::lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(fragment), std::string::npos) << result.err;
    EXPECT_EQ(scratch_.files(), (Names{"good.asc"}));
  };
  refused({"--legend", "--ground", "natural"}, "320x240", "no colour scale to show with --ground natural");
  refused({"--legend"}, "40x20", "enlarge the image");
  refused({"--legend", "--scale-bar"}, "240x150", "the scale bar and the legend overlap");
  refused({"--legend", "--look", "comanche", "--iterations"}, "", "--legend is not available with --iterations");
}
#endif

TEST_F(Cli, RenderWritesAPictureAndPrintsOneLine) {
  const auto result = test::Program({"render", good(), "-o", path("out.png"), "--size", "64x48"}).result();
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(test::lines(result.out), 1) << result.out;
  EXPECT_EQ(result.out.find(path("out.png") + ": 64 x 48 pixels; read "), 0u) << result.out;
  const test::Rgb picture = test::read_png(path("out.png"));
  EXPECT_EQ(picture.width, 64);
  EXPECT_EQ(picture.height, 48);
  EXPECT_EQ(scratch_.files(), (Names{"good.asc", "out.png"}));
}

TEST_F(Cli, EveryLookAndMarchRuns) {
  good();
  for (const std::string march :
       {"exhaustive", "naive", "relaxed", "lipschitz", "max-mip", "max-mip-bisect", "max-mip-easy"}) {
    for (const std::string look : {"shaded", "height", "steps", "error"}) {
      const auto result =
          run({"render", path("good.asc"), "-o", path("out.png"), "--size", "32x24", "--march", march, "--look", look});
      EXPECT_EQ(result.status, 0) << march << " " << look << ": " << result.err;
    }
  }
}

TEST_F(Cli, MapHasTheAspectRatioOfTheGround) {
  // At the default size, and without light, which would take a minute under sanitizers.
  const auto result = run({"render", good(), "-o", path("out.png"), "--top", "--look", "height"});
  EXPECT_EQ(result.status, 0) << result.err;
  const test::Rgb picture = test::read_png(path("out.png"));
  EXPECT_EQ(picture.width, 1280);
  EXPECT_EQ(picture.height, 853) << "3 x 2 cells";
}

TEST_F(Cli, PrintsStatisticsOfALook) {
  const auto steps = run({"render", good(), "-o", path("out.png"), "--size", "32x24", "--look", "steps"});
  EXPECT_NE(steps.out.find("steps per ray: "), std::string::npos) << steps.out;
  const auto error = run({"render", path("good.asc"), "-o", path("out.png"), "--size", "32x24", "--look", "error"});
  EXPECT_NE(error.out.find("lost        red        0\n"), std::string::npos) << error.out;
}

TEST_F(Cli, RecognisesGitLfsPointers) {
  expect_refused(write("dem.tif",
                       "version https://git-lfs.github.com/spec/v1\n"
                       "oid sha256:4d7a214614ab2935c943f9e0ff69d22eadbb8f32b1258daaa5e2ca24d17e2393\nsize 12345678\n"),
                 "Git LFS");
}

TEST_F(Cli, RejectsPhotographs) {
  const std::vector<std::uint8_t> photo(3 * 20 * 10, 90);
  write_png(path("photo.png"), {photo.data(), 20, 10});
  expect_refused(path("photo.png"), "photo.png");
}

TEST_F(Cli, RejectsAnEmptyFile) { expect_refused(write("dem.tif", ""), "empty"); }

TEST_F(Cli, RejectsATruncatedFile) {
  ASSERT_EQ(run({"generate", "--size", "600", "-o", path("whole.tif")}).status, 0);
  const std::string whole = test::text_of(path("whole.tif"));
  ASSERT_GT(whole.size(), 100000u);
  expect_refused(write("half.tif", whole.substr(0, whole.size() / 2)), "half.tif");
}

TEST_F(Cli, RejectsARasterOfOnlyNodata) {
  expect_refused(grid("void.asc", 3, 2, "-9999 -9999 -9999\n-9999 -9999 -9999"), "nodata");
}

TEST_F(Cli, RejectsInfiniteSamples) {
  // A .npy of 2 x 2 float32: 1, 2, 3, infinity.
  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2), }";
  header.resize(117, ' ');
  header += '\n';
  const std::string samples("\0\0\x80\x3f\0\0\0\x40\0\0\x40\x40\0\0\x80\x7f", 16);
  expect_refused(write("inf.npy", std::string("\x93NUMPY\x01\0", 8) + std::string("\x76\0", 2) + header + samples),
                 "infinite");
}

TEST_F(Cli, RejectsARotatedRasterWithARemedy) {
  good();
  expect_refused(write("rotated.vrt",
                       R"(<VRTDataset rasterXSize="4" rasterYSize="3"><GeoTransform>0,1,0.5,0,0.5,-1</GeoTransform>
<VRTRasterBand dataType="Float32" band="1"><SimpleSource><SourceFilename relativeToVRT="1">good.asc</SourceFilename>
<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>)"),
                 "gdalwarp");
}

TEST_F(Cli, RejectsARasterWithoutCells) {
  expect_refused(grid("point.asc", 1, 1, "5"), "cells");
  expect_refused(grid("row.asc", 5, 1, "5 6 7 8 9"), "cells");
  expect_refused(grid("column.asc", 1, 3, "5\n6\n7"), "cells");
}

TEST_F(Cli, RejectsAFolderWithoutRasters) { expect_refused(scratch_.path(""), "folder without a raster"); }

TEST_F(Cli, NamesAMissingFile) { expect_refused(path("nowhere.tif"), "nowhere.tif"); }

TEST_F(Cli, DetectsUnwritableOutputBeforeRendering) {
  good();
  const Names before = scratch_.files();
  for (const std::string& output :
       {path("no/such/folder/out.png"), path(""), std::string("/proc/out.png"), path("out.bmp")}) {
    // The input does not exist either: the output is checked first.
    const auto result = run({"render", path("missing.tif"), "-o", output});
    EXPECT_EQ(result.status, 1) << output;
    EXPECT_EQ(test::lines(result.err), 1) << result.err;
    EXPECT_TRUE(result.err.find(" " + output + ": ") != std::string::npos ||
                result.err.find("output '" + output + "': ") != std::string::npos)
        << result.err;
  }
  EXPECT_EQ(scratch_.files(), before);
}

TEST_F(Cli, ReportsHowFarTheEyeIsBelowGround) {
  // The ground is at 3.5 m there.
  const auto result = run(
      {"render", good(), "-o", path("out.png"), "--size", "8x6", "--eye", "15,10,-3656.5", "--target", "15,20,-3656"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.err.find("the eye is 3660 m below the ground"), std::string::npos) << result.err;
}

// Applies to all subcommands that write, and to all their inputs.
TEST_F(Cli, OutputsNeverOverwriteInputs) {
  const auto terrain = [&](const std::string& name, int west = 0) {
    return write(name, fmt::format("ncols 2\nnrows 2\nxllcorner {}\nyllcorner 0\ncellsize 10\n1 2\n3 4\n", west));
  };
  const std::string dem = terrain("dem.png"), folder = path("tiles"), image = path("image.png"),
                    rays = write("rays.csv", "x,y,z,dx,dy,dz\n5,5,99,0,0,-1\n"), volume = write("volume.svg", "\1"),
                    function = write("wave.tif", R"({"type": "plane", "slope": [1, 0]})"), model = path("model.vox"),
                    flight = write("flight-00.png", "x,y,z,tx,ty,tz\n5,-9,9,5,5,5\n");
  std::filesystem::create_directory(folder);
  std::filesystem::copy(dem, folder + "/west.png");
  std::filesystem::rename(terrain("east.png", 20), folder + "/east.png");
  std::filesystem::create_symlink(dem, path("link.png"));
  const std::vector<std::uint8_t> colours(std::size_t{3} * 2 * 2, 99);
  ReplaceFile file(image);
  write_png(file, image, {colours.data(), 2, 2});
  const auto virtual_raster = [&](const std::string& name, const std::string& of) {
    return write(
        name,
        fmt::format(
            R"(<VRTDataset rasterXSize="2" rasterYSize="2"><GeoTransform>0,10,0,20,0,-10</GeoTransform><VRTRasterBand dataType="Byte" band="1">
<SimpleSource><SourceFilename relativeToVRT="1">{}</SourceFilename><SourceBand>1</SourceBand></SimpleSource>
</VRTRasterBand></VRTDataset>)",
            of));
  };
  const std::string over_dem = virtual_raster("dem.vrt", "dem.png"),
                    over_image = virtual_raster("image.vrt", "image.png"), table = terrain("dem.csv"),
                    over_table = virtual_raster("table.vrt", "dem.csv");
  ASSERT_EQ(run({"voxelise", dem, "-o", model, "--count", "4"}).status, 0);
  const std::string voxels = write("voxels.json", R"({"objects": [{"voxels": {"file": "model.vox"}}]})"),
                    heights = write("heights.json", R"({"objects": [{"heights": {"file": "dem.vrt"}}]})"),
                    village = write("village.json", R"({"objects": [{"scene": "heights.json"}]})");

  const struct {
    Names arguments;
    std::string output;
  } cases[] = {
      {{"render", dem}, dem},
      {{"render", dem}, path("./dem.png")},
      {{"render", dem}, path("link.png")},
      {{"render", path("link.png")}, dem},
      {{"render", folder}, folder + "/west.png"},
      {{"render", folder + "/west.png", folder + "/east.png"}, folder + "/east.png"},
      {{"render", over_dem}, dem},
      {{"render", dem, "--ramp", image}, image},
      {{"render", dem, "--overlay", image}, image},
      {{"render", dem, "--overlay", over_image}, image},
      {{"render", heights}, dem},
      {{"render", village}, dem},
      {{"render", "--function", image}, image},
      {{"render", dem, "--path", flight, "--overwrite"}, path("flight-##.png")},
      {{"cast", dem, "--rays", rays}, rays},
      {{"cast", dem, "--rays", "-"}, rays},
      {{"cast", over_table, "--rays", rays}, table},
      {{"composite", dem, image}, dem},
      {{"composite", dem, image}, image},
      {{"voxelise", model}, model},
      {{"voxelise", voxels}, model},
      {{"section", volume, "--volume", "1x1x1:u8"}, volume},
      {{"generate", "--size", "2", "--function", function}, function},
  };
  for (const auto& c : cases) {
    std::map<std::string, std::string> before, after;
    const auto look = [&](std::map<std::string, std::string>& files) {
      for (const auto& entry : std::filesystem::recursive_directory_iterator(scratch_.path("")))
        if (entry.is_regular_file()) files[entry.path()] = test::text_of(entry.path());
    };
    look(before);
    Names arguments = c.arguments;
    arguments.insert(arguments.end(), {"-o", c.output});
    const auto result = run(arguments, rays);
    const std::string what = fmt::format("{}: {}", fmt::join(arguments, " "), result.err);
    EXPECT_EQ(result.status, 1) << what;
    EXPECT_EQ(test::lines(result.err), 1) << what;
    EXPECT_NE(result.err.find("': is the input"), std::string::npos) << what;
    look(after);
    EXPECT_TRUE(before == after) << what;
  }
}

TEST_F(Cli, ErrorsInOptionsNameValidValues) {
  good();
  const Names before = scratch_.files();
  const struct {
    Names options;
    std::string fragment;
  } cases[] = {
      {{"--no-such-option"}, "--no-such-option"},
      {{"--size", "0x0"}, "1 to 65536"},
      {{"--size", "-5x10"}, "1 to 65536"},
      {{"--size", "1000000x1000000"}, "1 to 65536"},
      {{"--size", "60000x60000"}, "at most"},
      {{"--size", "640"}, "WIDTHxHEIGHT"},
      {{"--size", "64.5x48"}, "WIDTHxHEIGHT"},
      {{"--size", "axb"}, "WIDTHxHEIGHT"},
      {{"--size", "1e300x1"}, "WIDTHxHEIGHT"},
      {{"--sun", "nan,45"}, "AZIMUTH,ALTITUDE"},
      {{"--sun", "315"}, "AZIMUTH,ALTITUDE"},
      {{"--sun", "315,-5"}, "above 0"},
      {{"--view", "1,2,3,4"}, "AZIMUTH,ELEVATION"},
      {{"--view", "0,120"}, "0 to 90"},
      {{"--view", "0,30,0"}, "above 0"},
      {{"--eye", "1,2"}, "X,Y,Z"},
      {{"--eye", "1,2,inf"}, "X,Y,Z"},
      {{"--eye", "1,2,3", "--target", "1,2,3"}, "same point"},
      {{"--target", "1,2,3"}, "--eye"},
      {{"--fov", "nan"}, "1 to 150"},
      {{"--fov", "0"}, "1 to 150"},
      {{"--top", "--view", "0,30"}, "--view"},
      {{"--exaggeration", "0"}, "above 0"},
      {{"--exaggeration", "nan"}, "above 0"},
      {{"--exaggeration", "-2"}, "above 0"},
      {{"--exaggeration", "much"}, "much"},
      {{"--march", "fast"}, "max-mip"},
      {{"--look", "pretty"}, "shaded"},
      {{"--ramp", "jet"}, "viridis"},
      {{"--aa", "0"}, "1 to 16"},
      {{"--aa", "x"}, "x"},
      {{"--samples", "-1"}, "0 to 4096"},
      {{"--samples", "5000"}, "0 to 4096"},
      {{"--samples", "2.5"}, "2.5"},
      {{"--sun-size", "-0.1"}, "0 to 90"},
      {{"--sun-size", "nan"}, "0 to 90"},
      {{"--ao-distance", "-1"}, "0 or more"},
      {{"--ao-distance", "nan"}, "0 or more"},
      {{"--seed", "-3"}, "0 to 4294967295"},
      {{"--seed", "4294967296"}, "0 to 4294967295"},
      {{"--naive-max-steps", "1e9"}, "--naive-max-steps '1e9': expected a whole number, 1 or more"},
      {{"--nodata", "x"}, "--nodata 'x': expected a number"},
      {{"--march", "lipschitz", "--lipschitz-max-steps", "0"}, "1 or more"},
      {{"--shrink", "1.5"}, "0 to 1"},
      {{"--haze", "2"}, "0 to 0.95"},
      {{"--threads", "-1"}, "0"},
      {{"--naive-min-step", "0"}, "above 0"},
      {{"--march", "relaxed", "--relaxed-tolerance", "0"}, "above 0"},
      {{"--march", "max-mip-bisect", "--bisect-halvings", "99"}, "1 to 60"},
      {{"--error-tolerance", "-1"}, "0 or more"},
      {{"second.asc"}, "second.asc: does not exist"},
      {{"--scale", "1,2,3"}, "S[,OFFSET]"},
      {{"--scale", "0"}, "finite, non-zero --scale"},
      {{"--scale", "1e300"}, "--scale '1e300': expected numbers from -1073741824 to 1073741824"},
      {{"--offset", "1e20"}, "--offset '1e20': expected a number from -1073741824 to 1073741824"},
      {{"--exaggeration", "1e30"}, "--exaggeration '1e30': expected a number above 0 and at most 1073741824"},
      {{"--bounds", "0,0,1e300,1e300"}, "--bounds '0,0,1e300,1e300': expected numbers from"},
      {{"--height-range", "0,1e30"}, "--height-range '0,1e30': expected numbers from"},
      {{"--crs", "EPSG:4326", "--bounds", "500000,4000000,501000,4001000"}, "longitudes span"},
      {{"--scale", "2,5", "--offset", "7"}, "--offset repeats the offset of --scale S,OFFSET"},
      {{"--scale", "2", "--height-range", "0,1"}, "--height-range cannot be combined with --scale"},
      {{"--height-range", "5"}, "LOW,HIGH"},
      {{"--height-range", "5,nan"}, "LOW,HIGH"},
      {{"--height-range", "5,4"}, "LOW < HIGH"},
      {{"--encoding", "rgb"}, "terrain-rgb or terrarium"},
      {{"--encoding", "terrarium"}, "it has 1 band"},
      {{"--raw", "4x3"}, "COLSxROWS:TYPE"},
      {{"--raw", "4x3:u16le"}, "--raw 4x3:u16le needs 24"},
      {{"--channel", "Y"}, ".exr"},
  };
  for (const auto& c : cases) {
    Names arguments{"render", path("good.asc"), "-o", path("out.png")};
    arguments.insert(arguments.end(), c.options.begin(), c.options.end());
    const auto result = run(arguments);
    const std::string what = fmt::format("{}: {}", fmt::join(c.options, " "), result.err);
    EXPECT_TRUE(result.status == 1 || result.status == 2) << result.status << ", " << what;
    EXPECT_EQ(result.out, "") << what;
    EXPECT_EQ(test::lines(result.err), 1) << what;
    EXPECT_NE(result.err.find(c.fragment), std::string::npos) << "'" << c.fragment << "' is not in: " << what;
  }
  EXPECT_EQ(scratch_.files(), before);
}

TEST_F(Cli, ReportsMissingArguments) {
  for (const Names& arguments : {Names{"render"},
                                 {"render", "--paint"},
                                 {"render", good()},
                                 {"render", "-o", path("out.png")},
                                 {"paint"},
                                 {"--paint"}}) {
    const auto result = run(arguments);
    EXPECT_EQ(result.status, 2) << result.err;
    EXPECT_EQ(test::lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find("--help"), std::string::npos) << result.err;
  }
}

TEST_F(Cli, UnknownSubcommandListsSubcommands) {
  for (const Names& arguments : {Names{"rendr"}, {"rendr", good(), "-o", path("out.png")}}) {
    const auto result = run(arguments);
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(test::lines(result.err), 1) << result.err;
    EXPECT_EQ(result.err.find("scarp: error: unknown subcommand 'rendr' (did you mean 'render'? available: render, "),
              0u)
        << result.err;
  }
  const auto file = run({good()});
  EXPECT_EQ(file.status, 2);
  EXPECT_EQ(file.err, fmt::format("scarp: error: '{0}' is a file, not a subcommand (did you mean 'scarp render {0} -o "
                                  "out.png'?)\n",
                                  good()));
}

TEST_F(Cli, ReportsAnUnknownOptionBeforeAMissingOne) {
  EXPECT_NE(run({"render", "--ouput", "x.png"}).err.find("--ouput"), std::string::npos);
}

TEST_F(Cli, GenerateRejectsInvalidOptions) {
  const struct {
    Names options;
    std::string fragment;
  } cases[] = {
      {{"--size", "0"}, "1 to 65536"},
      {{"--size", "70000"}, "1 to 65536"},
      {{"--size", "2x"}, "N or NxM"},
      {{"--size", "8", "--kind", "hills"}, "fbm or ridged"},
      {{"--size", "8", "--cell", "nan"}, "above 0"},
      {{"--size", "8", "--cell", "1e300"}, "at most 1000000"},
      {{"--size", "8", "--cell", "far"}, "--cell 'far': expected a number"},
      {{"--size", "8", "--seed", "1.5"}, "whole number from 0"},
      {{"--size", "8", "--seed", "18446744073709551616"}, "0 to 18446744073709551615"},
      {{"--size", "8", "-o", path("out.png")}, ".tif"},
      {{"--size", "8", "-o", path("none/out.tif")}, "does not exist"},
  };
  for (const auto& c : cases) {
    Names arguments{"generate"};
    arguments.insert(arguments.end(), c.options.begin(), c.options.end());
    if (std::find(arguments.begin(), arguments.end(), "-o") == arguments.end()) {
      arguments.insert(arguments.end(), {"-o", path("out.tif")});
    }
    const auto result = run(arguments);
    const std::string what = fmt::format("{}: {}", fmt::join(c.options, " "), result.err);
    EXPECT_TRUE(result.status == 1 || result.status == 2) << what;
    EXPECT_EQ(result.out, "") << what;
    EXPECT_EQ(test::lines(result.err), 1) << what;
    EXPECT_NE(result.err.find(c.fragment), std::string::npos) << "'" << c.fragment << "' is not in: " << what;
    EXPECT_EQ(scratch_.files(), Names{}) << what;
  }
}

// Samples and pyramid together take 4 bytes per sample for 16-bit files and 6 for float32, plus a float per 8 x 8 cells
// for the steepest edges.
TEST_F(Cli, SamplesKeepTheTypeOfTheFile) {
  constexpr int kSide = 64;
  constexpr double kEdges = 4.0 / (8 * 8);
  const struct {
    std::string raw, type;
    int bytes;
    double most;
  } cases[] = {
      {"i16le", "int16", 2, 4 + kEdges}, {"u16le", "uint16", 2, 4 + kEdges}, {"f32le", "float32", 4, 6 + kEdges}};
  for (const auto& c : cases) {
    const std::string file = write("heights.raw", std::string(static_cast<std::size_t>(kSide * kSide * c.bytes), '\0'));
    const auto result =
        run({"info", "--json", "--statistics", file, "--raw", fmt::format("{0}x{0}:{1}", kSide, c.raw)});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto info = nlohmann::json::parse(result.out);
    EXPECT_EQ(info.at("sample_type"), c.type);
    const double bytes = info.at("bytes_per_sample");
    EXPECT_GT(bytes, c.bytes) << "there is a pyramid";
    EXPECT_LE(bytes, c.most) << c.type;
  }
}

TEST_F(Cli, TilesAndGapsFormOneField) {
  const std::string west = good(), east = write("tiles.asc",
                                                "ncols 2\nnrows 3\nxllcorner 60\nyllcorner 0\ncellsize 10\n"
                                                "NODATA_value -9999\n1 2\n2 3\n3 9\n");
  for (const Names& inputs : {Names{west, east}, {scratch_.path("")}}) {
    Names arguments{"info", "--json", "--statistics"};
    arguments.insert(arguments.end(), inputs.begin(), inputs.end());
    const auto info = run(arguments);
    EXPECT_EQ(info.status, 0) << info.err;
    EXPECT_NE(info.out.find("\"cols\": 8,"), std::string::npos) << info.out;
    EXPECT_NE(info.out.find("\"nodata_count\": 6,"), std::string::npos) << info.out;
    EXPECT_NE(info.out.find("6 samples (25 %) are holes"), std::string::npos) << info.out;
  }
  const auto picture = run({"render", west, east, "-o", path("out.png"), "--size", "32x24"});
  EXPECT_EQ(picture.status, 0) << picture.err;
  EXPECT_NE(picture.err.find("note: gaps between tiles"), std::string::npos) << picture.err;
}

TEST_F(Cli, ReadsRawSamplesAsDeclared) {
  const std::string file = write("heights.raw", std::string("head\x01\x00\x02\x00\x03\x00\x00\x01", 12));
  const auto info = run({"info", "--json", "--statistics", file, "--raw", "2x2:u16le+4", "--scale", "0.5,100"});
  EXPECT_EQ(info.status, 0) << info.err;
  EXPECT_NE(info.out.find("\"min_m\": 100.5,"), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("\"max_m\": 228.0,"), std::string::npos) << info.out;
}

TEST_F(Cli, InfoReadsSamplesOnlyForStatistics) {
  // The last of four heights is infinite.
  const std::string file = write("heights.raw", std::string(14, '\0') + "\x80\x7f");
  const Names words{"info", file, "--raw", "2x2:f32le"};
  const auto with = [&](const char* option) {
    Names more = words;
    more.emplace_back(option);
    return run(more);
  };
  const auto text = run(words);
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_NE(text.out.find("samples not read (--statistics"), std::string::npos) << text.out;
  const auto json = nlohmann::json::parse(with("--json").out);
  EXPECT_EQ(json.at("cols"), 2);
  EXPECT_EQ(json.at("statistics"), "none");
  EXPECT_TRUE(json.at("max_m").is_null());
  const auto refused = with("--statistics");
  EXPECT_NE(refused.status, 0);
  EXPECT_NE(refused.err.find("infinite"), std::string::npos) << refused.err;
}

TEST_F(Cli, PrintsHelpAndVersion) {
  const auto bare = test::Program({}).result();
  EXPECT_EQ(bare.status, 2);
  EXPECT_NE(bare.err.find("render"), std::string::npos);
  EXPECT_EQ(bare.out, "");
  const auto help = run({"--help"});
  EXPECT_EQ(help.status, 0);
  for (const char* command : {"render", "cast", "info", "generate", "marches", "replay"}) {
    EXPECT_NE(help.out.find(fmt::format("\n  {} ", command)), std::string::npos) << command << ": " << help.out;
    EXPECT_EQ(run({command, "--help"}).status, 0);
  }
  const auto version = test::Program({"--version"}).result();
  EXPECT_EQ(version.status, 0);
  EXPECT_EQ(version.out.find("scarp "), 0u) << version.out;
}

TEST_F(Cli, ListsEachMarchOnce) {
  const auto plain = run({"marches"}), markdown = run({"marches", "--markdown"});
  EXPECT_EQ(plain.status, 0);
  EXPECT_EQ(markdown.status, 0);
  for (const char* name :
       {"exhaustive", "naive", "relaxed", "lipschitz", "max-mip", "max-mip-bisect", "max-mip-easy"}) {
    EXPECT_NE(plain.out.find(fmt::format("\n{} ", name)), std::string::npos) << plain.out;
    EXPECT_NE(markdown.out.find(fmt::format("\n| `{}` |", name)), std::string::npos) << markdown.out;
  }
}

TEST_F(Cli, ReportsAFullStandardOutput) {
  for (const char* word : {"marches", "--help", "--version"}) {
    test::Program program({word}, "/dev/full");
    const auto result = program.result();
    EXPECT_EQ(result.status, 1) << word;
    EXPECT_NE(result.err.find("standard output"), std::string::npos) << word << ": " << result.err;
  }
}

// Stops a long render by a signal; it must exit soon and leave no files.
class Interrupt : public Cli, public testing::WithParamInterface<int> {};

TEST_P(Interrupt, LeavesNoOutput) {
  good();
  const auto begin = std::chrono::steady_clock::now();
  test::Program program({"render", path("good.asc"), "-o", path("out.png"), "--size", "8000x8000", "--aa", "16"});
  const auto waited = [&] { return std::chrono::steady_clock::now() - begin; };
  while (scratch_.files().size() < 2 && waited() < std::chrono::seconds(20)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ASSERT_EQ(scratch_.files().size(), 2u) << "the output was never begun";
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  ::kill(program.pid(), GetParam());
  const auto result = program.result();
  EXPECT_EQ(result.status, 128 + GetParam()) << result.err;
  EXPECT_TRUE(result.err.ends_with("scarp: interrupted\n")) << result.err;
  EXPECT_EQ(scratch_.files(), Names{"good.asc"});
}

// A pipe that other processes can open immediately, and whose readers wait until it is closed.
class OpenPipe {
 public:
  explicit OpenPipe(const std::string& path) {
    if (::mkfifo(path.c_str(), 0600) != 0) throw std::runtime_error("mkfifo failed");
    file_ = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  }
  ~OpenPipe() { close(); }
  OpenPipe(const OpenPipe&) = delete;
  OpenPipe& operator=(const OpenPipe&) = delete;

  // Returns when the text has been read: a program that opens /dev/stdin again only after close() waits for a writer.
  void write(std::string_view text) const {
    EXPECT_EQ(::write(file_, text.data(), text.size()), static_cast<::ssize_t>(text.size()));
    for (int left = 1, i = 0; left > 0 && i < 20'000; ++i) {
      ASSERT_EQ(::ioctl(file_, FIONREAD, &left), 0);
      if (left > 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  void close() {
    if (file_ >= 0) ::close(file_);
    file_ = -1;
  }

 private:
  int file_ = -1;
};

// Waits on a pipe for a function that nobody writes, so it cannot check for signals.
TEST_P(Interrupt, EndsBlockedReads) {
  const std::string pipe = path("pipe");
  const OpenPipe kept(pipe);
  const Names waiting{"render", "--function", "/dev/stdin", "-o", path("out.png")};
  const auto begun = [&](test::Program& program) {
    wait_for_output();
    ::kill(program.pid(), GetParam());
  };
  {
    test::Program program(waiting, nullptr, pipe);
    begun(program);
    const auto result = program.result();
    EXPECT_EQ(result.status, 128 + GetParam()) << result.err;
    EXPECT_EQ(result.err, "scarp: interrupted\n");
    EXPECT_EQ(scratch_.files(), Names{"pipe"});
  }
  // The second signal ends the program at once: its number is reported, not that of the first.
  const int second = GetParam() == SIGINT ? SIGTERM : SIGINT;
  test::Program program(waiting, nullptr, pipe);
  begun(program);
  // If two signals are pending at once, the system chooses which comes first.
  const std::string status = fmt::format("/proc/{}/status", program.pid());
  for (int i = 0; i < 2000 && test::text_of(status).find("\nShdPnd:\t0000000000000000\n") == std::string::npos; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ::kill(program.pid(), second);
  const auto result = program.result();
  EXPECT_EQ(result.status, 128 + second) << result.err;
  EXPECT_EQ(result.err, "scarp: interrupted\n");
  EXPECT_EQ(scratch_.files(), Names{"pipe"});
}

INSTANTIATE_TEST_SUITE_P(Signals, Interrupt, testing::Values(SIGINT, SIGTERM, SIGHUP, SIGQUIT));

// As under nohup.
TEST_F(Cli, KeepsIgnoredSignalsIgnored) {
  const std::string pipe = path("pipe");
  OpenPipe function(pipe);
  const auto before = std::signal(SIGHUP, SIG_IGN);
  // Checks for signals after reading the function.
  test::Program program({"render", "--function", "/dev/stdin", "-o", path("out.png"), "--size", "8x6"}, nullptr, pipe,
                        test::Ignored::inherited);
  std::signal(SIGHUP, before);
  wait_for_output();
  ::kill(program.pid(), SIGHUP);
  function.write(R"({"type": "sines", "waves": [{"amplitude": 3.2, "wavelength": 140, "towards": 70}]})");
  function.close();
  const auto result = program.result();
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "");
}

}  // namespace
}  // namespace scarp
