// SPDX-License-Identifier: MIT
#include "scarp/source/voxel/qubicle.h"

#include <fmt/format.h>

#include "scarp/base/error.h"
#include "scarp/source/incomplete_file.h"
#include "scarp/source/voxel/vox_bytes.h"

namespace scarp {
namespace {

constexpr std::int32_t kVersion = 0x00000101, kRun = 2, kEndOfSlice = 6;
constexpr int kFarthestVoxel = 1 << 24;  // voxels from the origin, as in .vox files

struct Header {
  bool blue_first, right_handed, compressed;
  std::uint32_t matrices;
};

Header parse_header(VoxBytes& bytes) {
  if (bytes.left() < 24)
    throw Error(fmt::format("truncated: {} bytes, but the header needs 24 ({})", bytes.left(), kFetchAgain));
  if (const std::int32_t version = bytes.number(); version != kVersion) {
    throw Error(
        fmt::format("not a Qubicle Binary file of version 1.1: begins with the number {:#010x} instead of {:#010x}",
                    static_cast<std::uint32_t>(version), static_cast<std::uint32_t>(kVersion)));
  }
  const auto flag = [&](const char* what) {
    const std::int32_t value = bytes.number();
    if (value != 0 && value != 1) throw Error(fmt::format("{} is {} (must be 0 or 1)", what, value));
    return value == 1;
  };
  Header header{};
  header.blue_first = flag("colour format");
  header.right_handed = flag("z axis orientation");
  header.compressed = flag("compression");
  flag("visibility mask");
  header.matrices = static_cast<std::uint32_t>(bytes.number());
  return header;
}

// Collects the voxels of a matrix.
class Matrix {
 public:
  Matrix(const Header& header, const ivec3& size, const ivec3& position, std::size_t& listed)
      : header_(header), size_(size), listed_(listed) {
    // y is up in the file. Its z points away from the viewer if the file is left-handed, otherwise towards the viewer.
    part.size = {size.x, size.z, size.y};
    part.low = {position.x, header.right_handed ? -position.z - size.z : position.z, position.y};
    part.file_turn = {{0, 2, 1}, {1, 1, header.right_handed ? -1 : 1}};
    part.file_origin.z = header.right_handed ? size.z : 0;
  }

  // `place`: position in the slice.
  void add(int place, int z, std::int32_t colour) {
    const auto bits = static_cast<std::uint32_t>(colour);
    if (bits >> 24 == 0) return;
    if (++listed_ > kMostListedVoxels) throw Error(fmt::format("more than {} voxels", kMostListedVoxels));
    const auto channel = [&](int i) { return static_cast<std::uint8_t>(bits >> (8 * i)); };
    const int y = header_.right_handed ? size_.z - 1 - z : z;
    part.voxels.push_back({static_cast<std::int16_t>(place % size_.x),
                           static_cast<std::int16_t>(y),
                           static_cast<std::int16_t>(place / size_.x),
                           {channel(header_.blue_first ? 2 : 0), channel(1), channel(header_.blue_first ? 0 : 2)}});
  }

  void parse_plain(VoxBytes& bytes) {
    const int slice = size_.x * size_.y;
    const std::uint64_t needed =
        std::uint64_t{4} * static_cast<std::uint64_t>(slice) * static_cast<std::uint64_t>(size_.z);
    if (bytes.left() < needed)
      throw Error(fmt::format("truncated: {} bytes are left, but {} x {} x {} voxels need {} ({})", bytes.left(),
                              size_.x, size_.y, size_.z, needed, kFetchAgain));
    for (int z = 0; z < size_.z; ++z) {
      for (int i = 0; i < slice; ++i) add(i, z, bytes.number());
    }
  }
  void parse_runs(VoxBytes& bytes) {
    const int slice = size_.x * size_.y;
    for (int z = 0; z < size_.z; ++z) {
      int place = 0;
      for (;;) {
        std::int32_t colour = bytes.number();
        if (colour == kEndOfSlice) break;
        std::int64_t count = 1;
        if (colour == kRun) {
          count = static_cast<std::uint32_t>(bytes.number());
          colour = bytes.number();
        }
        if (count > slice - place)
          throw Error(fmt::format("slice {}: runs contain more than its {} x {} voxels", z, size_.x, size_.y));
        for (; count > 0; --count) add(place++, z, colour);
      }
    }
  }

  VoxelPart part;

 private:
  const Header& header_;
  ivec3 size_;
  std::size_t& listed_;
};

VoxelPart parse_matrix(const Header& header, VoxBytes& bytes, std::size_t& listed) {
  bytes.take(static_cast<std::uint8_t>(bytes.take(1)[0]));  // name
  ivec3 size, position;
  for (int axis = 0; axis < 3; ++axis) {
    size[axis] = bytes.number();
    if (size[axis] < 1 || size[axis] > kMaxPartSide)
      throw Error(
          fmt::format("side of {} voxels (must be 1 to {})", static_cast<std::uint32_t>(size[axis]), kMaxPartSide));
  }
  for (int axis = 0; axis < 3; ++axis) {
    position[axis] = bytes.number();
    if (position[axis] > kFarthestVoxel || position[axis] < -kFarthestVoxel)
      throw Error(fmt::format("position {} (limited to {} voxels)", position[axis], kFarthestVoxel));
  }
  Matrix matrix(header, size, position, listed);
  header.compressed ? matrix.parse_runs(bytes) : matrix.parse_plain(bytes);
  return std::move(matrix.part);
}

}  // namespace

VoxelParts parse_qubicle(std::string_view file) {
  refuse_lfs_pointer(file);
  VoxBytes bytes(file);
  const Header header = parse_header(bytes);
  VoxelParts parts{"Qubicle Binary", {}, {}};
  std::size_t listed = 0;
  for (std::uint32_t i = 0; i < header.matrices; ++i) {
    try {
      parts.parts.push_back(advising("save it again in Qubicle", [&] { return parse_matrix(header, bytes, listed); }));
    } catch (const Error& error) {
      throw Error(fmt::format("matrix {} of {}: {}", i, header.matrices, error.what()));
    }
  }
  return parts;
}

}  // namespace scarp
