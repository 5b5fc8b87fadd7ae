// SPDX-License-Identifier: MIT
#include "scarp/scene/file/from_parts.h"

#include <utility>

#include "scarp/scene/file/voxel_memory.h"
#include "scarp/scene/voxel/lattice_place.h"

namespace scarp {
namespace {

constexpr int kColourBits = 24;

VoxelBox box_of(const VoxelPart& part) {
  VoxelBox box;
  for (const ListedVoxel& v : part.voxels) box = around(box, {{v.x, v.y, v.z}, ivec3(v.x, v.y, v.z) + 1});
  return box;
}

VoxelGrid grid_of(const VoxelPart& part, const VoxelBox& box) {
  VoxelGrid grid(box.high - box.low, kColourBits);
  std::vector<VoxelGrid::Placed> placed;
  for (const ListedVoxel& v : part.voxels) {
    const std::uint32_t rgb = v.colour[0] | std::uint32_t{v.colour[1]} << 8 | std::uint32_t{v.colour[2]} << 16;
    placed.push_back({ivec3(v.x, v.y, v.z) - box.low, rgb});
    if (placed.size() < kVoxelsAtOnce && &v != &part.voxels.back()) continue;
    grid.set(placed);
    placed.clear();
  }
  return grid;
}

}  // namespace

PlacedVoxels placed_voxels_from(const VoxelParts& file, const VoxelFileOptions& options) {
  std::vector<VoxelBox> boxes;
  std::vector<ivec3> sizes;
  std::int64_t listed = 0;
  for (const VoxelPart& part : file.parts) {
    listed += static_cast<std::int64_t>(part.voxels.size());
    boxes.push_back(box_of(part));
    if (!boxes.back().empty()) sizes.push_back(boxes.back().high - boxes.back().low);
  }
  const VoxelMarchEntry& march = file_voxel_march(options.march, sizes);
  VoxelMemory memory(listed);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (boxes[i].empty()) continue;
    const ivec3 size = boxes[i].high - boxes[i].low;
    require_marchable(march, size);
    const auto solid = static_cast<std::int64_t>(file.parts[i].voxels.size());
    // At most one page per voxel.
    const std::int64_t pages = std::min(solid, VoxelGrid::pages_of(size));
    memory.add(VoxelGrid::bytes_of(size, pages, solid, kColourBits) + accelerator_bytes(march.accelerator, size),
               "split the model, or choose --march voxel-bricks");
  }
  PlacedVoxels placed{.rounding = options.rounding};
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (boxes[i].empty()) continue;
    VoxelGrid grid = grid_of(file.parts[i], boxes[i]);
    if (options.surface_colours) grid.drop_hidden_entries();
    const auto model = static_cast<std::uint32_t>(placed.models.size());
    placed.places.push_back({.model = model, .origin = dvec3(file.parts[i].low + boxes[i].low)});
    const auto made = std::make_shared<VoxelModel>(std::move(grid), march);
    const LatticePlace part(file.parts[i].file_turn, file.parts[i].file_origin);
    made->set_file_place({part.turn(), part.turn()(boxes[i].low) + part.origin()});
    placed.models.push_back(made);
  }
  return placed;
}

}  // namespace scarp
