// SPDX-License-Identifier: MIT
#include "scarp/accel/max_pyramid_vk.h"

#include <algorithm>
#include <cstddef>

#include "scarp/accel/ground_buffers.glsl.h"
#include "scarp/accel/max_pyramid.glsl.h"
#include "scarp/accel/max_quads.glsl.h"

namespace scarp {
namespace {

constexpr std::uint32_t kEntries[] = {
#include "scarp/accel/max_pyramid.comp.inc"
};
constexpr std::uint32_t kQuads[] = {
#include "scarp/accel/max_quads.comp.inc"
};

// Limits that every device supports: workgroups along one side of a dispatch, and invocations per workgroup.
constexpr int kMaxGroups = 65535;
static_assert(glsl::kPyramidGroupCols * glsl::kPyramidGroupRows <= 128);

}  // namespace

std::vector<ShaderProgram> pyramid_shaders() {
  return {{"scarp/accel/max_pyramid.comp", "", kEntries, sizeof(glsl::PyramidPush)},
          {"scarp/accel/max_quads.comp", "", kQuads, sizeof(glsl::QuadsPush)}};
}

PyramidPasses::PyramidPasses(const Device& device)
    : entries_(device, pyramid_shaders()[0], "max_pyramid"), quads_(device, pyramid_shaders()[1], "max_quads") {}

void PyramidPasses::record(Commands& commands, std::uint64_t ground, std::uint64_t codes, const HeightField& field,
                           const CellBox& changed) const {
  constexpr int kGroupCols = glsl::kPyramidGroupCols, kGroupRows = glsl::kPyramidGroupRows;
  std::vector<CellBox> parts = parts_inside(field, changed);
  const std::size_t levels = pyramid_levels(field).size();
  for (std::size_t l = 0; l < levels; ++l) {
    commands.barrier();
    for (CellBox& part : parts) {
      part = coarser(part);
      // A long side takes several dispatches.
      for (int row = part.row_begin; row < part.row_end; row += kMaxGroups * kGroupRows) {
        for (int col = part.col_begin; col < part.col_end; col += kMaxGroups * kGroupCols) {
          const int cols = std::min(part.col_end - col, kMaxGroups * kGroupCols);
          const int rows = std::min(part.row_end - row, kMaxGroups * kGroupRows);
          const Commands::Groups groups{static_cast<std::uint32_t>((cols + kGroupCols - 1) / kGroupCols),
                                        static_cast<std::uint32_t>((rows + kGroupRows - 1) / kGroupRows), 1};
          const auto level = static_cast<std::uint32_t>(l + 1);
          const auto col_begin = static_cast<std::uint32_t>(col), row_begin = static_cast<std::uint32_t>(row);
          const auto col_end = static_cast<std::uint32_t>(col + cols), row_end = static_cast<std::uint32_t>(row + rows);
          commands.dispatch(entries_, glsl::PyramidPush{ground, codes, level, col_begin, row_begin, col_end, row_end},
                            groups);
          const std::uint64_t spread = ground + offsetof(glsl::GroundBuffers, spread);
          commands.dispatch(quads_, glsl::QuadsPush{ground, spread, level, col_begin, row_begin, col_end, row_end},
                            groups);
        }
      }
    }
  }
}

}  // namespace scarp
