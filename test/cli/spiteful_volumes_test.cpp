// SPDX-License-Identifier: MIT
// binvox files, bare volumes, and voxel files of other programs, made to break readers.
#include <gtest/gtest.h>

#include <bit>
#include <string>
#include <vector>

#include "cli/spiteful_checks.h"
#include "cli/spiteful_files.h"

namespace scarp {
namespace {

using namespace test::spite;

constexpr Size kCubeOf4{4, 4, 4};
const std::vector<std::string> kEach{"cast", "section", "voxelise"};

TEST(SpitefulBinvox, Headers) {
  const auto with = [](const std::string& header) { return binvox(header, {{1, 64}}); };
  check_all(
      {
          {"a block", with("dim 4 4 4\ntranslate 0 0 0\nscale 1\n"), shown(64, kCubeOf4).trying(kEach).worth(64)},
          {"nothing but dim", with("dim 4 4 4\n"), shown(64, kCubeOf4)},
          {"lines end as on Windows", "#binvox 1\r\ndim 4 4 4\r\ntranslate 0 0 0\r\nscale 1\r\ndata\r\n\x01\x40",
           shown(64, kCubeOf4)},
          {"depth, height, width", binvox("dim 2 3 4\n", {{1, 24}}), shown(24, Size{2, 4, 3})},
          {"dim 0", with("dim 4 0 4\n"), refused("dim 4 0 4")},
          {"dim 0 0 0 without runs", binvox("dim 0 0 0\n", {}), refused("dim 0 0 0")},
          {"a negative dim", with("dim 4 -4 4\n"), refused("dim 4 -4 4")},
          {"10^18 voxels", with("dim 1000000 1000000 1000000\n"), refused("dim 1000000")},
          {"2^33 voxels, of which it has 64", with("dim 2048 2048 2048\n"), refused("64 voxels")},
          {"dim beyond 64 bits", with("dim 99999999999999999999 4 4\n"), refused("dim")},
          {"dim of two numbers", with("dim 4 4\n"), refused("dim 4 4")},
          {"dim of four numbers", with("dim 4 4 4 4\n"), refused("dim 4 4 4 4")},
          {"dim of fractions", with("dim 4.5 4 4\n"), refused("dim 4.5")},
          {"no dim", with("scale 1\n"), refused("dim")},
          {"no line data", "#binvox 1\ndim 4 4 4\n\x01\x40", refused("data")},
          {"the first line only", "#binvox 1\n", refused("data")},
          {"a header without line breaks", "#binvox 1 dim 4 4 4 data", refused("m.binvox")},
          {"version 2", "#binvox 2\ndim 4 4 4\ndata\n\x01\x40", refused("version")},
          {"a million comments", "#binvox 1\n" + std::string(1'000'000, '#') + "\ndim 4 4 4\ndata\n\x01\x40",
           refused("m.binvox")},
          {"translate nan", with("dim 4 4 4\ntranslate nan 0 0\n"), refused("translate")},
          {"scale inf", with("dim 4 4 4\nscale inf\n"), refused("scale")},
          {"scale 0", with("dim 4 4 4\nscale 0\n"), either("scale", 64)},
          {"scale -1e308", with("dim 4 4 4\nscale -1e308\n"), either("scale", 64)},
          {"another file of this name", vox(block({2, 2, 2})), either("binvox", 8)},
          {"an empty file", "", refused("m.binvox")},
      },
      "m.binvox");
}

TEST(SpitefulBinvox, Runs) {
  const auto of = [](const std::vector<std::pair<int, int>>& runs) { return binvox("dim 4 4 4\n", runs); };
  // A floor of 128 x 128 below a large empty space: y fastest, then z. 63 runs of 255 and one of 191 are 127 rows.
  std::string floor = "#binvox 1\ndim 128 128 128\ndata\n";
  for (int column = 0; column < 128; ++column) {
    floor += bytes({1, 128});
    for (int i = 0; i < 63; ++i) floor += bytes({0, 255});
    floor += bytes({0, 191});
  }
  check_all(
      {
          {"one voxel too many", of({{1, 65}}), refused("65 voxels")},
          {"far too many", of(std::vector<std::pair<int, int>>(5000, {1, 255})), refused("voxels")},
          {"one voxel too few", of({{1, 63}}), refused("63 voxels")},
          {"no runs", of({}), refused("0 voxels")},
          {"a run of none", of({{1, 64}, {1, 0}}), refused("run 1")},
          {"runs of none only", of({{1, 0}, {0, 0}}), refused("run 0")},
          {"a run of 7", of({{7, 64}}), refused("run 0")},
          {"half a run at the end", of({{1, 64}}) + "\x01", either("run", 64)},
          {"a line break at the end", of({{1, 64}}) + "\n", either("run", 64)},
          {"nothing solid", of({{0, 64}}), nothing("").trying(kEach)},
          {"64 runs of one", of(std::vector<std::pair<int, int>>(64, {1, 1})), shown(64, kCubeOf4)},
          {"a floor of 128 x 128 in 128^3", floor, shown(128 * 128, Size{128, 128, 1}).in(128 * 128 * 128)},
      },
      "m.binvox");
}

TEST(SpitefulVolume, RawNumbers) {
  const std::string nan = test::spite::number(0x7fc00000), one = test::spite::number(std::bit_cast<std::int32_t>(1.0F)),
                    inf = test::spite::number(0x7f800000);
  const auto times = [](const std::string& what, int count) {
    std::string out;
    for (int i = 0; i < count; ++i) out += what;
    return out;
  };
  const std::string ones(64, '\x01');
  const auto as = [](const std::string& format, const std::vector<std::string>& more = {}) {
    std::vector<std::string> options{"--volume", format};
    options.insert(options.end(), more.begin(), more.end());
    return options;
  };
  check_all(
      {
          {"a block", ones, shown(64, kCubeOf4).with(as("4x4x4:u8")).trying(kEach).worth(64)},
          {"a file that is too short", ones, refused("64 bytes").with(as("4x4x5:u8"))},
          {"a file that is too long", ones, refused("64 bytes").with(as("4x4x3:u8"))},
          {"2^33 samples of 8 bytes", ones, refused("64 bytes").with(as("2048x2048x2048:f64le"))},
          {"a side of 0", ones, refused("0x4x4").with(as("0x4x4:u8")).by_option()},
          {"a side of 3000", ones, refused("2048").with(as("3000x1x1:u8")).by_option()},
          {"a side of 2^32 + 4", ones, refused("4294967300").with(as("4294967300x4x4:u8")).by_option()},
          {"an offset beyond the file", ones, refused("offset").with(as("4x4x4:u8+100"))},
          {"an offset of 2^63", ones, refused("4x4x4:u8+").with(as("4x4x4:u8+9223372036854775808")).by_option()},
          {"an offset that wraps round", ones,
           refused("4x4x4:u8+").with(as("4x4x4:u8+9223372036854775807")).by_option()},
          {"a negative offset", ones, refused("4x4x4:u8+").with(as("4x4x4:u8+-4")).by_option()},
          {"zeros only", std::string(64, '\0'), nothing("").with(as("4x4x4:u8"))},
          {"negative numbers only", std::string(64, '\xff'), nothing("--solid-from").with(as("4x4x4:i8"))},
          {"NaN only", times(nan, 64), nothing("").with(as("4x4x4:f32le"))},
          {"NaN and ones", times(nan + one, 32), shown(32).with(as("4x4x4:f32le"))},
          {"infinity and ones", times(inf + one, 32), shown(64).with(as("4x4x4:f32le"))},
          {"nothing from there on", ones, nothing("--solid-from").with(as("4x4x4:u8", {"--solid-from", "1000"}))},
          {"all from nan on", ones, refused("--solid-from").with(as("4x4x4:u8", {"--solid-from", "nan"})).by_option()},
          {"all from -inf on", ones,
           either("--solid-from", 64).with(as("4x4x4:u8", {"--solid-from=-inf"})).by_option()},
          {"one voxel", "\x01", shown(1, Size{1, 1, 1}).with(as("1x1x1:u8")).trying({"section", "voxelise"}).worth(1)},
          {"a needle of 2048", std::string(2048, '\x01'),
           shown(2048, Size{1, 1, 2048}).with(as("1x1x2048:u8")).too_small()},
          {"4 MiB that are skipped", std::string(std::size_t{1} << 22, '\0') + "\x01",
           shown(1, Size{1, 1, 1}).with(as("1x1x1:u8+4194304"))},
          {"no file of numbers", "", refused("m.raw").with(as("4x4x4:u8"))},
      },
      "m.raw");
}

TEST(SpitefulVolume, Arrays) {
  const auto npy = [](const std::string& dictionary, const std::string& samples) {
    std::string header = dictionary;
    header.resize(117, ' ');
    return "\x93NUMPY" + bytes({1, 0}) + test::spite::number(118, 2) + header + "\n" + samples;
  };
  const auto shaped = [](const std::string& shape, const std::string& type = "|u1") {
    return "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }";
  };
  const std::string ones(64, '\x01');
  const std::vector<std::string> options{"--volume", "npy"};
  check_all(
      {
          {"a block", npy(shaped("(4, 4, 4)"), ones), shown(64, kCubeOf4).with(options)},
          {"[z][y][x]", npy(shaped("(2, 3, 4)"), ones.substr(0, 24)), shown(24, Size{4, 3, 2}).with(options)},
          {"no samples", npy(shaped("(0, 4, 4)"), ""), refused("0").with(options)},
          {"an array of two dimensions", npy(shaped("(8, 8)"), ones), refused("dimensions").with(options)},
          {"an array of none", npy(shaped("()"), "\x01"), refused("dimensions").with(options)},
          {"2^63 samples", npy(shaped("(2097152, 2097152, 2097152)"), ones), refused("2097152").with(options)},
          {"2^33 samples of 8 bytes", npy(shaped("(2048, 2048, 2048)", "<f8"), ones), refused("bytes").with(options)},
          {"Python objects", npy(shaped("(4, 4, 4)", "|O"), ones), refused("type").with(options)},
          {"complex numbers", npy(shaped("(2, 2, 2)", "<c8"), ones), refused("type").with(options)},
          {"half of its samples", npy(shaped("(4, 4, 4)"), ones.substr(0, 32)), refused("bytes").with(options)},
          {"a header that goes beyond the file", "\x93NUMPY" + bytes({1, 0, 255, 255}) + "{",
           refused("m.npy").with(options)},
          {"a header of version 9", "\x93NUMPY" + bytes({9, 0, 1, 0}) + "{", refused("m.npy").with(options)},
          {"truth values", npy(shaped("(4, 4, 4)", "|b1"), ones), shown(64, kCubeOf4).with(options)},
      },
      "m.npy");
}

// Files of Qubicle and Voxlap. Either they are read correctly, or the program lists the formats that it reads and does
// not ask for another copy of an undamaged file.

TEST(SpitefulOthers, Qubicle) {
  // y is up in Qubicle.
  constexpr std::array<std::int64_t, 3> kBox{2, 3, 4};
  // Each slice is a run of 6, and its end.
  const std::string run = numbers({2, 6}) + qubicle_reds(1), slice = run + test::spite::number(6);
  check_all(
      {
          {"a block", qubicle(false, kBox, qubicle_reds(24)),
           either("", 24, Size{2, 4, 3}).intact().trying({"cast", "section"})},
          {"a block in runs", qubicle(true, kBox, slice + slice + slice + slice),
           either("", 24, Size{2, 4, 3}).intact()},
          {"half its voxels", qubicle(false, kBox, qubicle_reds(12)), refused("m.qb")},
          {"a matrix of 2^31", qubicle(false, {std::int64_t{1} << 31, 3, 4}, qubicle_reds(24)), refused("m.qb")},
          {"a matrix of (2^32 - 1)^3", qubicle(true, {-1, -1, -1}, slice), refused("m.qb")},
          {"a matrix of none", qubicle(false, {0, 3, 4}, ""), nothing("")},
          {"2^32 - 1 matrices", qubicle(false, kBox, qubicle_reds(24), -1), refused("m.qb")},
          {"no matrices", qubicle(false, kBox, "", 0), nothing("")},
          {"a run beyond its slice", qubicle(true, kBox, numbers({2, -1}) + qubicle_reds(1) + slice), refused("m.qb")},
          {"a slice that does not end", qubicle(true, kBox, run + run + run + run + run), refused("m.qb")},
          {"air only", qubicle(false, kBox, std::string(96, '\0')), nothing("")},
          {"an empty file", "", refused("m.qb")},
      },
      "m.qb");
}

TEST(SpitefulOthers, Kv6) {
  check_all(
      {
          {"a block", kv6({2, 2, 2}, 8), either("", 8, Size{2, 2, 2}).intact().trying({"cast", "section"})},
          {"more voxels than it has", kv6({2, 2, 2}, 9), refused("m.kv6")},
          {"2^32 - 1 voxels", kv6({2, 2, 2}, -1), refused("m.kv6")},
          {"voxels outside", kv6({2, 2, 2}, 8, 500), refused("m.kv6")},
          {"a side of 2^31", kv6({2, 2, 2}, 8).replace(4, 4, test::spite::number(std::int64_t{1} << 31)),
           refused("m.kv6")},
          {"its columns are missing", kv6({2, 2, 2}, 8).substr(0, 32 + 64), refused("m.kv6")},
          {"no voxels", kv6({2, 2, 2}, 0).replace(32, 64, ""), refused("m.kv6")},
          {"another kind of file", "Kvxx" + kv6({2, 2, 2}, 8).substr(4), refused("m.kv6")},
      },
      "m.kv6");
}

TEST(SpitefulOthers, Vxl) {
  // Layers 60 and 61 of 64 are coloured, and the layers below are solid: 4 layers.
  const std::string map = vxl_columns(512 * 512, 60, 61);
  check_all(
      {
          {"a map of 512 x 512 without a head", map, either("", -1, Size{512, 512, 4}).intact().in(512 * 512 * 64)},
          {"a map of Voxlap", vxl_head(32) + vxl_columns(32 * 32, 250, 251), either("", -1).intact()},
          {"a map that ends too soon", map.substr(0, map.size() / 2), refused("m.vxl")},
          {"a map with more behind it", map + map, refused("m.vxl")},
          {"spans that end above where they begin", vxl_columns(512 * 512, 40, 30), refused("m.vxl")},
          {"lists of spans that overrun", std::string(512 * 512 * 4, '\xff'), refused("m.vxl")},
          {"a map of 2^31 columns a side", vxl_head(std::int64_t{1} << 31) + "x", refused("m.vxl")},
          {"a map of none", vxl_head(0), refused("m.vxl")},
          {"a voxel animation", "Voxel Animation" + std::string(1000, '\0'), refused("m.vxl").intact()},
          {"an empty file", "", refused("m.vxl")},
      },
      "m.vxl");
}

// A scene that uses a broken file names that file.
TEST(SpitefulOthers, BrokenFilesInScenes) {
  for (const auto& [file, content] :
       std::vector<std::pair<std::string, std::string>>{{"broken.vox", vox(block(kCubeOf4), 99)},
                                                        {"broken.vox", vox(model(kCubeOf4, {}))},
                                                        {"broken.binvox", binvox("dim 4 4 4\n", {{0, 64}})}}) {
    const test::Scratch folder;
    folder.write(file, content);
    folder.write("broken.json", R"({"objects": [{"voxels": {"file": ")" + file + R"("}}]})");
    check_file(folder, "broken.json", {"a scene of " + file, content, refused(file)});
  }
}

}  // namespace
}  // namespace scarp
