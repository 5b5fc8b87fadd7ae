// SPDX-License-Identifier: MIT
// Viewsheds of all nodes by centrifugal horizon merging, equal to one ray per node (sight_rays.h).
//
//      \  north  /     four sectors around the observer, each cut into parts by u
//       \       /
//   west \     /       in the sector to the east, projected from the observer onto the plane x = 1:
//         \ o /          u = y / x, s = (z - eye) / x
//         /   \        straight edges stay straight, and a line of sight is a line u = const
//        /     \ east
//
// Ring by ring (column by column in the sector to the east): first test the samples of the ring against the horizon,
// then merge the edges between the previous ring and this one (spokes), then the edges along the ring. A line of sight
// crosses no other edge between the rings: in the sector, a step to the next ring moves it by at most one sample.
// Blocks of samples that lie below the horizon are skipped: neither they nor their edges rise above it.
//
// Source: H. J. Haverkort and L. Toma, "A comparison of I/O-efficient algorithms for visibility computation on massive
// grid terrains", arXiv 1810.01946, 2018. Guarantee: exact, for any number of threads.
#pragma once

#include <cstdint>

#include "scarp/analysis/block_maxima.h"
#include "scarp/analysis/sweep_statistics.h"
#include "scarp/analysis/viewshed.h"
#include "scarp/base/progress.h"

namespace scarp {

/// Writes the code of every node, rows from north to south. `maxima`: of the view's field, for callers with many
/// observers; null: computed here.
SweepStatistics sweep_viewshed(const Viewpoint& view, Seen* codes, const Progress& progress = {},
                               const BlockMaxima* maxima = nullptr);

/// Adds 1 to the count of every node that is visible and within the limits. Other threads may add to the same counts.
/// `maxima`: of the view's field.
SweepStatistics sweep_count(const Viewpoint& view, std::uint16_t* counts, const BlockMaxima& maxima);

/// Writes the least visible height of every node (least_visible() in viewshed.h).
SweepStatistics sweep_least_visible(const Viewpoint& view, double* least, const Progress& progress = {});

}  // namespace scarp
