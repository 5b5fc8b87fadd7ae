// SPDX-License-Identifier: MIT
// Volumes of bare numbers, one per voxel: .npy arrays of three dimensions, whose header says all, and files of samples
// alone, of which one must know
//
//   NXxNYxNZ:TYPE[+OFFSET]       256x256x128:u8      512x512x301:i16le+1024
//
// TYPE and OFFSET as in raw_format.h. x runs fastest, then y, then z; arrays are indexed [z][y][x], in either order of
// storage.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "scarp/base/vec.h"

namespace scarp {

struct VolumeFormat {
  ivec3 size{1};            ///< each 1..kMaxVolumeSide
  char kind = 'u';          ///< 'i' signed, 'u' unsigned, 'f' float
  int bytes = 1;            ///< per sample: 1, 2, 4, 8
  bool big_endian = false;  ///< means nothing for one byte
  bool z_fastest = false;   ///< then y, then x
  std::int64_t offset = 0;  ///< of the first sample, >= 0
  bool may_go_on = false;   ///< whether the file may have more behind the samples
};

constexpr int kMaxVolumeSide = 2048;

/// Reads the text above. Throws Error, in one line with the text and the form.
VolumeFormat parse_volume_format(std::string_view text);
/// From the header of a .npy file, see npy_header.h. Throws Error: no such header, not three dimensions, no numbers, a
/// side that is 0 or beyond kMaxVolumeSide.
VolumeFormat npy_volume_format(std::string_view bytes);

class DenseVolume {
 public:
  /// `bytes` are a whole file. Throws Error when it is shorter than the format says, or longer and may not be.
  DenseVolume(const VolumeFormat& format, std::string bytes);

  const ivec3& size() const { return format_.size; }
  /// The voxel must be inside. Numbers of 64 bits are rounded.
  double operator[](const ivec3& voxel) const;

 private:
  VolumeFormat format_;
  std::array<std::size_t, 3> stride_;
  std::string bytes_;
};

/// `format`: the text above, or "npy". Throws Error naming the file; nothing is allocated that it does not hold.
DenseVolume read_volume(const std::string& path, const std::string& format);

}  // namespace scarp
