// SPDX-License-Identifier: MIT
#include "scarp/scene/file/from_vdb.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/field/sparse_table.h"
#include "scarp/scene/voxel/lattice_place.h"

namespace scarp {
namespace {

constexpr int kCell = 8, kBlock = 128;  // voxels: sides of leaves, and of the tiles above them
constexpr int kVdbColourBits = 24;
constexpr std::int64_t kMostBytes = std::int64_t{4} << 30;

std::size_t count_of(const ivec3& counts) {
  return static_cast<std::size_t>(counts.x) * static_cast<std::size_t>(counts.y) * static_cast<std::size_t>(counts.z);
}
std::size_t index_in(const ivec3& v, const ivec3& counts) {
  return static_cast<std::size_t>(v.x) +
         static_cast<std::size_t>(counts.x) *
             (static_cast<std::size_t>(v.y) + static_cast<std::size_t>(counts.y) * static_cast<std::size_t>(v.z));
}

VoxelBox box_of(const VdbLeaf& leaf) {
  VoxelBox box;
  for (int brick = 0; brick < 8; ++brick) {
    const ivec3 low = leaf.low + 4 * ivec3(brick & 1, brick >> 1 & 1, brick >> 2);
    for (std::uint64_t rest = leaf.solid[static_cast<std::size_t>(brick)]; rest != 0; rest &= rest - 1) {
      const int bit = std::countr_zero(rest);
      const ivec3 v = low + ivec3(bit & 3, bit >> 2 & 3, bit >> 4);
      box = around(box, {v, v + 1});
    }
  }
  return box;
}

// The file's voxels by their position in the grid.
class Cells {
 public:
  explicit Cells(const VdbVoxels& file) : file_(file) {
    VoxelBox box;
    for (const VdbLeaf& leaf : file.leaves) {
      if (box.contains(leaf.low) && box.contains(leaf.low + kCell - 1)) continue;
      box = around(box, box_of(leaf));
    }
    for (const VdbTile& tile : file.tiles) box = around(box, {tile.low, tile.low + tile.side});
    if (box.empty()) throw Error("no voxel is solid");
    // Aligned, so that the bricks of leaves are those of the grid.
    low_ = (box.low >> 3) << 3;
    size_ = box.high - low_;
    VoxelGrid::require_size(size_, kVdbColourBits);
    first_block_ = low_ >> 7;
    cells_ = (size_ + kCell - 1) / kCell;
    blocks_ = ((box.high - 1) >> 7) + 1 - first_block_;
  }

  // Maximum memory of a grid of these voxels.
  std::int64_t bytes() const {
    // A leaf covers four pages, which it may not share.
    const auto leaves = static_cast<std::int64_t>(file_.leaves.size());
    std::int64_t cells = leaves, pages = 4 * leaves, places = 0;
    for (const VdbTile& tile : file_.tiles) {
      const std::int64_t side = tile.side / kCell;
      if (tile.side < kBlock) cells += 1, pages += 4;
      // Completely solid pages share their masks.
      places += 4 * side * side * (side / 32 + 2);
    }
    return VoxelGrid::bytes_of(size_, std::min(pages, VoxelGrid::pages_of(size_)),
                               static_cast<std::int64_t>(file_.colours.size()), kVdbColourBits) +
           static_cast<std::int64_t>(sizeof(std::uint32_t)) * (cells + places);
  }

  void fill() {
    kinds_.resize(count_of(blocks_));
    leaves_ = SparseTable<std::uint32_t>(count_of(cells_));
    for (std::size_t i = 0; i < file_.leaves.size(); ++i) set(file_.leaves[i].low, static_cast<std::uint32_t>(i + 2));
    for (const VdbTile& tile : file_.tiles) {
      if (tile.side < kBlock) {
        set(tile.low, kSolid);
        continue;
      }
      for_each_voxel({tile.low >> 7, (tile.low + tile.side) >> 7},
                     [&](const ivec3& block) { kinds_[index_in(block - first_block_, blocks_)] = kSolidBlock; });
    }
    first_colour_.resize(file_.colours.empty() ? 0 : file_.leaves.size());
    std::size_t colour = 0;
    for (std::size_t i = 0; i < first_colour_.size(); ++i) {
      first_colour_[i] = colour;
      for (const std::uint64_t solid : file_.leaves[i].solid) colour += static_cast<std::size_t>(std::popcount(solid));
    }
  }

  const ivec3& low() const { return low_; }
  const ivec3& size() const { return size_; }

