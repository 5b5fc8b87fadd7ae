// SPDX-License-Identifier: MIT
// Private to scarp/analysis: the horizons of blocks of nodes, exact (horizon_crossings.h).
//
//   group of 16 x 2 nodes      crossings up to 8 steps away: all
//   o o o ... o                then segments of 8 steps up to 64, of 32 up to 256, of 128 up to 1024, ...:
//   o o o ... o                the maximum of the segment's window, seen from the node at the segment's nearest
//                              crossing, is not above the horizon so far: skipped; else its four parts, and at
//                              last its crossings
//
// Neighbouring nodes lie in the lanes of a vector: their samples at one crossing are neighbours, too.
//
// Warm start: the crossings around those that won in the group above are tried first, and the horizon is lowered by one
// unit in the last place. The walk then finds the maximum again, nearest first: the result does not depend on the
// start.
//
// Why skipping is exact, with u = 2^-24 and H = max |height| + eye: the slope to a crossing of the segment is
// fma(g, p, -drop), where g is at most 6 u H above the real w h1 + (1 - w) h0 - z <= M - z, and the maximum M - z in
// floats at most 3 u H below. Maxima are raised by 16 u H, so g <= b = M - z in floats; rounding is monotone, so
// fma(b, p, -least drop) is at least the slope, with the largest p of the segment if b >= 0, else the smallest.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scarp/analysis/horizon.h"
#include "scarp/analysis/horizon_crossings.h"
#include "scarp/analysis/horizon_ground.h"

namespace scarp {

/// The crossings of an azimuth with offsets in the memory of a ground, and the segments of its levels.
class HorizonTable {
 public:
  HorizonTable(const HorizonGround& ground, const HorizonCrossings& crossings)
      : HorizonTable(ground.heights().layout(), crossings) {}
  HorizonTable(const HorizonLayout& heights, const HorizonCrossings& crossings);

  struct Entry {
    std::ptrdiff_t first;  ///< samples from the node to the first sample
    std::int32_t second;   ///< samples from there to the second
    float w, per_distance, drop;
  };
  struct Segment {
    std::int32_t begin, end;              ///< entries
    std::int32_t corner_col, corner_row;  ///< of its window, from the node
    float most_per_distance, least_per_distance, least_drop;
  };

  const std::vector<Entry>& entries() const { return entries_; }
  /// Horizontal metres to each entry.
  const std::vector<float>& distances() const { return distances_; }
  const std::vector<Segment>& segments(int level) const { return segments_[static_cast<std::size_t>(level)]; }
  /// Number of entries that nodes at this distance from the borders ahead can reach.
  std::int32_t reachable(int cols_ahead, int rows_ahead) const;
  int col_sign() const { return col_sign_; }
  int row_sign() const { return row_sign_; }
  /// Entries by which the ridge that a node sees moves from one group to the next one below.
  std::int32_t shift() const { return shift_; }

 private:
  std::vector<Entry> entries_;
  std::vector<float> distances_;
  std::vector<std::vector<Segment>> segments_;
  std::vector<std::int32_t> by_col_, by_row_;
  int col_sign_, row_sign_;
  std::int32_t shift_;
};

/// Writes the slopes of the horizons of the nodes of `rect`, rows of `pitch`: -inf without any crossing, NaN on holes.
/// `entry`, if not null, receives the winning entry, or -1. `eye`: metres above the node, >= 0.
void scan_horizon(const HorizonGround& ground, const HorizonTable& table, float eye, const NodeRect& rect, float* slope,
                  std::int32_t* entry, std::ptrdiff_t pitch);

/// The same by every crossing, one after another: the text to read first, and the judge of the vectors.
void scan_horizon_by_all(const HorizonGround& ground, const HorizonTable& table, float eye, const NodeRect& rect,
                         float* slope, std::int32_t* entry, std::ptrdiff_t pitch);

}  // namespace scarp
