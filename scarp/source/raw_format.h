// SPDX-License-Identifier: MIT
// What one must know to read a file of bare samples:
//
//   COLSxROWS:TYPE[+OFFSET]      4097x4097:u16le      1201x1201:i16be      512x256:f32le+128
//
// TYPE is u8, i8, u16, i16, u32, i32, f32 or f64; those of several bytes end in le or be, the order of their bytes.
// OFFSET counts the bytes of a header to skip. Rows run from north to south, each from west to east, without gaps.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace scarp {

struct RawFormat {
  int cols = 0;             ///< >= 1
  int rows = 0;             ///< >= 1
  char kind = 'u';          ///< 'i' signed, 'u' unsigned, 'f' float
  int bytes = 1;            ///< per sample: 1, 2, 4, 8
  bool big_endian = false;  ///< means nothing for one byte
  /// Of the first sample in the file, >= 0.
  std::int64_t offset = 0;
  /// The offset was given: then the file may go on behind the samples.
  bool has_offset = false;
};

/// Reads the text above. Throws Error, in one line with the text and the form: anything else, extents below 1, more
/// bytes in a row than 32 bits count, an offset beyond 2^62.
RawFormat parse_raw_format(std::string_view text);

/// The same as text: parse_raw_format(text_of(f)) is f.
std::string text_of(const RawFormat& format);

}  // namespace scarp
