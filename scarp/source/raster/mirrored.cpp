// SPDX-License-Identifier: MIT
#include "scarp/source/raster/mirrored.h"

#include <fmt/format.h>

#include <cstddef>
#include <utility>

#include "scarp/base/error.h"

namespace scarp {

Raster mirrored(Raster raster) {
  constexpr int kMostSide = 1 << 29;
  const int cols = raster.cols, rows = raster.rows;
  if (cols < 2 || rows < 2 || cols > kMostSide || rows > kMostSide) {
    throw Error(fmt::format("{}: cannot mirror {} x {} samples (must be 2 x 2 to {} x {})", raster.path, cols, rows,
                            kMostSide, kMostSide));
  }
  const int wide = 2 * cols - 2, high = 2 * rows - 2;
  std::visit(
      [&]<class T>(std::vector<T>& samples) {
        std::vector<T> all;
        all.reserve(static_cast<std::size_t>(wide) * static_cast<std::size_t>(high));
        for (int row = 0; row < high; ++row) {
          // The raster's own rows come last, starting with its northern border.
          const int from_border = row - (rows - 2);
          const int source = from_border < 0 ? -from_border : from_border;
          const T* line = samples.data() + static_cast<std::size_t>(source) * static_cast<std::size_t>(cols);
          all.insert(all.end(), line, line + cols);
          for (int col = cols - 2; col >= 1; --col) all.push_back(line[col]);
        }
        samples = std::move(all);
      },
      raster.samples);
  raster.cols = wide;
  raster.rows = high;
  return raster;
}

}  // namespace scarp
