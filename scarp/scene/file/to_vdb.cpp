// SPDX-License-Identifier: MIT
#include "scarp/scene/file/to_vdb.h"

#include <algorithm>
#include <vector>

namespace scarp {
namespace {

constexpr int kTile = 128, kLeaf = 8;  // voxels

// Kinds of a grid's pages. Each page is examined once: worlds share most of them.
class PageKinds {
 public:
  enum Kind : std::uint8_t { unknown, empty, full, mixed };

  explicit PageKinds(const VoxelGrid& grid)
      : grid_(grid), known_(grid.masks().size() / VoxelGrid::kPageBricks + 1, unknown) {}

  /// Contents of the bricks of a box of voxels; also `mixed` if pages continue beyond the box.
  Kind of(const VoxelBox& box) {
    Kind all = unknown;
    for_each_row({box.low / 4, (box.high + 3) / 4}, [&](int y, int z) {
      if (all == mixed) return;
      const std::size_t first = grid_.brick_index({box.low.x / 4, y, z}),
                        last = grid_.brick_index({(box.high.x - 1) / 4, y, z});
      for (std::size_t page = first / VoxelGrid::kPageBricks; page <= last / VoxelGrid::kPageBricks; ++page) {
        const Kind here = of_page(page);
        all = all == unknown || all == here ? here : mixed;
      }
    });
    return all;
  }

 private:
  Kind of_page(std::size_t page) {
    const std::size_t first = grid_.page_table()[page];
    Kind& kind = known_[first / VoxelGrid::kPageBricks];
    if (kind == unknown) {
      const auto masks = grid_.masks().subspan(first, VoxelGrid::kPageBricks);
      const auto all = [&](std::uint64_t value) {
        return std::all_of(masks.begin(), masks.end(), [value](std::uint64_t mask) { return mask == value; });
      };
      kind = all(0) ? empty : all(~std::uint64_t{0}) ? full : mixed;
    }
    return kind;
  }

  const VoxelGrid& grid_;
  std::vector<Kind> known_;
};

void add_leaf(const VoxelGrid& grid, const ivec3& low, VdbVoxels& to) {
  VdbLeaf leaf{low, {}};
  std::uint64_t any = 0, all = ~std::uint64_t{0};
  for (int i = 0; i < 8; ++i) {
    const ivec3 brick = low / 4 + ivec3(i & 1, i >> 1 & 1, i >> 2);
    const ivec3& bricks = grid.bricks();
    if (brick.x < bricks.x && brick.y < bricks.y && brick.z < bricks.z)
      leaf.solid[static_cast<std::size_t>(i)] = grid.mask(brick);
    any |= leaf.solid[static_cast<std::size_t>(i)], all &= leaf.solid[static_cast<std::size_t>(i)];
  }
  if (any == 0) return;
  if (all == ~std::uint64_t{0}) {
    to.tiles.push_back({low, kLeaf});
  } else {
    to.leaves.push_back(leaf);
  }
}

}  // namespace

VdbVoxels vdb_of(const VoxelGrid& grid, const ivec3& low, double side) {
  VdbVoxels voxels;
  voxels.world_from_index = glm::dmat3(side);
  voxels.origin = side * (dvec3(low) + 0.5);
  PageKinds pages(grid);
  const VoxelBox& solid = grid.bounds();
  if (solid.empty()) return voxels;
  for_each_voxel({solid.low / kTile, (solid.high + kTile - 1) / kTile}, [&](const ivec3& block) {
    const ivec3 from = kTile * block;
    const VoxelBox box = intersection({from, from + kTile}, grid.box());
    const PageKinds::Kind kind = pages.of(box);
    if (kind == PageKinds::empty) return;
    if (kind == PageKinds::full && box.high == from + kTile) {
      voxels.tiles.push_back({from, kTile});
      return;
    }
    for_each_voxel({box.low / kLeaf, (box.high + kLeaf - 1) / kLeaf},
                   [&](const ivec3& leaf) { add_leaf(grid, kLeaf * leaf, voxels); });
  });
  return voxels;
}

}  // namespace scarp
