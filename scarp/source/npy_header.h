// SPDX-License-Identifier: MIT
// The header of NumPy's .npy files: sample type, storage order and shape.
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

/// A field of a structured array: a plain number.
struct NpyField {
  std::string name;
  char kind = 'f';  ///< as in NpyHeader
  int bytes = 8;
  bool big_endian = false;
  std::int64_t begin = 0;  ///< offset in the structure
};

/// Sample type, order and shape of an array.
struct NpyHeader {
  char kind = 'f';  ///< NumPy's letter: 'i' signed, 'u' unsigned, 'f' float, 'b' bool, 'c' complex, 'O', 'V', ...
  int bytes = 4;    ///< per sample; 0 for kinds without a size
  bool big_endian = false;
  bool fortran_order = false;       ///< the first index varies fastest
  std::vector<std::int64_t> shape;  ///< every extent >= 0; empty: a single number
  std::int64_t data_begin = 0;      ///< offset of the first sample in the file
  std::string descr;                ///< as in the file, for messages; empty for structures
  std::vector<NpyField> fields;     ///< of structures, whose kind is 'V'; otherwise empty
};

/// Bytes from the file's start that determine where the header ends.
inline constexpr std::size_t kNpyPreambleBytes = 12;
/// Maximum header length; NumPy writes about a hundred bytes.
inline constexpr std::int64_t kLargestNpyHeader = 1 << 20;

/// Returns the offset of the samples, from the first kNpyPreambleBytes of a file (fewer if it is shorter). Throws
/// Error: not .npy, an unknown version, a header beyond kLargestNpyHeader.
std::int64_t npy_data_begin(std::string_view preamble);

/// Parses the header in `bytes`, which contain the file up to npy_data_begin(). Throws Error: not a dictionary with
/// these three entries, or a structured type. The caller must reject kinds that are not heights.
NpyHeader parse_npy_header(std::string_view bytes);

/// Parses the header of an array that may be structured. Throws Error for fields that are themselves structures or
/// arrays.
NpyHeader parse_npy_table_header(std::string_view bytes);

}  // namespace scarp
