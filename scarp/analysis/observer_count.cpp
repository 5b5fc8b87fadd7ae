// SPDX-License-Identifier: MIT
#include "scarp/analysis/observer_count.h"

#include <fmt/format.h>

#include <algorithm>

#include "scarp/analysis/block_maxima.h"
#include "scarp/analysis/viewshed_sweep.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"

namespace scarp {
namespace {

// Returns 0 for nodes that an observer may see, and the codes of the others.
std::vector<std::uint16_t> uncounted(std::span<const Viewpoint> views) {
  const SightGround& ground = views.front().ground();
  const int cols = ground.field().cols(), rows = ground.field().rows();
  std::vector<std::uint16_t> counts(static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows), 0);
  const bool limited = std::all_of(views.begin(), views.end(), [](const Viewpoint& view) { return view.has_limits(); });
  if (!limited && ground.field().nodata_count() == 0) return counts;
  parallel_for(rows, 16, [&](std::int64_t begin, std::int64_t end) {
    for (int row = static_cast<int>(begin); row < end; ++row) {
      std::uint16_t* out = counts.data() + static_cast<std::ptrdiff_t>(row) * cols;
      for (int col = 0; col < cols; ++col) {
        const Node node{col, row};
        const auto height = ground.height(node);
        const auto in_range = [&](const Viewpoint& view) {
          return view.in_range(node, view.target(view.ground().lowered(*height, col, row)));
        };
        if (!height) {
          out[col] = kCountHole;
        } else if (limited && std::none_of(views.begin(), views.end(), in_range)) {
          out[col] = kCountOutOfRange;
        }
      }
    }
  });
  return counts;
}

}  // namespace

std::vector<std::uint16_t> observer_count(std::span<const Viewpoint> views, const Progress& progress) {
  if (views.empty() || views.size() > kMostObservers)
    throw Error(fmt::format("viewshed: {} observers (1 to {} are possible)", views.size(), kMostObservers));
  const HeightField& field = views.front().ground().field();
  for (const Viewpoint& view : views) {
    const HeightField& other = view.ground().field();
    if (other.cols() != field.cols() || other.rows() != field.rows())
      throw Error(fmt::format("viewshed: fields of {} x {} and {} x {} samples", field.cols(), field.rows(),
                              other.cols(), other.rows()));
  }
  std::vector<std::uint16_t> counts = uncounted(views);
  const BlockMaxima maxima(field);
  parallel_for(
      static_cast<std::int64_t>(views.size()), 1,
      [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
          sweep_count(views[i], counts.data(), maxima);
      },
      progress);
  return counts;
}

}  // namespace scarp
