// SPDX-License-Identifier: MIT
// Runs scarp-bench from end to end, and checks that its output is as README.md describes. Times are not tested here.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "bench/program_output.h"

namespace {

using nlohmann::json;
using scarp::bench::expect_documented, scarp::bench::output_of;

// The output of a command that must succeed or must fail, depending on `succeeds`.
std::string text_of(const std::string& arguments, bool succeeds) {
  const std::string command = fmt::format("'{}' {}", SCARP_BENCH_PROGRAM, arguments);
  FILE* const pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return "";
  std::string text;
  for (int c; (c = std::fgetc(pipe)) != EOF;) text += static_cast<char>(c);
  EXPECT_EQ(::pclose(pipe) == 0, succeeds) << command;
  return text;
}

TEST(ScarpBench, NaiveWritesTheDocumentedFields) {
  const json all =
      output_of("naive --size 129 --exaggerations 1,4 --rays small --repeats 1 --judged 2000 --pass-limit 0.02");
  expect_documented(all, "naive");
  int comparisons = 0;
  for (const json& row : all["rows"]) {
    const double missed = row["miss_rate"], late = row["late_rate"], early = row["early_rate"];
    if (row["mode"] == "naive-position") {
      ++comparisons;
      EXPECT_LE(missed + late + early, 0.001);
      EXPECT_LE(row["false_rate"], 0.001);
      EXPECT_EQ(row["exhausted"], 0.0);
    }
    if (row["mode"] == "naive-missed") {
      EXPECT_LT(missed, 0.001);
    }
    if (row["mode"] == "naive-missed-false") {
      EXPECT_LT(missed + row["false_rate"].get<double>(), 0.001);
    }
    if (row["mode"] == "naive-missed-late") {
      EXPECT_LT(missed + late, 0.001);
    }
  }
  EXPECT_EQ(comparisons, 4 * 2);  // classes, exaggerations
}

TEST(ScarpBench, BatchesRunsAllSizes) {
  const json all = output_of("batches --size 129 --rays small --repeats 1 --batches 10,5000");
  expect_documented(all, "batches");
  EXPECT_EQ(all["rows"].size(), 2u * 2u * 2u);  // classes, orders, sizes
  for (const json& row : all["rows"]) {
    EXPECT_NEAR(row["mrays_per_s"].get<double>() * row["us_per_batch"].get<double>(), row["batch"].get<double>(), 1e-6);
  }
}

#ifdef SCARP_BENCH_C
TEST(ScarpBench, CAnswersAsCpp) {
  const json all = output_of("c --size 129 --rays small --repeats 1");
  expect_documented(all, "c");
  EXPECT_EQ(all["rows"].size(), 2u * 2u);  // classes, calls
  for (const json& row : all["rows"]) EXPECT_EQ(row["differ"], 0) << row;
}
#endif

TEST(ScarpBench, CallsRunsAllTasks) {
  const json all = output_of("calls --sizes 65 --of heights,normals,feet --points 1000 --repeats 1");
  expect_documented(all, "calls");
  EXPECT_GT(all["rows"].size(), 3u);
  for (const json& row : all["rows"]) EXPECT_GT(row["ratio"], 0) << row;
}

TEST(ScarpBench, TilesMatchOneField) {
  const json all = output_of("tiles --sizes 65 --cells 16 --points 2000 --repeats 1");
  expect_documented(all, "tiles");
  EXPECT_EQ(all["rows"].size(), 5u * 2u * 2u);  // tasks, terrains, calls
  for (const json& row : all["rows"]) EXPECT_EQ(row["differ"], 0) << row;
}

TEST(ScarpBench, ExtentsMatchWindows) {
  const json all = output_of("extents --sizes 600x513 --windows 2");
  expect_documented(all, "extents");
  for (const json& row : all["rows"]) {
    EXPECT_EQ(row["lost"], 0);
    EXPECT_EQ(row["different"], 0);
  }
}

TEST(ScarpBench, PyramidWritesTheDocumentedFields) {
  const json all = output_of("pyramid --sizes 2,129 --repeats 1");
  expect_documented(all, "pyramid");
}

TEST(ScarpBench, MapsWritesTheDocumentedFields) {
  const json all = output_of("maps --sizes 65 --repeats 1 --judged 100 --programs none");
  expect_documented(all, "maps");
  for (const json& row : all["rows"]) {
    EXPECT_EQ(row["wrong"], 0);
  }
}

TEST(ScarpBench, MapsMeasuresLinesOfSight) {
  const json all = output_of("maps --sizes 1024 --repeats 1 --judged 1000 --lines 1000 --programs none");
  for (const json& row : all["rows"]) {
    if (row["map"] != "lines of sight") continue;
    EXPECT_EQ(row["judged"], 1000);
    EXPECT_EQ(row["wrong"], 0);
  }
  EXPECT_EQ(all["rows"].back()["map"], "lines of sight");
}

#ifdef SCARP_BENCH_SCARP
TEST(ScarpBench, MapsMeasuresPrograms) {
  const json all = output_of(
      "maps --sizes 65 --repeats 1 --judged 100 --observers 3 --programs scarp --scarp '" SCARP_BENCH_SCARP "'");
  std::set<std::string> maps;
  for (const json& row : all["rows"]) {
    if (!row.contains("program")) continue;
    EXPECT_GT(row["seconds"], 0);
    EXPECT_EQ(row["judged"], row["map"] == "cumulative" ? 33 : 65 * 65);
    EXPECT_EQ(row["wrong"], 0);
    maps.insert(row["map"]);
  }
  EXPECT_EQ(maps, (std::set<std::string>{"viewshed", "shadow", "cumulative"}));
}
#endif

TEST(ScarpBench, VolumesWritesTheDocumentedFields) {
  const json all = output_of("volumes --side 64 --repeats 1");
  expect_documented(all, "volumes");
  EXPECT_EQ(all["rows"].size(), 4u);
}

TEST(ScarpBench, LeaksFindsNoneAndIsReproducible) {
  const json all = output_of("leaks --rays 200000 --large 129 --seed 5 --judge-every 64 --dump /nowhere/none");
  expect_documented(all, "leaks");
  for (const json& row : all["rows"]) {
    SCOPED_TRACE(row.dump());
    EXPECT_GT(row["rays"], 0);
    EXPECT_EQ(row["lost"], 0);
    EXPECT_EQ(row["false"], 0);
    EXPECT_EQ(row["contradictions"], 0);
  }
  const json& total = all["rows"].back();
  EXPECT_EQ(total["rays"], 200000);
  EXPECT_GT(total["must_hit"], 50000);
  EXPECT_GT(total["judged"], 1000);
  EXPECT_GT(total["embree_lost"], 0) << "rays that no engine loses prove nothing";
  const json again = output_of("leaks --rays 200000 --large 129 --seed 5 --judge-every 64 --dump /nowhere/none");
  EXPECT_EQ(again["rows"], all["rows"]);
}

TEST(ScarpBench, EditsWritesTheDocumentedFields) {
  const json all = output_of("edits --size 129 --rect 16 --edits 5");
  expect_documented(all, "edits");
  EXPECT_EQ(all["rows"].size(), 2u);
}

TEST(ScarpBench, VoxelEditsWritesTheDocumentedFields) {
  const json all = output_of("voxel-edits --side 40 --radius 4 --edits 3");
  expect_documented(all, "voxel-edits");
  EXPECT_EQ(all["rows"].size(), 9u);
}

TEST(ScarpBench, VoxelWorldsWritesTheDocumentedFieldsAndMarchesAgree) {
  const json all = output_of("voxel-worlds --side 600 --width 16 --repeats 1 --planes");
  expect_documented(all, "voxel-worlds");
  EXPECT_GE(all["rows"].size(), 4u);
  for (const json& row : all["rows"]) {
    if (row["engine"] != "nanovdb-hdda") {
      EXPECT_EQ(row["other_ppm"], 0);
      EXPECT_GT(row["hit_share"], 0.5);
    }
  }
}

TEST(ScarpBench, ScenesWritesTheDocumentedFields) {
  const json all = output_of("scenes --objects 100,1000 --rays 1000 --repeats 1");
  expect_documented(all, "scenes");
  EXPECT_EQ(all["rows"].size(), 2u);
}

TEST(ScarpBench, VoxelsWritesTheDocumentedFieldsAndMarchesAgree) {
  const json all =
      output_of("voxels --sets standard,degenerate --thousands 1 --stride 16 --width 16 --block 2 --repeats 1");
  expect_documented(all, "voxels");
  std::map<std::string, int> rows;
  for (const json& row : all["rows"]) {
    const std::string table = row["table"];
    ++rows[table];
    if (table == "build") {
      continue;
    }
    if (table == "colours") {
      continue;
    }
    // NanoVDB's results may differ.
    const std::string engine = row["engine"];
    if (!engine.starts_with("voxel-") && engine != "embree-user") continue;
    EXPECT_EQ(row["lost_ppm"], 0) << row;
    EXPECT_EQ(row["other_ppm"], 0) << row;
    if (table == "grid" || engine == "embree-user") continue;
  }
  EXPECT_EQ(rows["colours"], 4);
  EXPECT_EQ(rows["frame"], 2 * (24 + 4));
  EXPECT_GE(rows["grid"], 2 * 10);
}

TEST(ScarpBench, VoxelLeaksFindsNone) {
  const json all = output_of("voxel-leaks --rays 50000 --judge-every 8");
  expect_documented(all, "voxel-leaks");
  for (const json& row : all["rows"]) {
    EXPECT_EQ(row["wrong"], 0);
    EXPECT_GT(row["hits"], 1000);
  }
}

TEST(ScarpBench, PixelMatchFindsNoDifference) {
  const json all = output_of(
      "pixel-match --sets degenerate --thousands 1 --width 96 --height 54 --cameras post "
      "--marches voxel-planes,voxel-octants");
  expect_documented(all, "pixel-match");
  EXPECT_EQ(all["rows"].size(), 2U);
  for (const json& row : all["rows"]) {
    EXPECT_EQ(row["way"], "cpu");
    EXPECT_EQ(row["differ"], 0);
    EXPECT_EQ(row["near_edge_wrong"], 0);
    EXPECT_LT(row["ray_pixels"], 1e-3);
    EXPECT_GT(row["hits"], 5);
  }
}

// A device can take minutes for all pictures.
TEST(ScarpBench, PixelMatchReportsItsProgress) {
  const std::string progress = text_of(
      "pixel-match --sets degenerate,standard --thousands 1 --width 32 --height 18 --cameras post 2>&1 >/dev/null",
      true);
  EXPECT_EQ(
      progress,
      "picture 1 of 2: degenerate, 1024 objects, camera post\npicture 2 of 2: standard, 1024 objects, camera post\n");
}

TEST(ScarpBench, RenderWritesTheDocumentedFieldsAndMaxMipIsRight) {
  const json all = output_of("render --period 64 --width 40 --height 30 --cameras 2 --repeats 1 --judge-every 3");
  expect_documented(all, "render");
  double stepped = 0;
  for (const json& row : all["rows"]) {
    EXPECT_EQ(row["engine"], "cpu");
    EXPECT_EQ(row["judged_pixels"], 2 * 400);
    if (row["way"] == "max-mip") {
      EXPECT_EQ(row["wrong_percent"], 0);
    } else {
      stepped += row["wrong_percent"].get<double>();
    }
  }
  EXPECT_GT(stepped, 0) << "steps are seen to be wrong";
}

#ifdef SCARP_BENCH_VULKAN
TEST(ScarpBench, RenderReportsDeviceAndCpuRows) {
  const std::string command =
      fmt::format("'{}' gpu --device none-of-that-name 2>&1 | grep -q 'Vulkan: no'", SCARP_BENCH_PROGRAM);
  if (std::system(command.c_str()) == 0) GTEST_SKIP() << "no Vulkan device";
  const json all =
      output_of("render --period 64 --width 32 --height 24 --cameras 1 --repeats 1 --judge-every 1 --device auto");
  ASSERT_EQ(all["rows"].size(), 40u);
  for (std::size_t i = 0; i < 20; ++i) {
    const json &cpu = all["rows"][i], &device = all["rows"][20 + i];
    EXPECT_EQ(cpu["engine"], "cpu");
    EXPECT_NE(device["engine"], "cpu");
    EXPECT_EQ(device["way"], cpu["way"]);
    // Steps, and therefore errors, are those of the CPU.
    EXPECT_NEAR(device["wrong_percent"].get<double>(), cpu["wrong_percent"].get<double>(), 0.3);
  }
}

TEST(ScarpBench, VoxelsOnDeviceMatchCpu) {
  const std::string command =
      fmt::format("'{}' gpu --device none-of-that-name 2>&1 | grep -q 'Vulkan: no'", SCARP_BENCH_PROGRAM);
  if (std::system(command.c_str()) == 0) GTEST_SKIP() << "no Vulkan device";
  const json all = output_of("voxels --device auto --sets degenerate --thousands 1 --height 36 --repeats 1");
  expect_documented(all, "voxels");
  std::map<std::string, int> ways;
  for (const json& row : all["rows"]) {
    SCOPED_TRACE(row.dump());
    ++ways[row["engine"] == "triangles" ? "triangles" : row["way"].get<std::string>()];
    EXPECT_GT(row["ms"], 0.0);
    EXPECT_LT(row["device_mib"], 2.0);
    if (row["engine"] == "triangles") continue;
    EXPECT_EQ(row["wrong"], 0);
  }
  // Five marches in grids and in bounds.
  EXPECT_EQ(ways, (std::map<std::string, int>{{"compute", 10}, {"proxies", 10}, {"triangles", 1}}));
}

TEST(ScarpBench, GpuWritesTheDocumentedFieldsAndMaxMipIsRight) {
  // If no device has the given name, the error lists the available devices, or states that there are none.
  const std::string command =
      fmt::format("'{}' gpu --device none-of-that-name 2>&1 | grep -q 'Vulkan: no'", SCARP_BENCH_PROGRAM);
  if (std::system(command.c_str()) == 0) GTEST_SKIP() << "no Vulkan device";
  const json all = output_of("gpu --sizes 129 --rays small --judged 2000 --repeats 1");
  expect_documented(all, "gpu");
  std::set<std::string> classes, modes;
  for (const json& row : all["rows"]) {
    SCOPED_TRACE(row.dump());
    const std::string ray_class = row["class"], mode = row["mode"];
    classes.insert(ray_class);
    modes.insert(mode);
    if (ray_class == "build") {
      EXPECT_GT(row["build_ms"], 0.0);
      continue;
    }
    EXPECT_GT(row["mrays_per_s"], 0.0);
    EXPECT_GE(row["fetches_per_ray"], row["steps_per_ray"]);
    if (mode == "max-mip") {
      // None of the 2000 rays passes the surface within the error of single precision.
      EXPECT_EQ(row["wrong_rate"], 0.0);
      EXPECT_EQ(row["fetch_ratio"], 1.0);
    }
    if (mode == "naive-missed") {
      EXPECT_LT(row["miss_rate"], 0.001);
    }
    if (mode == "naive-wrong-equal") {
      EXPECT_EQ(row["wrong_rate"], 0.0);
      EXPECT_GT(row["fetch_ratio"], 1.0);
    }
    if (mode == "naive-wrong" || mode == "naive-wrong-clipped") {
      EXPECT_LE(row["wrong_rate"], 0.001);
    }
  }
  EXPECT_EQ(classes, (std::set<std::string>{"build", "chunk", "primary", "shadow", "grazing", "ao"}));
  for (const char* mode :
       {"pyramid", "max-mip", "naive-default", "naive-position", "naive-position-clipped", "naive-missed",
        "naive-missed-false", "naive-wrong", "naive-wrong-clipped", "naive-wrong-equal", "relaxed", "lipschitz"})
    EXPECT_TRUE(modes.contains(mode)) << mode;
}

TEST(ScarpBench, GpuComparesAtEqualPositionError) {
  const std::string command =
      fmt::format("'{}' gpu --device none-of-that-name 2>&1 | grep -q 'Vulkan: no'", SCARP_BENCH_PROGRAM);
  if (std::system(command.c_str()) == 0) GTEST_SKIP() << "no Vulkan device";
  const json all =
      output_of("gpu --sizes 129 --rays small --judged 2000 --repeats 1 --classes primary,chunk --exaggerations 1,4");
  std::multiset<std::string> found, builds;
  std::map<double, double> factor_of_primary;
  for (const json& row : all["rows"]) {
    SCOPED_TRACE(row.dump());
    const std::string ray_class = row["class"], mode = row["mode"];
    if (ray_class == "build") {
      builds.insert(mode);
      continue;
    }
    if (mode != "naive-position" && mode != "naive-position-clipped") continue;
    found.insert(fmt::format("{} {} {}", ray_class, row["exaggeration"].get<int>(), mode));
    EXPECT_LE(row["miss_rate"].get<double>() + row["late_rate"].get<double>() + row["early_rate"].get<double>(), 0.001);
    EXPECT_LE(row["false_rate"], 0.001);
    EXPECT_GT(row["fetch_ratio"], 1.0);
    if (ray_class == "primary") factor_of_primary[row["exaggeration"]] = row["step_factor"];
  }
  EXPECT_EQ(builds.size(), 1u);
  EXPECT_EQ(found, (std::multiset<std::string>{"chunk 1 naive-position", "chunk 1 naive-position-clipped",
                                               "chunk 4 naive-position", "chunk 4 naive-position-clipped",
                                               "primary 1 naive-position", "primary 1 naive-position-clipped",
                                               "primary 4 naive-position", "primary 4 naive-position-clipped"}));
  EXPECT_LT(factor_of_primary[4], factor_of_primary[1]) << "steep ground needs a smaller factor";
}

TEST(ScarpBench, DevicesMarksTheChosenOne) {
  const std::string command =
      fmt::format("'{}' gpu --device none-of-that-name 2>&1 | grep -q 'Vulkan: no'", SCARP_BENCH_PROGRAM);
  if (std::system(command.c_str()) == 0) GTEST_SKIP() << "no Vulkan device";
  const std::string text = text_of("devices", true);
  EXPECT_NE(text.find("\n*"), std::string::npos) << text;
  EXPECT_EQ(text.find("\n*"), text.rfind("\n*")) << text;
  text_of("devices --device none-of-that-name 2> /dev/null", false);
}
#endif

#ifdef SCARP_BENCH_VULKAN
// Corners are rounded to a fraction of a pixel, so pixels next to an edge may show its other side, but nothing else.
TEST(ScarpBench, DrawnGridDepthsMatchRays) {
  const std::string command =
      fmt::format("'{}' gpu --device none-of-that-name 2>&1 | grep -q 'Vulkan: no'", SCARP_BENCH_PROGRAM);
  if (std::system(command.c_str()) == 0) GTEST_SKIP() << "no Vulkan device";
  const json all = output_of("gpu --raster --sizes 129,200 --rays small --repeats 1");
  expect_documented(all, "gpu --raster");
  std::multiset<std::string> modes;
  for (const json& row : all["rows"]) {
    SCOPED_TRACE(row.dump());
    modes.insert(row["mode"].get<std::string>());
    EXPECT_GT(row["ms"], 0.0);
    EXPECT_GT(row["hit_share"], 0.4);
    if (row["mode"] != "grid-mesh") continue;
    EXPECT_EQ(row["unexplained_rate"], 0.0);
  }
  EXPECT_EQ(modes, (std::multiset<std::string>{"grid-mesh", "grid-mesh", "max-mip", "max-mip", "max-mip, triangles",
                                               "max-mip, triangles"}));
}
#endif

TEST(ScarpBench, SimtComparesBundlesAtEqualError) {
  const std::string command = "simt --sizes 129 --rays small --groups 8 --classes chunk,primary --wrong-limit 0.01";
  const json all = output_of(command);
  expect_documented(all, "simt");
  std::multiset<std::string> modes;
  std::map<std::string, double> turns_of_32;
  for (const json& row : all["rows"]) {
    SCOPED_TRACE(row.dump());
    const std::string mode = row["mode"];
    modes.insert(mode);
    EXPECT_EQ(row["judged"], 8 * 64);
    EXPECT_LE(row["wrong_rate"], 0.01);
    EXPECT_GE(row["turns"], row["turns_per_ray"]);
    double sum = 0;
    for (const auto& [name, value] : row.items()) {
      if (name.ends_with("_instructions") && !value.is_null() && row.contains(name.substr(0, name.find('_')) + "_runs"))
        sum += value.get<double>();
    }
    EXPECT_NEAR(sum, row["instructions"].get<double>(), 1e-6 * sum);
    EXPECT_GE(row["lines_64"], row["lines_128"]);
    EXPECT_GE(row["lines_128"], row["fetches"]);
    if (mode == "max-mip") {
      EXPECT_EQ(row["max_mip_instructions"], 1.0);
      EXPECT_EQ(row["wrong_rate"], 0.0);
      EXPECT_EQ(row["second_pass_rate"], 0.0);
    }
    // In a larger bundle, more rays wait for one another.
    const std::string key = row["class"].get<std::string>() + mode;
    if (row["bundle"] == 32)
      turns_of_32[key] = row["turns"];
    else
      EXPECT_GE(row["turns"], turns_of_32.at(key));
  }
  for (const char* mode : {"max-mip", "naive", "naive-clipped"}) EXPECT_EQ(modes.count(mode), 4u) << mode;
  EXPECT_EQ(output_of(command)["rows"], all["rows"]);
}

TEST(ScarpBench, SeamsLoseNoRay) {
  const json all = output_of("seams --rays 200000");
  expect_documented(all, "seams");
  for (const json& row : all["rows"]) {
    EXPECT_EQ(row["lost"], 0) << row;
    EXPECT_EQ(row["any_hit_lost"], 0) << row;
  }
}

TEST(ScarpBench, PitchesWritesTheDocumentedFields) {
  const json all = output_of("pitches --size 129 --repeats 1 --step 45");
  expect_documented(all, "pitches");
  EXPECT_EQ(all["rows"].size(), 15u);
}

TEST(ScarpBench, SkyComparesHorizonsWithEmbree) {
  const json all = output_of("sky --sizes 129 --repeats 1 --azimuths 8 --nodes 400");
  expect_documented(all, "sky");
  ASSERT_EQ(all["rows"].size(), 4u);
  // Half of the accuracy of Embree's search, and the ground between crossings, which triangles have.
  for (const json& row : all["rows"]) EXPECT_LT(row["error_p50_deg"], 0.25) << row;
  const json maps = output_of("sky --sizes 129 --maps");
  expect_documented(maps, "sky");
  ASSERT_EQ(maps["rows"].size(), 2u);
  EXPECT_EQ(maps["rows"][0]["mean_error"], 0);
  EXPECT_LT(maps["rows"][1]["mean_error"], 0.001);
#ifdef SCARP_BENCH_SCARP
  const json programs = output_of("sky --sizes 65 --repeats 1 --programs scarp --scarp " SCARP_BENCH_SCARP);
  expect_documented(programs, "sky");
  ASSERT_EQ(programs["rows"].size(), 8u);
  // Angles and shares are sums of 64 floats, of at most pi / 2 each; hours are sums of half-hours, and at each of the
  // four times at which the sun comes or goes the step may be the one before or behind, by a quarter on average.
  constexpr double kFloats = 64 * 0x1p-24, kHours = 4 * 0.25;
  for (const json& row : programs["rows"]) {
    if (row["program"] == "scarp, exact") {
      EXPECT_LE(row["error_p99"], row["map"] == "hours of sun" ? kHours : kFloats) << row;
    }
  }
#endif
}

TEST(ScarpBench, SweepsAgreeWithBulletWithoutTunnelling) {
  const json all = output_of("sweeps --sweeps 500 --repeats 1 --judged 20000");
  expect_documented(all, "sweeps");
  int judged = 0, surfaces = 0;
  for (const json& row : all["rows"]) {
    if (row.contains("tunnelled")) {
      ++judged;
      EXPECT_EQ(row["tunnelled"], 0) << row;
      EXPECT_EQ(row["untouched"], 0) << row;
      continue;
    }
    // Rows of both surfaces have no peer.
    if (row.contains("bilinear_us")) {
      ++surfaces;
      continue;
    }
    // Bullet computes in float, so it may decide grazing contacts differently.
    EXPECT_LE(row["differ"].get<int>(), row["sweeps"].get<int>() / 50 + 1) << row;
  }
  EXPECT_EQ(judged, 2);
  EXPECT_GT(surfaces, 0);
}

TEST(ScarpBench, ReportsErrorsInOneLine) {
  const auto fails = [](const std::string& arguments) {
    return std::system(fmt::format("'{}' {} > /dev/null 2>&1", SCARP_BENCH_PROGRAM, arguments).c_str()) != 0;
  };
  EXPECT_TRUE(fails(""));
  EXPECT_TRUE(fails("heights --sizes 1"));
  EXPECT_TRUE(fails("heights --classes sideways"));
  EXPECT_TRUE(fails("heights --engines none"));
  EXPECT_TRUE(fails("heights --dem /nowhere.tif --rays small"));
  EXPECT_TRUE(fails("survey --dems /nowhere.tif --rays small"));
  EXPECT_TRUE(fails("heights --csv /nowhere/rows.csv"));
  EXPECT_TRUE(fails("leaks --rays 0"));
  EXPECT_TRUE(fails("gpu --device none-of-that-name --sizes 33 --rays small"));
  EXPECT_TRUE(fails("gpu --sizes 33 --rays small --classes sideways"));
  EXPECT_TRUE(fails("edits --size 100 --rect 101"));
  EXPECT_TRUE(fails("pyramid --sizes 2 --repeats 1 --json /nowhere/out.json"));
}

TEST(ScarpBench, ReportsUsageErrorsInOneLine) {
  for (const auto& [arguments, error] : std::map<std::string, std::string>{
           {"heights --sizes 5", "--sizes '5': expected a whole number from 33 to 32767"},
           {"heights --sizes 129,much", "--sizes 'much': expected a whole number from 33 to 32767"},
           {"heights --size 129", "unknown option '--size' (did you mean '--sizes'? see 'scarp-bench heights --help')"},
           {"heights --classes primary,sideways", "--classes 'sideways': expected primary, shadow, "},
           {"heights --csv /nowhere/rows.csv", "/nowhere/rows.csv"},
           {"leaks --fan-margin 2", "--fan-margin has no effect without --fans"},
           {"leaks --rays 1.5", "--rays '1.5': expected a whole number"},
           {"extents --sizes 65536x512,12", "--sizes '12': expected COLSxROWS"},
           {"voxel-models", "FILE is required"},
           {"hights", "unknown subcommand 'hights' (did you mean 'heights'? available: heights, "}}) {
    const std::string text = text_of(arguments + " 2>&1 > /dev/null", false);
    EXPECT_EQ(text.find("scarp-bench: error: "), 0u) << text;
    EXPECT_NE(text.find(error), std::string::npos) << text;
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
  }
  EXPECT_NE(text_of("2>&1", false).find("Usage: scarp-bench SUBCOMMAND"), std::string::npos);
}

// Every option with a number rejects values that are not numbers or out of range.
TEST(ScarpBench, RefusesNumbersThatAreNotFinite) {
  const std::regex option("\n  (--[a-z-]+) (F|N)(,\\.\\.\\.)? ");
  const std::string program = text_of("--help", true);
  const std::regex command("\n  ([a-z-]+)  ");
  std::set<std::string> found;
  for (std::sregex_iterator it(program.begin(), program.end(), command), end; it != end; ++it) {
    const std::string name = (*it)[1], help = text_of(name + " --help all", true);
    for (std::sregex_iterator number(help.begin(), help.end(), option); number != end; ++number) {
      const std::string to = (*number)[1];
      found.insert(name + " " + to);
      if (name == "voxel-models") continue;  // needs files
      for (const std::string value : {"nan", "1e999"}) {
        const std::string text = text_of(fmt::format("{} {}={} 2>&1 > /dev/null", name, to, value), false);
        EXPECT_NE(text.find(fmt::format("{} '{}': expected a ", to, value)), std::string::npos) << name << ": " << text;
        EXPECT_LT(text.size(), 200u) << text;
      }
    }
  }
  EXPECT_GT(found.size(), 100u);
  EXPECT_TRUE(found.contains("leaks --fan-margin"));
}

}  // namespace
