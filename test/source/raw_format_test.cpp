// SPDX-License-Identifier: MIT
#include "scarp/source/raster/raw_format.h"

#include <gtest/gtest.h>

#include <string>

#include "scarp/base/error.h"

namespace scarp {
namespace {

TEST(RawFormat, ParsesEveryTypeInBothByteOrders) {
  const struct {
    const char* name;
    char kind;
    int bytes;
  } types[] = {{"u8", 'u', 1},  {"i8", 'i', 1},  {"u16", 'u', 2}, {"i16", 'i', 2},
               {"u32", 'u', 4}, {"i32", 'i', 4}, {"f32", 'f', 4}, {"f64", 'f', 8}};
  for (const auto& type : types) {
    for (const bool big : {false, true}) {
      const RawFormat format = parse_raw_format(std::string("7x5:") + type.name + (big ? "be" : "le"));
      EXPECT_EQ(format.cols, 7);
      EXPECT_EQ(format.rows, 5);
      EXPECT_EQ(format.kind, type.kind) << type.name;
      EXPECT_EQ(format.bytes, type.bytes) << type.name;
      EXPECT_EQ(format.big_endian, big);
      EXPECT_EQ(format.offset, 0);
      EXPECT_FALSE(format.has_offset);
    }
  }
}

TEST(RawFormat, OneByteTypesNeedNoByteOrder) { EXPECT_EQ(parse_raw_format("7x5:u8").bytes, 1); }

TEST(RawFormat, ParsesTheOffset) {
  EXPECT_EQ(parse_raw_format("7x5:f32le+128").offset, 128);
  EXPECT_TRUE(parse_raw_format("7x5:f32le+0").has_offset);
  EXPECT_EQ(parse_raw_format("7x5:u8+4611686018427387904").offset, std::int64_t{1} << 62);
}

TEST(RawFormat, RoundTrips) {
  for (const char* text : {"4097x4097:u16le", "1x1:i8", "3x2:f64be+12", "3x2:f32le+0"})
    EXPECT_EQ(text_of(parse_raw_format(text)), text);
}

TEST(RawFormat, ErrorShowsTheExpectedForm) {
  for (const std::string text : {"",
                                 "7",
                                 "7x5",
                                 "7x5:",
                                 "7x5:u16",
                                 "7x5:i32",
                                 "7x5:f64",
                                 "7x5:u24le",
                                 "7x5:f16le",
                                 "7x5:u64le",
                                 "x5:u8",
                                 "7x:u8",
                                 "0x5:u8",
                                 "7x0:u8",
                                 "-7x5:u8",
                                 "+7x5:u8",
                                 "7.0x5:u8",
                                 " 7x5:u8",
                                 "7 x5:u8",
                                 "7x5:u8 ",
                                 "7X5:u8",
                                 "7x5:U8",
                                 "7x5:u16le+",
                                 "7x5:u16le+-1",
                                 "7x5:u16le+1k",
                                 "7x5:u16le+4611686018427387905",
                                 "7x5:u16le+99999999999999999999",
                                 "2147483648x1:u8",
                                 "1x2147483648:u8",
                                 "1073741824x1:u16le",
                                 "7x5:u16leu16le",
                                 "7,5:u8",
                                 "nanxnan:u8"}) {
    try {
      parse_raw_format(text);
      ADD_FAILURE() << "'" << text << "' was taken";
    } catch (const Error& error) {
      const std::string line = error.what();
      EXPECT_NE(line.find("--raw '" + text + "'"), std::string::npos) << line;
      EXPECT_NE(line.find("4097x4097:u16le"), std::string::npos) << line;
      EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    }
  }
}

}  // namespace
}  // namespace scarp
