// SPDX-License-Identifier: MIT
#include "scarp/accel/slope_bound.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "scarp/base/parallel.h"

namespace scarp {

double slope_bound(const HeightField& field) {
  if (!field.has_cells()) return 0;
  const HeightFieldSettings& settings = field.settings();
  const double metres = settings.scale * settings.exaggeration;
  constexpr std::int64_t kRowsPerPiece = 64;
  const bool bilinear = settings.surface == Surface::bilinear;
  double bound = 0;
  std::mutex merging;
  field.visit([&](const auto& grid) {
    parallel_for(field.cell_rows(), kRowsPerPiece, [&](std::int64_t begin, std::int64_t end) {
      double steepest = 0;
      for (int row = static_cast<int>(begin); row < end; ++row) {
        for (int col = 0; col < field.cell_cols(); ++col) {
          if (grid.is_hole(col, row)) continue;
          const CellHeights h = grid.cell(col, row);
          const double north = (h.h10 - h.h00) / settings.cell_x, south = (h.h11 - h.h01) / settings.cell_x;
          const double west = (h.h01 - h.h00) / settings.cell_y, east = (h.h11 - h.h10) / settings.cell_y;
          steepest = std::max({steepest, north * north + west * west, south * south + east * east});
          if (bilinear) steepest = std::max({steepest, north * north + east * east, south * south + west * west});
        }
      }
      const std::scoped_lock lock(merging);
      bound = std::max(bound, steepest);
    });
  });
  return std::sqrt(bound) * metres;
}

}  // namespace scarp
