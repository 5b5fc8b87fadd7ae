// SPDX-License-Identifier: MIT
// MagicaVoxel files through the command line.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/program.h"
#include "output/read_png.h"
#include "scarp/source/voxel/vox_file.h"

namespace scarp {
namespace {

using test::run;

class CliVox : public testing::Test {
 protected:
  CliVox() {
    VoxFile file;
    file.version = 200;
    file.models = {{{3, 3, 3}, {}}};
    for (std::uint8_t i = 0; i < 9; ++i)
      file.models[0].voxels.push_back({static_cast<std::uint8_t>(i % 3), static_cast<std::uint8_t>(i / 3), 0, 216});
    file.nodes = {{0, {}, VoxTransform{1}},
                  {1, {}, VoxGroup{{2, 4}}},
                  {2, {}, VoxTransform{3}},
                  {3, {}, VoxShape{}},
                  {4, {{"_hidden", "1"}}, VoxTransform{5, -1, -1, {{{"_t", "0 0 9"}}}}},
                  {5, {}, VoxShape{}}};
    write_vox(model_, file);
  }

  std::string path(const std::string& name) const { return scratch_.path(name); }

  // One line on stderr with the fragment, no picture.
  void expect_refused(const std::vector<std::string>& arguments, const std::string& fragment) {
    const auto result = run(arguments);
    EXPECT_NE(result.status, 0);
    EXPECT_EQ(test::lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(fragment), std::string::npos) << result.err;
    EXPECT_EQ(scratch_.files(), std::vector<std::string>{"model.vox"});
  }

