// SPDX-License-Identifier: MIT
// binvox files: which voxels of a box are solid, in runs.
//
//   #binvox 1
//   dim DEPTH HEIGHT WIDTH       along x, z and y
//   translate X Y Z              place = translate + scale * (voxel + 1/2) / dim in the mesh that it was made of
//   scale S
//   data                         then pairs of bytes: 0 or 1, and how often, 1 to 255; y fastest, then z, then x
//
// Source: P. Min, "binvox", www.patrickmin.com/binvox. Nothing is allocated before the runs have been counted.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scarp/base/vec.h"

namespace scarp {

struct Binvox {
  static constexpr int kMaxSide = 2048;

  ivec3 size{1};  ///< each 1..kMaxSide
  dvec3 translate{0.0};
  double scale = 1;
  std::vector<std::uint64_t> bits;  ///< of voxels in the file's order, from the lowest bit on

  std::size_t place(const ivec3& v) const {
    return static_cast<std::size_t>(v.y) +
           static_cast<std::size_t>(size.y) *
               (static_cast<std::size_t>(v.z) + static_cast<std::size_t>(size.z) * static_cast<std::size_t>(v.x));
  }
  bool solid(const ivec3& v) const { return bits[place(v) / 64] >> place(v) % 64 & 1; }
  /// Makes `bits` fit `size`, all empty.
  void clear();
  void set(const ivec3& v) { bits[place(v) / 64] |= std::uint64_t{1} << place(v) % 64; }
  friend bool operator==(const Binvox&, const Binvox&) = default;
};

/// Throws Error, in one line: no binvox, a side beyond kMaxSide, runs that are none or are not as many voxels as the
/// header says.
Binvox parse_binvox(std::string_view bytes);
/// The same from a file; names it in messages.
Binvox read_binvox(const std::string& path);

/// The bytes of a file of which parse_binvox() makes the same.
std::string binvox_bytes(const Binvox& binvox);
/// Throws Error when it cannot be written; then nothing is left or changed.
void write_binvox(const std::string& path, const Binvox& binvox);

}  // namespace scarp
