// SPDX-License-Identifier: MIT
#include "scarp/source/voxel/vox_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "base/refusal.h"
#include "scarp/base/error.h"
#include "scarp/source/voxel/vox_animation.h"
#include "scarp/source/voxel/vox_material.h"
#include "scarp/source/voxel/vox_scene.h"

namespace scarp {
namespace {

VoxFile cube_file() {
  VoxFile file;
  file.version = 200;
  file.models = {{{3, 2, 1}, {{0, 0, 0, 1}, {2, 1, 0, 255}}}};
  return file;
}

// A root transform, a group, and below it this many transforms, each with a shape.
VoxFile scene_file(const std::vector<VoxAttributes>& frames) {
  VoxFile file = cube_file();
  VoxGroup group;
  file.nodes = {{0, {}, VoxTransform{1}}, {1, {}, VoxGroup{}}};
  int id = 2;
  for (const VoxAttributes& frame : frames) {
    group.children.push_back(id);
    file.nodes.push_back({id, {}, VoxTransform{id + 1, -1, 0, {frame}}});
    file.nodes.push_back({id + 1, {}, VoxShape{}});
    id += 2;
  }
  file.nodes[1].content = group;
  return file;
}

using test::refusal;

std::string parse_message(const std::string& bytes) {
  return refusal([&] { parse_vox(bytes); });
}

std::string scene_message(const VoxFile& file) {
  return refusal([&] { vox_bytes(file); });
}

TEST(VoxFile, RoundTrips) {
  VoxFile file = scene_file({{{"_t", "1 2 3"}, {"_r", "40"}}, {}});
  file.layers = {{0, {{"_name", "walls"}}, -1}, {1, {{"_hidden", "1"}}, -1}};
  file.palette.emplace();
  (*file.palette)[3] = {1, 2, 3, 4};
  file.index_map.emplace();
  file.materials = {{7, {{"_type", "_emit"}, {"_emit", "0.4"}}}};
  file.others = {{"NOTE", std::string("\1\0\0\0", 4), ""}, {"XXXX", "abc", "de"}};
  file.pack = true;
  EXPECT_EQ(parse_vox(vox_bytes(file)), file);
}

TEST(VoxFile, HasTheDefaultPaletteOfTheFormat) {
  const VoxPalette& palette = vox_default_palette();
  EXPECT_EQ(palette[0], (VoxColour{255, 255, 255, 255}));
  EXPECT_EQ(palette[1], (VoxColour{255, 255, 204, 255}));
  EXPECT_EQ(palette[6], (VoxColour{255, 204, 255, 255}));
  EXPECT_EQ(palette[214], (VoxColour{0, 0, 51, 255}));
  EXPECT_EQ(palette[215], (VoxColour{238, 0, 0, 255}));
  EXPECT_EQ(palette[224], (VoxColour{17, 0, 0, 255}));
  EXPECT_EQ(palette[225], (VoxColour{0, 238, 0, 255}));
  EXPECT_EQ(palette[235], (VoxColour{0, 0, 238, 255}));
  EXPECT_EQ(palette[254], (VoxColour{17, 17, 17, 255}));
  EXPECT_EQ(&cube_file().colours(), &palette);
}

TEST(VoxFile, RejectsOtherFiles) {
  const std::string good = vox_bytes(cube_file());
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "empty file", parse_message(""));
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "begins with the bytes ff d8 ff e0",
                      parse_message("\xff\xd8\xff\xe0 JFIF, a picture"));
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "git lfs pull",
                      parse_message("version https://git-lfs.github.com/spec/v1\n"));
  std::string version = good;
  version[4] = 77;
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "unsupported version 77", parse_message(version));
  // A one-line error for any missing part.
  for (std::size_t length = 0; length < good.size(); ++length) {
    const std::string message = parse_message(good.substr(0, length));
    EXPECT_NE(message, "") << length;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

TEST(VoxFile, RejectsInconsistentSizes) {
  const std::string good = vox_bytes(cube_file());
  const auto with = [&](std::size_t at, unsigned value) {
    std::string bytes = good;
    for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(value >> (8 * i) & 255);
    return parse_message(bytes);
  };
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "truncated", with(16, 0x7fffffff));        // of MAIN
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "truncated", with(24, 0xfffffff0));        // of SIZE
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "each side must be", with(32, 1u << 30));  // x
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "each side must be", with(32, 0));
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "is outside", with(32, 2));
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "2147483648 voxels need", with(56, 1u << 31));
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "voxels need", with(56, 1));
}

