// SPDX-License-Identifier: MIT
// The header of NumPy's .npy files: which samples follow, in which order, in which shape.
//
//   \x93NUMPY  major minor  length (2 bytes, from version 2 on 4; little-endian)
//   {'descr': '<i2', 'fortran_order': False, 'shape': (344, 403), }      padded with blanks, then the samples
//
// Source: NEP 1, "A Simple File Format for NumPy Arrays", and numpy.lib.format (versions 1.0, 2.0, 3.0).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace scarp {

/// A field of an array of structures: a plain number.
struct NpyField {
  std::string name;
  char kind = 'f';  ///< as in NpyHeader
  int bytes = 8;
  bool big_endian = false;
  std::int64_t begin = 0;  ///< offset in the structure
};

struct NpyHeader {
  char kind = 'f';  ///< NumPy's letter: 'i' signed, 'u' unsigned, 'f' float, 'b' bool, 'c' complex, 'O', 'V', ...
  int bytes = 4;    ///< per sample; 0 for kinds without a size
  bool big_endian = false;
  bool fortran_order = false;       ///< the first index runs fastest
  std::vector<std::int64_t> shape;  ///< every extent >= 0; empty: a single number
  std::int64_t data_begin = 0;      ///< offset of the first sample in the file
  std::string descr;                ///< as written, for messages; empty for structures
  std::vector<NpyField> fields;     ///< of structures, whose kind is 'V'; else empty
};

/// Bytes from the file's start that tell where the header ends.
inline constexpr std::size_t kNpyPreambleBytes = 12;
/// Headers longer than this are refused: NumPy's own are some hundred bytes.
inline constexpr std::int64_t kLargestNpyHeader = 1 << 20;

/// Where the samples begin, from the first kNpyPreambleBytes of a file (fewer if it is shorter). Throws Error: no .npy,
/// a version not known, a header beyond kLargestNpyHeader.
std::int64_t npy_data_begin(std::string_view preamble);

/// The header in `bytes`, which holds the file up to npy_data_begin(). Throws Error: not a dictionary of the three
/// entries, a structured type. Kinds that are no heights are the caller's to refuse.
NpyHeader parse_npy_header(std::string_view bytes);

/// The same for an array that may be one of structures, too. Throws Error for structures with fields that are
/// structures or arrays themselves.
NpyHeader parse_npy_table_header(std::string_view bytes);

}  // namespace scarp
