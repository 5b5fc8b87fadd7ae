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
  double bound = 0;
  std::mutex merging;
  field.visit([&](const auto& grid) {
    parallel_for(field.cell_rows(), kRowsPerPiece, [&](std::int64_t begin, std::int64_t end) {
      double steepest = 0;
      for (int row = static_cast<int>(begin); row < end; ++row) {
        const auto *north = grid.row(row), *south = grid.row(row + 1);
        for (int col = 0; col < field.cell_cols(); ++col) {
          if (grid.is_hole(col, row)) continue;
          const double h00 = north[col], h10 = north[col + 1], h01 = south[col], h11 = south[col + 1];
          const double along_x = std::max(std::abs(h10 - h00), std::abs(h11 - h01)) / settings.cell_x;
          const double along_y = std::max(std::abs(h01 - h00), std::abs(h11 - h10)) / settings.cell_y;
          steepest = std::max(steepest, along_x * along_x + along_y * along_y);
        }
      }
      const std::scoped_lock lock(merging);
      bound = std::max(bound, steepest);
    });
  });
  return std::sqrt(bound) * metres;
}

}  // namespace scarp