TEST(VoxFile, CountsVoxelsOfIndexZeroAsEmpty) {
  VoxFile file = cube_file();
  EXPECT_TRUE(vox_notes(file).empty());
  file.models[0].voxels[0].index = 0;
  const VoxFile read = parse_vox(vox_bytes(file));
  EXPECT_EQ(read, file);
  EXPECT_EQ(vox_notes(read), std::vector<std::string>{"voxels with palette index 0, treated as empty: 1"});
}

TEST(VoxFile, RejectsInvalidScenes) {
  VoxFile cyclic = scene_file({{}});
  std::get<VoxTransform>(cyclic.nodes[2].content).child = 1;
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "contains itself", scene_message(cyclic));
  VoxFile missing = scene_file({{}});
  std::get<VoxShape>(missing.nodes[3].content).models[0].model = 1;
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "model 1 does not exist", scene_message(missing));
  VoxFile orphan = scene_file({{}});
  std::get<VoxTransform>(orphan.nodes[2].content).child = 9;
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "child 9 does not exist", scene_message(orphan));
  VoxFile twice = scene_file({{}});
  twice.nodes[3].id = 2;
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "duplicate node 2", scene_message(twice));
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "not a lattice rotation", scene_message(scene_file({{{"_r", "5"}}})));
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "expected an integer", scene_message(scene_file({{{"_r", "x"}}})));
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "'1 2' (expected 'x y z')", scene_message(scene_file({{{"_t", "1 2"}}})));
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "(limited to ", scene_message(scene_file({{{"_t", "1 2 99999999"}}})));
}

// Constructed in place: for a moved one, g++ 12 warns about uninitialised content.
template <class Content>
void add_node(VoxFile& file, int id, const Content& content) {
  VoxNode& node = file.nodes.emplace_back();
  node.id = id;
  node.content = content;
}

// Each level of groups holds the next one twice: 2^40 models in 100 nodes.
TEST(VoxFile, RejectsTooManyInstances) {
  VoxFile file = cube_file();
  for (int level = 0; level < 40; ++level) {
    add_node(file, 3 * level, VoxGroup{{3 * level + 1, 3 * level + 2}});
    add_node(file, 3 * level + 1, VoxTransform{3 * level + 3});
    add_node(file, 3 * level + 2, VoxTransform{3 * level + 3});
  }
  add_node(file, 120, VoxShape{});
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "more than 1048576 model instances", refusal([&] { vox_instances(file); }));
}

TEST(VoxScene, AppliesTransformsFromTheInsideOut) {
  // Row 0 takes y, row 1 takes -x: a quarter turn clockwise about z.
  VoxFile file = scene_file({{{"_t", "10 0 0"}, {"_r", std::to_string(1 | 0 << 2 | 1 << 5)}}});
  std::get<VoxTransform>(file.nodes[0].content).frames = {
      {{"_t", "0 0 100"}, {"_r", std::to_string(1 | 0 << 2 | 1 << 5)}}};
  const std::vector<VoxInstance> instances = vox_instances(file);
  ASSERT_EQ(instances.size(), 1u);
  EXPECT_EQ(instances[0].move, ivec3(0, -10, 100));
  EXPECT_EQ(instances[0].turn(ivec3(1, 2, 3)), ivec3(-1, -2, 3));
}

TEST(VoxScene, SkipsHiddenNodes) {
  VoxFile file = scene_file({{}, {}, {}});
  file.nodes[2].attributes = {{"_hidden", "1"}};
  file.layers = {{0, {}, -1}, {4, {{"_hidden", "1"}}, -1}};
  std::get<VoxTransform>(file.nodes[4].content).layer = 4;
  EXPECT_EQ(vox_instances(file).size(), 1u);
  EXPECT_EQ(vox_instances(file, {.frame = 0, .hidden = true}).size(), 3u);
}

