// SPDX-License-Identifier: MIT
// Volumes with one number per voxel: three-dimensional .npy arrays, which describe themselves, and raw files, which
// need a format:
//
//   NXxNYxNZ:TYPE[+OFFSET]       256x256x128:u8      512x512x301:i16le+1024
//
// TYPE and OFFSET as in raw_format.h. x varies fastest, then y, then z; arrays are indexed [z][y][x], in C or Fortran
// order.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "scarp/base/vec.h"

namespace scarp {

/// Sample type and layout of a volume.
struct VolumeFormat {
  ivec3 size{1};            ///< each 1..kMaxVolumeSide
  char kind = 'u';          ///< 'i' signed, 'u' unsigned, 'f' float
  int bytes = 1;            ///< per sample: 1, 2, 4, 8
  bool big_endian = false;  ///< ignored for one byte
  bool z_fastest = false;   ///< z varies fastest, then y, then x
  std::int64_t offset = 0;  ///< of the first sample, >= 0
  bool may_go_on = false;   ///< whether the file may contain more after the samples
};

constexpr int kMaxVolumeSide = 2048;

/// Parses the text above. Throws Error, in one line with the text and the expected form.
VolumeFormat parse_volume_format(std::string_view text);
/// Reads the header of a .npy file, see npy_header.h. Throws Error: no valid header, not three dimensions, not numbers,
/// a side of 0 or beyond kMaxVolumeSide.
VolumeFormat npy_volume_format(std::string_view bytes);

/// A volume of numbers, in memory or in a file.
class DenseVolume {
 public:
  /// `bytes` is a whole file. Throws Error if it is shorter than the format requires, or longer unless `may_go_on` is
  /// set.
  DenseVolume(const VolumeFormat& format, std::string bytes);
  /// The numbers of a file, each read when it is first used: the file must not change meanwhile. Throws Error without
  /// the path: as above, or if the file cannot be opened.
  static DenseVolume in_file(const VolumeFormat& format, const std::string& path);

  const ivec3& size() const { return format_.size; }
  const VolumeFormat& format() const { return format_; }
  /// Returns the number of a voxel, which must be inside. 64-bit integers are rounded.
  double operator[](const ivec3& voxel) const;
  /// Writes the number of the voxel at from + x * step[0] + y * step[1] + z * step[2] to numbers[x + 4 y + 16 z], for
  /// all x, y and z below `count`, each 0..4. All voxels must be inside.
  void brick(const ivec3& from, const std::array<ivec3, 3>& step, const ivec3& count,
             std::span<double, 64> numbers) const;

 private:
  DenseVolume(const VolumeFormat& format, const std::shared_ptr<const std::string>& bytes);
  DenseVolume(const VolumeFormat& format, std::shared_ptr<const void> owner, std::string_view bytes);

  VolumeFormat format_;
  std::array<std::size_t, 3> stride_;
  std::shared_ptr<const void> owner_;  // keeps the bytes alive
  std::string_view bytes_;
};

/// Returns the format of a file without reading its samples. `format`: the text above, or "npy". Throws Error naming
/// the file, also if it is too short or too long.
VolumeFormat volume_format_of(const std::string& path, const std::string& format);
/// Opens a volume; see DenseVolume::in_file(). `format`: the text above, or "npy". Throws Error naming the file.
DenseVolume read_volume(const std::string& path, const std::string& format);

}  // namespace scarp
