// SPDX-License-Identifier: MIT
// Private to scarp/analysis: angles of slopes, and what one azimuth adds to the measures of sky_view.h. Results depend
// on no vector width. NaN stays NaN; -inf, no ground, is level ground for the measures.
#pragma once

#include <cstddef>

namespace scarp {

/// Arc tangents, -pi/2 to pi/2, off by less than 2^-22: the polynomial of S. L. Moshier's Cephes Mathematical Library,
/// atanf().
void find_angles(const float* slopes, std::size_t count, float* angles);

/// Adds 1 - sin h.
void add_sky_fraction(const float* slopes, std::size_t count, float* sums);

/// Tangent planes of nodes: cos b, and sin b times the direction of the aspect.
struct TangentPlanes {
  const float *level, *east, *north;
};

/// Adds cos b sin^2 H + sin b cos(azimuth - a) (H - sin H cos H); `east` and `north` are the direction of the azimuth.
void add_sky_view_factor(const float* slopes, const TangentPlanes& planes, float east, float north, std::size_t count,
                         float* sums);

/// Adds pi/2 - h.
void add_openness(const float* slopes, std::size_t count, float* sums);

}  // namespace scarp