TEST(VoxScene, StartsAtNodeZero) {
  VoxFile file = scene_file({{{"_t", "1 2 3"}}});
  std::reverse(file.nodes.begin(), file.nodes.end());
  ASSERT_EQ(vox_instances(file).size(), 1u);
  EXPECT_EQ(vox_instances(file)[0].move, ivec3(1, 2, 3));
}

// Keyframes at 2 and 5, in any order: the first and the last are held, positions in between are rounded.
TEST(VoxScene, InterpolatesPositionsAndSwitchesOtherAttributes) {
  VoxFile file = scene_file({{}});
  file.models.push_back({{1, 1, 1}, {{0, 0, 0, 1}}});
  const std::string quarter = std::to_string(1 | 0 << 2 | 1 << 5);
  std::get<VoxTransform>(file.nodes[2].content).frames = {{{"_f", "5"}, {"_t", "11 -11 4"}, {"_r", quarter}},
                                                          {{"_f", "2"}, {"_t", "1 -1 3"}}};
  std::get<VoxShape>(file.nodes[3].content).models = {{0, {}}, {1, {{"_f", "4"}}}};
  const auto at = [&](int frame) { return vox_instances(file, {.frame = frame}).at(0); };
  EXPECT_EQ(at(0).move, ivec3(1, -1, 3));
  EXPECT_EQ(at(2).move, ivec3(1, -1, 3));
  EXPECT_EQ(at(3).move, ivec3(4, -4, 3));  // 4.33, -4.33, 3.33
  EXPECT_EQ(at(4).move, ivec3(8, -8, 4));  // 7.67, -7.67, 3.67
  EXPECT_EQ(at(4).turn, LatticeRotation{});
  EXPECT_EQ(at(5).move, ivec3(11, -11, 4));
  EXPECT_NE(at(5).turn, LatticeRotation{});
  EXPECT_EQ(at(1 << 30).move, ivec3(11, -11, 4));
  EXPECT_EQ(at(3).model, 0);
  EXPECT_EQ(at(4).model, 1);
  // Halves are rounded up, also below 0.
  std::get<VoxTransform>(file.nodes[2].content).frames = {{{"_t", "0 0 -3"}}, {{"_f", "2"}, {"_t", "1 -1 -4"}}};
  EXPECT_EQ(at(1).move, ivec3(1, 0, -3));
}

TEST(VoxScene, RepeatsLoops) {
  VoxFile file = scene_file({{}});
  file.nodes[2].attributes = {{"_loop", "1"}};
  std::get<VoxTransform>(file.nodes[2].content).frames = {{{"_f", "2"}, {"_t", "0 0 0"}},
                                                          {{"_f", "5"}, {"_t", "3 0 0"}}};
  std::vector<int> x;
  for (int frame = 0; frame < 12; ++frame) x.push_back(vox_instances(file, {.frame = frame})[0].move.x);
  EXPECT_EQ(x, (std::vector<int>{2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1}));
}

TEST(VoxScene, CountsFramesAndNotesFramesPastTheEnd) {
  VoxFile file = scene_file({{}, {}});
  const auto note = [&](int frame) {
    const std::vector<std::string> notes = vox_notes(file, {.frame = frame});
    return notes.empty() ? "" : notes.at(0);
  };
  EXPECT_EQ(vox_animation(file).frames, 1);
  EXPECT_EQ(note(0), "");
  EXPECT_EQ(note(1), "frame 1: the file has a single frame, which is shown");
  std::get<VoxTransform>(file.nodes[2].content).frames = {{}, {{"_f", "9"}}};
  EXPECT_EQ(vox_animation(file).frames, 10);
  EXPECT_EQ(note(9), "");
  EXPECT_EQ(note(10), "frame 10: the animation ends at frame 9, which is shown");
  file.nodes[2].attributes = {{"_loop", "1"}};
  EXPECT_EQ(note(10), "frame 10: the animation repeats, its last frame is 9");
  std::get<VoxShape>(file.nodes[5].content).models = {{0, {}}, {0, {{"_f", "4"}}}};
  EXPECT_EQ(note(10), "frame 10: parts of the animation repeat, the others are shown as at frame 9");
  // Files of old versions: a model is a frame.
  VoxFile old = cube_file();
  old.models.push_back(old.models[0]);
  EXPECT_EQ(vox_animation(old).frames, 1);
  old.pack = true;
  EXPECT_EQ(vox_animation(old).frames, 2);
}

