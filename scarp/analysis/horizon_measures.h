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

/// Upward normals of nodes, of length 1.
struct NodeNormals {
  const float *east, *north, *level;
};

/// Adds cos b sin^2 H + sin b cos(azimuth - a) (H - sin H cos H); `east` and `north` are the direction of the azimuth.
void add_sky_view_factor(const float* slopes, const NodeNormals& normals, float east, float north, std::size_t count,
                         float* sums);

/// Adds pi/2 - h.
void add_openness(const float* slopes, std::size_t count, float* sums);

}  // namespace scarp
