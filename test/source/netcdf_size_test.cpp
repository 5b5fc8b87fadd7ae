// SPDX-License-Identifier: MIT
#include "scarp/source/raster/netcdf_size.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <string>

namespace scarp {
namespace {

std::string word(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xff);
  return bytes;
}

// Two dimensions, y and x, and one variable of 16-bit samples that starts at byte 1000.
std::string header(std::uint32_t rows, std::uint32_t cols, std::uint32_t records = 0) {
  return std::string("CDF\1") + word(records) + word(10) + word(2) + word(1) + std::string("y\0\0\0", 4) + word(rows) +
         word(1) + std::string("x\0\0\0", 4) + word(cols) + word(0) + word(0) + word(11) + word(1) + word(1) +
         std::string("z\0\0\0", 4) + word(2) + word(0) + word(1) + word(0) + word(0) + word(3) + word(cols * 2) +
         word(1000);
}

TEST(NetcdfSize, EqualsTheEndOfTheLastVariable) {
  EXPECT_EQ(1000 + 2 * 30 * 20, netcdf_classic_bytes(header(30, 20)));
  // Rows as records: the first, and 9 more; their padding is not assumed.
  EXPECT_EQ(1000 + 40 + 9 * (40 - 3), netcdf_classic_bytes(header(0, 20, 10)));
  EXPECT_EQ(0, netcdf_classic_bytes(header(0, 20, 0xffffffff)));
}

TEST(NetcdfSize, IsUnknownForOtherFilesAndTruncatedHeaders) {
  EXPECT_FALSE(netcdf_classic_bytes("").has_value());
  EXPECT_FALSE(netcdf_classic_bytes("\x89HDF\r\n").has_value());
  const std::string whole = header(30, 20);
  for (std::size_t n = 0; n < whole.size(); ++n)
    EXPECT_FALSE(netcdf_classic_bytes(std::string_view(whole).substr(0, n)).has_value()) << n;
}

TEST(Hdf5Size, IsReadFromEverySuperblockVersion) {
  const auto header = [](char version, std::size_t address_bytes, std::size_t end) {
    std::string bytes(end + 8, '\0');
    bytes.replace(0, 8, "\x89HDF\r\n\x1a\n");
    bytes[8] = version;
    bytes[address_bytes] = 8;
    bytes[end] = 0x34;
    bytes[end + 1] = 0x12;
    bytes[end + 4] = 1;
    return bytes;
  };
  for (const std::string& bytes : {header(0, 13, 40), header(1, 13, 44), header(2, 9, 28), header(3, 9, 28)}) {
    EXPECT_EQ(4294967296.0 + 0x1234, hdf5_bytes(bytes)) << int{bytes[8]};
    for (std::size_t n = 0; n < bytes.size(); ++n) EXPECT_FALSE(hdf5_bytes(std::string_view(bytes).substr(0, n))) << n;
  }
  EXPECT_FALSE(hdf5_bytes(header(4, 9, 28)));
  std::string short_addresses = header(0, 13, 40);
  short_addresses[13] = 4;
  EXPECT_FALSE(hdf5_bytes(short_addresses));
}

TEST(NetcdfSize, SurvivesArbitraryBytes) {
  EXPECT_TRUE(rc::check("a damaged header is understood or not", [] {
    std::string bytes = header(30, 20);
    bytes[3] = *rc::gen::element('\1', '\2', '\5');
    const int changes = *rc::gen::inRange(1, 8);
    for (int i = 0; i < changes; ++i)
      bytes[*rc::gen::inRange<std::size_t>(4, bytes.size())] = *rc::gen::arbitrary<char>();
    const auto least = netcdf_classic_bytes(bytes);
    RC_ASSERT(!least || *least >= 0);
  }));
}

}  // namespace
}  // namespace scarp
