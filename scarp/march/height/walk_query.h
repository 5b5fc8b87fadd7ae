// SPDX-License-Identifier: MIT
// The query of a traversal of `max-mip`.
#pragma once

#include <cstdint>
#include <vector>

#include "scarp/march/height/max_mip_resume.h"
#include "scarp/march/hit_rules.h"

namespace scarp {
struct MarchTrace;
}

namespace scarp::max_mip {

/// The query: the closest hit, any hit, or as Wanted specifies: all hits, the closest one that a filter accepts, or the
/// closest one by bisection. These share one walk: compiling more of them costs more than a test at each hit.
enum class Ask { closest, any, as_wanted };

/// Parameters of a query besides the ray.
struct Wanted {
  bool bisects = false;               ///< as_wanted: the closest hit by bisection
  int halvings = 0;                   ///< number of bisections
  double t_clear = kNotClear;         ///< until when the ray is known to be above the ground by more than rounding
  std::vector<Hit>* all = nullptr;    ///< as_wanted: receives all hits, unless null
  bool from_below = false;            ///< as_wanted: hits from below, over the inverted ground
  const HitFilter* accept = nullptr;  ///< as_wanted: null: the first hit is accepted
  MarchTrace* trace = nullptr;        ///< as_wanted: receives the blocks and cells of the walk, unless null
};

// Look-ahead parameters of any hit, from a search over the rays of scarp-bench (doc/dev/decisions/march.md).
constexpr std::uint32_t kPatience = 3;  // traversal steps before the first look-ahead: half of the rays need no more
constexpr int kProbeLevel = 3;          // blocks of 8 x 8 cells
constexpr int kProbes = 24;
constexpr double kFirstProbe = 8, kProbeGrowth = 1.2;  // steps in cells
constexpr double kShortWay = 128;                      // cells up to which the traversal is as fast

}  // namespace scarp::max_mip