  test::Scratch scratch_;
  std::string model_ = scratch_.path("model.vox");
};

TEST_F(CliVox, InfoDescribesTheFile) {
  const auto text = run({"info", model_});
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_NE(text.out.find("1 objects, 1 hidden"), std::string::npos) << text.out;
  const auto json = nlohmann::json::parse(run({"info", model_, "--json", "--hidden"}).out);
  EXPECT_EQ(json["version"], 200);
  EXPECT_EQ(json["models"][0]["voxels"], 9);
  EXPECT_EQ(json["instances"], 2);
  EXPECT_EQ(json["low"], (std::vector<int>{-1, -1, -1}));
  EXPECT_EQ(json["high"], (std::vector<int>{2, 2, 9}));
}

TEST_F(CliVox, InfoListsPaletteLayersAndMaterials) {
  VoxFile file = parse_vox(test::text_of(model_));
  file.models[0].voxels[0].index = 7;
  file.layers = {{0, {{"_name", "walls"}, {"_hidden", "1"}}}, {1, {}}};
  file.materials = {
      {7, {{"_type", "_glass"}, {"_ior", "0.3"}}}, {8, {{"_type", "_emit"}}}, {216, {{"_type", "_diffuse"}}}};
  write_vox(model_, file);
  const auto json = nlohmann::json::parse(run({"info", model_, "--json"}).out);
  ASSERT_EQ(json["palette"].size(), 2u);
  EXPECT_EQ(json["palette"][0], (nlohmann::json{{"index", 216}, {"colour", "#ee0000"}, {"voxels", 8}}));
  ASSERT_EQ(json["materials"].size(), 1u);
  EXPECT_EQ(json["materials"][0]["type"], "glass");
  const std::string text = run({"info", model_}).out;
  for (const char* expected : {"0 'walls', hidden: its objects are left out", "216 #ee0000 8", "7 glass, ior 0.3",
                               "box          3 x 3 x 1 voxels"})
    EXPECT_NE(text.find(expected), std::string::npos) << text;
}

// Two voxels in the corners of each model: their boxes are large, the models are not.
TEST_F(CliVox, MemoryDependsOnSolidVoxels) {
  VoxFile file;
  file.version = 200;
  VoxGroup group;
  constexpr int kModels = 40, kSide = 256;
  file.nodes = {{0, {}, VoxTransform{1}}, {1, {}, VoxGroup{}}};
  for (int i = 0; i < kModels; ++i) {
    file.models.push_back({ivec3(kSide), {{0, 0, 0, 1}, {255, 255, 255, 2}}});
    const int node = static_cast<int>(file.nodes.size());
    file.nodes.push_back({node, {}, VoxTransform{node + 1, -1, -1, {{{"_t", fmt::format("{} 0 0", 300 * i)}}}}});
    file.nodes.push_back({node + 1, {}, VoxShape{{{i, {}}}}});
    group.children.push_back(node);
  }
  file.nodes[1].content = group;
  write_vox(model_, file);
  const auto json = nlohmann::json::parse(run({"info", model_, "--json"}).out);
  // Each would take 3.3 MB if all its voxels were stored.
  EXPECT_LT(json["bytes"].get<int>(), kModels * 60'000);
  // Octants take 8 bytes per voxel of the boxes.
  expect_refused({"render", model_, "-o", path("out.png"), "--march", "voxel-octants"}, "1.1 GB of memory");
}

// The plate moves 8 voxels east in 4 frames. One of its voxels is empty by its palette index.
TEST_F(CliVox, RendersAnimationFrames) {
  VoxFile file = read_vox(model_);
  std::get<VoxTransform>(file.nodes[0].content).frames = {{{"_t", "0 0 0"}}, {{"_f", "4"}, {"_t", "8 0 0"}}};
  file.models[0].voxels.push_back({1, 1, 2, 0});
  write_vox(model_, file);
  const auto info = run({"info", model_});
  EXPECT_NE(info.out.find("frames       5 (--frame 0 to 4)\n"), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("note         voxels with palette index 0, treated as empty: 1\n"), std::string::npos)
      << info.out;
  const auto low = [&](const char* frame) {
    const auto json = nlohmann::json::parse(run({"info", model_, "--json", "--frame", frame}).out);
    EXPECT_EQ(json["models"][0]["voxels"], 9);
    EXPECT_EQ(json["colours_used"], 1);
    return json["low"][0].get<int>();
  };
  EXPECT_EQ(low("0"), -1);
  EXPECT_EQ(low("3"), 5);
  EXPECT_EQ(low("9"), 7);
  const auto past = run({"render", model_, "-o", path("past.png"), "--size", "30x30", "--frame", "9"});
  EXPECT_EQ(past.status, 0);
  EXPECT_NE(past.err.find("note: frame 9: the animation ends at frame 4, which is shown\n"), std::string::npos)
      << past.err;
  // For scene files the note includes the name of the file.
  const std::string scene =
      scratch_.write("scene.json", R"({"objects": [{"voxels": {"file": "model.vox", "frame": 5}}]})");
  const auto placed = run({"render", scene, "-o", path("placed.png"), "--size", "30x30"});
  EXPECT_EQ(placed.status, 0);
  EXPECT_NE(placed.err.find("model.vox: frame 5: the animation ends at frame 4, which is shown\n"), std::string::npos)
      << placed.err;
}

// From four sides, and along a path: as an input, and in a scene. The tower in the plate's eastern corner is at a
// different position in each picture.
TEST_F(CliVox, RendersTurntablesAndPaths) {
  VoxFile file = read_vox(model_);
  for (std::uint8_t z = 1; z < 3; ++z) file.models[0].voxels.push_back({2, 0, z, 1});
  write_vox(model_, file);
  const std::string scene = scratch_.write("scene.json", R"({"objects": [{"voxels": {"file": "model.vox"}}]})");
  const std::string flight = scratch_.write("path.csv", "x,y,z,tx,ty,tz\n9,-9,5,0,0,0\n9,9,5,0,0,0\n-9,9,5,0,0,0\n");
  const auto frames = [&](const std::string& input, const std::string& name, int count, std::vector<std::string> how) {
    how.insert(how.begin(), {"render", input, "-o", path(name + "#.png"), "--size", "48x32", "--haze", "0"});
    const auto result = run(how);
    EXPECT_EQ(result.status, 0) << result.err;
    std::vector<std::string> pictures;
    for (int i = 0; i < count; ++i) pictures.push_back(test::text_of(path(name + std::to_string(i) + ".png")));
    for (int i = 0; i < count; ++i) {
      for (int j = 0; j < i; ++j) EXPECT_NE(pictures[i], pictures[j]) << name << i << ' ' << j;
    }
    return pictures;
  };
  const std::vector<std::string> turn{"--turntable", "--frames", "4", "--sun", "235,45"};
  const auto turned = frames(model_, "turned", 4, turn);
  EXPECT_EQ(frames(scene, "scene", 4, turn), turned);
  const std::vector<std::string> fly{"--path", flight, "--frames", "3", "--sun", "235,45"};
  EXPECT_EQ(frames(scene, "flown", 3, fly), frames(model_, "flight", 3, fly));
  // After a quarter turn the picture is that of --view.
  ASSERT_EQ(run({"render", model_, "-o", path("a.png"), "--size", "48x32", "--turntable"}).status, 1);
  ASSERT_EQ(run({"render", model_, "-o", path("a.png"), "--size", "48x32", "--haze", "0", "--view", "290,30"}).status,
            0);
  ASSERT_EQ(run({"render", model_, "-o", path("b#.png"), "--size", "48x32", "--haze", "0", "--view", "200,30",
                 "--turntable", "--frames", "4"})
                .status,
            0);
  EXPECT_EQ(test::text_of(path("a.png")), test::text_of(path("b1.png")));
}

// The default palette's entry 216 is a pure red; from above, in full sun, it does not change.
TEST_F(CliVox, AllMarchesRenderTheSamePicture) {
  std::string first;
  for (const char* march : {"voxel-exhaustive", "voxel-planes", "voxel-spheres", "voxel-cubes", "voxel-cubes-jump",
                            "voxel-octants", "voxel-bricks"}) {
    const std::string out = path(std::string(march) + ".png");
    const auto result = run({"render", model_, "-o", out, "--top", "--size", "30x30", "--march", march});
    ASSERT_EQ(result.status, 0) << result.err;
    if (first.empty()) first = test::text_of(out);
    EXPECT_EQ(test::text_of(out), first) << march;
  }
  const test::Rgb picture = test::read_png(path("voxel-bricks.png"));
  ASSERT_EQ(picture.width, 30);
  const std::uint8_t* middle = picture.pixel(15, 15);
  EXPECT_GT(middle[0], 200);
  EXPECT_EQ(middle[1], 0);
  EXPECT_EQ(middle[2], 0);
}

TEST_F(CliVox, ReportsBadFilesInOneLine) {
  const std::string out = path("out.png");
  expect_refused({"render", model_, "-o", out, "--march", "max-mip"}, "voxel-exhaustive, voxel-planes");
  expect_refused({"render", model_, "-o", out, "--look", "pretty"}, "expected shaded, hillshade, height, steps");
  expect_refused({"render", model_, model_, "-o", out}, "stands alone");
  expect_refused({"info", path("missing.vox")}, "cannot be opened");
  expect_refused({"cast", model_, "--rays", "x.csv", "-o", path("hits.csv")}, "x.csv: cannot be opened");
  expect_refused({"render", model_, "-o", out, "--size", "320x240", "--legend"}, "do not depend on height");
  std::string bytes = test::text_of(model_);
  bytes.resize(bytes.size() / 2);
  scratch_.write("model.vox", bytes);
  expect_refused({"render", model_, "-o", out}, "truncated");
  scratch_.write("model.vox", "\xff\xd8\xff\xe0, a picture");
  expect_refused({"render", model_, "-o", out}, "ff d8 ff e0");
  VoxFile empty;
  empty.models = {{{3, 3, 3}, {}}};
  write_vox(model_, empty);
  expect_refused({"render", model_, "-o", out}, model_ + ": no visible voxels");
  EXPECT_NE(run({"info", model_}).out.find("empty: there is no voxel"), std::string::npos);
}

// The same plate as a binvox file, an array and bare numbers: the same picture of another colour.
TEST_F(CliVox, ReadsBinvoxAndVolumes) {
  const std::string binvox = path("plate.binvox"), raw = scratch_.write("plate.raw", std::string("head") + "123456789");
  const auto made = run({"voxelise", model_, "-o", binvox});
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_NE(made.out.find("3 x 3 x 1 voxels of 1 m, 9 solid"), std::string::npos) << made.out;
  const auto top = [&](std::vector<std::string> arguments, const std::string& out) {
    arguments.insert(arguments.begin(), "render");
    arguments.insert(arguments.end(), {"-o", path(out), "--top", "--size", "30x30"});
    const auto result = run(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    return test::text_of(path(out));
  };
  const std::string of_binvox = top({binvox}, "a.png");
  EXPECT_EQ(top({raw, "--volume", "3x3x1:u8+4"}, "b.png"), of_binvox);
  EXPECT_NE(top({raw, "--volume", "3x3x1:u8+4", "--solid-from", "54"}, "c.png"), of_binvox);
  EXPECT_NE(top({raw, "--volume", "3x3x1:u8+4", "--ramp", "grey"}, "d.png"), of_binvox);
  const auto json = nlohmann::json::parse(run({"info", raw, "--volume", "3x3x1:u8+4", "--json"}).out);
  EXPECT_EQ(json["format"], "volume");
  EXPECT_EQ(json["models"][0]["voxels"], 9);
}

TEST_F(CliVox, VoxelisesVoxels) {
  const std::string copy = path("copy.vox");
  ASSERT_EQ(run({"voxelise", model_, "-o", copy}).status, 0);
  const auto original = nlohmann::json::parse(run({"info", model_, "--json"}).out);
  const auto json = nlohmann::json::parse(run({"info", copy, "--json"}).out);
  EXPECT_EQ(json["low"], original["low"]);
  EXPECT_EQ(json["high"], original["high"]);
  EXPECT_EQ(json["colours_used"], 1);
  const auto top = [&](const std::string& model, const std::string& out) {
    EXPECT_EQ(run({"render", model, "-o", path(out), "--top", "--size", "30x30"}).status, 0);
    return test::text_of(path(out));
  };
  EXPECT_EQ(top(copy, "a.png"), top(model_, "b.png"));
}

// 8 x 8 cells of 10 m: 4 x 4 columns of voxels of 20 m.
TEST_F(CliVox, VoxelisesTerrain) {
  const std::string dem = path("dem.tif"), out = path("dem.vox");
  ASSERT_EQ(run({"generate", "--size", "9", "--cell", "10", "-o", dem}).status, 0);
  const auto made = run({"voxelise", dem, "-o", out, "--voxel", "20", "--exaggeration", "30"});
  ASSERT_EQ(made.status, 0) << made.err;
  const auto json = nlohmann::json::parse(run({"info", out, "--json"}).out);
  EXPECT_EQ(json["models"][0]["size"][0], 4);
  EXPECT_EQ(json["models"][0]["size"][1], 4);
  EXPECT_EQ(json["low"][0], 0);
  EXPECT_EQ(json["high"][1], 4);
  EXPECT_GT(json["colours_used"], 1);
}

TEST_F(CliVox, KeepsTheVoxelSideOfTheFile) {
  const std::string dem = path("dem.tif"), world = path("world.vdb"), copy = path("copy.vdb");
  ASSERT_EQ(run({"generate", "--size", "9", "--cell", "10", "-o", dem}).status, 0);
  const auto made = run({"voxelise", dem, "-o", world, "--voxel", "2.5", "--exaggeration", "30"});
  if (made.err.find("OpenVDB") != std::string::npos) GTEST_SKIP() << made.err;
  ASSERT_EQ(made.status, 0) << made.err;
  const auto copied = run({"voxelise", world, "-o", copy});
  ASSERT_EQ(copied.status, 0) << copied.err;
  const std::size_t end = made.out.find(" voxels of 2.5 m, ");
  ASSERT_NE(end, std::string::npos) << made.out;
  EXPECT_TRUE(copied.out.ends_with(made.out.substr(end))) << copied.out << made.out;
}

TEST_F(CliVox, CastReportsVoxelsOfTheFile) {
  VoxFile file = parse_vox(test::text_of(model_));
  file.models = {{{10, 12, 9}, {{5, 6, 7, 216}}}};
  file.nodes = {{0, {}, VoxTransform{1, -1, -1, {{{"_r", "20"}, {"_t", "7 8 9"}}}}}, {1, {}, VoxShape{}}};
  write_vox(model_, file);
  const auto json = nlohmann::json::parse(run({"info", model_, "--json"}).out);
  ASSERT_EQ(json["parts"].size(), 1u);
  // The middle of voxel (5, 6, 7), by the part's offset and axes.
  std::array<double, 3> middle{};
  for (std::size_t i = 0; i < 3; ++i) {
    middle[i] = json["parts"][0]["offset"][i].get<double>();
    const std::array<double, 3> p{5.5, 6.5, 7.5};
    for (std::size_t k = 0; k < 3; ++k) middle[i] += p[k] * json["parts"][0]["axes"][k][i].get<double>();
    EXPECT_EQ(middle[i], json["low"][i].get<double>() + 0.5);
  }
  const std::string rays =
      scratch_.write("rays.csv", fmt::format("x,y,z,dx,dy,dz\n{},{},99,0,0,-1\n", middle[0], middle[1]));
  const auto cast = run({"cast", model_, "--rays", rays});
  EXPECT_NE(cast.out.find(",5,6,7,high_z"), std::string::npos) << cast.out << cast.err;
}

TEST_F(CliVox, InfoPrintsDecimalsOfOpenVdb) {
  const std::string dem = path("dem.tif"), world = path("world.vdb");
  ASSERT_EQ(run({"generate", "--size", "9", "--cell", "10", "-o", dem}).status, 0);
  const auto made = run({"voxelise", dem, "-o", world, "--voxel", "2.75", "--exaggeration", "30"});
  if (made.err.find("OpenVDB") != std::string::npos) GTEST_SKIP() << made.err;
  const std::string text = run({"info", world}).out;
  const std::size_t box = text.find("\nbox ");
  ASSERT_NE(box, std::string::npos) << text;
  EXPECT_NE(text.substr(box, text.find('\n', box + 1) - box).find('.'), std::string::npos) << text;
  const auto json = nlohmann::json::parse(run({"info", world, "--json"}).out);
  EXPECT_EQ(std::fmod(json["high"][2].get<double>() - json["low"][2].get<double>(), 2.75), 0) << json["high"];
}

TEST_F(CliVox, EveryLookDiffers) {
  std::vector<std::string> pictures;
  const std::string overlay = path("overlay.png");
  ASSERT_EQ(run({"render", model_, "-o", overlay, "--top", "--size", "9x9", "--look", "height"}).status, 0);
  const std::vector<std::vector<std::string>> looks = {{},
                                                       {"--rounded", "0.3"},
                                                       {"--rounded", "0.3", "--each"},
                                                       {"--normals", "voxel"},
                                                       {"--normals", "smooth"},
                                                       {"--contours", "0.4"},
                                                       {"--overlay", overlay},
                                                       {"--coarse-voxels", "--view", "190,35,60"},
                                                       {"--view", "190,35,60"}};
  for (const auto& look : looks) {
    std::vector<std::string> arguments{"render", model_, "-o", path("look.png"), "--size", "60x40"};
    arguments.insert(arguments.end(), look.begin(), look.end());
    const auto result = run(arguments);
    ASSERT_EQ(result.status, 0) << result.err;
    pictures.push_back(test::text_of(path("look.png")));
    for (std::size_t i = 0; i + 1 < pictures.size(); ++i)
      EXPECT_NE(pictures[i], pictures.back()) << i << ' ' << pictures.size();
  }
}

// A plate of 3 x 3 with a margin of 2 voxels: 49 cells, 40 of which show their distance.
TEST_F(CliVox, SectionPrintsDistances) {
  const std::string svg = path("section.svg");
  const auto count = [](const std::string& text, const std::string& part) {
    int found = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
  };
  ASSERT_EQ(run({"section", model_, "-o", svg, "--margin", "2", "--at", "0"}).status, 0);
  const std::string spheres = test::text_of(svg);
  EXPECT_EQ(count(spheres, "<rect"), 49);
  EXPECT_EQ(count(spheres, ">0<"), 16);
  EXPECT_EQ(count(spheres, ">1<"), 24);  // the corners are 1.41 away
  ASSERT_EQ(run({"section", model_, "-o", svg, "--margin", "2", "--radii", "cubes", "--axis", "y"}).status, 0);
  const std::string cubes = test::text_of(svg);
  // Vertically there is one layer.
  EXPECT_EQ(count(cubes, "<rect"), 35);
  EXPECT_EQ(count(cubes, "<text"), 32);
}

// 2^21 times the same model: nested groups of two equal children.
TEST_F(CliVox, ErrorNamesOversizedScenes) {
  constexpr int kLevels = 21;
  VoxFile file;
  file.version = 200;
  file.models = {{{1, 1, 1}, {{0, 0, 0, 1}}}};
  for (int i = 0; i < kLevels; ++i) {
    file.nodes.push_back({2 * i, {}, VoxTransform{2 * i + 1}});
    file.nodes.push_back({2 * i + 1, {}, VoxGroup{{2 * i + 2, 2 * i + 2}}});
  }
  file.nodes.push_back({2 * kLevels, {}, VoxTransform{2 * kLevels + 1}});
  file.nodes.push_back({2 * kLevels + 1, {}, VoxShape{}});
  const std::string named = model_ + ": scene: more than 1048576 model instances";
  write_vox(model_, file);
  expect_refused({"render", model_, "-o", path("out.png")}, named);
  expect_refused({"info", model_}, named);
  // Only `info` counts the hidden voxels.
  file.nodes[0].attributes = {{"_hidden", "1"}};
  write_vox(model_, file);
  expect_refused({"info", model_}, named);
}

TEST_F(CliVox, RejectsSectionsOfLargeModels) {
  const std::string model = scratch_.write("long.raw", std::string(600, 'a'));
  const auto err = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"section", model, "--volume", "600x1x1:u8", "-o", path("out.svg")};
    words.insert(words.end(), more.begin(), more.end());
    const auto result = run(words);
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(test::lines(result.err), 1) << result.err;
    return result.err;
  };
  EXPECT_NE(err({}).find("long.raw: the layer with its margin is 608 x 9 voxels (limited to 256 per side; try another"),
            std::string::npos);
  EXPECT_NE(
      err({"--axis", "x"}).find("long.raw: the model with its margin has 608 layers (limited to 512; try another"),
      std::string::npos);
}

TEST_F(CliVox, ReportsInvalidOptionsInOneLine) {
  const std::string out = path("out.png");
  expect_refused({"render", model_, "-o", out, "--rounded", "0.6"}, "0 to 0.5");
  expect_refused({"render", model_, "-o", out, "--each"}, "--rounded");
  expect_refused({"render", model_, "-o", out, "--normals", "soft"}, "--normals");
  expect_refused({"render", model_, "-o", out, "--up", "y"}, "--up");
  expect_refused({"render", model_, "-o", out, "--solid-from", "3"}, "--volume");
  expect_refused({"render", model_, "-o", out, "--volume", "3x3:u8"}, "NXxNYxNZ");
  expect_refused({"render", model_, "-o", out, "--volume", "3x3x3:u8"}, "need 27");
  // The size is known before the file is read.
  expect_refused({"render", model_, "-o", out, "--volume", "513x1x1:u8+0", "--march", "voxel-octants"}, "513 x 1 x 1");
  expect_refused({"render", model_, "-o", out, "--volume", "3x3x1:u8+0", "--solid-from", "1e9"},
                 model_ + ": no voxel is solid: its numbers are ");
  expect_refused({"render", path("dem.tif"), "-o", out, "--rounded", "0.2"}, "applies to voxels only");
  expect_refused({"render", "--function", "elevated", "-o", out, "--normals", "smooth"}, "applies to voxels only");
  expect_refused({"info", path("dem.tif"), "--hidden"}, "applies to voxels only");
  expect_refused({"voxelise", path("dem.tif"), "-o", path("out.vox"), "--up", "y"}, "applies to voxels only");
  expect_refused({"voxelise", model_, "-o", path("out.obj")}, ".binvox");
  expect_refused({"voxelise", model_, "-o", path("out.vox"), "--within", "50,50,50,60,60,60"},
                 "nothing in the box to make voxels of");
  expect_refused({"section", model_, "-o", path("out.png")}, ".svg");
  expect_refused({"section", model_, "-o", path("out.svg"), "--at", "7"}, "layers 0 to 0 along z");
}

}  // namespace
}  // namespace scarp
