// SPDX-License-Identifier: MIT
#include "scarp/source/voxel/voxlap.h"

#include <fmt/format.h>

#include <algorithm>

#include "scarp/base/error.h"
#include "scarp/source/incomplete_file.h"
#include "scarp/source/voxel/vox_bytes.h"

namespace scarp {
namespace {

constexpr std::string_view kKv6 = "Kvxl", kWestwood = "Voxel Animation";
constexpr std::uint8_t kEmpty = 255;
constexpr std::size_t kPaletteBytes = 768;
constexpr std::int32_t kMap = 0x09072000;
constexpr std::size_t kCameraBytes = 96;
constexpr int kMapSide = 512, kMapDepth = 256, kLeastMapDepth = 64;

std::uint8_t byte_at(std::string_view bytes, std::size_t i) { return static_cast<std::uint8_t>(bytes[i]); }
int short_at(std::string_view bytes, std::size_t i) { return byte_at(bytes, i) | byte_at(bytes, i + 1) << 8; }

std::array<std::uint8_t, 3> from_bgr(std::string_view bytes) {
  return {byte_at(bytes, 2), byte_at(bytes, 1), byte_at(bytes, 0)};
}

ivec3 parse_size(VoxBytes& bytes, int axes) {
  ivec3 size(1);
  for (int axis = 0; axis < axes; ++axis) {
    size[axis] = bytes.number();
    if (size[axis] < 1 || size[axis] > kMaxPartSide)
      throw Error(
          fmt::format("side of {} voxels (must be 1 to {})", static_cast<std::uint32_t>(size[axis]), kMaxPartSide));
  }
  return size;
}

// Half a turn about x: then y points away from the viewer and z points up.
ListedVoxel upright(const ivec3& v, const ivec3& size, const std::array<std::uint8_t, 3>& colour) {
  return {static_cast<std::int16_t>(v.x), static_cast<std::int16_t>(size.y - 1 - v.y),
          static_cast<std::int16_t>(size.z - 1 - v.z), colour};
}

// The inverse turn, for corners of the box.
VoxelPart upright_part(const ivec3& size) {
  VoxelPart part;
  part.size = size;
  part.file_turn = {{0, 1, 2}, {1, -1, -1}};
  part.file_origin = {0, size.y, size.z};
  return part;
}

std::uint64_t bytes_of_indices(const ivec3& size) {
  return static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y) * static_cast<std::uint64_t>(size.z);
}

// Reads the spans of map columns; z is down.
class MapColumns {
 public:
  MapColumns(std::string_view bytes, const ivec3& columns) : bytes_(bytes), columns_(columns) {}

  std::vector<ListedVoxel> voxels;  // z as in the file
  int depth = 0;                    // 1 + z of the lowest voxel

  void parse() {
    for (int y = 0; y < columns_.y; ++y) {
      for (int x = 0; x < columns_.x; ++x) parse_column(x, y);
    }
  }

  // Bytes after the last column.
  std::size_t left() const { return bytes_.size(); }

 private:
  void need(std::size_t count) {
    if (bytes_.size() < count) throw Error(fmt::format("truncated map, or not one of Voxlap ({})", kFetchAgain));
  }
  void add(int x, int y, int z, std::string_view colour) {
    if (voxels.size() == kMostListedVoxels) throw Error(fmt::format("more than {} voxels", kMostListedVoxels));
    voxels.push_back(
        {static_cast<std::int16_t>(x), static_cast<std::int16_t>(y), static_cast<std::int16_t>(z), from_bgr(colour)});
    depth = std::max(depth, z + 1);
  }
  // Adds the inside of the ground, which is visible at the border of the map, in the colour above it.
  void add_inside(int x, int y, int begin, int end, std::string_view colour) {
    const bool border = x == 0 || y == 0 || x == columns_.x - 1 || y == columns_.y - 1;
    for (int z = begin; border && z < end; ++z) add(x, y, z, colour);
  }

  void parse_column(int x, int y) {
    int next = 0;  // the first z that is not decided yet
    for (;;) {
      need(4);
      const std::size_t words = byte_at(bytes_, 0);
      const int begin = byte_at(bytes_, 1), end = byte_at(bytes_, 2) + 1;
      const auto colours = static_cast<std::size_t>(std::max(0, end - begin));
      // A span without colours ends right above its start.
      if (begin < next || end < begin || (words > 0 && words < 1 + colours))
        throw Error(fmt::format("column ({}, {}): inconsistent spans (is it a map of Voxlap?)", x, y));
      const std::size_t length = 4 * (words > 0 ? words : 1 + colours);
      need(length);
      for (std::size_t i = 0; i < colours; ++i) add(x, y, begin + static_cast<int>(i), bytes_.substr(4 + 4 * i));
      const std::string_view last = bytes_.substr(4 * std::max<std::size_t>(colours, 1));
      if (words == 0) {
        // The ground continues to the bottom.
        if (colours > 0) add_inside(x, y, end, bottom_, last);
        bytes_.remove_prefix(length);
        return;
      }
      const std::size_t below = words - 1 - colours;  // colours of the ceiling
      const std::string_view ceiling = bytes_.substr(4 + 4 * colours, 4 * below);
      bytes_.remove_prefix(length);
      need(4);
      const int air = byte_at(bytes_, 3), from = air - static_cast<int>(below);
      if (from < end) throw Error(fmt::format("column ({}, {}): inconsistent spans (is it a map of Voxlap?)", x, y));
      if (colours > 0) add_inside(x, y, end, from, last);
      for (std::size_t i = 0; i < below; ++i) add(x, y, from + static_cast<int>(i), ceiling.substr(4 * i));
      next = air;
    }
  }

