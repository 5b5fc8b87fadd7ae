// SPDX-License-Identifier: MIT
// Millions of lines of sight: returns only whether they are visible. Results equal those of line_of_sight(), several
// times faster.
//
//   const scarp::BlockMaxima maxima(field);
//   const auto visible = scarp::visible_lines(field, lines, maxima);
#pragma once

#include <span>
#include <vector>

#include "scarp/analysis/block_maxima.h"
#include "scarp/analysis/line_of_sight.h"
#include "scarp/base/progress.h"

namespace scarp {

/// Both ends of a line.
struct LineEnds {
  SightEnd from, to;
};

/// Returns 1 for each line that is visible, 0 for each that is blocked. `maxima` are those of the field. Throws as
/// SightLine does.
std::vector<char> visible_lines(const HeightField& field, std::span<const LineEnds> lines, const BlockMaxima& maxima,
                                const SightCurvature& curvature = {}, const Progress& progress = {});

}  // namespace scarp
