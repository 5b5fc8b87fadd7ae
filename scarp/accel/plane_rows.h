// SPDX-License-Identifier: MIT
// Private to the station: fits planes to the blocks of one row of a level, in vectors. See block_planes.h.
#pragma once

#include <cstddef>
#include <cstdint>

namespace scarp {

struct PlaneFit {
  float unit;         ///< codes per cell and step of a slope
  float half;         ///< half the side of a child, in cells; unused for the first level
  std::int32_t most;  ///< steps of the steepest slope allowed
};

/// Entries that kernels read beyond the end of a row, and write. A row of samples has one more.
constexpr std::size_t kPlaneRowPadding = 64;

/// The first level: blocks of 2 x 2 cells, from rows of 2 * count + 1 sample codes. `flat`: codes above
/// the blocks, at most 65535, used without a slope where a plane would be higher in the middle of the block.
void fit_first_planes(const PlaneFit& fit, const float* north, const float* middle, const float* south,
                      const float* flat, std::size_t count, std::uint32_t* entries);

/// A coarser level, from rows of 2 * count entries of the finer one.
void fit_coarser_planes(const PlaneFit& fit, const std::uint32_t* north, const std::uint32_t* south, const float* flat,
                        std::size_t count, std::uint32_t* entries);

}  // namespace scarp