  std::string_view bytes_;
  ivec3 columns_;
  static constexpr int bottom_ = kLeastMapDepth;
};

}  // namespace

VoxelParts parse_kv6(std::string_view file) {
  refuse_lfs_pointer(file);
  if (!file.starts_with(kKv6))
    throw Error(
        fmt::format("not a KV6 file: begins with {} instead of 'Kvxl'", printable(file.substr(0, kKv6.size()))));
  VoxBytes bytes(file.substr(kKv6.size()));
  const ivec3 size = parse_size(bytes, 3);
  bytes.take(12);  // pivot
  const auto count = static_cast<std::uint32_t>(bytes.number());
  const std::uint64_t columns = static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y);
  const std::uint64_t needed = std::uint64_t{8} * count + 4 * static_cast<std::uint64_t>(size.x) + 2 * columns;
  if (bytes.left() < needed || count > kMostListedVoxels) {
    throw Error(fmt::format("{} voxels of {} x {} x {} need {} bytes, but {} are left ({})", count, size.x, size.y,
                            size.z, needed, bytes.left(), kFetchAgain));
  }
  const std::string_view voxels = bytes.take(std::size_t{8} * count);
  bytes.take(4 * static_cast<std::size_t>(size.x));  // counts per x, which follow from the counts per column
  const std::string_view counts = bytes.take(2 * columns);
  VoxelPart part = upright_part(size);
  part.voxels.reserve(count);
  std::size_t at = 0;
  for (int x = 0; x < size.x; ++x) {
    for (int y = 0; y < size.y; ++y) {
      const auto column = static_cast<std::size_t>(x) * static_cast<std::size_t>(size.y) + static_cast<std::size_t>(y);
      int above = -1;
      for (int left = short_at(counts, 2 * column); left > 0; --left, ++at) {
        if (at == count)
          throw Error(fmt::format("its columns contain more than its {} voxels ({})", count, kFetchAgain));
        const std::string_view voxel = voxels.substr(8 * at, 8);
        const int z = short_at(voxel, 4);
        if (z <= above || z >= size.z)
          throw Error(
              fmt::format("column ({}, {}): voxel at z = {} is out of order or outside ({})", x, y, z, kFetchAgain));
        part.voxels.push_back(upright({x, y, z}, size, from_bgr(voxel)));
        above = z;
      }
    }
  }
  if (at != count) throw Error(fmt::format("its columns contain {} voxels instead of {}", at, count));
  return {"KV6", {std::move(part)}, {"KV6 files list the voxels of the surface only: the inside is empty"}};
}

bool is_voxlap_vox(std::string_view first, std::uint64_t file_bytes) {
  if (first.size() < 12 || first.starts_with("VOX ")) return false;
  VoxBytes bytes(first);
  try {
    return file_bytes == 12 + bytes_of_indices(parse_size(bytes, 3)) + kPaletteBytes;
  } catch (const Error&) {
    return false;
  }
}

VoxelParts parse_voxlap_vox(std::string_view file) {
  if (!is_voxlap_vox(file.substr(0, 12), file.size()))
    throw Error("not a .vox file of Voxlap: its size is not that of its voxels and palette");
  VoxBytes bytes(file);
  const ivec3 size = parse_size(bytes, 3);
  const std::string_view indices = bytes.take(bytes_of_indices(size)), palette = bytes.take(kPaletteBytes);
  const auto solid = static_cast<std::size_t>(std::count_if(
      indices.begin(), indices.end(), [](char index) { return static_cast<std::uint8_t>(index) != kEmpty; }));
  if (solid > kMostListedVoxels) throw Error(fmt::format("more than {} voxels", kMostListedVoxels));
  VoxelPart part = upright_part(size);
  part.voxels.reserve(solid);
  std::size_t at = 0;
  for (int x = 0; x < size.x; ++x) {
    for (int y = 0; y < size.y; ++y) {
      for (int z = 0; z < size.z; ++z, ++at) {
        const std::size_t index = byte_at(indices, at);
        if (index == kEmpty) continue;
        std::array<std::uint8_t, 3> colour{};
        // 0..63 to 0..255.
        for (std::size_t i = 0; i < 3; ++i)
          colour[i] = static_cast<std::uint8_t>(std::min(63, int{byte_at(palette, 3 * index + i)}) * 255 / 63);
        part.voxels.push_back(upright({x, y, z}, size, colour));
      }
    }
  }
  return {"Voxlap .vox", {std::move(part)}, {}};
}

VoxelParts parse_vxl(std::string_view file) {
  refuse_lfs_pointer(file);
  if (file.starts_with(kWestwood)) {
    throw Error(
        "voxel animation of Westwood's games, which is not supported (Scarp reads .vxl maps of Voxlap and Ace "
        "of Spades)");
  }
  ivec3 size(kMapSide, kMapSide, 1);
  if (file.size() >= 4 && VoxBytes(file).number() == kMap) {
    VoxBytes bytes(file.substr(4));
    size = parse_size(bytes, 2);
    bytes.take(kCameraBytes);
    file = bytes.rest();
  }
  MapColumns map(file, size);
  map.parse();
  if (const std::size_t behind = map.left(); behind > 0)
    throw Error(
        fmt::format("{} bytes follow the last of {} x {} columns (is it a map of Voxlap?)", behind, size.x, size.y));
  size.z = map.depth <= kLeastMapDepth ? kLeastMapDepth : kMapDepth;
  VoxelPart part = upright_part(size);
  part.voxels = std::move(map.voxels);
  for (ListedVoxel& v : part.voxels) v = upright({v.x, v.y, v.z}, size, v.colour);
  return {"Voxlap map", {std::move(part)}, {"the ground below the surface of the map is empty"}};
}

}  // namespace scarp
