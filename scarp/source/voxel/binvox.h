// SPDX-License-Identifier: MIT
// binvox files: run-length encoded solid voxels of a box.
//
//   #binvox 1
//   dim DEPTH HEIGHT WIDTH       along x, z and y
//   translate X Y Z              place = translate + scale * (voxel + 1/2) / dim in the source mesh
//   scale S
//   data                         then pairs of bytes: 0 or 1, and a count of 1 to 255; y fastest, then z, then x
//
// Source: P. Min, "binvox", www.patrickmin.com/binvox. The reader counts the runs before it allocates memory.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scarp/base/vec.h"

namespace scarp {

/// The contents of a binvox file.
struct Binvox {
  static constexpr int kMaxSide = 2048;

  ivec3 size{1};  ///< each 1..kMaxSide
  dvec3 translate{0.0};
  double scale = 1;
  std::vector<std::uint64_t> bits;  ///< voxels in file order, lowest bit first

  std::size_t place(const ivec3& v) const {
    return static_cast<std::size_t>(v.y) +
           static_cast<std::size_t>(size.y) *
               (static_cast<std::size_t>(v.z) + static_cast<std::size_t>(size.z) * static_cast<std::size_t>(v.x));
  }
  bool solid(const ivec3& v) const { return bits[place(v) / 64] >> place(v) % 64 & 1; }
  /// Resizes `bits` to fit `size`, all empty.
  void clear();
  void set(const ivec3& v) { bits[place(v) / 64] |= std::uint64_t{1} << place(v) % 64; }
  friend bool operator==(const Binvox&, const Binvox&) = default;
};

/// Throws Error, in one line: not a binvox file, a side beyond kMaxSide, invalid runs, or a voxel count that differs
/// from the header.
Binvox parse_binvox(std::string_view bytes);
/// Parses a file; errors name it.
Binvox read_binvox(const std::string& path);

/// Returns the bytes of a file that parse_binvox() maps to the same value.
std::string binvox_bytes(const Binvox& binvox);
/// Throws Error if writing fails; then no file is created or changed.
void write_binvox(const std::string& path, const Binvox& binvox);

}  // namespace scarp