TEST(VoxFile, WritesAtomically) {
  const auto path = (std::filesystem::path(testing::TempDir()) / "written.vox").string();
  write_vox(path, cube_file());
  EXPECT_EQ(read_vox(path), cube_file());
  VoxFile bad = cube_file();
  bad.models[0].voxels[0].x = 3;
  EXPECT_THROW(write_vox(path, bad), Error);
  EXPECT_EQ(read_vox(path), cube_file());
  std::filesystem::remove(path);
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "cannot be opened", refusal([&] { read_vox(path); }));
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "cannot be", refusal([&] { read_vox(testing::TempDir()); }));
}

// Real-world files: those of ../shared/data/vox beside the checkout. Writing restores the same bytes.
TEST(VoxFile, ReadsRealFiles) {
  const auto folder = std::filesystem::path(SCARP_SOURCE_DIR) / ".." / "shared" / "data" / "vox";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no shared data beside the checkout (../shared/data/vox)";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const VoxFile file = read_vox(entry.path().string());
    std::ifstream in(entry.path(), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    EXPECT_EQ(vox_bytes(file), bytes) << entry.path();
    EXPECT_GE(vox_instances(file).size(), 1u);
  }
}

TEST(VoxMaterial, IsReadAsLight) {
  const auto of = [](VoxAttributes attributes) { return VoxMaterial{1, std::move(attributes)}; };
  EXPECT_EQ(vox_emission(of({{"_type", "_emit"}, {"_emit", "0.5"}})), 0.5f);
  EXPECT_EQ(vox_emission(of({{"_type", "_emit"}, {"_emit", "0.5"}, {"_flux", "3"}})), 4.0f);
  EXPECT_EQ(vox_emission(of({{"_type", "_emit"}, {"_weight", "0.25"}})), 0.25f);
  EXPECT_EQ(vox_emission(of({{"_type", "_diffuse"}, {"_emit", "0.5"}})), 0.0f);
  EXPECT_EQ(vox_emission(of({{"_type", "_emit"}, {"_emit", "nan"}})), 0.0f);
  EXPECT_EQ(vox_emission(of({{"_type", "_emit"}, {"_emit", "1e9"}, {"_flux", "1e9"}})), 1024.0f);
  EXPECT_EQ(vox_mirror(of({{"_type", "_metal"}, {"_metal", "1"}, {"_rough", "0.25"}})), 0.75f);
  EXPECT_EQ(vox_mirror(of({{"_type", "_metal"}, {"_weight", "0.5"}})), 0.5f);
  EXPECT_EQ(vox_mirror(of({{"_type", "_glass"}, {"_metal", "1"}})), 0.0f);
  EXPECT_EQ(vox_mirror(of({})), 0.0f);
  EXPECT_TRUE(is_vox_glass(of({{"_type", "_glass"}})));
  EXPECT_FALSE(is_vox_glass(of({{"_type", "_blend"}, {"_metal", "1"}})));
}

TEST(VoxNotes, ReportThatGlassIsShownOpaque) {
  VoxFile file = cube_file();
  file.materials = {{7, {{"_type", "_glass"}}}};
  EXPECT_TRUE(vox_notes(file).empty());  // no voxel has this colour
  file.materials[0].id = 255;
  EXPECT_EQ(vox_notes(file), std::vector<std::string>{"glass is shown opaque"});
}

}  // namespace
}  // namespace scarp
