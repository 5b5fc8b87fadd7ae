// SPDX-License-Identifier: MIT
#include "scarp/accel/max_pyramid_vk.h"

#include <algorithm>

#include "scarp/accel/max_pyramid.glsl.h"

namespace scarp {
namespace {

constexpr std::uint32_t kShader[] = {
#include "scarp/accel/max_pyramid.comp.inc"
};

// Limits that every device supports: workgroups along one side of a dispatch, and invocations per workgroup.
constexpr int kMaxGroups = 65535;
static_assert(glsl::kPyramidGroupCols * glsl::kPyramidGroupRows <= 128);

}  // namespace

std::vector<ShaderProgram> pyramid_shaders() {
  return {{"scarp/accel/max_pyramid.comp", "", kShader, sizeof(glsl::PyramidPush)}};
}

PyramidPasses::PyramidPasses(const Device& device) : pipeline_(device, pyramid_shaders()[0], "max_pyramid") {}

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
          const glsl::PyramidPush push{ground,
                                       codes,
                                       static_cast<std::uint32_t>(l + 1),
                                       static_cast<std::uint32_t>(col),
                                       static_cast<std::uint32_t>(row),
                                       static_cast<std::uint32_t>(col + cols),
                                       static_cast<std::uint32_t>(row + rows)};
          commands.dispatch(pipeline_, push,
                            {static_cast<std::uint32_t>((cols + kGroupCols - 1) / kGroupCols),
                             static_cast<std::uint32_t>((rows + kGroupRows - 1) / kGroupRows), 1});
        }
      }
    }
  }
}

}  // namespace scarp
