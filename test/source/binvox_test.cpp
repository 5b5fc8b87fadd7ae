// SPDX-License-Identifier: MIT
// binvox files and volumes of numbers.
#include "scarp/source/voxel/binvox.h"

#include <gtest/gtest.h>

#include "base/refusal.h"
#include "scarp/source/voxel/dense_volume.h"

namespace scarp {
namespace {

using test::refusal;

std::string header(const std::string& dim) { return "#binvox 1\ndim " + dim + "\ntranslate 1 2 3\nscale 4\ndata\n"; }

// Written by hand, from the format's description: y runs fastest, then z, then x.
TEST(Binvox, ReadsVoxelsInFileOrder) {
  // dim is x, z, y: 2 x 3 x 4 in x, y, z.
  const Binvox binvox = parse_binvox(header("2 4 3") + std::string("\0\5\1\1\0\12\1\1\0\7", 10));
  EXPECT_EQ(binvox.size, ivec3(2, 3, 4));
  EXPECT_EQ(binvox.translate, dvec3(1, 2, 3));
  EXPECT_EQ(binvox.scale, 4);
  for (int x = 0; x < 2; ++x) {
    for (int y = 0; y < 3; ++y) {
      for (int z = 0; z < 4; ++z) {
        // Voxels 5 (x 0, z 1, y 2) and 16 (x 1, z 1, y 1) of the file.
        const bool solid = ivec3(x, y, z) == ivec3(0, 2, 1) || ivec3(x, y, z) == ivec3(1, 1, 1);
        EXPECT_EQ(binvox.solid({x, y, z}), solid) << x << y << z;
      }
    }
  }
  EXPECT_EQ(parse_binvox(binvox_bytes(binvox)), binvox);
}

TEST(Binvox, ReportsErrors) {
  const auto refused = [](const std::string& bytes, std::string_view fragment) {
    const std::string message = refusal([&] { parse_binvox(bytes); });
    EXPECT_NE(message.find(fragment), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  };
  refused("\xff\xd8\xff\xe0 JFIF", "not a binvox file");
  refused("#binvox 7\n", "expected '#binvox 1'");
  refused(header("2 2"), "DEPTH HEIGHT WIDTH");
  refused(header("2 2 4096"), "sides must be 1 to 2048");
  refused(header("99999999999999999999 2 2"), "DEPTH HEIGHT WIDTH");
  refused("#binvox 1\nscale 1\ndata\n", "no line 'dim");
  refused("#binvox 1\ndim 2 2 2\n", "truncated");
  refused(header("2048 2048 2048") + "\1\377", "runs contain 255 voxels");
  refused(header("2 2 2") + "\1\11", "runs contain 9 voxels");
  refused(header("2 2 2") + std::string("\1\0", 2), "expected 1 to 255 of 0 or 1");
  refused(header("2 2 2") + "\1\10\1\1", "runs contain 9 voxels");
  refused(header("2 2 2") + "\1\10\1", "ends within a run");
  refused(header("2 2 2") + "\7\10", "expected 1 to 255 of 0 or 1");
}

TEST(DenseVolume, ReadsAllTypesAndByteOrders) {
  const std::string bytes("ab\0\1\0\2\377\376\0\4", 10);
  const DenseVolume volume(parse_volume_format("2x1x2:i16be+2"), bytes);
  EXPECT_EQ(volume[ivec3(0, 0, 0)], 1);
  EXPECT_EQ(volume[ivec3(1, 0, 0)], 2);
  EXPECT_EQ(volume[ivec3(0, 0, 1)], -2);
  EXPECT_EQ(volume[ivec3(1, 0, 1)], 4);
  const DenseVolume floats(parse_volume_format("1x1x1:f32le"), std::string("\0\0\300\77", 4));
  EXPECT_EQ(floats[ivec3(0)], 1.5);
  VolumeFormat z_fastest = parse_volume_format("2x1x3:u8");
  z_fastest.z_fastest = true;
  EXPECT_EQ(DenseVolume(z_fastest, "abcdef")[ivec3(1, 0, 0)], 'd');
  EXPECT_EQ(DenseVolume(z_fastest, "abcdef")[ivec3(0, 0, 2)], 'c');
}

TEST(DenseVolume, ReportsErrors) {
  for (const char* text : {"", "2x2:u8", "0x2x2:u8", "2x2x2", "2x2x2:u16", "4096x2x2:u8", "2x4096x2:u8", "2x2x4096:u8"})
    EXPECT_NE(refusal([&] { parse_volume_format(text); }).find("expected npy, or NXxNYxNZ:TYPE"), std::string::npos)
        << text;
  const auto with = [](std::size_t bytes) {
    return refusal([&] { DenseVolume(parse_volume_format("2x2x2:u8"), std::string(bytes, 'x')); });
  };
  EXPECT_NE(with(7).find("7 bytes, but 2 x 2 x 2 samples of 1 bytes need 8"), std::string::npos) << with(7);
  EXPECT_NE(with(9).find("9 bytes, but"), std::string::npos) << with(9);
  EXPECT_EQ(with(8), "");
}

}  // namespace
}  // namespace scarp
