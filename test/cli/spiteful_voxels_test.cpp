// SPDX-License-Identifier: MIT
// MagicaVoxel files made to break readers: headers, chunks, models, palettes, truncation. Each must do what an artist
// would expect.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cli/spiteful_checks.h"
#include "cli/spiteful_files.h"

namespace scarp {
namespace {

using namespace test::spite;

constexpr Size kFour{4, 4, 4}, kTwo{2, 2, 2};
const std::string kBlock = block(kFour);

// Commands for some of the cases.
const std::vector<std::string> kAll{"cast", "section", "voxelise"};

// About as much as an editor writes: two models in a scene, a layer, a palette, materials, its own settings.
std::string editors_file() {
  const std::string scene = moved(0, 1) + group(1, {2, 4}) + moved(2, 3, {{{"_t", "0 0 2"}}}, 0) + shape(3) +
                            moved(4, 5, {{{"_t", "6 0 2"}, {"_r", "4"}}}, 0) + shape(5, {{1, {}}});
  const std::string material = number(1) + attributes({{"_type", "_metal"}, {"_rough", "0.1"}, {"_ior", "0.3"}});
  return vox(kBlock + block({2, 3, 4}) + scene + layer(0, {{"_name", "walls"}, {"_hidden", "0"}}) + palette(0xff0000) +
                 chunk("MATL", material) + chunk("rOBJ", attributes({{"_type", "_bounce"}})) +
                 chunk("rCAM", number(0) + attributes({{"_mode", "pers"}})) + chunk("NOTE", number(0)),
             200);
}

TEST(SpitefulVox, Versions) {
  check_all({
      {"version 150", vox(kBlock), shown(64, kFour).trying(kAll).worth(64)},
      {"version 200 without a scene", vox(kBlock, 200), shown(64, kFour)},
      {"an editor's file", editors_file(), shown(88, Size{9, 4, 4}).trying(kAll).worth(88)},
      {"version 99", vox(kBlock, 99), refused("99")},
      {"version 201, perhaps the next", vox(kBlock, 201), either("201", 64, kFour)},
      {"version -1", vox(kBlock, -1), refused("version")},
  });
}

TEST(SpitefulVox, PackChunks) {
  const auto pack = [](std::int64_t count) { return chunk("PACK", numbers({count})); };
  check_all({
      {"PACK of one", vox(pack(1) + kBlock), shown(64, kFour)},
      {"PACK of three, the first is shown", vox(pack(3) + kBlock + block(kTwo) + block({1, 2, 3})), shown(78, kFour)},
      {"PACK of three, the last frame", vox(pack(3) + kBlock + block(kTwo) + block({1, 2, 3})),
       shown(78, Size{1, 2, 3}).with({"--frame", "2"})},
      {"PACK of three where there are two", vox(pack(3) + kBlock + kBlock), either("PACK", 128, kFour)},
      {"PACK of -1", vox(pack(-1) + kBlock), either("PACK", 64, kFour)},
      {"PACK of 2^31 - 1", vox(pack(0x7fffffff) + kBlock), either("PACK", 64, kFour)},
      {"PACK without its number", vox(chunk("PACK", "") + kBlock), either("PACK", 64, kFour)},
  });
}

TEST(SpitefulVox, Sizes) {
  const std::string dot = dots_chunk({{0, 0, 0, kRed}});
  const std::vector<Dot> corners{{0, 0, 0, kRed}, {255, 255, 255, kRed}};
  check_all({
      {"SIZE without XYZI", vox(size_chunk(4, 4, 4)), refused("XYZI")},
      {"XYZI without SIZE", vox(dot), refused("SIZE")},
      {"two SIZE in a row", vox(size_chunk(4, 4, 4) + kBlock), refused("SIZE")},
      {"XYZI twice", vox(kBlock + dot), refused("SIZE")},
      {"a voxel outside its SIZE", vox(model(kTwo, {{2, 0, 0, kRed}})), refused("outside")},
      {"a voxel at 255 of 4", vox(model(kFour, {{0, 0, 255, kRed}})), refused("outside")},
      {"SIZE 0", vox(size_chunk(0, 4, 4) + dot), refused("0 x 4 x 4")},
      {"SIZE 0 x 0 x 0 without voxels", vox(size_chunk(0, 0, 0) + dots_chunk({})), refused("0 x 0 x 0")},
      {"SIZE 257", vox(size_chunk(257, 4, 4) + dot), either("257", 1, Size{1, 1, 1})},
      {"SIZE -1", vox(size_chunk(4, -1, 4) + dot), refused("model of")},
      {"SIZE 2^31", vox(size_chunk(4, 4, std::int64_t{1} << 31) + dot), refused("model of")},
      {"SIZE 65536^3, 2^48 voxels", vox(size_chunk(65536, 65536, 65536) + dot), refused("65536")},
      {"SIZE of two numbers", vox(chunk("SIZE", numbers({4, 4})) + dot), refused("SIZE")},
      {"256^3 with a dot", vox(model({256, 256, 256}, {{9, 9, 9, kRed}})), shown(1, Size{1, 1, 1}).trying({"cast"})},
      {"256^3 with dots in two corners", vox(model({256, 256, 256}, corners)),
       shown(2, Size{256, 256, 256}).too_small().in(256 * 256 * 256)},
      {"256 x 1 x 1", vox(block({256, 1, 1})), shown(256, Size{256, 1, 1}).too_small()},
  });
}

// Canvases of 256^3 with dots in two corners: a few kilobytes that declare gigabytes, side by side and inside one
// another.
TEST(SpitefulVox, ManyNearlyEmptyModels) {
  constexpr int kModels = 300;
  const auto file = [](int step) {
    std::string models, nodes;
    std::vector<int> children;
    for (int i = 0; i < kModels; ++i) {
      models += model({256, 256, 256}, {{0, 0, 0, kRed}, {255, 255, 255, kRed}});
      children.push_back(2 + 2 * i);
      const std::string place = std::to_string(step * i) + " 0 128";
      nodes += moved(2 + 2 * i, 3 + 2 * i, {{{"_t", place}}}) + shape(3 + 2 * i, {{i, {}}});
    }
    return vox(models + moved(0, 1) + group(1, children) + nodes, 200);
  };
  constexpr std::int64_t kCanvases = std::int64_t{kModels} << 24;
  check_all({
      {"300 models of 256^3 with two voxels each, side by side", file(256),
       either("m.vox", 2 * kModels, Size{300 * 256, 256, 256}).too_small().in(kCanvases)},
      {"300 models of 256^3 with two voxels each, 3 voxels apart", file(3),
       either("m.vox", 2 * kModels, Size{299 * 3 + 256, 256, 256}).too_small().in(kCanvases)},
  });
}

TEST(SpitefulVox, Counts) {
  const auto of = [](std::int64_t count) { return vox(size_chunk(4, 4, 4) + dots_chunk(dots_of(kTwo), count)); };
  check_all({
      {"XYZI states more than it has", of(9), refused("XYZI")},
      {"XYZI states fewer than it has", of(7), either("XYZI", 7)},
      {"XYZI states 2^31", of(std::int64_t{1} << 31), refused("XYZI")},
      {"XYZI states 2^32 - 1", of(0xffffffff), refused("XYZI")},
      {"XYZI states 2^30, of which 4 bytes each are 2^32", of(std::int64_t{1} << 30), refused("XYZI")},
      {"no chunk at all", vox(""), nothing("").trying(kAll)},
      {"no model, but a palette", vox(palette(0xff0000)), nothing("")},
      {"a model without voxels", vox(model(kFour, {})), nothing("").trying(kAll)},
      {"one position a hundred thousand times", vox(model(kFour, std::vector<Dot>(100'000, {1, 1, 1, kRed}))),
       shown(-1, Size{1, 1, 1}).trying({"voxelise"}).worth(1)},
  });
}

TEST(SpitefulVox, Palettes) {
  std::string map;
  for (int i = 0; i < 256; ++i) map += static_cast<char>((i * 7 + 3) & 255);
  std::vector<Dot> some = dots_of(kTwo);
  some.push_back({3, 3, 3, 0});
  check_all({
      {"a palette of 10 colours", vox(kBlock + palette(0xff0000, 10)), either("RGBA", 64, kFour)},
      {"a palette of 257 colours", vox(kBlock + palette(0xff0000, 257)), either("RGBA", 64, kFour)},
      {"a palette without opacity", vox(kBlock + palette(0xff0000, 256, 0)), shown(64, kFour)},
      {"two palettes", vox(kBlock + palette(0x00ff00) + palette(0xff0000)), shown(64, kFour)},
      {"the palette before its models", vox(palette(0xff0000) + kBlock), shown(64, kFour)},
      {"a palette of black", vox(kBlock + palette(0)), shown(64, kFour)},
      {"IMAP, a permutation", vox(kBlock + palette(0xff0000) + chunk("IMAP", map)), shown(64, kFour)},
      {"IMAP of zeros", vox(kBlock + chunk("IMAP", std::string(256, '\0'))), shown(64, kFour)},
      {"IMAP of 3 bytes", vox(kBlock + chunk("IMAP", "abc")), either("IMAP", 64, kFour)},
      {"index 255", vox(block(kFour, 255)), shown(64, kFour)},
      {"some voxels of index 0", vox(model(kFour, some)), shown(8, kTwo).noting("palette index 0")},
      {"voxels of index 0 only", vox(block(kFour, 0)), nothing("")},
  });
}

// Red by the default palette, by entry kRed - 1 of RGBA regardless of IMAP; not by the entry of the index itself.
TEST(SpitefulVox, ColoursMatchTheEditor) {
  std::string rgba = palette(0x0000ff, kRed - 1).substr(12) + test::spite::bytes({255, 0, 0, 255});
  rgba += palette(0x0000ff, 256 - kRed).substr(12);
  const std::string own = chunk("RGBA", rgba);
  const std::vector<Case> cases = {
      {"the default palette", vox(kBlock), {}},
      {"an own palette", vox(kBlock + own), {}},
      {"an own palette and IMAP", vox(kBlock + own + chunk("IMAP", std::string(256, 1))), {}}};
  for (const Case& c : cases) {
    const test::Scratch folder;
    folder.write("m.vox", c.bytes);
    const Look look(folder, "m.vox", {"render", "--size", "96x54", "--haze", "0"}, "p.png");
    ASSERT_EQ(look.result.status, 0) << look.said();
    const test::Rgb picture = test::read_png(look.out());
    int red = 0;
    for (int i = 0; i < picture.width * picture.height; ++i) {
      const std::uint8_t* p = picture.pixel(i, 0);
      red += p[0] > 40 && 3 * p[1] < p[0] && 3 * p[2] < p[0];
    }
    EXPECT_GT(red, picture.width * picture.height / 20) << c.name << ": expected a red block";
  }
}

TEST(SpitefulVox, ForeignChunks) {
  const auto material = [](int id, const Attributes& of) { return chunk("MATL", number(id) + attributes(of)); };
  check_all({
      {"materials of unknown types", vox(kBlock + material(1, {{"_type", "_plasma"}}) + material(2, {})), shown(64)},
      {"materials of index 300 and -5", vox(kBlock + material(300, {}) + material(-5, {})), shown(64)},
      {"materials whose numbers are words", vox(kBlock + material(1, {{"_rough", "very"}, {"_ior", ""}})), shown(64)},
      {"old materials", vox(kBlock + chunk("MATT", numbers({1, 2, 0, 0}))), shown(64)},
      {"old materials of 1 byte", vox(kBlock + chunk("MATT", "x")), shown(64)},
      {"rOBJ, rCAM, NOTE of nonsense", vox(kBlock + chunk("rOBJ", "x") + chunk("rCAM", "") + chunk("NOTE", "yz")),
       shown(64)},
      {"unknown chunks, with children", vox(chunk("ABCD", "123", kBlock) + kBlock + chunk(std::string(4, '\0'), "")),
       shown(64, kFour)},
      {"a chunk that ends beyond the file", vox(kBlock + "NOTE" + numbers({1000, 0}) + "short"), either("NOTE", 64)},
      {"a chunk of 2^32 - 1 bytes", vox(kBlock + "NOTE" + numbers({-1, -1})), either("NOTE", 64)},
      {"three bytes of a chunk's name", vox(kBlock + "NOT"), either("at byte", 64)},
      {"MAIN in MAIN", vox(chunk("MAIN", "", kBlock)), nothing("")},
      {"models as children of SIZE", vox(chunk("SIZE", numbers({4, 4, 4}), dots_chunk(dots_of(kTwo)))),
       either("SIZE", 8, kTwo)},
      {"MAIN with bytes of its own", "VOX " + number(150) + chunk("MAIN", "own", kBlock), shown(64, kFour)},
      {"the first chunk is not MAIN", "VOX " + number(150) + chunk("MAIM", "", kBlock), refused("MAIN")},
  });
}

// Names are free text: their bytes must neither break JSON nor reach a terminal as control codes.
TEST(SpitefulVox, NamesWithArbitraryBytes) {
  const std::string scene = moved(0, 1, {{}}, 0, {{"_name", "a\x1b[31mb\nc"}}) + shape(1);
  const std::string bytes = vox(kBlock + scene + layer(0, {{"_name", "\xff\xfe\x1b]0;x\x07"}}) +
                                    chunk("MATL", number(1) + attributes({{"_type", "\xc3\x28\x1b[2J\n"}})),
                                200);
  check({"names with control codes and no UTF-8", bytes, shown(64, kFour).trying(kAll)});
  const test::Scratch folder;
  folder.write("m.vox", bytes);
  const Look text(folder, "m.vox", {"info"});
  EXPECT_TRUE(text.expect_sane());
  EXPECT_EQ(text.result.status, 0) << text.said();
}

TEST(SpitefulVox, FileNames) {
  const std::string broken = vox(kBlock, 99);
  for (const char* name : {"M.VOX", "a b.vox", "100%{}.vox", "-m.vox", "m.vox.vox"})
    check({name, vox(kBlock), shown(64)}, name);
  check({"a name that is not UTF-8", vox(kBlock), shown(64)}, "m\xff\xfe.vox");
  check({"a broken file of a name that is not UTF-8", broken, refused("99")}, "m\xff\xfe.vox");
  check({"a broken file of a name with braces", broken, refused("99")}, "{0}%s.vox");
  // Its name is quoted in some way.
  const test::Scratch folder;
  folder.write("two\nlines.vox", broken);
  const Look look(folder, "two\nlines.vox", {"info"});
  EXPECT_TRUE(look.expect_sane());
  EXPECT_NE(look.result.status, 0);
  EXPECT_EQ(test::lines(look.result.err), 1) << "a file's name with a line break: " << look.said();
}

TEST(SpitefulVox, TruncatedAtEveryTenthByte) {
  const std::string whole = editors_file();
  for (std::size_t tenth = 1; tenth < 10; ++tenth) {
    check({std::to_string(tenth) + " tenths of an editor's file", whole.substr(0, whole.size() * tenth / 10),
           refused("truncated").trying(tenth == 5 ? kAll : std::vector<std::string>{})});
  }
  check_all({
      {"the last byte is missing", whole.substr(0, whole.size() - 1), refused("truncated")},
      {"the first word only", "VOX ", refused("truncated")},
      {"garbage behind the end", whole + "garbage behind the end", shown(88)},
      {"zeros behind the end", whole + std::string(5000, '\0'), shown(88)},
  });
}

// For files of other kinds, the error does not advise fetching them again: that would not help.
TEST(SpitefulVox, OtherFormatsNamedVox) {
  // Width, depth and height, then a byte each, 255 empty, and a palette of 6 bits: Voxlap's .vox.
  const std::string slab = numbers({2, 2, 2}) + std::string(8, '\x01') + std::string(768, '\x3f');
  check_all({
      {"a zip", "PK\x03\x04" + std::string(60, 'z'), refused("MagicaVoxel").intact().trying(kAll)},
      {"a picture", "\x89PNG\r\n\x1a\n" + std::string(60, 'p'), refused("MagicaVoxel").intact()},
      {"text", "size 4 4 4\n", refused("MagicaVoxel").intact()},
      {"a .vox of Voxlap", slab, either("MagicaVoxel", 8, kTwo).intact()},
      {"the first letter in lower case", "vox " + vox(kBlock).substr(4), refused("MagicaVoxel").intact()},
      {"an empty file", "", refused("empty")},
      {"a pointer of Git LFS", "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n",
       refused("git lfs pull")},
  });
}

TEST(SpitefulVox, MissingFile) {
  const test::Scratch folder;
  std::filesystem::create_directory(folder.path("folder.vox"));
  std::filesystem::create_symlink(folder.path("nowhere"), folder.path("dangling.vox"));
  std::filesystem::create_symlink(folder.path("loop.vox"), folder.path("loop.vox"));
  check_file(folder, "folder.vox", {"a folder", "", refused("folder.vox")});
  check_file(folder, "dangling.vox", {"a link to nothing", "", refused("cannot be opened")});
  check_file(folder, "loop.vox", {"a link to itself", "", refused("cannot be opened")});
  check_file(folder, "missing.vox", {"no file", "", refused("cannot be opened")});
}

}  // namespace
}  // namespace scarp
