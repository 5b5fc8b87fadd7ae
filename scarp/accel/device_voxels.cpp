// SPDX-License-Identifier: MIT
#include "scarp/accel/device_voxels.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <set>
#include <utility>

#include "scarp/base/error.h"

namespace scarp {
namespace {

// Size of a buffer that several grids share.
constexpr std::uint64_t kSharedBytes = std::uint64_t{64} << 20;
constexpr std::uint64_t kAlign = 16;

// Entries of a page start at a multiple of this many words, which leaves room for a few more voxels.
constexpr std::uint32_t kSlotWords = 8;

std::uint64_t aligned(std::uint64_t bytes) { return (bytes + kAlign - 1) / kAlign * kAlign; }
std::uint32_t slot_words(std::size_t words64) {
  // One extra entry is readable after the last.
  const auto words = static_cast<std::uint32_t>(2 * words64 + 1);
  return (words + kSlotWords - 1) / kSlotWords * kSlotWords;
}

glsl::ScarpVoxelPage page_of(const VoxelGrid::PackedEntries& entries, std::uint32_t first_word) {
  glsl::ScarpVoxelPage page{first_word, {}};
  for (std::size_t i = 0; i < entries.rank_from.size(); ++i)
    page.ranks[i / 2] |= std::uint32_t{entries.rank_from[i]} << (16 * (i % 2));
  return page;
}

std::uint32_t march_of(const MarchedGrid& parts) {
  if (parts.spheres) return glsl::kScarpVoxelSpheres;
  if (parts.cubes) return glsl::kScarpVoxelCubes;
  if (parts.octants) return glsl::kScarpVoxelOctants;
  return parts.bricks ? glsl::kScarpVoxelBricks : glsl::kScarpVoxelPlanes;
}

// The bytes of an accelerator with one byte per voxel, as on the CPU.
std::span<const std::byte> voxel_bytes_of(const MarchedGrid& parts) {
  const auto bytes_of = [](const VoxelBytes& of) {
    const ivec3& size = of.size();
    return std::as_bytes(std::span(of.data(), static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
                                                  static_cast<std::size_t>(size.z)));
  };
  if (parts.spheres) return bytes_of(parts.spheres->distances());
  if (parts.cubes) return bytes_of(parts.cubes->distances());
  if (parts.octants) return bytes_of(parts.octants->sides());
  return {};
}

// Entries [begin, end) of a table, which may be in chunks.
template <class T>
std::vector<T> values_of(const SparseTable<T>& table, std::size_t begin, std::size_t end) {
  std::vector<T> values(end - begin);
  for (std::size_t i = table.next(begin); i < end; i = table.next(i + 1)) values[i - begin] = table[i];
  return values;
}
template <class T>
std::vector<T> values_of(const SparseTable<T>& table) {
  return values_of(table, 0, table.size());
}

// Shaders count bricks in 32 bits.
constexpr std::uint64_t kMostBricks = std::uint64_t{1} << 32;

void require_size(const MarchedGrid& parts) {
  const ivec3 &size = parts.grid->size(), &bricks = parts.grid->bricks();
  if (static_cast<std::uint64_t>(bricks.x) * static_cast<std::uint64_t>(bricks.y) *
          static_cast<std::uint64_t>(bricks.z) >
      kMostBricks) {
    throw Error(fmt::format("voxels: {} x {} x {}, limited to 2^38 voxels on Vulkan devices (use the CPU)", size.x,
                            size.y, size.z));
  }
}

// Uploads bytes [begin, end) of a block, widened to whole words; pads beyond the end of `data`.
void upload_part(const DeviceBuffer& to, std::uint64_t offset, std::span<const std::byte> data, std::uint64_t begin,
                 std::uint64_t end) {
  begin = begin / 4 * 4;
  end = (end + 3) / 4 * 4;
  if (end <= data.size()) return upload(to, offset + begin, data.data() + begin, end - begin);
  std::vector<std::byte> padded(end - begin);
  std::memcpy(padded.data(), data.data() + begin, data.size() - begin);
  upload(to, offset + begin, padded.data(), padded.size());
}

}  // namespace

// The contents of a grid's blocks.
struct DeviceVoxels::Image {
  std::size_t grid;
  std::vector<std::uint32_t> first_data;
  std::vector<glsl::ScarpVoxelPage> page_data;
  std::vector<std::uint32_t> entry_data;
  std::vector<std::uint64_t> sector_data;
  std::array<std::span<const std::byte>, kBlocks> blocks;

