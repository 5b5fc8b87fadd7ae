// SPDX-License-Identifier: MIT
// Qubicle and Voxlap files, byte by byte from the descriptions of their formats.
#include "scarp/source/voxel/voxel_parts.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <set>

#include "base/refusal.h"
#include "scarp/source/voxel/qubicle.h"
#include "scarp/source/voxel/voxlap.h"

namespace scarp {
namespace {

using test::refusal;

std::string numbers(std::initializer_list<std::uint32_t> list) {
  std::string bytes;
  for (const std::uint32_t number : list) {
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(number >> (8 * i) & 255);
  }
  return bytes;
}

using Sorted = std::set<std::array<int, 6>>;
Sorted voxels_of(const VoxelPart& part) {
  Sorted sorted;
  for (const ListedVoxel& v : part.voxels) sorted.insert({v.x, v.y, v.z, v.colour[0], v.colour[1], v.colour[2]});
  EXPECT_EQ(sorted.size(), part.voxels.size());
  return sorted;
}

template <class Parse>
void refused_with(const Parse& parse, const std::string& bytes, std::string_view fragment) {
  const std::string message = refusal([&] { parse(bytes); });
  EXPECT_NE(message.find(fragment), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

std::string qubicle(std::uint32_t format, std::uint32_t right_handed, std::uint32_t compressed) {
  return numbers({0x101, format, right_handed, compressed, 0, 1}) + "\2ab" + numbers({2, 3, 4}) + numbers({10, 20, 30});
}

TEST(Qubicle, ReadsPlainAndCompressedMatrices) {
  // Voxels (1, 0, 0) and (0, 2, 3) of the file.
  std::string plain;
  for (int i = 0; i < 24; ++i) plain += numbers({i == 1 ? 0xff030201u : i == 22 ? 0xff302010u : 0x00ffffffu});
  const std::string runs = numbers({0, 0xff030201, 6, 6, 6, 2, 4, 0, 0xff302010, 6});
  // y up becomes z; z away from the viewer becomes y.
  const Sorted left{{1, 0, 0, 1, 2, 3}, {0, 3, 2, 0x10, 0x20, 0x30}};
  for (const bool compressed : {false, true}) {
    const std::string& data = compressed ? runs : plain;
    const VoxelParts file = parse_qubicle(qubicle(0, 0, compressed) + data);
    ASSERT_EQ(file.parts.size(), 1u);
    EXPECT_EQ(file.parts[0].size, ivec3(2, 4, 3));
    EXPECT_EQ(file.parts[0].low, ivec3(10, 30, 20));
    EXPECT_EQ(voxels_of(file.parts[0]), left);
    const VoxelPart right = parse_qubicle(qubicle(1, 1, compressed) + data).parts[0];
    EXPECT_EQ(right.low, ivec3(10, -34, 20));
    EXPECT_EQ(voxels_of(right), (Sorted{{1, 3, 0, 3, 2, 1}, {0, 0, 2, 0x30, 0x20, 0x10}}));
  }
}

TEST(Qubicle, ReportsErrors) {
  const auto refused = [](const std::string& bytes, std::string_view fragment) {
    refused_with([](const std::string& b) { parse_qubicle(b); }, bytes, fragment);
  };
  refused("QB", "the header needs 24");
  refused(numbers({0x102, 0, 0, 0, 0, 1}), "version 1.1");
  refused(numbers({0x101, 7, 0, 0, 0, 1}), "colour format is 7");
  refused(qubicle(0, 0, 0), "2 x 3 x 4 voxels need 96");
  refused(qubicle(0, 0, 1) + numbers({2, 7, 0}), "more than its 2 x 3 voxels");
  refused(qubicle(0, 0, 1) + numbers({2, 0xffffffff, 0}), "more than its 2 x 3 voxels");
  refused(numbers({0x101, 0, 0, 0, 0, 1}) + std::string(1, '\0') + numbers({0xffffffff, 1, 1, 0, 0, 0}),
          "side of 4294967295 voxels");
  std::string bomb = numbers({0x101, 0, 0, 1, 0, 1}) + std::string(1, '\0') + numbers({2048, 2048, 2048, 0, 0, 0});
  for (int z = 0; z < 2048; ++z) bomb += numbers({2, 2048 * 2048, 0xff000000, 6});
  refused(bomb, "more than 67108864 voxels");
}

TEST(Kv6, ReadsTheVoxelsOfItsColumns) {
  const std::string head = "Kvxl" + numbers({2, 1, 4, 0, 0, 0});
  const std::string voxels("\3\2\1\0\0\0\77\0\6\5\4\0\3\0\77\0\11\10\7\0\2\0\77\0", 24);
  const std::string file = head + numbers({3}) + voxels + numbers({2, 1}) + std::string("\2\0\1\0", 4);
  const VoxelParts parts = parse_kv6(file);
  ASSERT_EQ(parts.parts.size(), 1u);
  EXPECT_EQ(parts.parts[0].size, ivec3(2, 1, 4));
  // z is down in the file.
  EXPECT_EQ(voxels_of(parts.parts[0]), (Sorted{{0, 0, 3, 1, 2, 3}, {0, 0, 0, 4, 5, 6}, {1, 0, 1, 7, 8, 9}}));
  EXPECT_EQ(parts.notes.size(), 1u);

  const auto refused = [](const std::string& bytes, std::string_view fragment) {
    refused_with([](const std::string& b) { parse_kv6(b); }, bytes, fragment);
  };
  refused("PK\3\4", "instead of 'Kvxl'");
  refused(head + numbers({0xffffffff}) + voxels, "need");
  refused(head + numbers({3}) + voxels + numbers({2, 1}) + std::string("\3\0\1\0", 4), "out of order");
  refused(head + numbers({3}) + voxels + numbers({2, 1}) + std::string("\2\0\0\0", 4), "2 voxels instead of 3");
}

TEST(VoxlapVox, ReadsIndicesAndPalette) {
  std::string palette(768, '\0');
  palette[3] = 63, palette[4] = 21;
  const std::string file = numbers({1, 2, 2}) + "\xff\1\xff\xff" + palette;
  EXPECT_TRUE(is_voxlap_vox(file, file.size()));
  EXPECT_FALSE(is_voxlap_vox(file, file.size() + 1));
  EXPECT_EQ(voxels_of(parse_voxlap_vox(file).parts[0]), (Sorted{{0, 1, 0, 255, 85, 0}}));
  refused_with([](const std::string& b) { parse_voxlap_vox(b); }, file + "x", "not a .vox file of Voxlap");
}

// A map of 2 x 1 columns: one column with a bridge, one without.
TEST(Vxl, ReadsSpans) {
  const std::string head = numbers({0x09072000, 2, 1}) + std::string(96, '\0');
  // Colour at z 2, solid to 4, ceiling colour at 5, air from 6, ground from 10.
  const std::string bridge("\3\2\2\0\3\2\1\0\6\5\4\0\0\12\12\6\11\10\7\0", 20);
  const std::string plain("\0\77\77\0\3\2\1\0", 8);
  const VoxelParts file = parse_vxl(head + bridge + plain);
  const VoxelPart& part = file.parts[0];
  EXPECT_EQ(part.size, ivec3(2, 1, 64));
  Sorted expected{{0, 0, 61, 1, 2, 3}, {0, 0, 60, 1, 2, 3}, {0, 0, 59, 1, 2, 3},
                  {0, 0, 58, 4, 5, 6}, {0, 0, 53, 7, 8, 9}, {1, 0, 0, 1, 2, 3}};
  for (int z = 0; z < 53; ++z) expected.insert({0, 0, z, 7, 8, 9});  // all columns are at the border
  EXPECT_EQ(voxels_of(part), expected);

  const auto refused = [](const std::string& bytes, std::string_view fragment) {
    refused_with([](const std::string& b) { parse_vxl(b); }, bytes, fragment);
  };
  refused(head + bridge, "truncated map");
  refused(head + std::string("\1\2\2\0", 4) + plain + plain, "inconsistent spans");
  refused(std::string("Voxel Animation\0\1\0\0\0", 20), "Westwood");
  refused("PNG", "truncated map");
}

}  // namespace
}  // namespace scarp
