// SPDX-License-Identifier: MIT
// Format of a file of raw samples:
//
//   COLSxROWS:TYPE[+OFFSET]      4097x4097:u16le      1201x1201:i16be      512x256:f32le+128
//
// TYPE is u8, i8, u16, i16, u32, i32, f32 or f64, followed by the byte order le or be if it has several bytes. OFFSET
// is the size of a header to skip. Rows run from north to south, each from west to east, without gaps.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace scarp {

/// Sample type and layout of a raw file.
struct RawFormat {
  int cols = 0;             ///< >= 1
  int rows = 0;             ///< >= 1
  char kind = 'u';          ///< 'i' signed, 'u' unsigned, 'f' float
  int bytes = 1;            ///< per sample: 1, 2, 4, 8
  bool big_endian = false;  ///< ignored for one byte
  /// Offset of the first sample in the file, >= 0.
  std::int64_t offset = 0;
  /// Whether the offset was given: the file may then continue after the samples.
  bool has_offset = false;

  bool operator==(const RawFormat&) const = default;
};

/// Parses the text above. Throws Error, in one line with the text and the expected form: anything else, extents below
/// 1, rows with more bytes than 32 bits can count, an offset beyond 2^62.
RawFormat parse_raw_format(std::string_view text);

/// Returns the format as text: parse_raw_format(text_of(f)) is f.
std::string text_of(const RawFormat& format);

}  // namespace scarp