  VoxelGrid::Contents contents(const VoxelBox& page) const {
    const VoxelBox box{page.low, glm::min(page.high, size_)};
    bool some = false, all = true;
    for (int z = box.low.z; z < box.high.z && (all || !some); z = next(z, kCell)) {
      for (int y = box.low.y; y < box.high.y && (all || !some); y = next(y, kCell)) {
        for (int x = box.low.x; x < box.high.x && (all || !some);) {
          const ivec3 v(x, y, z);
          const std::uint8_t kind = kinds_[block_of(v)];
          const std::uint32_t here = kind == kMixedBlock ? leaves_[index_in(v >> 3, cells_)] : kind;
          some = some || here != 0;
          all = all && here == kSolid;
          x = kind == kMixedBlock ? next(x, kCell) : (((low_.x + x) >> 7) + 1) * kBlock - low_.x;
        }
      }
    }
    return !some ? VoxelGrid::Contents::empty : all ? VoxelGrid::Contents::full : VoxelGrid::Contents::mixed;
  }

  VoxelGrid::Brick fill(const ivec3& brick, std::span<std::uint32_t, 64> entries) const {
    const ivec3 v = 4 * brick;
    const std::uint8_t kind = kinds_[block_of(v)];
    const std::uint32_t here = kind == kMixedBlock ? leaves_[index_in(v >> 3, cells_)] : kind;
    if (here <= kSolid) return {here == kSolid ? ~std::uint64_t{0} : 0, 0};
    const std::size_t leaf = here - 2;
    const auto part = static_cast<std::size_t>((brick.x & 1) | (brick.y & 1) << 1 | (brick.z & 1) << 2);
    const std::uint64_t solid = file_.leaves[leaf].solid[part];
    if (first_colour_.empty()) return {solid, 0};
    std::size_t colour = first_colour_[leaf];
    for (std::size_t i = 0; i < part; ++i)
      colour += static_cast<std::size_t>(std::popcount(file_.leaves[leaf].solid[i]));
    for (std::uint64_t rest = solid; rest != 0; rest &= rest - 1) {
      const VdbColour& c = file_.colours[colour++];
      entries[static_cast<std::size_t>(std::countr_zero(rest))] =
          c[0] | std::uint32_t{c[1]} << 8 | std::uint32_t{c[2]} << 16;
    }
    return {solid, solid};
  }

 private:
  // Cells: 0 where nothing is solid, kSolid where all is, or a leaf's index + 2. Blocks: the same for all their cells.
  static constexpr std::uint32_t kSolid = 1;
  static constexpr std::uint8_t kSolidBlock = 1, kMixedBlock = 2;

  static int next(int place, int side) { return (place / side + 1) * side; }
  std::size_t block_of(const ivec3& voxel) const { return index_in(((low_ + voxel) >> 7) - first_block_, blocks_); }
  void set(const ivec3& place, std::uint32_t value) {
    leaves_.at(index_in((place - low_) >> 3, cells_)) = value;
    kinds_[block_of(place - low_)] = kMixedBlock;
  }

  const VdbVoxels& file_;
  ivec3 low_{0}, size_{1}, first_block_{0}, cells_{1}, blocks_{1};
  SparseTable<std::uint32_t> leaves_;
  std::vector<std::uint8_t> kinds_;
  std::vector<std::size_t> first_colour_;
};

}  // namespace

PlacedVoxels placed_voxels_from(const VdbVoxels& file, const VoxelFileOptions& options, UpAxis up) {
  Cells cells(file);
  const VoxelMarchEntry& march = file_voxel_march(options.march, {&cells.size(), 1});
  require_marchable(march, cells.size());
  const std::int64_t bytes = cells.bytes() + accelerator_bytes(march.accelerator, cells.size());
  if (bytes > kMostBytes) {
    throw Error(fmt::format("its voxels need up to {:.2g} GB of memory (limited to {:.2g} GB; use a coarser grid)",
                            static_cast<double>(bytes) / 1e9, static_cast<double>(kMostBytes) / 1e9));
  }
  cells.fill();
  VoxelGrid grid = VoxelGrid::built(
      cells.size(), file.colours.empty() ? 1 : kVdbColourBits,
      {[&](const VoxelBox& page) { return cells.contents(page); },
       [&](const ivec3& brick, std::span<std::uint32_t, 64> entries) { return cells.fill(brick, entries); }});
  if (options.surface_colours) grid.drop_hidden_entries();
  // Without entries, all voxels have the number 0.
  std::vector<VoxelColour> palette;
  if (file.colours.empty()) palette = {kPlainVoxels};
  // (x, y, z) becomes (x, -z, y).
  const glm::dmat3 turn =
      up == UpAxis::y ? glm::dmat3(dvec3(1, 0, 0), dvec3(0, 0, 1), dvec3(0, -1, 0)) : glm::dmat3(1.0);
  const glm::dmat3 world_from_grid = turn * file.world_from_index;
  // A grid point is the middle of its voxel.
  const dvec3 origin = turn * file.origin + world_from_grid * (dvec3(cells.low()) - 0.5);
  PlacedVoxels placed{.rounding = options.rounding};
  const auto model = std::make_shared<VoxelModel>(std::move(grid), march, std::move(palette));
  model->set_file_place({{}, cells.low()});
  placed.models.push_back(model);
  placed.places.push_back({.world_from_grid = world_from_grid, .origin = origin});
  return placed;
}

}  // namespace scarp
