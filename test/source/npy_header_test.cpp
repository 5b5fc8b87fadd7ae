// SPDX-License-Identifier: MIT
#include "scarp/source/npy_header.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "scarp/base/error.h"
#include "source/npy_bytes.h"

namespace scarp {
namespace {

using test::npy_bytes;

NpyHeader parse(const std::string& dictionary, int version = 1) {
  return parse_npy_header(npy_bytes(dictionary, "", version));
}

TEST(NpyHeaderParser, ReadsNumpyHeaders) {
  for (const int version : {1, 2, 3}) {
    const NpyHeader h = parse("{'descr': '<i2', 'fortran_order': False, 'shape': (344, 403), }", version);
    EXPECT_EQ('i', h.kind);
    EXPECT_EQ(2, h.bytes);
    EXPECT_FALSE(h.big_endian);
    EXPECT_FALSE(h.fortran_order);
    EXPECT_EQ((std::vector<std::int64_t>{344, 403}), h.shape);
    EXPECT_EQ(0, h.data_begin % 64);
  }
  const NpyHeader h = parse("{'shape': (3L,), \"fortran_order\": True, 'descr': '>f8'}");
  EXPECT_TRUE(h.big_endian);
  EXPECT_TRUE(h.fortran_order);
  EXPECT_EQ(8, h.bytes);
  EXPECT_EQ((std::vector<std::int64_t>{3}), h.shape);
  EXPECT_TRUE(parse("{'descr': '|u1', 'fortran_order': False, 'shape': (), }").shape.empty());
  EXPECT_EQ('O', parse("{'descr': '|O', 'fortran_order': False, 'shape': (), }").kind);
}

TEST(NpyHeaderParser, RejectsDamagedHeaders) {
  for (const char* text : {"", "{", "{}", "{'descr': '<i2', 'fortran_order': False}",
                           "{'descr': '<i2', 'fortran_order': 0, 'shape': (1, 1)}",
                           "{'descr': '<i2', 'fortran_order': False, 'shape': (1, 1)} x",
                           "{'descr': '<i2', 'fortran_order': False, 'shape': (-1, 1)}",
                           "{'descr': '<i2', 'fortran_order': False, 'shape': (1 1)}",
                           "{'descr': '<i2, 'fortran_order': False, 'shape': (1, 1)}",
                           "{'descr': '', 'fortran_order': False, 'shape': (1, 1)}",
                           "{'descr': '<', 'fortran_order': False, 'shape': (1, 1)}",
                           "{'descr': '<i2', 'fortran_order': False, 'shape': (99999999999999999999, 1)}", "{'a': 1}",
                           "{'descr': [('x', '<i2')], 'fortran_order': False, 'shape': (1, 1)}"}) {
    EXPECT_THROW(parse(text), Error) << text;
  }
  EXPECT_THROW(npy_data_begin("PK\3\4"), Error);
  EXPECT_THROW(npy_data_begin("\x93NUMPY\1"), Error);
  EXPECT_THROW(npy_data_begin(std::string("\x93NUMPY\4\0\0\0\0\0", 12)), Error);
  EXPECT_THROW(npy_data_begin(std::string("\x93NUMPY\2\0\xff\xff\xff\xff", 12)), Error);
}

TEST(NpyHeaderParser, SurvivesArbitraryBytes) {
  EXPECT_TRUE(rc::check("a damaged header is parsed or refused", [] {
    std::string bytes = npy_bytes("{'descr': '<i2', 'fortran_order': False, 'shape': (344, 403), }", "");
    const int changes = *rc::gen::inRange(1, 8);
    for (int i = 0; i < changes; ++i)
      bytes[*rc::gen::inRange<std::size_t>(0, bytes.size())] = *rc::gen::arbitrary<char>();
    bytes.resize(*rc::gen::inRange<std::size_t>(0, bytes.size() + 1));
    try {
      for (const std::int64_t extent : parse_npy_header(bytes).shape) RC_ASSERT(extent >= 0);
    } catch (const Error&) {
    }
  }));
}

}  // namespace
}  // namespace scarp
