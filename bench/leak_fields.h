// SPDX-License-Identifier: MIT
// The grounds of `scarp-bench leaks`: every kind on which engines are known to lose rays. All fit in a core's cache,
// except one large field.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/embree_peer.h"
#include "scarp/accel/max_pyramid.h"
#include "scarp/field/height_field.h"
#include "scarp/march/height/height_target.h"
#include "scarp/source/raster/procedural_dem.h"

namespace scarp::bench {

/// Number of holes among the cells of a rectangle, in O(1).
class HoleCounts {
 public:
  explicit HoleCounts(const HeightField& field);
  /// Cells [col_begin, col_end) x [row_begin, row_end), inside the field.
  bool any(const CellBox& box) const;

 private:
  int stride_ = 0;
  std::vector<std::int32_t> sums_;  // number of hole cells north-west of each node; empty without holes
};

/// A node of the grid.
struct Node {
  int col, row;
};

struct LeakField {
  std::string name;
  HeightField field;
  std::optional<ProceduralDem> generator;  ///< set if the samples are those of a procedural DEM
  MaxPyramid pyramid{field};
  HoleCounts holes{field};
  std::vector<Node> rim{};  ///< nodes with a height that are next to a hole
  /// Embree's triangles over the same samples; null for fields that wrap, are solid or have holes.
  std::unique_ptr<EmbreePeer> embree{};

  HeightTarget target() const { return {&field, &pyramid}; }
};

/// All grounds, with Embree if requested. Deterministic by seed; `large` is the side of the large one, in samples.
std::vector<LeakField> make_leak_fields(std::uint64_t seed, int large, bool embree);

}  // namespace scarp::bench
