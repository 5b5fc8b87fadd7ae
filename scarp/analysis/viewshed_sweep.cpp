// SPDX-License-Identifier: MIT
#include "scarp/analysis/viewshed_sweep.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <mutex>
#include <optional>

#include "scarp/analysis/viewshed_sector.h"
#include "scarp/base/parallel.h"
#include "scarp/base/progress_part.h"

namespace scarp {
namespace {

// Parts of each sector: enough to share the work among threads, few enough to keep rings long. A power of two.
constexpr int kParts = 4;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

SweepStatistics sweep(const Viewpoint& view, const SectorMaps& maps, const Progress& progress) {
  SweepStatistics all;
  std::mutex mutex;
  parallel_for(
      4 * kParts, 1,
      [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) {
          SectorPart part;
          part.direction = static_cast<SweepDirection>(i / kParts);
          part.low = -1 + 2.0 * static_cast<double>(i % kParts) / kParts;
          part.high = part.low + 2.0 / kParts;
          const SweepStatistics counts = sweep_sector(view, part, maps);
          const std::lock_guard lock(mutex);
          all.add(counts);
        }
      },
      progress);
  return all;
}

// Calls body(node, index, lowered height) for each node; the height is -infinity for holes.
template <class Body>
void for_each_node(const Viewpoint& view, const Progress& progress, const Body& body) {
  const SightGround& ground = view.ground();
  const HeightField& field = ground.field();
  field.visit([&](const auto& grid) {
    parallel_for(
        grid.rows, 64,
        [&](std::int64_t begin, std::int64_t end) {
          for (int r = static_cast<int>(begin); r < end; ++r) {
            const std::size_t first = static_cast<std::size_t>(r) * static_cast<std::size_t>(grid.cols);
            for (int c = 0; c < grid.cols; ++c) {
              const auto sample = grid.at(c, r);
              const double height = grid.is_nodata(sample)
                                        ? -std::numeric_limits<double>::infinity()
                                        : ground.lowered(field.height_from_sample(static_cast<double>(sample)), c, r);
              body(Node{c, r}, first + static_cast<std::size_t>(c), height);
            }
          }
        },
        progress);
  });
}

}  // namespace

SweepStatistics sweep_viewshed(const Viewpoint& view, Seen* codes, const Progress& progress,
                               const BlockMaxima* maxima) {
  const HeightField& field = view.ground().field();
  if (!view.has_limits() && field.nodata_count() == 0) {
    std::fill(codes, codes + static_cast<std::ptrdiff_t>(field.cols()) * field.rows(), Seen::hidden);
  } else {
    for_each_node(view, progress_part(progress, 0, 2), [&](Node node, std::size_t i, double lowered) {
      codes[i] = lowered == -std::numeric_limits<double>::infinity() ? Seen::hole
                 : view.in_range(node, view.target(lowered))         ? Seen::hidden
                                                                     : Seen::out_of_range;
    });
  }
  std::optional<BlockMaxima> own_maxima;
  if (maxima == nullptr) maxima = &own_maxima.emplace(field);
  Seen& own = codes[static_cast<std::ptrdiff_t>(view.observer().row) * field.cols() + view.observer().col];
  if (own == Seen::hidden) own = Seen::visible;
  return sweep(view, {.codes = codes, .maxima = maxima}, progress_part(progress, 1, 2));
}

SweepStatistics sweep_count(const Viewpoint& view, std::uint16_t* counts, const BlockMaxima& maxima) {
  const Node own = view.observer();
  if (const auto lowered = view.ground().lowered(own); lowered && view.in_range(own, view.target(*lowered)))
    add_visible(counts[static_cast<std::ptrdiff_t>(own.row) * view.ground().field().cols() + own.col]);
  return sweep(view, {.counts = counts, .maxima = &maxima}, {});
}

SweepStatistics sweep_least_visible(const Viewpoint& view, double* least, const Progress& progress) {
  constexpr double kNever = -std::numeric_limits<double>::infinity();
  for_each_node(view, progress_part(progress, 0, 2), [&](Node node, std::size_t i, double lowered) {
    least[i] = lowered == kNever || !view.in_range(node, view.target(lowered)) ? kNan : kNever;
  });
  return sweep(view, {.least = least}, progress_part(progress, 1, 2));
}

}  // namespace scarp
