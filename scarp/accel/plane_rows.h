// SPDX-License-Identifier: MIT
// Private to scarp/accel: fits planes to the blocks of one row of a level, in vectors. See block_planes.h.
#pragma once

#include <cstddef>
#include <cstdint>

namespace scarp {

struct PlaneFit {
  float unit;          ///< codes per cell and step of a slope
  float half;          ///< half the side of a child, in cells; half a cell for the first level
  std::int32_t most;   ///< steepest slope allowed, in steps
  float scale, shift;  ///< from codes of maxima to those of planes, exact
};

/// Entries that kernels read and write beyond the end of a row.
constexpr std::size_t kPlaneRowPadding = 64;

/// Adds planes to the maxima in a row of `blocks`, each of 2 x 2 cells, from rows of 2 * count + 1 sample codes.
void fit_first_planes(const PlaneFit& fit, const float* north, const float* middle, const float* south,
                      std::size_t count, std::uint32_t* blocks);

/// The same for a coarser level, from rows of 2 * count children.
void fit_coarser_planes(const PlaneFit& fit, const std::uint32_t* north, const std::uint32_t* south, std::size_t count,
                        std::uint32_t* blocks);

}  // namespace scarp
