// SPDX-License-Identifier: MIT
// Private to scarp/analysis: horizons by sweeps along parallel lines, an approximation several times as fast as
// horizon_scan.h.
//
//        far border  +---+---+---+      line     towards the azimuth, through one node of each row; all lines of an
//                    |   |  x|   |               azimuth lie beside the nodes by the same fraction
//        visits      +---+--x+---+      sample   x, linear between the two nodes beside the line
//                    |   | x |   |      hull     upper convex hull of the samples of a line, 8 rows behind the visit
//        now         +---+x--+---+               and farther
//                         o             node     o, the one nearest to the line in the row of the visit
//
// The horizon of the node is the largest of
//   - the slopes to the crossings up to 8 steps away, exactly those of horizon_crossings.h, and
//   - the slope to the major crossing at the step of the sample where the tangent from the node touches the hull, by
//     the same expression; where that crossing has no ground, the slope of the tangent.
// Most values are therefore horizons of horizon_crossings.h or lower, and the others differ by the distance of line and
// node. Rows are visited from the far border on, so that each sample is pushed once (V. Timonen, J. Westerholm,
// "Scalable Height Field Self-Shadowing", Computer Graphics Forum 29(2), 2010). The hull of that paper has neither near
// crossings nor the lag of 8 rows, and errs by whole degrees where a sample beside the node hides the ground behind it.
//
// The heights are transposed where the azimuth runs along the columns: rows here are then columns of the field.
//
// Lanes of vectors are lines. Results depend on no vector width and no thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "scarp/analysis/horizon_crossings.h"
#include "scarp/analysis/horizon_heights.h"

namespace scarp {

/// The crossings of an azimuth as a sweep asks for them, with offsets in the memory of heights.
class SweepTable {
 public:
  /// Major steps up to which every crossing is examined, and behind which samples enter the hull.
  static constexpr int kNearSteps = 8;

  /// `heights` are transposed if the crossings are along the columns.
  SweepTable(const HorizonHeights& heights, const HorizonCrossings& crossings)
      : SweepTable(heights.layout(), crossings) {}
  SweepTable(const HorizonLayout& heights, const HorizonCrossings& crossings);

  struct Entry {
    std::int32_t first;   ///< samples from the node to the first sample
    std::int32_t second;  ///< samples from there to the second
    float w, per_distance, drop;
  };
  /// Crossings 0, 1, ... up to kNearSteps.
  const std::vector<Entry>& near() const { return near_; }

  /// The major crossings by their step, one for each row, in arrays for gathers. The second sample, if w is not 0, is
  /// that in the column beside(). w is NaN where no node has such a crossing, and where an offset needs more than 32
  /// bits in the memory of a whole field.
  struct Majors {
    std::vector<std::int32_t> first;
    std::vector<float> w, per_distance, drop;
  };
  const Majors& majors() const { return majors_; }
  int beside() const { return col_sign_; }

  /// Horizontal distance in metres of an entry: those of near(), and then majors, by their step.
  const std::vector<float>& distances() const { return distances_; }
  std::int32_t first_major() const { return static_cast<std::int32_t>(near_.size()); }

  /// Whether rows ahead of a node have higher numbers (1) or lower ones (-1).
  int row_sign() const { return row_sign_; }
  /// Columns of a line at a visit, relative to visit 0.
  double drift(int visit) const { return -col_sign_ * tilt_ * visit; }
  float per_step() const { return per_step_; }  ///< 1 / length of a step, in 1/m
  /// Curvature lowers a sample by bend * (steps from the node)^2, metres. About the far border that differs from
  /// bend * visit^2 by what is linear in the steps, which moves no tangent.
  float bend() const { return bend_; }

 private:
  int row_sign_, col_sign_;
  double tilt_;
  float per_step_, bend_;
  std::vector<Entry> near_;
  Majors majors_;
  std::vector<float> distances_;
};

/// Receives horizons of `count` neighbouring nodes of a row, from column `col` on: slopes, NaN on holes and -inf
/// without ground; and entries of the table, or -1.
using SweepSink = std::function<void(int col, int row, int count, const float* slopes, const std::int32_t* entries)>;

/// Lines that one call sweeps.
inline constexpr int kSweptLines = 128;

/// Sweeps kSweptLines lines, the first of which is at column `line` (it may be negative) at visit 0, over `visits` rows
/// from the far border on. `eye`: metres above the node.
void sweep_horizons(const HorizonHeights& heights, const SweepTable& table, float eye, int line, int visits,
                    const SweepSink& sink);

/// The same line by line: the text to read first, and the judge of the vectors.
void sweep_horizons_by_one(const HorizonHeights& heights, const SweepTable& table, float eye, int line, int visits,
                           const SweepSink& sink);

/// The place of the lines at a visit: column of the nodes before them, weight of those after them, below 1, and column
/// of the nodes nearest to them, all relative to the number of a line.
struct SweptPlace {
  int before, nearest;
  float w;
};
SweptPlace swept_place(const SweepTable& table, int visit);

}  // namespace scarp
