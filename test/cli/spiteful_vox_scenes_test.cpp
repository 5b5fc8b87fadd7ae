// SPDX-License-Identifier: MIT
// Scenes of MagicaVoxel files made to break readers: cycles, depths, rotations, translations, frames, layers, distances
// and crowds.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cli/spiteful_checks.h"
#include "cli/spiteful_files.h"
#include "scarp/base/error.h"
#include "scarp/source/voxel/vox_file.h"

namespace scarp {
namespace {

using namespace test::spite;

const std::string kCube = block({4, 4, 4});
const std::vector<std::string> kOthers{"cast", "section", "voxelise"};

std::string scene(const std::string& nodes, const std::string& models = kCube) { return vox(models + nodes, 200); }
// A single cube, placed by a transform with these frames.
std::string once(const std::vector<Attributes>& frames, const Attributes& own = {}) {
  return scene(moved(0, 1, frames, -1, own) + shape(1));
}
std::string at(std::int64_t x, std::int64_t y, std::int64_t z) {
  return std::to_string(x) + ' ' + std::to_string(y) + ' ' + std::to_string(z);
}

// The reader's error for a file, without the startup time of the program.
std::string refusal_of(const std::string& bytes) {
  try {
    parse_vox(bytes);
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing: it is read";
}

TEST(SpitefulScene, Nodes) {
  constexpr int kDeep = 100'000, kDoubled = 64;
  std::string chain, doubled;
  for (int i = 0; i < kDeep; ++i) chain += moved(i, i + 1);
  for (int i = 0; i < kDoubled; ++i) doubled += moved(2 * i, 2 * i + 1) + group(2 * i + 1, {2 * i + 2, 2 * i + 2});
  const auto raw = [](const char* name, std::initializer_list<std::int64_t> content) {
    return scene(moved(0, 1) + group(1, {2}) + chunk(name, numbers(content)));
  };
  check_all({
      {"a transform that contains itself", scene(moved(0, 0)), refused("itself")},
      {"a cycle of two groups", scene(moved(0, 1) + group(1, {2}) + group(2, {1})), refused("itself")},
      {"a cycle that the root does not reach", scene(moved(0, 1) + shape(1) + moved(2, 3) + moved(3, 2)),
       either("itself", 64)},
      {"a chain of 100,000 transforms", scene(chain + shape(kDeep)), shown(64, Size{4, 4, 4})},
      {"groups of two that are the same, 64 deep", scene(doubled + shape(2 * kDoubled)), refused("instances")},
      {"a group of children that are missing", scene(moved(0, 1) + group(1, {2, 3})), refused("child")},
      {"a group without children", scene(moved(0, 1) + group(1, {})), nothing("")},
      {"a shape of a model that is missing", scene(moved(0, 1) + shape(1, {{1, {}}})), refused("model 1")},
      {"a shape of model -1", scene(moved(0, 1) + shape(1, {{-1, {}}})), refused("model -1")},
      {"a scene without models", scene(moved(0, 1) + shape(1), ""), refused("model 0")},
      {"a node with two parents",
       scene(moved(0, 1) + group(1, {2, 3}) + moved(2, 4) + moved(3, 4, {{{"_t", "9 0 0"}}}) + shape(4)),
       either("parent", 64, Size{13, 4, 4})},
      {"two nodes of one number", scene(moved(0, 1) + shape(1) + shape(1)), refused("duplicate")},
      {"no node 0", scene(moved(7, 9) + shape(9)), shown(64, Size{4, 4, 4})},
      {"negative node numbers", scene(moved(-7, -9) + shape(-9)), shown(64, Size{4, 4, 4})},
      {"a shape alone", scene(shape(0)), shown(64, Size{4, 4, 4})},
      {"children before parents", scene(shape(2) + group(1, {2}) + moved(0, 1)), shown(64, Size{4, 4, 4})},
      {"a transform without frames", scene(moved(0, 1, {}) + shape(1)), either("frames", 64)},
      {"a shape without models", scene(moved(0, 1) + shape(1, {})), either("models")},
      {"a transform of 2^31 frames", raw("nTRN", {2, 0, 3, -1, -1, std::int64_t{1} << 31}), refused("nTRN")},
      {"a group of 2^32 - 1 children", raw("nGRP", {2, 0, -1}), refused("nGRP")},
      {"a shape of 2^30 models", raw("nSHP", {2, 0, 1 << 30}), refused("nSHP")},
      {"2^32 - 1 attributes", raw("nTRN", {2, -1}), refused("nTRN")},
      {"an attribute's name of 2^31 bytes", raw("nTRN", {2, 1, std::int64_t{1} << 31, 0}), refused("nTRN")},
      {"a node of 2 bytes", scene(moved(0, 1) + shape(1) + chunk("nGRP", "xy")), refused("nGRP")},
  });
}

// The bits of _r: the columns of the entries of rows 0 and 1, and three signs. 6 permutations with 8 signs are
// rotations and reflections; 207 of the 256 bytes are invalid. Bit 7 has no meaning; the editor does not set it.
TEST(SpitefulScene, AllRotationBytes) {
  std::string right;
  std::vector<Attributes> places;
  int good = 0;
  for (int byte = 0; byte < 256; ++byte) {
    const int first = byte & 3, second = byte >> 2 & 3;
    const bool expected = byte < 128 && first < 3 && second < 3 && first != second;
    const std::string file = once({{{"_r", std::to_string(byte)}}});
    if (byte < 128) {
      EXPECT_EQ(has(refusal_of(file), "rotation"), !expected) << "rotation byte " << byte << ": " << refusal_of(file);
    }
    good += expected;
    if (expected) places.push_back({{"_r", std::to_string(byte)}, {"_t", at(10 * (good % 8), 10 * (good / 8), 5)}});
  }
  EXPECT_EQ(good, 48);
  check({"all 48 rotations", scene(placed(places), block({2, 3, 4})), shown(24).trying({"voxelise"}).worth(48 * 24)});
  for (const char* text : {"0", "5", "15", "127", "255", "-1", "256", "4.0", "four", "", " 4", "99999999999"}) {
    const std::string said = refusal_of(once({{{"_r", text}}}));
    EXPECT_TRUE(has(said, "rotation")) << "rotation '" << text << "': " << said;
  }
  check_all({{"rotation 5", once({{{"_r", "5"}}}), refused("rotation")},
             {"a rotation that is a word", once({{{"_r", "four"}}}), refused("rotation")}});
}

// A model of 2 x 3 x 4, rotated by a quarter turn about z, and about x.
TEST(SpitefulScene, RotationsTurnTheModel) {
  const auto turned = [](int byte) {
    return scene(moved(0, 1, {{{"_r", std::to_string(byte)}}}) + shape(1), block({2, 3, 4}));
  };
  check_all({
      {"no rotation", turned(0 | 1 << 2), shown(24, Size{2, 3, 4})},
      {"x and y change places", turned(1 | 0 << 2 | 1 << 4), shown(24, Size{3, 2, 4})},
      {"y and z change places", turned(0 | 2 << 2 | 1 << 5), shown(24, Size{2, 4, 3})},
      {"a reflection", turned(0 | 1 << 2 | 1 << 4), shown(24, Size{2, 3, 4})},
  });
}

TEST(SpitefulScene, Translations) {
  for (const char* text : {"2147483648 0 0", "0 -2147483649 0", "0 0 2147483647", "-2147483648 0 0", "1 2", "1", "",
                           "1 2 3 4", "1e3 0 0", "1.5 0 0", "x y z", "nan 0 0", "1,2,3", "0x1 0 0"}) {
    const std::string said = refusal_of(once({{{"_t", text}}}));
    EXPECT_TRUE(has(said, "translation")) << "translation '" << text << "': " << said;
  }
  check_all({
      {"a translation by 2^31", once({{{"_t", "2147483648 0 0"}}}), refused("translation").trying(kOthers)},
      {"a translation of two numbers", once({{{"_t", "1 2"}}}), refused("translation")},
      {"a translation of four numbers", once({{{"_t", "1 2 3 4"}}}), refused("translation")},
      {"a translation with more blanks", once({{{"_t", " 1  2 3 "}}}), either("translation", 64)},
      {"a translation twice, the last counts", once({{{"_t", "1 1 1"}, {"_t", "2 2 2"}}}), shown(64)},
      {"transforms that add up beyond 2^31",
       [] {
         std::string nodes;
         for (int i = 0; i < 200; ++i) nodes += moved(i, i + 1, {{{"_t", "16777216 0 0"}}});
         return scene(nodes + shape(200));
       }(),
       refused("away")},
      {"a model alone, 16 million voxels from the origin", once({{{"_t", "16000000 -16000000 16000000"}}}),
       shown(64, Size{4, 4, 4}).trying({"cast", "voxelise"}).worth(64)},
  });
}

TEST(SpitefulScene, Frames) {
  std::vector<Attributes> thousands;
  for (int i = 0; i < 10'000; ++i) thousands.push_back({{"_f", std::to_string(i)}, {"_t", at(i % 50, 0, 0)}});
  const std::vector<Attributes> far{{{"_f", "0"}, {"_t", "0 0 0"}}, {{"_f", "2147483647"}, {"_t", "8 0 0"}}};
  check_all({
      {"two frames of one index", once({{{"_f", "3"}, {"_t", "1 0 0"}}, {{"_f", "3"}, {"_t", "2 0 0"}}}),
       shown(64, Size{4, 4, 4})},
      {"descending frames", once({{{"_f", "9"}, {"_t", "9 0 0"}}, {{"_f", "0"}}}), shown(64).with({"--frame", "4"})},
      {"a negative frame", once({{{"_f", "-5"}}, {{"_f", "5"}}}), either("frame", 64)},
      {"a frame that is a word", once({{{"_f", "soon"}}}), refused("frame")},
      {"a frame beyond 2^31", once({{{"_f", "0"}}, {{"_f", "4294967296"}}}), refused("frame")},
      {"ten thousand frames", once(thousands), shown(64).with({"--frame", "9999"}).trying({"cast"})},
      {"two thousand million frames", once(far), shown(64, Size{4, 4, 4}).with({"--frame", "2000000000"})},
      {"two thousand million frames that repeat", once(far, {{"_loop", "1"}}),
       shown(64).with({"--frame", "2147483647"})},
      {"a frame that the file does not have", once({{}}), shown(64).with({"--frame", "7"}).noting("frame")},
      {"one shape, a model for each of 1,000 frames",
       [] {
         std::vector<std::pair<int, Attributes>> models;
         for (int i = 0; i < 1000; ++i) models.push_back({i % 2, {{"_f", std::to_string(i)}}});
         return scene(moved(0, 1) + shape(1, models), kCube + block({2, 2, 2}));
       }(),
       shown(72, Size{2, 2, 2}).with({"--frame", "999"})},
  });
}

TEST(SpitefulScene, Layers) {
  const auto in_layer = [](int id, const std::string& layers) {
    return scene(moved(0, 1, {{}}, id) + shape(1) + layers);
  };
  const std::string hidden = once({{}}, {{"_hidden", "1"}});
  check_all({
      {"all is hidden", hidden, nothing("--hidden").trying(kOthers)},
      {"all is hidden, and asked for", hidden, shown(64, Size{4, 4, 4}).with({"--hidden"})},
      {"all is in a hidden layer", in_layer(3, layer(3, {{"_hidden", "1"}})), nothing("--hidden")},
      {"a layer that does not exist", in_layer(77, layer(3, {})), shown(64)},
      {"layer -2^31", in_layer(static_cast<int>(0x80000000), ""), shown(64)},
      {"a layer twice", in_layer(3, layer(3, {}) + layer(3, {})), shown(64)},
      {"_hidden is a word", once({{}}, {{"_hidden", "perhaps"}}), shown(64)},
      {"a layer of 3 bytes", in_layer(3, chunk("LAYR", "abc")), refused("LAYR")},
  });
}

// The empty space between the models takes no memory, and no picture of this size shows both.
TEST(SpitefulScene, DistantModels) {
  const auto apart = [](std::int64_t by) { return scene(placed({{{"_t", at(0, 0, 2)}}, {{"_t", at(by, 0, 2)}}})); };
  check_all({
      {"two models 100 apart", apart(100), shown(64, Size{104, 4, 4}).trying({"voxelise"}).worth(128)},
      {"two models 100,000 apart", apart(100'000),
       shown(64, Size{100'004, 4, 4}).too_small().trying({"cast", "section"})},
      {"two models 16 million apart", apart(16'000'000),
       either("apart", 64, Size{16'000'004, 4, 4}).too_small().trying({"cast"})},
      {"two models 2^30 apart", apart(1 << 30), refused("1073741824")},
  });
  // 100,000 voxels are more than a file can have: they are rejected quickly, without allocating memory for them.
  const test::Scratch folder;
  folder.write("m.vox", apart(100'000));
  const Look look(folder, "m.vox", {"voxelise"}, "o.vox");
  look.expect_sane();
  look.expect_refused(refused(""));
  look.expect_memory(200, least_memory("render", "p.png"));
}

TEST(SpitefulScene, ManyInstances) {
  // The walls of a box of 126^3, at 10,000 positions.
  constexpr int kSide = 126;
  std::vector<Dot> walls;
  for (const Dot& dot : dots_of({kSide, kSide, kSide})) {
    const auto end = [](int i) { return i == 0 || i == kSide - 1; };
    if (end(dot.x) || end(dot.y) || end(dot.z)) walls.push_back(dot);
  }
  std::vector<Attributes> square, heap, stairs;
  for (int i = 0; i < 10'000; ++i) square.push_back({{"_t", at(130 * (i % 100), 130 * (i / 100), 63)}});
  for (int i = 0; i < 4096; ++i) {
    heap.push_back({});
    stairs.push_back({{"_t", at(i % 64, i / 64, 0)}});
  }
  check_all({
      {"10,000 instances of a model of 126^3", scene(placed(square), model({kSide, kSide, kSide}, walls)),
       shown(static_cast<std::int64_t>(walls.size()), Size{99 * 130 + kSide, 99 * 130 + kSide, kSide})
           .in(kSide * kSide * kSide)},
      {"4,096 instances in one place", scene(placed(heap)),
       either("overlap", 64, Size{4, 4, 4}).trying({"voxelise"}).worth(64)},
      {"4,096 instances, each a voxel on", scene(placed(stairs)),
       shown(64, Size{67, 67, 4}).trying({"voxelise"}).worth(67 * 67 * 4)},
      {"one node 4,096 times in a group", scene(moved(0, 1) + group(1, std::vector<int>(4096, 2)) + shape(2)),
       either("overlap", 64, Size{4, 4, 4})},
  });
}

}  // namespace
}  // namespace scarp
