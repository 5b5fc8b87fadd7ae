// SPDX-License-Identifier: MIT
// Lines of sight over a field that is too large for memory. Its nodes are read in parts along the line, as a diagonal
// of 40,000 cells passes 79 squares of 512 cells and not 40,000 x 40,000. Results are those of line_of_sight() and
// fresnel_clearance() over the whole field, bit by bit: crossings are integers, which a part only moves.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "scarp/analysis/horizon.h"
#include "scarp/analysis/line_of_sight.h"

namespace scarp {

/// Results for one line.
struct SightAnswer {
  LineOfSight line{};
  FresnelClearance fresnel{};
};

class SightParts {
 public:
  /// Returns the heights of some nodes as a field, whose samples are used until the next call.
  using Read = std::function<HeightField(const NodeRect& nodes)>;

  /// A field of `cols` x `rows` nodes. `side`: cells of a part along the longer axis of a line, > 0.
  SightParts(int cols, int rows, int side = 512) : cols_(cols), rows_(rows), side_(side) {}

  /// Returns the nodes of the parts in the order in which answer() reads them.
  std::vector<NodeRect> along(const SightEnd& from, const SightEnd& to) const;
  /// Returns the four nodes around an end, or fewer at the field's border.
  NodeRect around(const SightEnd& end) const;

  /// Answers one query. `wavelength` in metres; nullopt: no Fresnel clearance. `read` is also called for around() both
  /// ends. Throws Error as SightLine, and as `read`.
  SightAnswer answer(const SightEnd& from, const SightEnd& to, const SightCurvature& curvature,
                     std::optional<double> wavelength, const Read& read) const;

 private:
  NodeRect nodes_between(double col, double row, double other_col, double other_row, double beside) const;

  int cols_, rows_, side_;
};

}  // namespace scarp