  Image(std::size_t index, Grid& to, const MarchedGrid& parts) : grid(index) {
    const VoxelGrid& voxels = *parts.grid;
    const std::size_t stored = voxels.masks().size() / VoxelGrid::kPageBricks;
    to.slots.clear();
    to.used_words = 0;
    for (std::size_t i = 0; i < stored; ++i) {
      const VoxelGrid::PackedEntries packed = voxels.packed_entries(i);
      to.slots.push_back({to.used_words, slot_words(packed.words.size())});
      page_data.push_back(page_of(packed, to.used_words));
      to.used_words += to.slots.back().room;
    }
    entry_data.resize(to.used_words);
    for (std::size_t i = 0; i < stored; ++i) {
      const auto words = voxels.packed_entries(i).words;
      if (!words.empty()) std::memcpy(entry_data.data() + to.slots[i].first, words.data(), words.size_bytes());
    }
    first_data = values_of(voxels.page_table());
    blocks[first_masks] = std::as_bytes(std::span(first_data));
    blocks[masks] = std::as_bytes(voxels.masks());
    if (voxels.coloured_masks().data() != voxels.masks().data())
      blocks[coloured] = std::as_bytes(voxels.coloured_masks());
    blocks[pages] = std::as_bytes(std::span(page_data));
    blocks[entries] = std::as_bytes(std::span(entry_data));
    blocks[marks] = voxel_bytes_of(parts);
    if (parts.bricks) {
      sector_data = values_of(parts.bricks->levels()[0].masks);
      blocks[marks] = std::as_bytes(std::span(sector_data));
    }
  }
};

DeviceVoxels::DeviceVoxels(const Device& device, std::span<const MarchedGrid> grids)
    : device_(device), grids_(grids.size()), layout_(grids.size()) {
  for (const MarchedGrid& of : grids) require_size(of);
  header_ = std::make_unique<DeviceBuffer>(
      device, std::max<std::size_t>(grids.size(), 1) * sizeof(glsl::ScarpVoxelGrid), "the voxels' layout");
  // As many grids at a time as fit in one buffer.
  std::vector<Image> images;
  std::uint64_t bytes = 0;
  for (std::size_t i = 0; i < grids.size(); ++i) {
    images.emplace_back(i, grids_[i], grids[i]);
    for (const auto& block : images.back().blocks) bytes += aligned(block.size());
    if (bytes < kSharedBytes && i + 1 < grids.size()) continue;
    copy_all(images);
    images.clear();
    bytes = 0;
  }
  for (std::size_t i = 0; i < grids.size(); ++i) set_layout(i, grids[i]);
  if (!layout_.empty()) upload(*header_, 0, layout_.data(), layout_.size() * sizeof(layout_[0]));
}

// Blocks go into one buffer, or into several if they exceed its limit.
void DeviceVoxels::copy_all(std::span<Image> images) {
  const std::uint64_t most = device_.description().max_allocation_bytes;
  struct Copy {
    std::uint64_t offset;
    std::span<const std::byte> from;
  };
  std::vector<Copy> copies;
  std::vector<Place*> placed;
  std::uint64_t bytes = 0;
  const auto flush = [&] {
    if (bytes == 0) return;
    const auto buffer = std::make_shared<DeviceBuffer>(device_, bytes, "voxels");
    for (Place* place : placed) place->buffer = buffer;
    upload_rows(*buffer, {.row_bytes = bytes}, [&](std::span<std::byte> piece, std::uint64_t first) {
      std::memset(piece.data(), 0, piece.size());
      for (const Copy& copy : copies) {
        const std::uint64_t begin = std::max(first, copy.offset),
                            end = std::min(first + piece.size(), copy.offset + copy.from.size());
        if (begin < end)
          std::memcpy(piece.data() + (begin - first), copy.from.data() + (begin - copy.offset), end - begin);
      }
    });
    copies.clear();
    placed.clear();
    bytes = 0;
  };
  for (Image& image : images) {
    for (std::size_t b = 0; b < kBlocks; ++b) {
      const auto& block = image.blocks[b];
      Place& place = grids_[image.grid].places[b];
      place = {};
      if (block.empty()) continue;
      if (bytes + aligned(block.size()) > most) flush();
      place.offset = bytes;
      place.room = aligned(block.size());
      placed.push_back(&place);
      copies.push_back({bytes, block});
      bytes += place.room;
    }
  }
  flush();
}

void DeviceVoxels::set_layout(std::size_t index, const MarchedGrid& parts) {
  const Grid& grid = grids_[index];
  const VoxelGrid& voxels = *parts.grid;
  const auto address = [&](Block block) -> glsl::Address {
    const Place& place = grid.places[block];
    return place.buffer ? place.buffer->address() + place.offset : 0;
  };
  glsl::ScarpVoxelGrid& to = layout_[index];
  to.first_masks = address(first_masks);
  to.masks = address(masks);
  to.coloured = address(grid.places[coloured].buffer ? coloured : masks);
  to.pages = address(pages);
  to.entries = address(entries);
  to.marks = address(marks);
  to.bricks = voxels.bricks();
  to.size = voxels.size();
  to.low = parts.box.low;
  to.high = parts.box.high;
  to.entry_bits = static_cast<std::uint32_t>(voxels.entry_bits());
  to.march = march_of(parts);
  to.octant_bytes = parts.octants ? static_cast<std::uint32_t>(voxel_bytes_of(parts).size() / 8) : 0;
  to.none = 0;
}

void DeviceVoxels::place(std::size_t index, const MarchedGrid& parts) {
  Image image(index, grids_[index], parts);
  copy_all({&image, 1});
}

// Finds room for a page's entries; returns false if there is none.
bool DeviceVoxels::grow(Grid& grid, const MarchedGrid& parts, std::size_t stored) {
  const std::uint32_t needs = slot_words(parts.grid->packed_entries(stored).words.size());
  if (stored >= grid.slots.size()) grid.slots.resize(stored + 1);
  Slot& slot = grid.slots[stored];
  if (needs <= slot.room) return true;
  if (4 * (std::uint64_t{grid.used_words} + needs) > grid.places[entries].room) return false;
  slot = {grid.used_words, needs};
  grid.used_words += needs;
  return true;
}

void DeviceVoxels::update(std::size_t index, const MarchedGrid& parts, const VoxelBox& changed,
                          const VoxelBox& region) {
  Grid& grid = grids_[index];
  const VoxelGrid& voxels = *parts.grid;
  const VoxelBox inside = intersection(changed, voxels.box());
  std::set<std::size_t> of_grid;  // pages with changes, by their index in the grid
  if (!inside.empty()) {
    const VoxelBox bricks{inside.low >> 2, ((inside.high - 1) >> 2) + 1};
    for_each_row(bricks, [&](int y, int z) {
      const std::size_t from = voxels.brick_index({bricks.low.x, y, z}) / VoxelGrid::kPageBricks,
                        to = voxels.brick_index({bricks.high.x - 1, y, z}) / VoxelGrid::kPageBricks;
      for (std::size_t page = from; page <= to; ++page) of_grid.insert(page);
    });
  }
  const bool had_coloured = grid.places[coloured].buffer != nullptr,
             has_coloured = voxels.coloured_masks().data() != voxels.masks().data();
  bool fits = voxels.masks().size_bytes() <= grid.places[masks].room && had_coloured == has_coloured &&
              voxels.masks().size() / VoxelGrid::kPageBricks * sizeof(glsl::ScarpVoxelPage) <= grid.places[pages].room;
  std::set<std::size_t> stored;
  for (const std::size_t page : of_grid) stored.insert(voxels.page_table()[page] / VoxelGrid::kPageBricks);
  for (const std::size_t page : stored) fits = fits && grow(grid, parts, page);
  if (!fits) {
    place(index, parts);
  } else {
    const auto upload_block = [&](Block block, std::span<const std::byte> data, std::uint64_t begin,
                                  std::uint64_t end) {
      const Place& place = grid.places[block];
      upload_part(*place.buffer, place.offset, data, begin, end);
    };
    // Entries [begin, end) of a block that is a table on the CPU.
    const auto upload_table = [&](Block block, const auto& table, std::size_t begin, std::size_t end) {
      const auto values = values_of(table, begin, end);
      const Place& place = grid.places[block];
      upload(*place.buffer, place.offset + begin * sizeof(values[0]), values.data(), values.size() * sizeof(values[0]));
    };
    if (!of_grid.empty()) upload_table(first_masks, voxels.page_table(), *of_grid.begin(), *of_grid.rbegin() + 1);
    constexpr std::uint64_t kMaskBytes = 8 * VoxelGrid::kPageBricks;
    for (auto at = stored.begin(); at != stored.end();) {
      const std::size_t begin = *at;
      std::vector<glsl::ScarpVoxelPage> of_pages;
      std::size_t end = begin;
      for (; at != stored.end() && *at == end; ++at, ++end) {
        const VoxelGrid::PackedEntries packed = voxels.packed_entries(end);
        of_pages.push_back(page_of(packed, grid.slots[end].first));
        const auto words = std::as_bytes(packed.words);
        const Place& place = grid.places[entries];
        if (!words.empty())
          upload(*place.buffer, place.offset + 4 * std::uint64_t{grid.slots[end].first}, words.data(), words.size());
      }
      upload_block(masks, std::as_bytes(voxels.masks()), kMaskBytes * begin, kMaskBytes * end);
      if (has_coloured)
        upload_block(coloured, std::as_bytes(voxels.coloured_masks()), kMaskBytes * begin, kMaskBytes * end);
      const Place& place = grid.places[pages];
      upload(*place.buffer, place.offset + begin * sizeof(of_pages[0]), of_pages.data(),
             of_pages.size() * sizeof(of_pages[0]));
    }
    const std::span<const std::byte> data = voxel_bytes_of(parts);
    if (parts.bricks && !inside.empty()) {
      const BrickMasks::Level& sectors = parts.bricks->levels()[0];
      constexpr int kSectorBits = 4;  // 2^4 voxels a side
      const ivec3 low = inside.low >> kSectorBits, high = (inside.high - 1) >> kSectorBits;
      for (int z = low.z; z <= high.z; ++z)
        upload_table(marks, sectors.masks, sectors.index({low.x, low.y, z}), sectors.index({high.x, high.y, z}) + 1);
    } else if (const VoxelBox part = intersection(region, voxels.box()); !data.empty() && !part.empty()) {
      const ivec3& size = voxels.size();
      const auto row = static_cast<std::uint64_t>(size.x), slab = row * static_cast<std::uint64_t>(size.y);
      const std::uint64_t octant = slab * static_cast<std::uint64_t>(size.z);
      for (std::uint64_t begin = 0; begin < data.size(); begin += octant) {
        for (int z = part.low.z; z < part.high.z; ++z) {
          const std::uint64_t at = begin + static_cast<std::uint64_t>(z) * slab;
          upload_block(marks, data, at + row * static_cast<std::uint64_t>(part.low.y),
                       at + row * static_cast<std::uint64_t>(part.high.y));
        }
      }
    }
  }
  set_layout(index, parts);
  upload(*header_, index * sizeof(layout_[0]), &layout_[index], sizeof(layout_[0]));
}

std::uint64_t DeviceVoxels::bytes() const {
  std::set<const DeviceBuffer*> buffers{header_.get()};
  for (const Grid& grid : grids_) {
    for (const Place& place : grid.places) {
      if (place.buffer) buffers.insert(place.buffer.get());
    }
  }
  std::uint64_t sum = 0;
  for (const DeviceBuffer* buffer : buffers) sum += buffer->bytes();
  return sum;
}

}  // namespace scarp
